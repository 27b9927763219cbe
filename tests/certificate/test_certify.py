# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from posted_jobs import NARROW, of, preset
from programs import ON_PALLET, cone, program, steep_helices

from pkm_post.certificate import certify
from pkm_post.certificate.deviation import _SWING
from pkm_post.geometry import hermite_speeds
from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan, strut_motion
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))


@cache
def planned(jerk=np.inf, job=lambda: cone(80, turns=0.25), tolerances=TOLERANCES):
    machine = dataclasses.replace(example(), strut_jerk=jerk)
    trajectory, _ = place(job(), machine, ON_PALLET)
    made, faults = plan(trajectory, machine, tolerances)
    assert not faults
    return machine, trajectory, made.motion, made.struts


@cache
def planned_with_a_dwell(dwell=True):
    """A straight line in two moves, and a dwell between them; else no rest there."""
    events = Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.DWELL, 0.5)
    job = program([[0, 0, 60], [0, 0, 50], [0, 0, 40]], events=events if dwell else events[:1])
    machine, trajectory, motion, _ = planned(job=lambda: job)
    return machine, trajectory, motion


def verdict(struts=None, machine=None, tolerances=TOLERANCES):
    made_for, trajectory, motion, planned_struts = planned()
    return certify(struts or planned_struts, "x.pmc", trajectory, machine or made_for, motion, tolerances)


def changed(length=None, speed=None, time_ms=None, events=None, rows=slice(None)):
    struts = planned()[3]
    return StrutMotion(
        struts.time_ms[rows] if time_ms is None else time_ms,
        (struts.length if length is None else length)[rows],
        (struts.speed if speed is None else speed)[rows],
        struts.events if events is None else events,
    )


def codes(result):
    return {fault.code for fault in result[1]}


def test_the_plan_holds():
    certificate, faults = verdict()
    assert not faults
    assert certificate.holds
    assert certificate.intervals == len(planned()[3]) - 1
    assert 0 < certificate.tip_deviation.max() <= TOLERANCES.tip


@pytest.mark.parametrize("tip", [1e-3, 0.05])
def test_the_rounded_corners_of_steep_helices_hold(tip):
    # Measured from the points at the same angle, corners that keep to half of the tolerance were beyond all of it.
    tolerances = Tolerances(tip, TOLERANCES.axis)
    machine, trajectory, motion, struts = planned(job=steep_helices, tolerances=tolerances)
    certificate, faults = certify(struts, "x.pmc", trajectory, machine, motion, tolerances)
    assert not faults
    assert certificate.tip_deviation.max() < 0.5 * tip


def test_a_length_that_is_off_by_two_microns_is_found_where_it_is():
    length = planned()[3].length.copy()
    row = len(length) // 2
    length[row, 3] += 0.002
    certificate, faults = verdict(changed(length=length))
    assert codes((certificate, faults)) & {"V101", "V102"}
    worst = certificate.time[np.argmax(certificate.tip_deviation)]
    assert abs(worst - planned()[3].time_ms[row] / 1000) < 0.2


def test_speeds_in_mm_per_minute_are_found():
    assert "V101" in codes(verdict(changed(speed=planned()[3].speed / 60)))


def test_swapped_struts_are_found():
    length = planned()[3].length[:, [1, 0, 2, 3, 4, 5]]
    assert "V101" in codes(verdict(changed(length=length)))


def test_a_dropped_point_is_found():
    keep = np.arange(len(planned()[3])) != 20
    times = planned()[3].time_ms
    points = f"{len(times) - 1} found, {len(times)} planned"
    _, (fault,) = verdict(changed(rows=keep))
    assert (fault.code, fault.found) == ("V110", f"knot 20: {times[21]} ms, planned {times[20]} ms; {points}")


def test_a_last_point_that_is_missing_is_reported_as_such():
    times = planned()[3].time_ms
    points = f"{len(times) - 1} found, {len(times)} planned"
    _, faults = verdict(changed(rows=slice(-1)))
    reported = {fault.code: fault.found for fault in faults}
    assert reported["V110"] == f"knot {len(times) - 1}: none, planned {times[-1]} ms; {points}"


def test_a_shifted_point_is_reported_with_both_its_times():
    times = planned()[3].time_ms.copy()
    times[[30, 31]] += 1
    _, (fault,) = verdict(changed(time_ms=times))
    count = f"{len(times)} found, {len(times)} planned"
    assert (fault.code, fault.found) == ("V110", f"knot 30: {times[30]} ms, planned {times[30] - 1} ms; {count}")


def test_a_dropped_event_is_found():
    _, (fault,) = verdict(changed(events=()))
    event = "tool change 1 at knot 0"
    assert (fault.code, fault.found) == ("V109", f"event 0: none, planned {event}; 0 found, 1 planned")


def test_the_first_event_that_is_another_is_reported_as_found_and_as_planned():
    (change,) = planned()[3].events
    spindle = Event(0, EventKind.SPINDLE, 9000.0)
    for events, found in (
        ((dataclasses.replace(change, value=2),), "event 0: tool change 2 at knot 0, planned tool change 1 at knot 0"),
        ((dataclasses.replace(change, row=7),), "event 0: tool change 1 at knot 7, planned tool change 1 at knot 0"),
        ((change, spindle), "event 1: spindle 9000.0 at knot 0, planned none"),
    ):
        _, (fault,) = verdict(changed(events=events))
        assert (fault.code, fault.found) == ("V109", f"{found}; {len(events)} found, 1 planned")


@pytest.mark.parametrize(
    ("of_plan", "reported"),
    [
        (lambda events: (), "event 0: none, planned tool change 1 at knot 0; 0 found, 2 planned"),
        (lambda events: events[:1], "event 1: none, planned dwell 0.5 at knot {}; 1 found, 2 planned"),
        (
            lambda events: events[1:],
            "event 0: dwell 0.5 at knot {}, planned tool change 1 at knot 0; 1 found, 2 planned",
        ),
        (
            lambda events: (events[0], dataclasses.replace(events[1], row=0)),
            "event 1: dwell 0.5 at knot 0, planned dwell 0.5 at knot {}; 2 found, 2 planned",
        ),
    ],
)
def test_events_that_the_plan_itself_has_wrong_are_found(of_plan, reported):
    """A plan decides nothing about events: those of the trajectory count, at the rests before their rows."""
    machine, trajectory, motion = planned_with_a_dwell()
    wrong = dataclasses.replace(motion, events=of_plan(motion.events))
    _, (fault,) = certify(strut_motion(wrong, machine), "x.pmc", trajectory, machine, wrong, TOLERANCES)
    assert (fault.code, fault.found) == ("V109", reported.format(motion.events[1].row))


def test_an_exact_stop_at_which_the_program_moves_is_found():
    """A straight line through a programmed point: neither tip nor axis shows whether it stops there."""
    machine, trajectory, motion = planned_with_a_dwell(dwell=False)
    struts, stops = strut_motion(motion, machine), dataclasses.replace(trajectory, exact_stop=np.array([1, 1, 1], bool))
    _, (fault,) = certify(struts, "x.pmc", stops, machine, motion, TOLERANCES)
    at = round(1000 * motion.joint_time[0])
    assert (fault.code, fault.found) == ("V110", f"no rest at {at} ms, at the end of line 1")


def test_a_stop_at_which_one_strut_alone_moves_is_found():
    machine, trajectory, motion = planned_with_a_dwell()
    struts, row = strut_motion(motion, machine), int(np.flatnonzero(trajectory.exact_stop)[0])
    stop, speed = round(1000 * motion.joint_time[row]), struts.speed.copy()
    speed[struts.time_ms == stop, 3] = -1e-4
    _, faults = certify(dataclasses.replace(struts, speed=speed), "x.pmc", trajectory, machine, motion, TOLERANCES)
    assert faults[0].found == f"no rest at {stop} ms, at the end of line {trajectory.line[row]}"


def test_a_spin_that_the_plan_itself_has_wrong_is_found():
    """Tip and axis are right all the time, and so is the program by its plan: only the trajectory knows the spin."""
    machine, trajectory, motion, _ = planned()
    share = motion.time_ms / motion.time_ms[-1]
    for most, expected in ((0.5e-5, set()), (np.radians(0.02), {"V111"})):
        spin = motion.spin + most * np.sin(np.pi * share) ** 2
        rate = most * np.pi * np.sin(2 * np.pi * share) * 1000 / motion.time_ms[-1]
        turned = dataclasses.replace(motion, spin=spin, spin_rate=np.where(motion.tip_rate.any(axis=1), rate, 0.0))
        result = certify(strut_motion(turned, machine), "x.pmc", trajectory, machine, turned, TOLERANCES)
        assert codes(result) == expected


def test_turning_back_too_early_is_found():
    # To and fro on one straight line: a motion that turns round early never leaves the line.
    machine = example()
    there_and_back = program([[0, 0, 60], [0, 0, 50], [20, 0, 50], [0, 0, 50]])
    trajectory, _ = place(there_and_back, machine, ON_PALLET)
    motion = plan(trajectory, machine, TOLERANCES)[0].motion
    short = dataclasses.replace(motion, tip=np.minimum(motion.tip, [19.9, np.inf, np.inf]))
    turned = motion.tip[:, 0] > 19.9
    short = dataclasses.replace(short, tip_rate=np.where(turned[:, None], 1e-3, 1.0) * motion.tip_rate)
    assert turned.any()
    _, faults = certify(strut_motion(short, machine), "x.pmc", trajectory, machine, motion, Tolerances(0.01, 1e-3))
    assert "V110" in {fault.code for fault in faults}


def test_another_machine_is_found():
    other = dataclasses.replace(planned()[0], fingerprint="1" * 64)
    assert codes(verdict(machine=other)) == {"T104"}


@pytest.mark.parametrize(("row", "reported"), [(0, "first"), (-1, "last")])
def test_motion_at_an_end_is_found_where_it_is(row, reported):
    speed = planned()[3].speed.copy()
    speed[row, 0] = 0.5
    _, (fault,) = verdict(changed(speed=speed))
    assert (fault.code, fault.found) == ("V105", f"{reported} speeds [0.5, 0.0, 0.0, 0.0, 0.0, 0.0] mm/s")


def test_lengths_without_a_pose_are_found():
    struts = planned()[3]
    length = struts.length.copy()
    length[30] = [1250, 250, 250, 250, 250, 250]
    _, faults = verdict(changed(length=length))
    (found,) = (fault.found for fault in faults if fault.code == "V107")
    start = struts.time_ms[29] / 1000  # the interval that ends at that knot is the first without a pose
    assert found == f"interval without a pose 1, allowed 0, {start:.3f} s after the start"


@pytest.mark.parametrize(
    ("code", "limits"),
    [
        ("V103", {"strut_speed": 10.0}),
        ("V104", {"strut_acceleration": 100.0}),
        ("V106", {"strut_stroke": (1040.0, 1250.0)}),
        ("V106", {"strut_stroke": (750.0, 1040.0)}),
    ],
)
def test_limits_are_checked_in_what_is_played(code, limits):
    machine = dataclasses.replace(planned()[0], **limits)
    assert code in codes(verdict(machine=machine))


def test_too_fast_is_found():
    made_for, trajectory, motion, struts = planned()
    slower = dataclasses.replace(trajectory, feed=trajectory.feed / 2)
    certificate, (fault,) = certify(struts, "x.pmc", slower, made_for, motion, TOLERANCES)
    found = next(finding for finding in certificate.findings if finding.code == "V108")
    # as fast as planned, which is twice what is programmed now
    assert found.limit in 1.01 * slower.feed + 0.05
    assert found.value == pytest.approx(2 * (found.limit - 0.05) / 1.01, rel=0.01)
    assert fault.code == "V108"
    assert fault.found.startswith(f"tip speed {found.value:.6g} mm/s, allowed {found.limit:.6g} mm/s, ")


def test_tighter_tolerances_than_planned_do_not_hold():
    assert {"V101"} <= codes(verdict(tolerances=Tolerances(1e-5, np.radians(1e-5))))


def test_a_limit_of_jerk_is_kept_and_its_breach_is_found():
    jerk = 2e4
    gentle, trajectory, motion, struts = planned(jerk)
    certificate, faults = certify(struts, "x.pmc", trajectory, gentle, motion, TOLERANCES)
    assert not faults
    found = next(finding for finding in certificate.findings if finding.code == "V112")
    assert 0.2 * jerk < found.value <= jerk
    assert "V112" in codes(verdict(machine=gentle))


@pytest.mark.parametrize("ramp", [0.0, 0.1, 0.5, 1.0])
def test_a_cubic_that_comes_from_rest_swings_by_no_more_than_a_third_of_its_speed(ramp):
    """What the ceiling of the speed allows for in one millisecond: the plan is at speed after a part of it."""
    one, at_speed, way = np.ones((1, 6)), 0.536, 0.536 * (1 - ramp / 2) * 1e-3
    speed = hermite_speeds(0 * one, 0 * one, way * one, at_speed * one, np.array([1e-3]), np.linspace(0, 1, 1001))
    assert speed.max() <= (1 + _SWING) * at_speed * (1 + 1e-12)
    assert ramp or speed.max() > (1 + 0.99 * _SWING) * at_speed


@pytest.mark.parametrize(("speed_decimals", "codes"), [(4, ["V118"]), (8, [])])
def test_a_program_whose_decimals_know_no_speed_of_a_slow_move_is_refused(speed_decimals, codes):
    """Its reader sees a rest at each such point, and verify counts rests."""
    slow = program([[0, 0, 60], [0.001, 0, 60]], feed=0.002 / 60)
    *_, faults = of(preset("example_6tps"), slow, NARROW, (6, speed_decimals))
    assert [fault.code for fault in faults] == codes
