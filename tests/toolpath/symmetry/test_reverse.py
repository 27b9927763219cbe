# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws of reversed passes: twice is once, no point is lost or added, nothing goes down rapidly into the material."""

import dataclasses

import numpy as np
import pytest
from programs import cone, program, square_with_arc

from pkm_post.geometry import norm
from pkm_post.model import Event, EventKind, Kind
from pkm_post.toolpath.compensation.compensate import compensate
from pkm_post.toolpath.compensation.offset_options import OffsetOptions
from pkm_post.toolpath.symmetry.passes import axial_moves, displacements, pass_rows
from pkm_post.toolpath.symmetry.reverse import reversed_passes
from pkm_post.toolpath.symmetry.transform import mirror, transform

ROUNDING = 1e-12
CLEAR, SAFE, PLUNGE, CUT = 50.0, 30.0, 4.0, 20.0
UNCHANGED = ("kind", "position", "tool_axis", "feed", "arc_centre", "arc_axis", "line", "side_offset", "normal")


def turned(made):
    result, faults = reversed_passes(made)
    assert result is not None, faults
    return result


def made_of(rows, **more):
    """A program of (x, y, z, feed) with feed 0 for a rapid move."""
    values = np.array(rows, dtype=float)
    kind = np.where(values[:, 3] == 0, Kind.RAPID, Kind.LINE)
    return program(values[:, :3], kind=kind, feed=np.where(values[:, 3] == 0, np.nan, values[:, 3]), **more)


def one_pass(points):
    """Clearance, safe height, plunge, the points, safe height, clearance, as CAM writes an open profile."""
    (x, y, z), (u, v, _) = points[0], points[-1]
    down = [(x, y, CLEAR, 0), (x, y, SAFE, 0), (x, y, z, PLUNGE)]
    way = [(*point, CUT + number) for number, point in enumerate(points[1:])]
    return [*down, *way, (u, v, SAFE, 0), (u, v, CLEAR, 0)]


STEPS_DOWN = [[(0, 0, z), (20, 0, z), (30, 10, z), (30, 40, z)] for z in (10.0, 5.0, 0.0)]
"""A contour in three depths, from the top."""


def open_profile():
    return made_of([row for points in STEPS_DOWN for row in one_pass(points)])


def closed_profile():
    """A closed contour, its depths joined by plunges at feed."""
    square = [(20, 0), (20, 20), (0, 20), (0, 0)]
    rows = [(0, 0, CLEAR, 0)]
    for z in (10, 5, 0):
        rows += [(0, 0, z, PLUNGE), *((x, y, z, CUT) for x, y in square)]
    return made_of([*rows, (0, 0, CLEAR, 0)])


def with_arcs():
    """Lines, a half circle and a helix down, each with a feed of its own, and a lift at the end."""
    made = square_with_arc()
    blank = np.full((1, 3), np.nan)
    position, kind = np.vstack([made.position, [0, 0, 60]]), np.append(made.kind, Kind.RAPID)
    centre, turn = np.vstack([made.arc_centre, blank]), np.vstack([made.arc_axis, blank])
    return program(position, kind=kind, feed=np.arange(len(kind)) + 1.0, centre=centre, turn=turn)


def assert_same(left, right):
    for name in UNCHANGED:
        np.testing.assert_allclose(getattr(left, name), getattr(right, name), atol=ROUNDING, err_msg=name)
    assert left.events == right.events


def points_of(made):
    return {tuple(point) for point in np.round(np.hstack([made.position, made.tool_axis]), 9).tolist()}


def cut_points(made):
    """Where passes begin, lead to, and end."""
    rows = np.concatenate([np.arange(first - 1, behind) for first, behind in pass_rows(made)])
    return {tuple(point) for point in np.round(made.position[rows], 9).tolist()}


def off_the_ways(made, before):
    """How far points are off the straight ways of another program, at most."""
    start, way = before.position[:-1], displacements(before)[1:]
    share = np.einsum("abc,bc->ab", made.position[:, None] - start, way) / np.maximum(np.sum(way**2, axis=1), 1e-12)
    foot = start + np.clip(share, 0, 1)[..., None] * way
    return norm(made.position[:, None] - foot).min(axis=1).max()


def ways_of(made):
    """Feed, middle, length and centre of each row that cuts, in no order."""
    rows = np.concatenate([np.arange(first, behind) for first, behind in pass_rows(made)])
    middle = made.position[rows] - displacements(made)[rows] / 2
    length, centre = norm(displacements(made))[rows], np.nan_to_num(made.arc_centre[rows])
    table = np.column_stack([made.feed[rows], middle, length, centre, made.line[rows]])
    return sorted(map(tuple, np.round(table, 9).tolist()))


JOBS = {"open profile": open_profile, "closed profile": closed_profile, "arcs and a helix": with_arcs}
EVERY = JOBS | {"cone": lambda: cone(40, 0.25)}


@pytest.mark.parametrize("make", JOBS.values(), ids=JOBS)
def test_reversed_twice_is_the_original(make):
    assert_same(turned(turned(make())), make())


@pytest.mark.parametrize("make", EVERY.values(), ids=EVERY)
def test_three_times_is_once(make):
    once = turned(make())
    assert_same(turned(turned(once)), once)


@pytest.mark.parametrize("make", EVERY.values(), ids=EVERY)
def test_no_point_is_added_or_lost(make):
    assert points_of(turned(make())) == points_of(make())


@pytest.mark.parametrize("make", EVERY.values(), ids=EVERY)
def test_feeds_go_with_their_ways(make):
    assert ways_of(turned(make())) == ways_of(make())


def test_each_pass_is_run_the_other_way_and_depths_keep_their_sequence():
    before, after = open_profile(), turned(open_profile())
    for (first, behind), (start, end) in zip(pass_rows(before), pass_rows(after), strict=True):
        np.testing.assert_allclose(
            after.position[start - 1 : end], before.position[first - 1 : behind][::-1], atol=ROUNDING
        )
    assert after.position[:, 2][pass_rows(after)[:, 0]].tolist() == [10.0, 5.0, 0.0]


@pytest.mark.parametrize("make", [open_profile, closed_profile, with_arcs])
def test_no_rapid_move_comes_to_where_a_pass_begins(make):
    after = turned(make())
    starts = pass_rows(after)[:, 0] - 1
    assert np.all(after.kind[starts] == Kind.LINE)
    assert np.all(axial_moves(after)[starts] == -1)


def test_leads_change_places_with_the_feed_of_the_plunge():
    after = turned(made_of(one_pass(STEPS_DOWN[0])))
    assert after.position[:3].tolist() == [[30, 40, CLEAR], [30, 40, SAFE], [30, 40, 10]]
    np.testing.assert_array_equal(after.feed[:3], [np.nan, np.nan, PLUNGE])
    assert after.position[-2:].tolist() == [[0, 0, SAFE], [0, 0, CLEAR]]
    np.testing.assert_array_equal(after.feed[-2:], [np.nan, np.nan])


def test_a_lift_in_one_go_is_gone_back_rapidly_to_where_the_plunge_began():
    rows = [(0, 0, CLEAR, 0), (0, 0, SAFE, 0), (0, 0, 0, PLUNGE), (20, 0, 0, CUT), (20, 0, CLEAR, 0)]
    after = turned(made_of(rows))
    assert after.position[:3].tolist() == [[20, 0, CLEAR], [20, 0, SAFE], [20, 0, 0]]
    np.testing.assert_array_equal(after.feed[:3], [np.nan, np.nan, PLUNGE])
    assert after.position[-2:].tolist() == [[0, 0, 0], [0, 0, CLEAR]]


def test_a_lift_through_what_may_be_material_is_not_gone_back_rapidly():
    rows = [(0, 0, CLEAR, 0), (0, 0, SAFE, 0), (0, 0, 0, PLUNGE), (20, 0, 0, CUT), (20, 0, 10, 0), (20, 0, CLEAR, 0)]
    after = turned(made_of(rows))
    assert after.position[1:3].tolist() == [[20, 0, SAFE], [20, 0, 0]]
    assert after.feed[2] == PLUNGE  # 10 is below the height that was approached rapidly


def test_a_closed_contour_is_reached_and_left_as_before():
    before, after = closed_profile(), turned(closed_profile())
    leads = np.setdiff1d(np.arange(len(before)), np.concatenate([np.arange(*run) for run in pass_rows(before)]))
    np.testing.assert_array_equal(after.position[leads], before.position[leads])
    np.testing.assert_array_equal(after.feed[leads], before.feed[leads])


def test_arcs_turn_the_other_way_about_the_same_centre():
    before, after = with_arcs(), turned(with_arcs())
    arcs, back = before.kind == Kind.ARC, after.kind == Kind.ARC
    np.testing.assert_allclose(after.arc_axis[back], -before.arc_axis[arcs][::-1], atol=ROUNDING)
    np.testing.assert_allclose(after.arc_centre[back], before.arc_centre[arcs][::-1], atol=ROUNDING)


def test_compensation_to_the_left_is_to_the_right_then():
    before = dataclasses.replace(open_profile(), side_offset=np.full(len(open_profile()), 3.0))
    after = turned(before)
    assert all(np.all(after.side_offset[first:behind] == -3.0) for first, behind in pass_rows(after))


def test_a_mirror_and_a_reversal_keep_the_side_of_the_compensation():
    before = dataclasses.replace(open_profile(), side_offset=np.full(len(open_profile()), 3.0))
    after = turned(transform(before, mirror([0, 0, 0], [1, 0, 0]))[0])
    assert all(np.all(after.side_offset[first:behind] == 3.0) for first, behind in pass_rows(after))


def test_compensation_that_begins_and_ends_on_leads_does_so_on_the_other_one_then():
    points = [(0, 0), (5, 0), (5, 20), (25, 20), (25, 0)]
    x, y = np.array([points[0], points[0], *points, points[-1]]).T[:, :, None]
    z, feed = np.array([CLEAR, 0.0, *[0.0] * 5, CLEAR])[:, None], np.array([0, PLUNGE, *[CUT] * 5, 0])[:, None]
    side = np.array([0, 0, 0, 3.0, 3.0, 3.0, 0, 0])
    before = dataclasses.replace(made_of(np.hstack([x, y, z, feed])), side_offset=side)
    (there, _), (back, _) = (compensate(each, OffsetOptions(), {}) for each in (before, turned(before)))
    expected = turned(there)
    np.testing.assert_allclose(back.position, expected.position, atol=1e-9)
    np.testing.assert_array_equal(back.kind, expected.kind)


def test_what_a_program_says_of_corners_goes_with_the_way_and_a_stop_with_its_point():
    before = open_profile()
    (first, behind), rows = pass_rows(before)[0], np.arange(len(before))
    before = dataclasses.replace(
        before, exact_path=rows == first + 1, tip_tolerance=np.where(rows == first, 0.05, 0.0), exact_stop=rows == first
    )
    after = turned(before)
    begin, end = pass_rows(after)[0]
    assert np.flatnonzero(after.exact_path).tolist() == [begin + behind - first - 2]
    assert np.flatnonzero(after.tip_tolerance).tolist() == [end - 1]
    (stop,) = np.flatnonzero(after.exact_stop)
    np.testing.assert_allclose(after.position[stop], before.position[first], atol=ROUNDING)


def test_events_between_passes_stay_there_and_a_dwell_stays_at_its_point():
    before, events = open_profile(), [(0, EventKind.TOOL_CHANGE, 1), (0, EventKind.SPINDLE, 9000)]
    runs, rows = pass_rows(before), len(before)
    events += [(runs[0, 0] + 1, EventKind.DWELL, 0.5), (runs[0, 1] + 2, EventKind.SPINDLE, 7000)]
    events += [(rows, EventKind.SPINDLE, 0)]
    before = dataclasses.replace(before, events=tuple(Event(int(row), *rest) for row, *rest in events))
    after = turned(before)
    assert [event.kind for event in after.events] == [kind for _, kind, _ in events]
    dwell, speed, stop = after.events[2:]
    np.testing.assert_array_equal(after.position[dwell.row - 1], before.position[runs[0, 0]])
    np.testing.assert_array_equal(after.position[speed.row - 1], [0, 0, CLEAR])
    assert (speed.value, stop.row) == (7000, rows)
    assert_same(turned(after), before)


@pytest.mark.parametrize(
    ("rows", "codes"),
    [
        ([(0, 0, 5, 0), (20, 0, 5, CUT), (30, 0, 5, 0), (40, 0, 5, CUT)], ["K122"]),
        ([(0, 0, 9, 0), (0, 0, 5, PLUNGE), (20, 0, 5, CUT), (20, 0, 1, PLUNGE), (40, 0, 1, CUT)], ["K122"]),
        ([(0, 0, 9, 0), (0, 0, 5, PLUNGE), (20, 0, 5, CUT)], ["K122"]),
        ([(0, 0, 5, 0), (20, 0, 5, CUT)], ["K123"]),
        ([(0, 0, 9, 0), (0, 0, 5, PLUNGE), (20, 0, 0, CUT), (20, 0, 9, 0)], ["K124"]),
    ],
    ids=["no lift between", "down by a step", "never left", "neither reached nor left", "a ramp down"],
)
def test_what_stands_against_it_or_must_be_known(rows, codes):
    result, faults = reversed_passes(made_of(rows))
    assert {fault.code for fault in faults} == set(codes)
    assert (result is None) == ("K122" in codes)


def test_a_low_lift_is_not_where_a_rapid_move_may_go():
    """Lowered rapidly to 30 and lifted to 11: at 11 there may be material before the pass is cut."""
    rows = [(0, 0, CLEAR, 0), (0, 0, SAFE, 0), (0, 0, 10, PLUNGE), (20, 0, 10, CUT), (20, 0, 11, 0), (90, 0, 11, 0)]
    result, (fault,) = reversed_passes(made_of(rows))
    assert result is None
    assert (fault.code, fault.found) == ("K122", "the lift from this pass ends below where rapid moves went")


def test_heights_are_measured_along_each_tool_axis():
    """A quarter round a pin with the tool leaning towards the pin: both ends are 30 above the pass along their axes."""
    angle = np.linspace(0, np.pi / 2, 10)
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(10)])
    axis = np.array([0, 0, 0.8]) - 0.6 * out
    ends = [0, 9]
    position = np.insert(40 * out, [0, 10], 40 * out[ends] + 30 * axis[ends], axis=0)
    kind = [Kind.RAPID, *([Kind.LINE] * 10), Kind.RAPID]
    before = program(position, np.insert(axis, [0, 10], axis[ends], axis=0), kind=kind)
    after = turned(before)
    np.testing.assert_allclose(after.position, position[::-1], atol=ROUNDING)
    assert_same(turned(after), before)


def test_a_rapid_way_with_corners_is_not_cut_short():
    first, second = one_pass(STEPS_DOWN[0]), one_pass(STEPS_DOWN[1])
    around = [(90, 40, CLEAR, 0), (90, 0, CLEAR, 0)]
    result, (fault,) = reversed_passes(made_of([*first, *around, *second]))
    assert result is None
    assert (fault.code, fault.found) == ("K122", "the rapid way to this pass has corners")


def test_a_change_of_speed_in_the_middle_of_a_pass_is_refused():
    before = open_profile()
    event = Event(int(pass_rows(before)[0, 0]) + 1, EventKind.SPINDLE, 3000)
    result, (fault,) = reversed_passes(dataclasses.replace(before, events=(event,)))
    assert result is None
    assert (fault.code, fault.found, fault.place.line) == ("K125", "spindle", event.row + 1)


def test_drilling_is_as_it_was():
    rows = [(x, 0, z, feed) for x in (0, 10) for z, feed in ((CLEAR, 0), (0, PLUNGE), (CLEAR, 0))]
    assert_same(turned(made_of(rows)), made_of(rows))


def random_job(rng):
    """Open passes at random depths, lowered rapidly to SAFE, lifted rapidly to some height and on to CLEAR."""
    rows = []
    for _ in range(rng.integers(1, 6)):
        points = np.cumsum(rng.normal(scale=9, size=(rng.integers(2, 7), 3)) * [1, 1, 0.1], axis=0)
        (x, y, z), (u, v, _) = points[0], points[-1]
        rows += [(x, y, CLEAR, 0), (x, y, SAFE, 0), (x, y, z, PLUNGE), *((*point, CUT) for point in points[1:])]
        rows += [(u, v, height, 0) for height in (rng.uniform(SAFE, CLEAR), CLEAR)]
    return made_of(rows)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_laws_hold_for_random_jobs(seed):
    before = random_job(np.random.default_rng(seed))
    once = turned(before)
    assert cut_points(once) == cut_points(before)
    assert off_the_ways(once, before) < 1e-9
    assert ways_of(once) == ways_of(before)
    twice = turned(once)
    assert ways_of(twice) == ways_of(before)
    for name in ("kind", "position", "tool_axis", "feed"):
        np.testing.assert_allclose(getattr(twice, name), getattr(before, name), atol=1e-9, err_msg=name)
    rapid = once.kind == Kind.RAPID
    straight_up = axial_moves(once) == 1
    assert np.all(once.position[rapid & ~straight_up, 2] >= SAFE - ROUNDING)
    starts_high = once.position[np.flatnonzero(rapid & ~straight_up)[1:] - 1, 2]
    assert np.all(starts_high >= SAFE - ROUNDING)
