# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves by hand on a simulated Power PMAC: it is rehearsed that a jog holds itself, before anything moves."""

import numpy as np
import pytest
from power_station import MACHINE, SETTINGS, power_station
from test_probing import BALL, COUNT, INPUT, frame

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.tool_pose import ToolPoseReadout
from pkm_post.control.numerical_control import rehearsal
from pkm_post.control.numerical_control.manual_moves import CartesianJog, StrutJog
from pkm_post.control.numerical_control.probed_features import measure_face
from pkm_post.control.numerical_control.probing import Probe, ProbeInput, ProbeSettings
from pkm_post.control.numerical_control.simulated_probe import SimulatedProbe, plane
from pkm_post.control.simulator.gpascii_shell import refused_line

LONG, FEED = CartesianJog(shift=(100.0, 0.0, 0.0)), 5.0
"""mm, mm/s: twenty seconds."""


@pytest.fixture
def station():
    return power_station()


def moving(station):
    return np.abs(station.motors.speed).max() > 0.0


def begun(station, jog=LONG, feed=FEED):
    """A jog that has begun, past its approach."""
    plan, reported = station.control.plan_jog(jog, feed)
    assert plan is not None and not reported
    station.control.execute(plan)
    while not np.abs(station.motors.speed).max() > 1.0:  # counts/ms
        assert station.wait(0.05).status.running
    return plan


def silent_until_rest(station):
    """Nothing is sent until the struts stand; the seconds that takes."""
    sent, before = len(station.wire.said), station.wire.now
    while moving(station):
        station.wire.sleep(0.01)
    assert len(station.wire.said) == sent
    return station.wire.now - before


@pytest.mark.slow
@pytest.mark.parametrize(("slew", "jog", "feed"), [(0.0001, LONG, FEED), (0.0004, StrutJog(2, 20.0), 4.0)])
def test_a_jog_without_a_computer_comes_to_rest_within_the_time_that_was_found_out(station, slew, jog, feed):
    assert refused_line(station.wire.machine, [f"Coord[1].FeedHoldSlew={slew}"]) is None
    begun(station, jog, feed)
    station.wait(0.2)
    start, within = station.control.poll().pose.tip, station.control.silence_s
    taken = silent_until_rest(station)
    assert taken <= within < taken + 1.5
    state = station.control.poll()
    assert state.status.held and state.status.standing
    if jog is LONG:
        assert np.linalg.norm(state.pose.tip - start) <= feed * within


def starts(station):
    """How often a program by hand was started, rehearsals and moves."""
    return sum(line == "&1B999R" for line in station.wire.said)


@pytest.mark.slow
def test_nothing_moves_in_the_rehearsal_which_is_done_once(station):
    before = station.motors.commanded.copy()
    found = station.control.longest_silence_s()
    assert np.abs(station.motors.commanded - before).max() < 0.01  # counts; the digits of a program
    assert not station.wire.controller.runs_program() and starts(station) == 1
    for jog in (CartesianJog(shift=(1.0, 0.0, 0.0)), CartesianJog(shift=(-1.0, 0.0, 0.0))):
        plan = begun(station, jog, 20.0)
        assert station.control.silence_s == found
        assert np.allclose(station.control.wait_for_rest(60.0).commanded, plan.lengths, atol=1e-3)
    assert starts(station) == 3  # two of them are the jogs
    assert refused_line(station.wire.machine, ["Coord[1].FeedHoldSlew=0.0005"]) is None
    assert station.control.longest_silence_s() < found and starts(station) == 4


@pytest.mark.slow
def test_at_a_lower_override_no_shorter_time_is_found(station):
    full = station.control.longest_silence_s()
    other = power_station()
    other.control.override(25)
    assert full <= other.control.longest_silence_s() <= 1.5 * full


@pytest.mark.slow
def test_a_controller_whose_hold_never_ends_is_refused(station, monkeypatch):
    monkeypatch.setattr(rehearsal, "_LONGEST_S", 4.0)
    assert refused_line(station.wire.machine, ["Coord[1].FeedHoldSlew=0.00001"]) is None
    plan, _ = station.control.plan_jog(LONG, FEED)
    with pytest.raises(NotReadyError, match="counts down P999 and is not renewed did not hold itself within 4 s"):
        station.control.execute(plan)
    assert not moving(station) and not station.wire.controller.runs_program() and starts(station) == 1


def test_a_program_that_holds_itself_at_its_start_is_refused(station):
    """It is held while its count has not run out: something else did that, and the next time perhaps not."""
    system = station.wire.controller.systems[0]
    begin = system.run
    system.run = lambda step=False: (begin(step), system.hold())
    with pytest.raises(NotReadyError, match="did not hold itself"):
        station.control.longest_silence_s()


def test_a_line_of_gcode_goes_to_its_end(station):
    plan, reported = station.control.plan_line("G91 G1 X4 Z-1 F600")
    assert not reported
    station.control.execute(plan)
    assert np.allclose(station.to_rest().status.commanded, plan.lengths, atol=1e-3)
    assert starts(station) == 1  # itself: what goes to its end needs no rehearsal


@pytest.mark.slow
def test_a_face_is_found_by_a_touch_probe(station):
    height = 296.8345
    assert refused_line(station.wire.machine, ["Coord[1].FeedHoldSlew=0.002"]) is None
    readout = ToolPoseReadout(MACHINE, 120.0)
    SimulatedProbe(station.wire.controller, SETTINGS, readout, BALL, plane(height)).connect(INPUT)
    settings = ProbeSettings(ProbeInput(f"M{INPUT}"), BALL, resolution=0.2)
    probe = Probe(station.control._session, station.control, settings, station.control.longest_silence_s())
    found = measure_face(probe, frame(), "z-", 2.0)
    assert abs(found.position[2] - height) <= found.half_width + COUNT and found.half_width <= 0.1


def test_a_hold_while_the_struts_stand_waits_until_time_stands():
    """A dwell is over before the time base is at zero, and the move behind it begins; FeedHold is 3 until then."""
    station = power_station()
    assert refused_line(station.wire.machine, ["Coord[1].FeedHoldSlew=0.0002"]) is None
    station.control.execute(station.control.plan_line("G91 G4 P0.5 G1 X30 F3000")[0])
    system = station.wire.controller.systems[0]
    station.wire.sleep(0.1)
    assert system.running and station.control.poll().status.standing
    assert station.control.hold().held and system.override == 0.0
    before = station.motors.commanded.copy()
    station.wire.sleep(3.0)
    assert (station.motors.commanded == before).all()
