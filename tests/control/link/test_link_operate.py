# SPDX-License-Identifier: LGPL-2.1-or-later
"""Set-up, start, hold, resume and abort with the simulated controller, and everything that forbids a start."""

from dataclasses import replace

import numpy as np
import pytest
from controller_settings import threading_settings
from link_faults import FIRST, small_program
from rig import SETTINGS, STROKE, Wire, controller

from pkm_post.control.link import run as operate
from pkm_post.control.link import stopping
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, NotReadyError, OutcomeUnknownError, OverrideError, PmacError
from pkm_post.control.link.program import read_job
from pkm_post.control.link.run import check_start
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.status import is_busy, read_status
from pkm_post.control.numerical_control.execute import wait_for_rest
from pkm_post.model import StrutMotion
from pkm_post.writing.controllers.pmac import program_text, setup_text

MICRON = 1e-3
SLOW = small_program(100)


@pytest.fixture(params=["serial", "tcp"])
def wire(request):
    return Wire(controller(), request.param, moves=True)


@pytest.fixture
def loaded(wire):
    with wire.session() as session:
        download(session, SLOW)
        yield session


def test_the_set_up_is_as_the_machine_file_says(wire):
    with wire.session() as session:
        wire.sent.clear()
        assert check_setup(session, SETTINGS, STROKE) is None
    for query in (b"#6->", b"I5190", b"I5150", b"I5192", b"I5193", b"I5195", b"I68", b"I127", b"I613", b"I614"):
        assert query in wire.sent, "what is set up was asked for"
    assert b"=" not in wire.sent, "and nothing was set"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("&1#7->35999Z", "#7->: expected 36000Z+0, the controller has 35999Z"),
        ("&1#7->0", "#7->: expected 36000Z+0"),
        ("I713=1000", "I713: expected 0 (no soft limit of the spindle)"),
    ],
)
def test_another_axis_of_the_spindle_is_refused(line, said):
    settings, made = threading_settings(), controller()
    made.load(setup_text(settings, "simulated", STROKE).splitlines())
    with Wire(made).session() as session:
        assert check_setup(session, settings, STROKE) is None
    made.load([line])
    with Wire(made).session() as session, pytest.raises(NotReadyError) as refused:
        check_setup(session, settings, STROKE)
    assert said in str(refused.value)


@pytest.mark.parametrize("counts", [8192.0, 1638.4, 1234.56789, 20480 / 3])
@pytest.mark.parametrize("digits", [0, 4, 6])
def test_the_set_up_of_a_calibrated_machine_is_the_one_that_was_loaded(counts, digits):
    """Its offsets have more digits than the 36 bits of a Turbo PMAC; another count is another set-up."""
    zero = tuple(round(500.123456789 + motor, digits) for motor in range(6))
    settings, made = replace(SETTINGS, counts_per_mm=counts, zero_length=zero), controller()
    made.load(setup_text(settings, "calibrated", STROKE).splitlines())
    wire = Wire(made)
    with wire.session() as session:
        check_setup(session, settings, STROKE)
        for off in (0.1, -0.1):
            assert not wire.line.refusal(f"&1#3->{counts:.10f}C-{counts * zero[2] + off:.6f}")
            with pytest.raises(NotReadyError, match="#3->: expected .*C-"):
                check_setup(session, settings, STROKE)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("&1#3->10000C-5000001", "#3->: expected 10000C-5000000, the controller has 10000C-5000001"),
        ("&1#3->9999C-5000000", "#3->: expected"),
        ("&1#6->0", "#6->: expected"),
        ("I5190=60000", "I5190: expected 1000 (speeds are in mm/s), the controller has 60000"),
        ("I5150=1", "I5150: expected 0"),
        # Software Reference, Isx92: no blending occurs between any moves; Isx93 points to the time base, Isx95 to hold
        ("I5192=1", "I5192: expected 0 (moves follow one another without a stop), the controller has 1"),
        ("I5193=$350A", "I5193: expected $2000 (the time base is the override), the controller has $350A"),
        ("I5195=0", "I5195: expected more than 0, or a hold does not stop the struts, the controller has 0"),
        ("I227=360", "I227: expected 0 (no rollover of a strut)"),
        ("I413=0", "I413: expected 500000 or less and not 0"),
        ("I413=600000", "I413: expected 500000 or less"),
        ("I514=-600000", "I514: expected -500000 or more"),
    ],
)
def test_another_set_up_is_refused(line, said):
    wire = Wire(controller())
    assert not wire.line.refusal(line)
    with wire.session() as session, pytest.raises(NotReadyError) as refused:
        check_setup(session, SETTINGS, STROKE)
    assert len(refused.value.reasons) == 1 and said in refused.value.reasons[0]


def test_a_program_of_others_held_in_its_last_move_is_resumed(wire):
    """Running Program is 0 then, Move Timer Active is 1 [Turbo PMAC Software Reference, ??, ?]."""
    ends = wire.controller.motors.commanded + 10_000
    for line in ("OPEN PROG 20", "CLEAR", "LINEAR TM2000 TA100", "INC", "A1 B1 C1 U1 V1 W1", "CLOSE", "&1B20R"):
        assert not wire.line.refusal(line)
    wire.sleep(0.3)
    with wire.session() as session:
        before = read_status(session, SETTINGS)
        assert not before.running and not before.standing
        held = stopping.hold(session, SETTINGS)
        assert held.held and held.standing and is_busy(session) and b"&1A" not in wire.sent
        with pytest.raises(NotReadyError, match="a program runs, or is held"):
            check_start(held, held.length)
        operate.resume_program(session, SETTINGS)
        wire.sleep(3.0)
        assert np.allclose(wire.controller.motors.commanded, ends)
        assert not read_status(session, SETTINGS).running and not is_busy(session)


def test_a_strut_that_follows_a_master_position_starts_no_program(wire, loaded):
    """Turbo PMAC Software Reference, Ixx06: the position of the motor changes with that of the master."""
    assert not wire.line.refusal("I306=1")
    with pytest.raises(NotReadyError, match=r"strut 3: follows a master position \(Ixx06\)"):
        operate.start_program(loaded, SETTINGS, SLOW, FIRST)


def test_a_program_runs_is_held_goes_on_and_is_aborted(wire, loaded):
    status = operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    assert status.running and not status.held
    wire.sleep(0.3)
    stopping.hold(loaded, SETTINGS)
    wire.sleep(3.0)
    held = read_status(loaded, SETTINGS)
    assert held.running and held.held and held.standing
    wire.sleep(1.0)
    assert np.allclose(read_status(loaded, SETTINGS).length, held.length, atol=MICRON)
    assert operate.resume_program(loaded, SETTINGS).running
    status = stopping.abort(loaded, SETTINGS)
    assert not status.running
    wire.sleep(1.0)
    assert read_status(loaded, SETTINGS).standing


@pytest.mark.slow
def test_a_program_runs_to_its_end(wire, loaded):
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    wire.sleep(10.0)
    status = read_status(loaded, SETTINGS)
    assert not status.running and status.fault_texts() == ()
    assert np.allclose(status.length, 500.0, atol=MICRON)


def test_another_program_whose_listing_is_far_longer_is_not_started(loaded, wire):
    line = "A1000.123456:1.234567 B1000.123456:1.234567 C1000.123456:1.234567"
    wire.controller.load(["OPEN PROG 10", "CLEAR", *[line] * 5000, "CLOSE"])
    with pytest.raises(NotReadyError, match="program 10 in the controller is a different one: it is far longer"):
        operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    assert read_status(loaded, SETTINGS).standing  # the link serves on


def test_another_program_is_not_started(loaded, wire):
    for line in ("OPEN PROG 10", "A1:0", "CLOSE"):
        loaded.command(line)
    with pytest.raises(NotReadyError, match="program 10 in the controller is a different one"):
        operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    assert not wire.controller.runs_program()


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda motors: motors.homed.__setitem__(2, False), "strut 3: not homed"),
        (lambda motors: motors.closed.__setitem__(0, False), "strut 1: in open loop"),
        (lambda motors: motors.enabled.__setitem__(5, False), "strut 6: its amplifier is off"),
        (lambda motors: motors.amplifier_fault.__setitem__(1, True), "strut 2: amplifier fault"),
        (lambda motors: motors.fatal.__setitem__(1, True), "strut 2: following error too large, switched off"),
        (lambda motors: motors.low_switch.__setitem__(4, True), "strut 5: on its lower limit"),
    ],
)
def test_a_machine_that_is_not_ready_does_not_start(spoil, said):
    wire = Wire(controller())
    with wire.session() as session:
        download(session, SLOW)
        spoil(wire.controller.motors)
        with pytest.raises(NotReadyError) as refused:
            operate.start_program(session, SETTINGS, SLOW, FIRST)
    assert said in refused.value.reasons
    assert not wire.controller.runs_program()


def test_a_start_far_from_the_first_point_is_refused(loaded):
    first = np.array([500.0, 500.0, 500.0, 500.0, 501.1, 500.0])
    with pytest.raises(NotReadyError, match=r"strut 5: 500.000 mm long, 1.100 mm from the first point"):
        operate.start_program(loaded, SETTINGS, SLOW, first)
    status = read_status(loaded, SETTINGS)
    check_start(status, first, start_tolerance=1.2)
    with pytest.raises(NotReadyError):
        check_start(status, np.full(6, np.nan))


def test_a_running_program_is_not_started_again(loaded):
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    with pytest.raises(NotReadyError, match="a program runs, or is held"):
        operate.start_program(loaded, SETTINGS, SLOW, FIRST, start_tolerance=100.0)


def test_nothing_is_resumed_that_is_not_held(loaded):
    with pytest.raises(NotReadyError, match="no program is held; after a stop"):
        operate.resume_program(loaded, SETTINGS)
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    with pytest.raises(NotReadyError, match="no program is held; it runs already"):
        operate.resume_program(loaded, SETTINGS)


def test_an_override_beyond_the_plan_is_refused(wire, loaded):
    loaded.command("&1%120")
    wire.sleep(1.0)  # the time base goes there slowly
    with pytest.raises(NotReadyError, match="the override is 120 %"):
        operate.start_program(loaded, SETTINGS, SLOW, FIRST)


def test_an_override_that_is_no_number_is_refused(loaded):
    status = replace(read_status(loaded, SETTINGS), override=float("nan"))
    with pytest.raises(NotReadyError, match="the override is nan %"):
        check_start(status, FIRST)


def test_a_move_that_another_client_speeds_up_is_held(wire, loaded):
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    wire.controller.systems[0].set_override(150.0)
    with pytest.raises(
        PmacError, match=r"the override is 1\d\d\S* %, set from elsewhere: .* the machine is held: abort"
    ):
        wait_for_rest(loaded, SETTINGS, 60.0)
    assert wire.controller.systems[0].holding and read_status(loaded, SETTINGS).override == 0.0


def test_a_program_that_is_watched_is_held_at_an_override_beyond_the_plan(wire, loaded):
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    wire.controller.systems[0].set_override(150.0)
    with pytest.raises(OverrideError, match=r"the override is 1\d\d\S* %, set from elsewhere: .*: abort"):
        operate.watch_program(loaded, SETTINGS)
    with pytest.raises(OverrideError, match="the machine is held: abort"):
        operate.watch_resumed(loaded, SETTINGS, operate.resume_program(loaded, SETTINGS))
    assert wire.controller.systems[0].holding and read_status(loaded, SETTINGS).override == 0.0


@pytest.mark.slow
def test_a_program_is_watched_to_its_end_through_a_hold(wire, loaded):
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    stopping.hold(loaded, SETTINGS)
    status = operate.watch_resumed(loaded, SETTINGS, operate.resume_program(loaded, SETTINGS))
    assert status.running and status.override == 100.0
    status = operate.watch_program(loaded, SETTINGS)
    assert not status.running and np.allclose(status.commanded, 500.0, atol=MICRON)


def test_a_state_that_shows_a_command_late_is_waited_for(wire, loaded):
    """A start that is not seen at once is no start that failed, and a stop is not sent again for that."""
    system, owed = wire.controller.systems[0], []

    def later(command):
        return lambda *arguments: owed.append((wire.now + 0.3, command, arguments))

    system.run, system.hold, system.abort = later(system.run), later(system.hold), later(system.abort)
    sleep = wire.sleep

    def sleep_and_do(seconds):
        sleep(seconds)
        while owed and owed[0][0] <= wire.now:
            _, command, arguments = owed.pop(0)
            command(*arguments)

    wire.sleep = loaded._sleep = sleep_and_do
    assert operate.start_program(loaded, SETTINGS, SLOW, FIRST).running
    assert stopping.hold(loaded, SETTINGS).held
    wire.sleep(2.0)
    status = operate.resume_program(loaded, SETTINGS)
    assert status.running and not status.held
    assert not stopping.abort(loaded, SETTINGS, at_once=True).running
    assert [bytes(wire.sent).count(b"&1" + order) for order in (b"B10R", b"H", b"R", b"A")] == [1, 1, 1, 1]


def test_nothing_is_started_while_a_stop_waits(wire, loaded):
    loaded.preempt_when(lambda: True)
    with pytest.raises(CancelledError, match="a stop came first"):
        operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    loaded.preempt_when(lambda: False)
    operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    stopping.hold(loaded, SETTINGS)
    loaded.preempt_when(lambda: True)
    with pytest.raises(CancelledError, match="a stop came first"):
        operate.resume_program(loaded, SETTINGS)
    assert read_status(loaded, SETTINGS).held


def silent_after(wire, text):
    """Let the answer to a command get lost, once."""
    gone = [False]

    def fault(data, out):
        if not out and not gone[0] and bytes(wire.sent).rstrip(b"\r\x0e").endswith(text) and data != b"\x00":
            gone[0] = len(data) > 1 or data == b"\x06"
            return b"" if gone[0] else data
        return data

    wire.fault = fault
    return gone


def test_a_start_whose_answer_got_lost_is_seen_in_the_state(wire, loaded):
    gone = silent_after(wire, b"B10R")
    status = operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    assert gone[0] and status.running
    assert bytes(wire.sent).count(b"B10R") == 1


def test_a_start_that_got_lost_is_not_repeated(wire, loaded):
    fault = wire.fault
    wire.fault = lambda data, out: b"" if b"R\r" in bytes(wire.sent[-3:]) or b"B10R" in data else fault(data, out)
    with pytest.raises(PmacError) as lost:
        operate.start_program(loaded, SETTINGS, SLOW, FIRST)
    assert not wire.controller.runs_program()
    assert bytes(wire.sent).count(b"B10R\r") <= 1
    if wire.kind == "tcp":
        assert isinstance(lost.value, OutcomeUnknownError)


@pytest.mark.slow
def test_the_struts_move_as_the_program_says(wire):
    """Six struts go out by different lengths and back, in step: what the controller reports lies on that line."""
    reach = np.array([1.0, 2.0, -3.0, 4.0, -5.0, 6.0])
    time_ms = np.arange(0, 2001, 20)
    turn = 2 * np.pi * time_ms / 2000
    length = 500.0 + reach * (1 - np.cos(turn))[:, None] / 2
    speed = reach * (np.pi / 2 * np.sin(turn))[:, None]
    speed[[0, -1]] = 0.0
    text = program_text(StrutMotion(time_ms, length, speed, ()), SETTINGS, ["test"])
    job, faults = read_job(text, SETTINGS, "test.pmc")
    assert not faults and np.allclose(job.first, 500.0)
    reported = []
    with wire.session() as session:
        download(session, job.program)
        operate.start_program(session, SETTINGS, job.program, job.first)
        while (status := read_status(session, SETTINGS)).running:
            reported.append(status.length + status.following_error)
            wire.sleep(0.02)
    way = (np.array(reported) - 500.0) / reach
    assert np.ptp(way, axis=1).max() < MICRON
    assert way.max() == pytest.approx(1.0, abs=MICRON) and abs(way[-1]).max() < 10 * MICRON
    assert np.allclose(status.length, 500.0, atol=MICRON)


def test_a_part_of_a_program_is_read_by_itself():
    motion = StrutMotion(np.array([0, 20]), np.full((2, 6), 500.0), np.zeros((2, 6)), ())
    text = program_text(motion, SETTINGS, ["job", "part 2 of 3: start it where part 1 ended, and only there"])
    assert read_job(text, SETTINGS, "job-part2.pmc")[0] is not None
    broken, faults = read_job(text.replace("DWELL0", "DWELL", 1), SETTINGS, "job-part2.pmc")
    assert broken is None and faults[0].code == "C101"
    assert faults[0].place.line == text[: text.index("DWELL0")].count("\n") + 1
