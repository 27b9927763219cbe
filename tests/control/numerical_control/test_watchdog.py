# SPDX-License-Identifier: LGPL-2.1-or-later
"""A jog whose computer falls silent: the controller holds it by itself, within the time and way that are stated."""

import dataclasses

import numpy as np
import pytest
from station import MACHINE, SETTINGS, TOOL, new_station, set_up

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.numerical_control.control import NumericalControl
from pkm_post.control.numerical_control.manual_moves import CartesianJog, StrutJog
from pkm_post.control.numerical_control.plan import LONGEST_MOVE_MS
from pkm_post.control.numerical_control.watchdog import CREDIT_MS, with_watchdog

LONG = CartesianJog(shift=(100.0, 0.0, 0.0))
FEED = 5.0
"""mm/s: the jog takes twenty seconds."""


def begun(station, jog=LONG, feed=FEED):
    """A jog that has begun, and its plan."""
    plan, reported = station.control.plan_jog(jog, feed)
    assert plan is not None and not reported
    station.control.execute(plan)
    until_it_moves(station)
    return plan


def until_it_moves(station):
    """Also past the approach, which leads to where the struts are."""
    while not np.abs(station.motors.speed).max() > 1.0:  # counts/ms
        assert station.wait(0.05).status.running


def silent_until_rest(station):
    """Nothing is sent until the struts stand; the seconds that takes."""
    sent, before = len(station.wire.sent), station.wire.now
    while np.abs(station.motors.speed).max() > 0.0:
        station.wire.sleep(0.01)
    assert len(station.wire.sent) == sent
    return station.wire.now - before


def test_the_lines_of_the_program_are_untouched(station):
    plan, _ = station.control.plan_jog(LONG, FEED)
    lines = plan.job.program.lines
    with_dog = with_watchdog(lines, 77, dataclasses.replace(SETTINGS, coordinate_system=2))
    own = [line for line in with_dog if "P77" in line]
    assert tuple(line for line in with_dog if "P77" not in line) == lines
    assert own[0] == f"P77={CREDIT_MS}" and own[2::2] == ['IF(P77<0)COMMAND"&2H"'] * (len(own) // 2)
    taken = [int(line.rpartition("-")[2]) for line in own[1::2]]
    assert sum(taken) == plan.job.motion.time_ms[-1] and max(taken) <= LONGEST_MOVE_MS


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["tcp", "serial"])
@pytest.mark.parametrize(("jog", "feed"), [(LONG, FEED), (LONG, 40.0), (StrutJog(2, 20.0), FEED)])
def test_a_jog_without_a_computer_comes_to_rest(kind, jog, feed):
    station = new_station(kind)
    begun(station, jog, feed)
    station.wait(0.2)
    start, within = station.control.poll().pose.tip, station.control.silence_s
    assert silent_until_rest(station) <= within < 2.0
    state = station.control.poll()
    assert state.status.held and state.status.standing
    if jog is LONG:
        assert np.linalg.norm(state.pose.tip - start) <= feed * (within - 0.5)  # half of the speed in its last second


def test_the_time_of_a_hold_grows_with_the_square_of_the_servo_cycle(station):
    """Isx95 counts 2^-23 ms per servo cycle, and I10 of them are 100 % [Turbo PMAC Software Reference]."""
    credit = station.control.longest_silence_s() - 3_713_707**2 / 1644 / 2**23 / 1000
    station.wire.controller.variables.write("I", 10, 2.0 * 3_713_707)
    within = station.control.longest_silence_s()
    assert within == pytest.approx(credit + 4.0, abs=0.01)
    begun(station, CartesianJog(shift=(50.0, 0.0, 0.0)), 2.0)
    assert within - 1.5 < silent_until_rest(station) <= within


@pytest.mark.slow
@pytest.mark.parametrize("override", [20, 60])
def test_a_slower_override_takes_it_no_farther(station, override):
    station.control.override(override)
    begun(station)
    start = station.control.poll().pose.tip
    silent_until_rest(station)
    assert np.linalg.norm(station.control.poll().pose.tip - start) <= FEED * 0.9


@pytest.mark.slow
def test_a_jog_that_is_looked_at_goes_to_its_end(station):
    plan = begun(station)
    status = station.control.wait_for_rest(60.0)
    assert not status.running and np.allclose(status.commanded, plan.lengths, atol=1e-3)
    assert station.control.silence_s is None


def test_it_goes_on_when_the_override_takes_long(station):
    begun(station)
    assert station.control.override(30).override == pytest.approx(30, abs=0.1)
    assert station.control.override(100).running and not station.control.poll().status.held


def test_a_window_that_hangs_is_silence(station):
    looks_on = [True]
    station.control.attended_while(lambda: bool(looks_on))
    begun(station)
    for _ in range(10):
        station.wait(0.1)
    assert not station.control.poll().status.held
    looks_on.clear()
    for _ in range(30):
        station.wait(0.1)
    assert station.control.poll().status.held and station.control.poll().status.standing


@pytest.mark.slow
def test_renewing_late_does_not_start_it_again_and_resuming_does(station):
    plan = begun(station)
    silent_until_rest(station)
    for _ in range(10):
        assert station.wait(0.1).status.held
    assert station.control.resume().running
    assert np.allclose(station.control.wait_for_rest(60.0).commanded, plan.lengths, atol=1e-3)


def test_resumed_by_somebody_who_does_not_renew_it_is_held_again(station):
    begun(station)
    silent_until_rest(station)
    other = NumericalControl(station.wire.session(), MACHINE, SETTINGS, TOOL)
    before = other.poll().pose.tip
    assert other.resume().running
    station.wire.sleep(2.0)
    status = other.poll().status
    assert status.held and status.standing
    assert np.linalg.norm(other.poll().pose.tip - before) <= FEED


def test_what_a_killed_jog_left_in_the_variable_does_not_help_the_next(station):
    station.wire.controller.variables.write("P", 999, 1e9, 1)
    begun(station)
    assert silent_until_rest(station) <= station.control.silence_s


def test_a_controller_whose_hold_never_ends_is_refused(station):
    station.wire.controller.load(["I5195=0"])
    plan, _ = station.control.plan_jog(LONG, FEED)
    with pytest.raises(NotReadyError, match="I5195 is 0: a hold would not stop the struts"):
        station.control.execute(plan)
    assert 999 not in station.wire.controller.memory.programs


def test_a_line_by_hand_goes_to_its_end_by_itself(station):
    plan, _ = station.control.plan_line("G91 G1 X10 F300")
    station.control.execute(plan)
    until_it_moves(station)
    silent_until_rest(station)
    assert np.allclose(station.control.poll().status.commanded, plan.lengths, atol=1e-3)


def test_the_controller_was_not_asked_for_a_hold_before():
    assert set_up().variables.read("I", 5195, 1) == 1644
