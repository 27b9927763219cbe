# SPDX-License-Identifier: LGPL-2.1-or-later
"""A Power PMAC: programs are loaded, listed back and compared, started, and refused when anything is otherwise."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from power_rig import DRIVES, FIRST, SETTINGS, STROKE, Wire, power_pmac, small_program

from pkm_post.control.link import stopping
from pkm_post.control.link.download import download, verify_listing
from pkm_post.control.link.errors import DownloadError, NotOwnerError, NotReadyError, PmacError
from pkm_post.control.link.owner_record import RECORD
from pkm_post.control.link.ownership import claim
from pkm_post.control.link.program import PmacProgram, read_job
from pkm_post.control.link.run import resume_program, set_feed_override, start_program
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.status import is_busy, read_status
from pkm_post.control.numerical_control.execute import continue_after_stop
from pkm_post.machine import machine_named
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.power_pmac import program_text, setup_text

PROGRAM = small_program()
LONGEST_S = 300.0


@pytest.fixture
def wire():
    return Wire(power_pmac())


@pytest.fixture
def session(wire):
    with wire.session() as session:
        yield session


def listing(machine, number=10):
    program = machine.controller.memory.programs.get(number)
    return program and program.source


def test_a_program_is_loaded_and_listed_back(wire, session):
    seen = []
    loaded = download(session, PROGRAM, lambda done, lines: seen.append((done, lines)))
    assert (loaded.lines, loaded.digest, loaded.resumptions) == (len(PROGRAM.lines), PROGRAM.digest, 0)
    assert seen[-1] == (len(PROGRAM.lines), len(PROGRAM.lines))
    assert verify_listing(session, PROGRAM).same
    assert listing(wire.machine)[7:9] == ["pvt20", "A500.000011:-0.125 B500.000012:-0.25 C500.000013:-0.375 "
                                          "U500.000014:-0.5 V500.000015:-0.625 W500.000016:-0.75"]  # fmt: skip
    assert wire.machine.controller.memory.opened is None


def test_what_was_under_the_number_goes_first(wire, session):
    download(session, small_program(knots=20))
    download(session, PROGRAM)
    assert verify_listing(session, PROGRAM).same
    assert wire.said.count("open prog 10") == 6  # to see whether it may be opened, to clear it, to fill it


@pytest.mark.parametrize("place", range(len(PROGRAM.lines)))
def test_a_line_that_came_out_otherwise_is_seen(wire, session, place):
    download(session, PROGRAM)
    changed = listing(wire.machine)
    changed[place] = changed[place].replace("0", "1", 1) if "0" in changed[place] else changed[place] + " dwell5"
    assert not verify_listing(session, PROGRAM).same
    with pytest.raises(NotReadyError, match="program 10 in the controller is a different one: line"):
        start_program(session, SETTINGS, PROGRAM, np.array(FIRST))
    assert not any(line.endswith("B10R") for line in wire.said)


def test_a_listing_with_its_frame_and_semicolons_is_the_same(wire, session):
    download(session, PROGRAM)
    source = listing(wire.machine)
    source[:] = ["open prog 10", *(f"{line};" for line in source), "close"]
    assert verify_listing(session, PROGRAM).same
    source.pop()
    with pytest.raises(PmacError, match="the listing begins with 'open prog 10' and ends with 'linear'"):
        verify_listing(session, PROGRAM)


def test_a_download_that_takes_long_asks_nothing_while_its_program_is_open(wire, session):
    download(session, PROGRAM, lambda done, lines: wire.sleep(3))
    said = wire.said[len(wire.said) - wire.said[::-1].index("open prog 10") :]
    assert said[: said.index("close")] == list(PROGRAM.lines) and "P8187..8191" in said
    assert verify_listing(session, PROGRAM).same


@pytest.mark.slow
@pytest.mark.parametrize("cut_at", range(0, 1600, 37))
def test_a_link_that_is_cut_at_any_byte(wire, cut_at):
    with wire.session() as session:
        wire.cut_at = wire.passed + cut_at
        assert download(session, PROGRAM).resumptions <= 1
        assert verify_listing(session, PROGRAM).same
    assert listing(wire.machine) and wire.now < LONGEST_S


@pytest.mark.parametrize("cut_at", [0, 100, 400, 900])
def test_a_link_that_stays_cut_is_said_with_what_is_left(wire, cut_at):
    session = wire.session()
    session.open()
    wire.cut_at, wire.mends = wire.passed + cut_at, False
    with pytest.raises(PmacError) as failed:
        download(session, PROGRAM)
    assert not isinstance(failed.value, DownloadError) or not failed.value.cleared
    assert wire.now < LONGEST_S


def test_a_line_that_is_refused_leaves_nothing(wire, session):
    wrong = PmacProgram(10, (*PROGRAM.lines[:9], "foo12", *PROGRAM.lines[9:]))
    with pytest.raises(DownloadError, match=r"'foo12': error #31, invalid data.*nothing is left under its number"):
        download(session, wrong)
    assert listing(wire.machine) is None


def test_a_program_without_room_leaves_nothing():
    wire = Wire(power_pmac(memory_words=1200))
    with wire.session() as session, pytest.raises(DownloadError, match="error #34, the buffer is full.*nothing is"):
        download(session, small_program(knots=200))
    assert listing(wire.machine) is None


def started(session):
    download(session, PROGRAM)
    start_program(session, SETTINGS, PROGRAM, np.array(FIRST))


def test_a_program_runs_where_it_is_written_to(wire, session):
    ends = PmacProgram(
        10, (*PROGRAM.lines[:-3], "A500.5:0 B500.25:0 C499.5:0 U500:0 V500:0 W499.75:0", "dwell0", "linear")
    )
    download(session, ends)
    check_setup(session, SETTINGS, STROKE)
    assert start_program(session, SETTINGS, ends, np.array(FIRST)).running
    while read_status(session, SETTINGS).running:
        wire.sleep(0.1)
        assert wire.now < LONGEST_S
    wire.sleep(0.1)
    assert np.allclose(read_status(session, SETTINGS).length, [500.5, 500.25, 499.5, 500, 500, 499.75], atol=1e-4)
    assert wire.machine.controller.systems[0].path.abrupt_stops == 0


def test_a_program_is_held_resumed_slowed_down_and_aborted(wire, session):
    long = PmacProgram(10, (*PROGRAM.lines[:-1], "dwell60000", "linear"))
    download(session, long)
    start_program(session, SETTINGS, long, np.array(FIRST))
    assert stopping.hold(session, SETTINGS).held
    with pytest.raises(NotReadyError, match="held"):
        set_feed_override(session, SETTINGS, 50)
    assert resume_program(session, SETTINGS).running
    assert abs(set_feed_override(session, SETTINGS, 50).override - 50) < 0.2
    with pytest.raises(PmacError, match="#38, a program runs"):
        download(session, PROGRAM)
    assert verify_listing(session, long).same
    assert not stopping.abort(session, SETTINGS).running


def test_a_program_that_speeds_up_again_is_not_held(wire, session):
    """``Coord[].FeedHold`` is 2 meanwhile [Power PMAC User's Manual, p. 693]."""
    long = PmacProgram(10, (*PROGRAM.lines[:-1], "dwell60000", "linear"))
    download(session, long)
    start_program(session, SETTINGS, long, np.array(FIRST))
    stopping.hold(session, SETTINGS)
    status = resume_program(session, SETTINGS)
    assert session.query("Coord[1].FeedHold") == ("2",)
    assert status.running and not status.held and 0 < status.override < 100
    assert stopping.hold(session, SETTINGS).held
    wire.sleep(0.1)
    assert session.query("Coord[1].FeedHold") == ("1",)


def test_motors_that_nothing_else_stops_lose_their_power(wire, session):
    """A motor of a running program is not killed by ``#1k``, but by ``#*k`` [Power PMAC User's Manual, p. 697]."""
    quick = small_program(100)
    slow = PmacProgram(10, tuple("pvt400" if line == "pvt20" else line for line in quick.lines))
    download(session, slow)
    start_program(session, SETTINGS, slow, np.array(FIRST))
    wire.sleep(2)
    system = wire.machine.controller.systems[0]
    system.hold = system.abort = lambda *_: None
    with pytest.raises(PmacError, match="#38, a program runs"):
        session.command("#1k")
    assert stopping.hold(session, SETTINGS).standing
    assert not wire.machine.controller.motors.enabled.any()


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("&1#2->10000B-4999999", "#2->: expected 10000B-5000000, the controller has &1#2->10000B-4999999".upper()),
        ("&1#2->0", "#2->: expected 10000B-5000000, the controller has #2->0"),
        ("Coord[1].FeedTime=60000", "Coord[1].FeedTime: expected 1000 (speeds are in mm/s), the controller has 60000"),
        ("Motor[3].MaxPos=600000", "Motor[3].MinPos and MaxPos: expected limits from -500000 to 500000"),
        ("Motor[3].MinPos=500001", "Motor[3].MinPos and MaxPos: expected limits from -500000 to 500000"),
        ("Motor[4].ServoCtrl=0", "Motor[4].ServoCtrl: expected 1 or more (strut 4 is activated), the controller has 0"),
        ("Coord[1].NoBlend=1", "Coord[1].NoBlend: expected 0 (moves follow one another without a stop)"),
        ("Coord[1].FeedHoldSlew=0", "Coord[1].FeedHoldSlew: expected more than 0, or a hold does not stop the struts"),
        ("Coord[1].pDesTimeBase=EncTable[9].a", "Coord[1].pDesTimeBase: expected Coord[1].DesTimeBase.a (the time "
         "base is the override), the controller has EncTable[9].a"),
    ],
)  # fmt: skip
def test_a_set_up_that_is_another_one(wire, session, line, said):
    check_setup(session, SETTINGS, STROKE)
    session.command(line)
    with pytest.raises(NotReadyError) as refused:
        check_setup(session, SETTINGS, STROKE)
    assert said.upper() in str(refused.value).upper()


@pytest.mark.parametrize("shown", ["Coord[1].pDesTimeBase=coord[1].destimebase.a", "$11000"])
def test_a_set_up_that_is_shown_otherwise(wire, session, shown):
    """Any ServoCtrl above 0 activates a motor [Power PMAC User's Manual, p. 690]; ``.a`` is an address [p. 553]."""
    session.command("Motor[4].ServoCtrl=8 Coord[1].FeedHoldSlew=1.00000000000000005e-4")

    def show(line, answer):
        return answer.replace(b"Coord[1].DesTimeBase.a\r", shown.encode() + b"\r") if "pDes" in line else answer

    wire.answered = show
    check_setup(session, SETTINGS, STROKE)


def test_a_long_axis_definition_of_digits_alone_is_refused():
    """Time in proportion to the length: in proportion to its square, these 65 kB took minutes."""
    session = SimpleNamespace(query=lambda text: ("1" * (1 << 16) if text.endswith("->") else "0",))
    with pytest.raises(NotReadyError, match="#1->: expected 10000A-5000000, the controller has 1111"):
        check_setup(session, SETTINGS, STROKE)


@pytest.mark.parametrize(("units_per_mm", "beyond"), [(1.0, "50.5"), (0.001, "0.06"), (10000.0, "500002")])
def test_limits_beyond_the_stroke_are_told_in_any_motor_unit(wire, session, units_per_mm, beyond):
    settings = dataclasses.replace(SETTINGS, counts_per_mm=units_per_mm)
    commands = [line.partition("//")[0].rstrip() for line in setup_text(settings, "test", STROKE).splitlines()]
    for command in filter(None, commands):
        session.command(command)
    check_setup(session, settings, STROKE)
    session.command(f"Motor[3].MaxPos={beyond}")
    with pytest.raises(NotReadyError, match=r"Motor\[3\].MinPos and MaxPos: expected limits"):
        check_setup(session, settings, STROKE)


def test_a_machine_that_is_not_where_the_program_begins(session):
    download(session, PROGRAM)
    with pytest.raises(NotReadyError, match=r"strut 1: 500.000 mm long, 10.000 mm from the first point"):
        start_program(session, SETTINGS, PROGRAM, np.array([510.0] * 6))


def test_one_client_at_a_time(wire, session):
    long = PmacProgram(10, (*PROGRAM.lines[:-1], "dwell60000", "linear"))
    claim(session, "run")
    download(session, long)
    start_program(session, SETTINGS, long, np.array(FIRST))
    wire.sleep(5)
    with wire.session() as other:
        assert is_busy(other) and all(motor.has("standing") for motor in read_status(other, SETTINGS).motors)
        with pytest.raises(NotOwnerError, match="C210"):
            download(other, small_program(number=11))
        assert stopping.abort(other, SETTINGS).standing and not is_busy(other)
    session.keeper.release()
    with wire.session() as other:
        assert download(other, PROGRAM).lines and other.query(RECORD)[0] == "0"


def test_the_drives_of_the_tests_are_those_of_the_controller(session):
    for drive in DRIVES:
        name, value = drive.split("=")
        assert float(session.query(f"Motor[6].{name}")[0]) == pytest.approx(float(value))


def test_a_program_goes_on_after_its_stop(wire, session):
    machine, _ = machine_named("example_6tps")
    times = np.array([0, 500, 1000])
    length = np.array([[500.0] * 6, [501.0, *[500.0] * 5], [500.0] * 6])
    motion = StrutMotion(times, length, np.zeros((3, 6)), events=(Event(1, EventKind.STOP, 0.0),))
    job, faults = read_job(program_text(motion, SETTINGS, ["of the test"]), SETTINGS, "job")
    assert not faults and "M0" in job.program.lines
    download(session, job.program)
    start_program(session, SETTINGS, job.program, job.first)
    wire.sleep(3)
    assert np.allclose(read_status(session, SETTINGS).length, length[1], atol=1e-4)
    held = dataclasses.replace(machine, strut_stroke=STROKE)
    assert continue_after_stop(session, held, SETTINGS, job, 1).running
    wire.sleep(3)
    status = read_status(session, SETTINGS)
    assert not status.running and np.allclose(status.length, length[2], atol=1e-4)
