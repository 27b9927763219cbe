# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a controller answers: every action ends with an exit code and a line that says why, without a traceback."""

import random
import re
from types import SimpleNamespace

import pytest
from rig import SETTINGS, STROKE, Wire, controller, served

from pkm_post.cli import main
from pkm_post.control.link.errors import LinkLostError, PmacError
from pkm_post.control.link.owner_record import read_record
from pkm_post.control.link.rotary_buffer import RotaryBuffer
from pkm_post.control.link.session import free_memory
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.status import is_busy, read_status
from pkm_post.control.link.status_bits import PowerMotorBits
from pkm_post.control.simulator import Controller
from pkm_post.machine import machine_named
from pkm_post.writing.controllers.pmac import settings_of, setup_text

MACHINE = "example_6tps"
JUNK = (
    "",
    "nan",
    "inf",
    "-",
    "1e999",
    "1.2.3",
    "$",
    "$FFFFFFFFFFFFFFFFFFFF",
    "0",
    "-1",
    "X",
    "9" * 400,
    "1 2",
    ".",
    "+-3",
    "..X+1",
    "1.2.3X-4.5.6",
    "9" * 5000,
)
ACTIONS = {
    "probe": (),
    "status": (),
    "monitor": ("--seconds", "0.01"),
    "resume": (),
    "override": ("50",),
    "jog": ("--x", "1"),
    "mdi": ("G91 G1 X1 F100",),
    "home": ("--trigger", "#1HM"),
}


@pytest.fixture(scope="module")
def machine():
    return machine_named(MACHINE)[0]


def lying(made, choice, share):
    """Let a controller answer some questions with what makes no sense."""
    from pkm_post.control.simulator import serial_port as line

    execute = line.execute

    def reported(session, text):
        said = execute(session, text)
        if text == "SIZE" or re.match("I3", text):
            return said  # a false answer to these cannot be noticed
        lies = [choice.choice(JUNK) if choice.random() < share else each for each in said]
        return lies if choice.random() > share else lies[:-1]

    return reported


@pytest.mark.slow
@pytest.mark.parametrize("action", ACTIONS)
def test_every_action_ends_in_words(action, machine, capsys, monkeypatch):
    choice = random.Random(action)
    made = Controller()
    made.load(setup_text(settings_of(machine)[0], "test", machine.strut_stroke).splitlines())
    made.load([f"#{motor}J/ #{motor}HMZ" for motor in range(1, 7)])
    with served(made) as port:
        for share in (0.02, 0.05, 0.2, 1.0, 1.0):
            monkeypatch.setattr("pkm_post.control.simulator.serial_port.execute", lying(made, choice, share))
            code = main(["pmac", action, "--port", port, "--machine", MACHINE, "--patience", "0.5", *ACTIONS[action]])
            reported = capsys.readouterr()
            monkeypatch.undo()
            assert code == 0 or (code == 1 and reported.err.strip()), (share, reported)
            assert "Traceback" not in reported.err


def answered(place, said):
    """The honest answer to the query of the state, but for one of its lines."""
    wire = Wire(controller(), "tcp")
    with wire.session() as session:
        honest = session.query

        def query(text, most=1 << 16):
            lines = list(honest(text, most))
            lines[place] = said
            return tuple(lines)

        session.query = query
        return read_status(session, SETTINGS)


BITS, COUNTS, SYSTEM, OVERRIDE = 3, 4, 18, 19


@pytest.mark.parametrize(
    ("place", "said", "expected"),
    [
        (BITS, "+12800008400", "expected 12 hexadecimal digits"),
        (BITS, "8_2800008400", "expected 12 hexadecimal digits"),
        (BITS, "0x2800008400", "expected 12 hexadecimal digits"),
        (BITS, "$$812000008400", "expected 12 hexadecimal digits"),
        (BITS, "\uff18" + "0" * 11, "expected 12 hexadecimal digits"),
        (SYSTEM, "-" + "0" * 17, "expected 18 hexadecimal digits"),
        (COUNTS, "1_000", "expected a number"),
        (COUNTS, "nan", "expected a number"),
        (COUNTS, "1e999", "expected a number"),
        (COUNTS, "\uff18", "expected a number"),
        (OVERRIDE, "nan", "expected a number"),
        (OVERRIDE, "inf", "expected a number"),
        (OVERRIDE, "1_00", "expected a number"),
        (OVERRIDE, "-50", "expected an override of 0 or more"),
    ],
)
def test_what_no_controller_answers_is_refused_and_quoted(place, said, expected):
    with pytest.raises(LinkLostError) as lost:
        answered(place, said)
    assert expected in str(lost.value) and repr(said.removeprefix("$")) in str(lost.value)


def test_bits_and_numbers_as_controllers_write_them():
    assert answered(BITS, "$812000008400").motors == answered(BITS, "812000008400").motors
    assert answered(OVERRIDE, " 1E2").override == 100 and answered(COUNTS, "-.5").length[1] < SETTINGS.zero_length[1]


def test_a_power_pmac_that_reports_no_number_of_systems():
    said = {"Sys.MaxCoords": "1e999"}
    bits = "0" * PowerMotorBits.DIGITS
    session = SimpleNamespace(
        has_handshake=False, query=lambda text: (said.get(text, bits),) * (1 if text in said else 6)
    )
    with pytest.raises(LinkLostError, match="expected a number, got '1e999'"):
        is_busy(session)


ASKING = {
    "set-up": lambda session: check_setup(session, SETTINGS, STROKE),
    "status": lambda session: read_status(session, SETTINGS),
    "record": read_record,
    "lines ahead": lambda session: RotaryBuffer(session, SETTINGS, ["A1:0"], 100).lines_ahead(),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", ASKING)
def test_every_question_ends_in_a_fault_of_the_link_or_of_the_machine(what):
    choice, wire = random.Random(what), Wire(controller(), "tcp")
    with wire.session() as session:
        honest = session.query
        for share in [0.05, 0.2, 0.5, 1.0] * 10:

            def ask(text, most=1 << 16, share=share):
                reported = tuple(
                    choice.choice(JUNK) if choice.random() < share else each for each in honest(text, most)
                )
                return (
                    reported if choice.random() > share / 4 else (reported[:-1], (*reported, "1"))[choice.randrange(2)]
                )

            session.query = ask
            try:
                ASKING[what](session)
            except PmacError as fault:
                assert str(fault)
        session.query = honest
        ASKING[what](session)


@pytest.mark.parametrize("answer", ["1_000", "", "+5", "12.5", "\u0663"])
def test_a_size_of_the_free_memory_that_no_controller_writes_is_refused(answer):
    with pytest.raises(LinkLostError, match="SIZE: expected a number of words"):
        free_memory(SimpleNamespace(query=lambda text: [answer]))
    assert free_memory(SimpleNamespace(query=lambda text: ["-1"])) == -1
