# SPDX-License-Identifier: LGPL-2.1-or-later
"""Downloads over a link with faults drawn by chance, and what has to hold of each of them.

A download may end in two ways only: the controller holds the program to the last character, or there is a clear error.
After an error nothing is left under the number, or the error says that this could not be shown; then the link refuses
to run what is there.
"""

import random
from dataclasses import dataclass

from rig import SETTINGS, Noise, Wire, controller, listed

from pkm_post.control.link import run as operate
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, DownloadError, NotReadyError, PmacError
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.simulator import SerialPort

FIRST = (500.0,) * 6
LONGEST_S = 300.0
"""Seconds of the wire's clock in which each download has to end, in whatever way."""


def small_program(knots=6):
    """Some lines of every kind that programs have."""
    lines = ["ABS", "FRAX(A,B,C,U,V,W)", "LINEAR", "TA500 TS0 F10"]
    lines += [" ".join(f"{letter}500.000000" for letter in SETTINGS.letters), "DWELL0", "S1200.5 M3", "PVT20"]
    lines += [
        " ".join(f"{letter}500.{knot:05d}{strut}:{-knot * strut / 8:.4f}" for strut, letter in enumerate("ABCUVW", 1))
        for knot in range(1, knots + 1)
    ]
    lines += [" ".join(f"{letter}500.000000:0.0000" for letter in SETTINGS.letters), "DWELL0", "LINEAR"]
    return PmacProgram(10, tuple(lines))


@dataclass(frozen=True)
class Outcome:
    """How a download ended.

    Attributes:
        what: ``"loaded"``, ``"cleared"``, ``"unknown"``, or ``"untouched"`` when it did not begin.
        seconds: of the wire's clock.
        faults: how many bytes were changed.
    """

    what: str
    seconds: float
    faults: int = 0


def refuse(wire, place, number):
    """Let the controller refuse the line of a program at a place with an error."""
    line, taken = wire.line, [0]
    command, refusal = line.command, line.refusal

    def is_refused(text):
        if wire.controller.memory.opened is None or text in ("CLOSE", "CLEAR"):
            return False
        taken[0] += 1
        return taken[0] == place

    line.command = lambda text: line.refused(number) if is_refused(text) else command(text)
    line.refusal = lambda text: number if is_refused(text) else refusal(text)


def reset_after(wire, writes):
    """Let the controller be reset, with what it had saved, when it has got so many pieces."""
    wrapped, count = wire.fault, [0]

    def fault(data, out):
        count[0] += out
        if out and count[0] == writes:
            wire.controller.reset()
            wire.line.receive(b"\x18")
        return wrapped(data, out)

    wire.fault = fault


def tried(wire, program, reference, **arguments):
    """Download over a wire and check what has to hold.

    Args:
        wire: with its faults.
        program: to load.
        reference: what a controller lists that holds it.
        arguments: of ``download``.
    """
    session = wire.session()
    try:
        session.open()
        download(session, program, **arguments)
    except DownloadError as failed:
        what = "cleared" if failed.cleared else "unknown"
    except CancelledError:
        what = "cleared"
    except PmacError:
        what = "untouched"
    else:
        what = "loaded"
    assert wire.now < LONGEST_S
    made = wire.controller
    there = [line for line in listed(made, program.number) if line != "RETURN"]
    if what == "loaded":
        assert there == reference and made.memory.opened is None
    elif what == "cleared":
        assert there == [] and made.memory.opened is None
    elif there != reference:
        assert_nothing_runs(wire, program)
    return Outcome(what, wire.now, getattr(wire.fault, "faults", 0))


def assert_nothing_runs(wire, program):
    """What is left is refused, by the controller itself while its buffer is open, and by the link in any case."""
    made = wire.controller
    if made.memory.opened is not None:
        assert SerialPort(made).refusal(f"&1B{program.number}R")
    session = Wire(made, wire.kind, line=wire.line).session()
    session.open()
    try:
        operate.start_program(session, SETTINGS, program, FIRST)
    except NotReadyError as refused:
        assert f"program {program.number} in the controller is a different one" in str(refused)
    else:
        raise AssertionError("a program that is not the one that was sent was started")
    assert not made.runs_program()


def by_chance(seed, program, reference):
    """A download with a fault of a kind, at a place and over a link that the seed decides."""
    choice = random.Random(seed)
    kind, fault = choice.choice(("serial", "tcp")), choice.choice(tuple(_FAULTS))
    wire = Wire(controller(), kind)
    _FAULTS[fault](wire, choice)
    return fault, tried(wire, program, reference)


def _noise(*kinds):
    def noisy(wire, choice):
        wire.fault = Noise(choice.random(), 10 ** choice.uniform(-4, -2), kinds or ("drop", "double", "flip"))

    return noisy


def delayed(wire, choice):
    wire.delay = lambda: choice.uniform(0, 1) if choice.random() < 0.05 else 0.0


def in_pieces(wire, choice):
    wire.piece = choice.randrange(1, 20)


def _cut(wire, choice):
    wire.cut_at, wire.mends = choice.randrange(1, 6000), choice.random() < 0.5


def _refused(wire, choice):
    refuse(wire, choice.randrange(1, 18), choice.randrange(1, 20))


def _reset(wire, choice):
    reset_after(wire, choice.randrange(1, 60))


_FAULTS = {
    "lost bytes": _noise("drop"),
    "doubled bytes": _noise("double"),
    "changed bits": _noise("flip"),
    "all three": _noise(),
    "delay": delayed,
    "pieces": in_pieces,
    "cut": _cut,
    "refusal": _refused,
    "reset": _reset,
}


def reference_of(program):
    """What a controller lists that got a program over a link without faults."""
    wire = Wire(controller())
    session = wire.session()
    session.open()
    download(session, program)
    return [line for line in listed(wire.controller, program.number) if line != "RETURN"]
