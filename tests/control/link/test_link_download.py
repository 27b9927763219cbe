# SPDX-License-Identifier: LGPL-2.1-or-later
"""Downloads to the simulated controller, over links that do everything a link can do."""

from collections import Counter

import pytest
from link_faults import by_chance, reference_of, refuse, reset_after, small_program, tried
from rig import Noise, Wire, controller, listed
from series import cases

from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, DownloadError, RefusedError
from pkm_post.control.link.program import PmacProgram
from pkm_post.control.simulator import Controller, SimulatorSettings

KINDS = ("serial", "tcp")
FIRST_SEED, SEEDS = 0, cases(75)
"""So many of the faults by chance; ``make soak`` tries thousands."""


@pytest.fixture(scope="module")
def program():
    return small_program()


@pytest.fixture(scope="module")
def reference(program):
    return reference_of(program)


@pytest.mark.parametrize("kind", KINDS)
def test_a_program_is_loaded(kind, program, reference):
    reported = []
    wire = Wire(controller(), kind)
    with wire.session() as session:
        loaded = download(session, program, lambda done, lines: reported.append((done, lines)))
    assert (loaded.program, loaded.lines, loaded.digest) == (10, len(program.lines), program.digest)
    assert loaded.resumptions == 0
    assert reported[-1] == (len(program.lines), len(program.lines)) and reported == sorted(reported)
    # The reference is what this very way gives; here are two lines of it as one reads them in the manual.
    assert reference[:2] == ["ABS", "FRAX(A,B,C,U,V,W)"]
    assert [line for line in listed(wire.controller) if line != "RETURN"] == reference


@pytest.mark.parametrize("kind", KINDS)
def test_what_stood_there_is_replaced(kind, program, reference):
    wire = Wire(controller(), kind)
    for line in ("OPEN PROG 10", "CLEAR", "RAPID", "A1", "CLOSE", "OPEN PROG 11", "CLEAR", "ABS", "CLOSE"):
        assert not wire.line.refusal(line)
    assert tried(wire, program, reference).what == "loaded"
    assert listed(wire.controller, 11)[0] == "ABS"


@pytest.mark.parametrize("kind", KINDS)
def test_any_line_may_be_refused(kind, program, reference):
    for place in range(1, len(program.lines) + 1):
        wire = Wire(controller(), kind)
        refuse(wire, place, 6)
        assert tried(wire, program, reference).what == "cleared", place


@pytest.mark.parametrize("kind", KINDS)
def test_the_refused_line_is_named(kind, program):
    wire = Wire(controller(), kind)
    refuse(wire, 8, 6)
    with wire.session() as session, pytest.raises(DownloadError, match="'PVT20': ERR006, the buffer has no room"):
        download(session, program)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "first"), [(kind, place) for place, kind in enumerate(KINDS)])
@pytest.mark.parametrize("mends", [True, False])
def test_the_link_is_cut_at_any_byte(kind, first, mends):
    """Over one link at every second byte, over the other one at those between."""
    program = PmacProgram(10, ("ABS", "PVT20", "A500.125000:-0.5000"))
    reference = reference_of(program)
    whole = Wire(controller(), kind)
    assert tried(whole, program, reference).what == "loaded"
    made = Counter()
    for place in range(first, whole.passed, len(KINDS)):
        wire = Wire(controller(), kind, cut_at=place + 1, mends=mends)
        made[tried(wire, program, reference).what] += 1
    assert set(made) == ({"loaded"} if mends else {"unknown", "untouched", "loaded"})


@pytest.mark.parametrize("kind", KINDS)
def test_bytes_come_in_pieces_of_any_size(kind, program, reference):
    for piece in (1, 2, 3, 5, 8, 13, 100):
        assert tried(Wire(controller(), kind, piece=piece), program, reference).what == "loaded"


def test_bytes_of_a_line_are_changed_lost_or_doubled_once(program, reference):
    """On the serial line nothing of that gets into the program: it ends loaded, or cleared."""
    line = program.lines[9].encode()

    class Once:
        def __init__(self, change):
            self.change, self.faults = change, 0

        def __call__(self, data, out):
            if out and data.startswith(line) and not self.faults:
                self.faults = 1
                return self.change(data)
            return data

    for place in (*range(0, len(line), 5), len(line)):  # the ^N behind the line as well
        for change in (
            lambda data, place=place: data[:place] + data[place + 1 :],
            lambda data, place=place: data[: place + 1] + data[place:],
            lambda data, place=place: data[:place] + bytes([data[place] ^ 4]) + data[place + 1 :],
        ):
            wire = Wire(controller(), fault=Once(change))
            outcome = tried(wire, program, reference)
            assert outcome.what in ("loaded", "cleared") and outcome.faults == 1


@pytest.mark.parametrize("kind", KINDS)
def test_the_user_stops_it_at_any_line(kind, program, reference):
    for stop in range(1, 6):
        asked = [0]

        def is_cancelled(stop=stop, asked=asked):
            asked[0] += 1
            return asked[0] == (stop if kind == "serial" else 1)

        outcome = tried(Wire(controller(), kind), program, reference, is_cancelled=is_cancelled)
        assert outcome.what == "cleared"


def test_an_interrupt_clears_as_well(program):
    wire = Wire(controller())

    def interrupt(done, lines):
        if done == 5:
            raise KeyboardInterrupt

    with wire.session() as session, pytest.raises(CancelledError, match="nothing is left under program 10"):
        download(session, program, interrupt)
    assert listed(wire.controller) in ([], ["RETURN"])


def test_a_fault_of_the_caller_clears_and_goes_on(program):
    wire = Wire(controller())

    def fault(done, lines):
        raise ZeroDivisionError

    with wire.session() as session, pytest.raises(ZeroDivisionError):
        download(session, program, fault)
    assert listed(wire.controller) in ([], ["RETURN"])


def test_a_lost_link_is_gone_on_with_where_the_controller_is(program, reference):
    whole = Wire(controller())
    tried(whole, program, reference)
    wire = Wire(controller(), cut_at=whole.passed // 2)
    with wire.session() as session:
        loaded = download(session, program)
    assert loaded.resumptions == 1
    assert wire.sent.count(b"PVT20\x0e") == 1  # a line of the first half was not sent again
    assert [line for line in listed(wire.controller) if line != "RETURN"] == reference


@pytest.mark.parametrize("kind", KINDS)
def test_the_controller_is_reset_on_the_way(kind, program, reference):
    made = Counter()
    for writes in range(1, 60, 3):
        wire = Wire(controller(), kind)
        reset_after(wire, writes)
        made[tried(wire, program, reference).what] += 1
    # Resets behind the last write change nothing; one on the way is gone on with, or ends in a number that is clear.
    assert made["loaded"] and set(made) <= {"loaded", "cleared"}


def test_too_large_for_the_memory():
    wire = Wire(Controller(SimulatorSettings(memory_words=1000)))
    with (
        wire.session() as session,
        pytest.raises(DownloadError, match="takes about .* words; nothing is left|takes about"),
    ):
        download(session, small_program(500))
    assert listed(wire.controller) in ([], ["RETURN"])


def test_a_running_program_is_left_alone(program):
    wire = Wire(controller())
    for line in ("OPEN PROG 10", "CLEAR", "LINEAR", "DWELL100000", "CLOSE", "&1B10R"):
        assert not wire.line.refusal(line)
    before = listed(wire.controller)
    with wire.session() as session, pytest.raises(RefusedError, match="ERR001"):
        download(session, program)
    assert listed(wire.controller) == before and wire.controller.runs_program()


@pytest.mark.parametrize("kind", KINDS)
def test_a_link_of_noise_alone_ends(kind, program, reference):
    for seed in range(3):
        assert tried(Wire(controller(), kind, fault=Noise(seed, 0.2)), program, reference).what != "loaded"


@pytest.mark.slow
def test_faults_by_chance(program, reference):
    ends = Counter(by_chance(seed, program, reference)[1].what for seed in range(FIRST_SEED, FIRST_SEED + SEEDS))
    assert ends["loaded"] > SEEDS // 4 and ends["cleared"] > SEEDS // 10
