# SPDX-License-Identifier: LGPL-2.1-or-later
"""Homing: what may start it, and how it is watched."""

import numpy as np
import pytest

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import NotReadyError, RefusedError
from pkm_post.control.link.status import Status
from pkm_post.control.link.status_bits import MotorBits, SystemBits
from pkm_post.control.numerical_control.homing import Homing, HomingPhase, HomingWatch, check_trigger

STANDING, HOMED, HOMING = 1 << 37, 1 << 10, 1 << 34  # [EPICSpmac]
ALL_MOTORS = " ".join(f"#{motor}HM" for motor in range(1, 7))


@pytest.mark.parametrize(
    "trigger",
    ["ENABLE PLC 3", "enaplc12", "P101=1", "M40=-1.5", "&1B500R", "&2 B5 R", "#1HM", "#1HM #2HM", "#1HM#2HM", "#6home"],
)
def test_lines_that_may_start_it(trigger):
    assert check_trigger(trigger) is None


@pytest.mark.parametrize(
    "trigger", ["", "DISABLE PLC 3", "I5190=1", "&1A", "#1J+", "#7HM", "#1HM;", "#1HMZ", "P1=1 #1K", "ENABLE PLC 1..3"]
)
def test_lines_that_may_not(trigger, station):
    with pytest.raises(ValueError, match="a homing starts with one of ENABLE PLC n, "):
        station.control.home(trigger)
    assert station.sent() == b""


def state(bits):
    zero = np.zeros(6)
    return Status(tuple(map(MotorBits, bits)), SystemBits(0), 100.0, zero, zero)


def test_struts_are_homed_one_by_one(station):
    station.motors.homed[:] = False
    assert station.control.poll().homing is None
    station.control.home(ALL_MOTORS)
    seen = [station.control.poll().homing]
    while seen[-1].phase is HomingPhase.SEARCHING:
        assert len(seen) < 1000
        seen.append(station.wait(0.1).homing)
    assert seen[-1] == Homing(HomingPhase.DONE, (), ())
    assert str(seen[-1]) == "all struts have found their homes"
    assert station.control.poll().homing == seen[-1]  # it is reported until the next one


@pytest.mark.parametrize("stop", ["hold", "abort"])
def test_a_stop_in_the_moment_of_the_trigger_stops_the_search(station, stop):
    """No strut moves yet, and no program runs; that is the state of a machine at rest as well."""
    station.motors.homed[:], station.motors.home_flag[:] = False, 1e6
    station.control.home(ALL_MOTORS)
    assert getattr(station.control, stop)().standing
    before = np.array(station.motors.commanded)
    station.wait(1.0)
    assert np.array_equal(station.motors.commanded, before)


@pytest.mark.parametrize("stop", ["hold", "abort"])
def test_a_search_of_motors_that_was_stopped_has_failed(station, stop):
    station.motors.homed[:], station.motors.home_flag[:] = False, 1e6
    station.control.home(ALL_MOTORS)
    station.wait(0.5)
    with station.wire.session() as other:  # a stop from elsewhere; the hold of this control is one as well
        getattr(stopping, stop)(other, station.settings)
    assert station.wait(1.0).homing.phase is HomingPhase.SEARCHING
    homing = station.wait(6.0).homing
    assert homing.phase is HomingPhase.FAILED and homing.missing == (1, 2, 3, 4, 5, 6)


def test_a_plc_program_may_go_on_after_any_pause():
    watch, rests = HomingWatch(0.0, by_plc=True), state([STANDING | HOMED] * 5 + [STANDING])
    assert {watch.see(rests, now).phase for now in (1.0, 100.0, 599.0)} == {HomingPhase.SEARCHING}


def test_struts_without_home_are_named():
    watch = HomingWatch(0.0)
    reported = watch.see(state([STANDING | HOMED] * 4 + [STANDING, STANDING | HOMING]), 1.0)
    assert reported.phase is HomingPhase.SEARCHING and reported.missing == (5, 6)
    assert str(reported).startswith(
        "the struts look for their homes; no home yet: strut 5, 6\nstrut 6: searching its home"
    )


def test_a_pause_between_two_struts_is_not_the_end():
    watch = HomingWatch(0.0)
    all_homed, one_searches = state([STANDING | HOMED] * 6), state([STANDING | HOMED] * 5 + [HOMING])
    for now, seen, phase in [
        (0.1, one_searches, HomingPhase.SEARCHING),
        (3.0, all_homed, HomingPhase.SEARCHING),
        (4.0, one_searches, HomingPhase.SEARCHING),
        (8.0, all_homed, HomingPhase.SEARCHING),
        (9.5, all_homed, HomingPhase.SEARCHING),
        (10.5, all_homed, HomingPhase.DONE),
    ]:
        assert watch.see(seen, now).phase is phase, now


def test_a_controller_that_does_nothing():
    watch = HomingWatch(0.0)
    assert watch.see(state([STANDING | HOMED] * 6), 4.0).phase is HomingPhase.SEARCHING
    assert watch.see(state([STANDING | HOMED] * 6), 6.0).phase is HomingPhase.NOTHING


def test_a_homing_that_takes_too_long():
    watch = HomingWatch(10.0, seconds=60.0)
    assert watch.see(state([HOMING] * 6), 69.0).phase is HomingPhase.SEARCHING
    assert watch.see(state([HOMING] * 6), 71.0).phase is HomingPhase.LATE


@pytest.mark.parametrize("fault", [1 << 3, 1 << 2])
def test_a_fault_ends_it(fault):
    assert HomingWatch(0.0).see(state([HOMING] * 5 + [HOMING | fault]), 1.0).phase is HomingPhase.FAILED


def test_a_limit_does_not_end_it():
    """The home may be at a limit."""
    reported = HomingWatch(0.0).see(state([HOMING] * 5 + [HOMING | 1 << 46]), 1.0)
    assert reported.phase is HomingPhase.SEARCHING and "strut 6: on its lower limit" in reported.words


def test_it_is_not_started_beside_a_program_or_with_a_fault(station):
    from pkm_post.control.numerical_control.manual_moves import CartesianJog

    station.control.execute(station.control.plan_jog(CartesianJog((20, 0, 0)), 10.0)[0])
    with pytest.raises(NotReadyError, match="a program runs"):
        station.control.home(ALL_MOTORS)
    station.to_rest()
    station.motors.amplifier_fault[3] = True
    with pytest.raises(NotReadyError, match="strut 4: amplifier fault"):
        station.control.home(ALL_MOTORS)
    assert b"HM" not in station.sent()


def test_a_trigger_after_which_nothing_moves(station):
    """The simulated controller takes the line and has no PLC programs."""
    station.control.home("ENABLE PLC 3")
    assert station.wait(1.0).homing.phase is HomingPhase.SEARCHING
    assert station.wait(6.0).homing.phase is HomingPhase.NOTHING


def test_a_trigger_that_the_controller_refuses(station):
    with pytest.raises(RefusedError, match="&1B500R"):
        station.control.home("&1B500R")
    assert station.control.poll().homing is None


def test_an_abort_ends_the_watch(station):
    station.control.home("P7000=1")
    assert station.control.poll().homing.phase is HomingPhase.SEARCHING
    station.control.abort(at_once=True)
    assert station.control.poll().homing is None
