# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a program does is recovered from program and trajectory alone, whatever planner has made it."""

import dataclasses
from dataclasses import replace

import numpy as np
import pytest
from machines import without_jerk
from posted_jobs import NARROW, UNEQUAL, WIDE, offset, preset
from programs import ON_PALLET, cone, program, random_job, square_with_arc, steep_helices

from pkm_post.certificate import certify, reconstruct
from pkm_post.certificate.played_path import _spin
from pkm_post.machine import platform_rotation, reach_faults, strut_lengths
from pkm_post.model import Event, EventKind, Kind, StrutMotion
from pkm_post.model.certificate import Tolerances
from pkm_post.model.diagnostics import errors
from pkm_post.planning import interpolate, plan_feed, strut_motion
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))


@pytest.fixture(scope="module")
def machine():
    return preset("example_6tps")


def planned(trajectory, machine, tolerances, feed=1.0):
    feed_plan, faults = plan_feed(replace(trajectory, feed=feed * trajectory.feed), machine, tolerances)
    return interpolate(feed_plan).motion, faults


def printed(motion, machine):
    struts = strut_motion(motion, machine)
    return StrutMotion(struts.time_ms, struts.length.round(6), struts.speed.round(4) + 0.0, struts.events)


def refusals(struts, trajectory, machine, tolerances=TOLERANCES):
    found, faults = reconstruct(struts, "job.pmc", trajectory, machine, tolerances)
    if found is None:
        return errors(faults)
    measured = certify(
        struts, "job.pmc", trajectory, machine, found.motion, tolerances, spin_deviation=found.spin_deviation
    )
    return errors((*measured[1], *reach_faults(machine, trajectory, *found.pose_path())))


def placed(job, machine):
    trajectory, faults = place(job, machine, ON_PALLET)
    assert not faults
    return trajectory


@pytest.mark.slow
@pytest.mark.parametrize("job", [cone(120), square_with_arc(), steep_helices()], ids=["cone", "square", "helices"])
@pytest.mark.parametrize("feed", [1.0, 0.7, 0.2])
def test_programs_of_planners_that_drive_slower_hold(machine, job, feed):
    trajectory = placed(job, machine)
    motion, _ = planned(trajectory, machine, TOLERANCES, feed)
    assert not refusals(printed(motion, machine), trajectory, machine)


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_programs_of_planners_that_round_corners_otherwise_hold(machine, share):
    trajectory = placed(square_with_arc(), machine)
    tighter = Tolerances(share * TOLERANCES.tip, share * TOLERANCES.axis)
    motion, _ = planned(trajectory, machine, tighter)
    assert not refusals(printed(motion, machine), trajectory, machine)


@pytest.mark.slow
@pytest.mark.parametrize("tolerances", [NARROW, WIDE, UNEQUAL])
@pytest.mark.parametrize("seed", range(6))
def test_random_jobs_hold_when_their_plan_does(machine, tolerances, seed):
    asked = Tolerances(tolerances[0], np.radians(tolerances[1]))
    trajectory, _ = place(random_job(np.random.default_rng(seed)), machine, offset(machine))
    motion, faults = planned(trajectory, machine, asked)
    struts = printed(motion, machine)
    by_plan = (*faults, *certify(struts, "job.pmc", trajectory, machine, motion, asked)[1])
    if not errors(by_plan):
        assert not refusals(struts, trajectory, machine, asked)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [13, 16, 35, 39, 89, 124, 283])
def test_wide_corners_between_two_feeds_are_passed_where_the_slower_one_holds(machine, seed):
    """The tool brakes in the corner: at the nearest place to the joint it is still faster than the next line allows.

    It may also have been that fast before, or begin an interval that is a little too fast for the slower feed alone;
    and tip and axis together may fit best where one of them does not fit at all.
    """
    test_random_jobs_hold_when_their_plan_does(machine, WIDE, seed)


@pytest.mark.parametrize(
    ("stroke", "feed", "tip"), [(1, 5.0, 0.05), (2, 10.0, 0.01), (10, 10.0, 0.001), (20, 5.0, 0.05)]
)
def test_programs_that_go_there_and_back_hold(machine, stroke, feed, tip):
    """From rest to rest such plans are symmetrical: a rounded corner had a knot without speed, a rest too many."""
    ends, dwells = [[0, 0, 65], [0, 0, 60], [stroke, 0, 60], [0, 0, 60]], (Event(2, EventKind.DWELL, 0.1),)
    trajectory, asked = placed(program(ends, feed=feed, events=dwells), machine), Tolerances(tip, TOLERANCES.axis)
    motion, _ = planned(trajectory, machine, asked)
    assert not refusals(printed(motion, machine), trajectory, machine, asked)


def test_a_joint_soon_after_a_rest_is_found(machine):
    """The instant nearest to it may be the rest, which Newton's method does not leave."""
    kinds, ends = [Kind.RAPID, Kind.LINE, Kind.RAPID, Kind.RAPID], [[0, 0, 61], [0, 0, 59.5], [0, 0, 59.7], [0, 0, 80]]
    asked, jumping = Tolerances(0.01, TOLERANCES.axis), without_jerk(machine)
    trajectory = placed(program(ends, kind=np.array(kinds), feed=10.0), jumping)
    motion, _ = planned(trajectory, jumping, asked)
    assert not refusals(printed(motion, jumping), trajectory, jumping, asked)


def test_a_spin_that_ends_to_change_in_a_straight_move_holds(machine):
    """One cubic of tip and axis may lead through its whole rounded joint, where it does not follow the spin."""
    asked, jumping = Tolerances(0.01, TOLERANCES.axis), without_jerk(machine)
    trajectory = placed(program([[0, 0, 120], [0, 0, 105]], kind=np.array([Kind.RAPID] * 2)), jumping)
    spin = np.radians(30) * np.ones(len(trajectory))
    trajectory = dataclasses.replace(trajectory, spin=spin)
    motion, _ = planned(trajectory, jumping, asked)
    assert not refusals(printed(motion, jumping), trajectory, jumping, asked)


@pytest.mark.parametrize(("radius", "rise", "tip"), [(0.1, -0.01, 0.2), (0.01, 0.0, 0.01)])
def test_full_turns_that_are_hardly_larger_than_the_tolerance_are_followed(machine, radius, rise, tip):
    """A pose near the joint of two turns may fit the end of both: the tool has not gone back by a turn."""
    ends = [[-0.35, -10, 60], [0, 0, 60], *([0, 0, 60 + turn * rise] for turn in (1, 2, 3)), [8, 2, 60 + 3 * rise]]
    kinds = [Kind.RAPID, Kind.LINE, Kind.ARC, Kind.ARC, Kind.ARC, Kind.LINE]
    centre, turn = np.full((2, 6, 3), np.nan)
    centre[2:5], turn[2:5] = np.array(ends)[1:4] - [radius, 0, 0], [0, 0, 1]
    asked, gentle = Tolerances(tip, TOLERANCES.axis), replace(machine, strut_jerk=4e4, tip_jerk=4e4)
    trajectory = placed(program(ends, kind=np.array(kinds), feed=20.0, centre=centre, turn=turn), gentle)
    motion, _ = planned(trajectory, gentle, asked)
    assert not refusals(printed(motion, gentle), trajectory, gentle, asked)


@pytest.mark.slow
def test_both_ends_of_a_small_circle_have_their_times(machine):
    """They are one place, to which the tool also returns after it; all the way that corners save is saved near it."""
    start, radius, tip = [129.0, 0, 60], 0.0026, 0.003
    ends = [[0, 0, 60], start, start, [128.991, 0.001, 60], start]
    kinds = [Kind.RAPID, Kind.LINE, Kind.ARC, Kind.LINE, Kind.LINE]
    centre, turn = np.full((2, 5, 3), np.nan)
    centre[2], turn[2] = np.array(start) - [0.8 * radius, 0.6 * radius, 0], [0, 0, -1]
    trajectory = placed(program(ends, kind=np.array(kinds), feed=50.0, centre=centre, turn=turn), machine)
    asked = Tolerances(tip, TOLERANCES.axis)
    motion, _ = planned(trajectory, machine, asked)
    assert not refusals(printed(motion, machine), trajectory, machine, asked)


@pytest.mark.slow
def test_a_joint_that_fits_badly_is_not_taken_for_the_next_pass_of_its_place(machine):
    """A rounded corner at the start of a small circle uses most of the tolerance; at its end the tool is as near."""
    start, radius, phi, tip = [100.0, 0, 60], 0.00698268, 3.76258058, 0.003
    ends = [[99, 0, 60], start, start, [99.99528418, 0.00513358, 60], start]
    kinds = [Kind.LINE, Kind.LINE, Kind.ARC, Kind.LINE, Kind.LINE]
    centre, turn = np.full((2, 5, 3), np.nan)
    centre[2], turn[2] = np.array(start) - [radius * np.cos(phi), radius * np.sin(phi), 0], [0, 0, 1]
    trajectory = placed(program(ends, kind=np.array(kinds), feed=50.0, centre=centre, turn=turn), machine)
    asked = Tolerances(tip, TOLERANCES.axis)
    motion, _ = planned(trajectory, machine, asked)
    assert not refusals(printed(motion, machine), trajectory, machine, asked)


def test_joints_are_passed_when_the_plan_passes_them(machine):
    trajectory = placed(cone(120), machine)
    motion, _ = planned(trajectory, machine, TOLERANCES)
    found, _ = reconstruct(printed(motion, machine), "job.pmc", trajectory, machine, TOLERANCES)
    assert np.abs(found.motion.joint_time - motion.joint_time).max() < 1e-3
    assert np.abs(found.motion.tip - motion.tip).max() < 1e-5


def test_poses_are_checked_so_close_that_the_tool_keeps_to_the_straight_path_between_them(machine):
    wide = Tolerances(0.2, np.radians(0.2))
    trajectory = placed(steep_helices(), machine)
    motion, _ = planned(trajectory, machine, wide)
    found, _ = reconstruct(printed(motion, machine), "job.pmc", trajectory, machine, wide)
    checked, segments = found.pose_path()
    assert len(checked) == len(segments) == 1 + found.instants.sum()
    assert found.instants.min() == 4 < found.instants.max()
    last = np.append(0, np.cumsum(found.instants))
    even = np.linspace(0, 1, 97)[:, None]
    tips = found.path.at(np.arange(len(found.instants)), even)[:3].transpose(2, 1, 0)
    for tip, first, end in zip(tips, last[:-1], last[1:], strict=True):
        rows = checked.tip[first : end + 1]
        chord = np.diff(rows, axis=0)
        away = tip[:, None] - rows[:-1]
        length = np.maximum((chord**2).sum(axis=1), 1e-30)
        share = np.clip((away * chord).sum(axis=2) / length, 0.0, 1.0)
        assert np.linalg.norm(away - share[..., None] * chord, axis=2).min(axis=1).max() < 0.01


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 3])
def test_the_spin_is_the_one_near_the_start_and_has_no_jumps(turns):
    """Matrices do not show whole turns: the home of a machine may have any number, and a path may pass half a turn."""
    spin = np.linspace(2.5, 4.5, 30) + 2 * np.pi * turns
    axis = np.tile([0.1, -0.2, np.sqrt(0.95)], (30, 1))
    assert np.abs(_spin(platform_rotation(axis, spin), spin[0] + 0.3) - spin).max() < 1e-9


@pytest.mark.slow
def test_a_smooth_curve_through_a_changing_spin_holds(machine):
    """The curve in place of short lines is off by up to the axis tolerance in spin as well."""
    asked = Tolerances(0.2, np.radians(2.0))
    trajectory, _ = place(random_job(np.random.default_rng(10)), machine, offset(machine))
    way = np.maximum(trajectory.length, np.degrees(trajectory.angle))
    turns = np.random.default_rng(1).choice([-1, 0, 0.3, 1], len(way)) * np.radians(0.5) * way
    trajectory = dataclasses.replace(trajectory, spin=np.clip(np.cumsum(turns), -0.5, 0.5))
    motion, faults = planned(trajectory, machine, asked)
    struts = printed(motion, machine)
    assert not faults
    assert not errors(certify(struts, "job.pmc", trajectory, machine, motion, asked)[1])
    assert not refusals(struts, trajectory, machine, asked)


def test_a_spin_that_was_not_programmed_is_found(machine):
    """Tip and axis are right all the time: the platform turns about the tool axis by a little and back."""
    trajectory = placed(cone(60), machine)
    motion, _ = planned(trajectory, machine, TOLERANCES)
    seconds = motion.time_ms / 1000
    turn, most = 2 * np.pi / seconds[-1], np.radians(0.02)
    spin = motion.spin + most * (1 - np.cos(turn * seconds)) / 2
    rate = motion.spin_rate + most * turn * np.sin(turn * seconds) / 2
    rest = np.append(motion.time_ms[[0, -1]], motion.time_ms[[event.row for event in motion.events]])
    rate[np.isin(motion.time_ms, rest)] = 0.0
    turned = dataclasses.replace(motion, spin=spin, spin_rate=rate)
    struts = printed(turned, machine)
    lengths = strut_lengths(machine, motion.tip, motion.axis, spin, motion.tool_length)
    assert np.abs(struts.length - lengths).max() < 1e-6
    assert "V111" in {fault.code for fault in refusals(struts, trajectory, machine)}


@pytest.mark.parametrize(("swing", "expected"), [(0.1, set()), (0.3, {"V110"})])
def test_a_tool_that_runs_to_and_fro_on_its_path_is_found(machine, swing, expected):
    """It slows down within two seconds, with more swing goes back, and catches up: it is never off the path."""
    trajectory = placed(program([[0, 0, 60], [20, 0, 60], [40, 0, 60]]), machine)
    motion, _ = planned(trajectory, machine, TOLERANCES, 0.1)
    struts = printed(motion, machine)
    found, _ = reconstruct(struts, "job.pmc", trajectory, machine, TOLERANCES)
    begin, end = motion.time_ms[-1] - 4000, motion.time_ms[-1] - 2000
    warped = np.arange(begin, end, 20)
    turn = 2 * np.pi * (warped - begin) / (end - begin)
    at = (warped - (end - begin) * swing * (1 - np.cos(turn))) / 1000
    pace = 1 - 2 * np.pi * swing * np.sin(turn)
    interval = np.searchsorted(found.path.time, at) - 1
    share = (at - found.path.time[interval]) / np.diff(found.path.time)[interval]
    place, rate = found.path.at(interval, share[None])[:, 0], pace * found.path.rates_at(interval, share)[0]
    outside = (motion.time_ms < begin) | (motion.time_ms >= end)
    columns = {
        "time_ms": warped, "tip": place[:3].T, "axis": place[3:6].T, "spin": place[6], "tip_rate": rate[:3].T,
        "axis_rate": rate[3:6].T, "spin_rate": rate[6], "tool_length": np.full(len(warped), motion.tool_length[0]),
        "segment": np.full(len(warped), 2),
    }  # fmt: skip
    first = int(np.count_nonzero(motion.time_ms < begin))
    assert all(event.row < first for event in motion.events)
    joined = {
        name: np.concatenate([getattr(motion, name)[outside][:first], column, getattr(motion, name)[outside][first:]])
        for name, column in columns.items()
    }
    faults = refusals(printed(replace(motion, **joined), machine), trajectory, machine)
    assert {fault.code for fault in faults} == expected
    assert all("goes back on its path" in fault.found for fault in faults)


ONE_DASH = [(20, 0.01, 1.0), (320, 15.16, 100.0), (618, 45.0, 100.0), (818, 55.0, 0.0)]
"""ms, mm and mm/s: from rest to the speed of the second line, in an interval that begins on the first one."""


def faults_of_dash(machine, feed, dash, tip=0.05):
    """What is found in a program of two lines, of 15 mm and to where the dash ends, with one tool."""
    wide = Tolerances(tip, np.radians(0.05))
    time_ms, along, speed = np.array(dash).T
    stop = Event(0, EventKind.TOOL_CHANGE, 1), Event(1, EventKind.DWELL, 0.1)
    points = [[0, 0, 60], [15, 0, 60], [along[-1], 0, 60]]
    trajectory = placed(program(points, feed=np.array([np.nan, feed, 100.0]), events=stop), machine)
    motion, _ = planned(trajectory, machine, wide)
    rest = motion.events[-1].row
    count, still = len(along), np.zeros((len(along), 2))
    columns = {
        "time_ms": motion.time_ms[rest] + time_ms.astype(int), "segment": np.minimum(1 + (along > 15), 2),
        "tip": motion.tip[rest] + np.column_stack([along, still]), "tip_rate": np.column_stack([speed, still]),
    }  # fmt: skip
    same = ("axis", "axis_rate", "spin", "spin_rate", "tool_length")
    columns |= {name: np.repeat(getattr(motion, name)[[rest]], count, axis=0) for name in same}
    joined = {name: np.concatenate([getattr(motion, name)[: rest + 1], column]) for name, column in columns.items()}
    return refusals(printed(replace(motion, **joined), machine), trajectory, machine, wide)


@pytest.mark.parametrize(("feed", "expected"), [(100.0, set()), (1.0, {"V108"})])
def test_a_tool_that_is_fast_before_it_reaches_the_fast_line_is_found(machine, feed, expected):
    """An interval from a slow line of 15 mm to a fast one: at its end the tool may be fast, on the slow line not.

    The oracle: the mean speed of the interval is 50.5 mm/s, the first line has 1 mm/s.
    """
    assert {fault.code for fault in faults_of_dash(machine, feed, ONE_DASH)} == expected


@pytest.mark.parametrize(("share", "expected"), [(0.0, set()), (0.5, set()), (1.0, {"V110"})])
def test_a_tool_that_goes_back_between_even_instants_is_found(machine, share, expected):
    """One cubic of half a second nearly stops half way, and goes back for an eighth of its time: 16/4096 of 10 mm.

    The way by the share y from the middle is 10 (4 y^3 - k y), k = 12/256 turns back at y = 1/16 and -1/16.
    """
    back = share * 12 / 256
    speed, way = 20 * (3 - back), 10 * (1 - back)
    begin = 0.2 * speed
    dash = [(400, begin, speed), (900, begin + way, speed), (1300, way + 2 * begin, 0.0)]
    faults = faults_of_dash(machine, 100.0, dash, tip=0.03)
    assert {fault.code for fault in faults} == expected
    assert all("goes back on its path, by 1.3" in fault.found for fault in faults)


@pytest.fixture(scope="module")
def with_a_stop(machine):
    """A trajectory with a tool change and a stop, and a program of it that holds."""
    stops = (Event(0, EventKind.TOOL_CHANGE, 1), Event(20, EventKind.STOP, 0.0))
    trajectory = placed(replace(cone(40), events=stops), machine)
    motion, _ = planned(trajectory, machine, TOLERANCES)
    struts = printed(motion, machine)
    assert not refusals(struts, trajectory, machine)
    return trajectory, struts


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda events: events[:-1], "V109"),
        (lambda events: (*events[:-1], replace(events[-1], value=1.0)), "V109"),
        (lambda events: (*events, Event(events[-1].row, EventKind.STOP, 0.0)), "V109"),
    ],
)
def test_events_are_those_of_the_trajectory_where_it_rests(machine, with_a_stop, change, code):
    trajectory, struts = with_a_stop
    spoiled = replace(struts, events=change(struts.events))
    assert code in {fault.code for fault in refusals(spoiled, trajectory, machine)}


def test_a_rest_more_or_less_is_found(machine):
    trajectory = placed(cone(40), machine)
    motion, _ = planned(trajectory, machine, TOLERANCES)
    struts = printed(motion, machine)
    last = len(struts) - 1
    longer = StrutMotion(
        np.append(struts.time_ms, struts.time_ms[-1] + 20),
        struts.length[[*range(last + 1), last]],
        struts.speed[[*range(last + 1), last]],
        struts.events,
    )
    assert {fault.code for fault in refusals(longer, trajectory, machine)} == {"V110"}
