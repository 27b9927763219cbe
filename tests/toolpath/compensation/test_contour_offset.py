# SPDX-License-Identifier: LGPL-2.1-or-later
"""2D compensation of whole programs: distances on contours of chance, laws of sides, and what stays with the rows."""

from dataclasses import replace

import numpy as np
import pytest
from contour_programs import beside, clearance, contour, cutting_rows, distance, in_plane, random_contour, samples
from series import cases

from pkm_post.model import Event, EventKind, Kind
from pkm_post.model.diagnostics import errors
from pkm_post.toolpath.compensation.contour_elements import elements_of
from pkm_post.toolpath.compensation.contour_offset import _with_offsets, element_offsets, offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions
from pkm_post.toolpath.symmetry.transform import mirror, transform

MICRON = 1e-3
ROUNDING = 1e-9

EVERY_OPTION = pytest.mark.parametrize(
    "options",
    [OffsetOptions(corners, leads) for corners in ("chord", "arc") for leads in "AB"],
    ids=lambda options: f"{options.corners} {options.leads}",
)
SQUARE = [(0.0, 0.0), (20.0, 0.0), (20.0, -40.0), (-20.0, -40.0), (-20.0, 0.0), (0.0, 0.0), (0.0, 30.0)]


def chance(seed):
    rng = np.random.default_rng(seed)
    return rng, rng.choice([-1.0, 1.0]) * rng.uniform(2.0, 5.0), int(rng.integers(0, 3))


def reversed_contour(given):
    """The contour travelled from its end to its start."""
    count = len(given)
    before = np.arange(count - 1, 0, -1)
    return replace(
        given,
        position=given.position[::-1],
        kind=np.append(Kind.RAPID, given.kind[before]),
        arc_centre=np.vstack([np.full(3, np.nan), given.arc_centre[before]]),
        arc_axis=np.vstack([np.full(3, np.nan), -given.arc_axis[before]]),
        feed=np.append(np.nan, given.feed[before]),
    )


def moved_and_source(given, options):
    elements, faults = elements_of(given)
    assert faults == ()
    return _with_offsets(given, elements, element_offsets(elements, options))


@pytest.mark.slow
@EVERY_OPTION
def test_the_tool_keeps_its_radius_from_contours_of_chance(options):
    kept = 0
    for seed in range(60):
        rng, offset, plane = chance(seed)
        given = random_contour(rng, offset, plane)
        moved, _ = offset_contours(given, options)
        if moved is None:
            continue
        _, source, extra = moved_and_source(given, options)
        walls, size = cutting_rows(given), abs(offset)
        for row in range(2, len(moved) - 1):
            points = samples(moved, row)
            assert clearance(points, given, walls, plane).min() > size - MICRON
            # At corners the tool is within sqrt(2) of its radius.
            assert clearance(points, given, walls, plane).max() < size * np.sqrt(2) + MICRON
            if not extra[row]:
                cuts = beside(points, given, source[row], plane)
                assert cuts.sum() > 0
                np.testing.assert_allclose(distance(points[cuts], given, source[row], plane), size, atol=MICRON)
        kept += 1
    assert kept > 35


@pytest.mark.slow
@EVERY_OPTION
def test_what_is_refused_would_cut_into_the_part(options):
    """A path that is refused for a gouge, measured by closed forms, is too near to the contour; no other is refused."""
    refused = 0
    for seed in range(cases(50)):
        rng, offset, plane = chance(seed)
        given = random_contour(rng, offset, plane)
        reported = {fault.code for fault in errors(offset_contours(given, options)[1])}
        if not reported:
            continue
        assert reported in ({"N202"}, {"N204"})
        if reported == {"N204"}:
            moved, _, _ = moved_and_source(given, options)
            rows = range(2, len(moved) - 1)
            nearest = min(clearance(samples(moved, row, 300), given, cutting_rows(given), plane).min() for row in rows)
            assert nearest < abs(offset) - MICRON / 2
            refused += 1
    assert refused > 3


@pytest.mark.slow
@pytest.mark.parametrize("corners", ["chord", "arc"])
def test_left_of_the_reversed_path_is_right_of_the_path(corners):
    compared = 0
    for seed in range(60):
        rng, offset, plane = chance(seed)
        given = random_contour(rng, offset, plane)
        back = reversed_contour(given)
        side = np.full(len(back), -offset)
        side[[0, -1]] = 0.0
        moved, _ = offset_contours(given, OffsetOptions(corners))
        returned, _ = offset_contours(replace(back, side_offset=side), OffsetOptions(corners))
        assert (moved is None) == (returned is None)
        if moved is None:
            continue
        # Where a plunge goes with a joint, the heights of what is added differ with the sense.
        np.testing.assert_allclose(
            in_plane(moved.position, plane), in_plane(returned.position[::-1], plane), atol=ROUNDING
        )
        compared += 1
    assert compared > 40


@pytest.mark.slow
def test_a_mirrored_path_changes_its_side():
    plane_of_mirror = mirror([3.0, 0.0, 0.0], [1.0, 0.0, 0.0])
    compared = 0
    for seed in range(60):
        rng, offset, _ = chance(seed)
        given = random_contour(rng, offset)
        image, _ = transform(given, plane_of_mirror)
        np.testing.assert_array_equal(image.side_offset, -given.side_offset)
        moved, _ = offset_contours(given)
        of_image, _ = offset_contours(image)
        if moved is None:
            assert of_image is None
            continue
        image_of, _ = transform(moved, plane_of_mirror)
        np.testing.assert_allclose(of_image.position, image_of.position, atol=ROUNDING)
        np.testing.assert_allclose(of_image.arc_axis, image_of.arc_axis, atol=ROUNDING)
        compared += 1
    assert compared > 40


def test_a_program_without_compensation_is_itself():
    given = contour((0.0, 0.0), SQUARE, 0.0)
    moved, faults = offset_contours(given)
    assert moved is given
    assert faults == ()


def test_arcs_at_corners_are_about_the_corners():
    moved, faults = offset_contours(contour((0.0, 30.0), SQUARE, 5.0), OffsetOptions("arc"))
    assert faults == ()
    expected = [
        (0, 30), (0, 5), (20, 5), (25, 0), (25, -40), (20, -45),
        (-20, -45), (-25, -40), (-25, 0), (-20, 5), (0, 5), (0, 30),
    ]  # fmt: skip
    np.testing.assert_allclose(moved.position[:, :2], expected, atol=ROUNDING)
    arcs = np.flatnonzero(moved.kind == Kind.ARC)
    np.testing.assert_allclose(moved.arc_centre[arcs, :2], [(20, 0), (20, -40), (-20, -40), (-20, 0)], atol=ROUNDING)
    np.testing.assert_allclose(moved.arc_axis[arcs], np.tile([0, 0, -1.0], (4, 1)))


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("offset", [3.0, -3.0])
def test_full_circles_stay_full_circles(turn, offset):
    radius = 12.0
    inside = radius - turn * offset
    lead = (2 * inside - radius, 0.0) if inside > radius else (0.0, 0.0)
    given = contour(lead, [(radius, 0.0), (radius, 0.0, -4.0, 0.0, 0.0, turn), lead], offset)
    moved, faults = offset_contours(given)
    assert faults == ()
    np.testing.assert_allclose(moved.position[1:3], [(inside, 0, 0), (inside, 0, -4)], atol=ROUNDING)
    assert moved.kind[2] == Kind.ARC


def test_plunges_keep_the_offset_of_the_row_before():
    pieces = [(0, 0, 5), (0, 0, -2), (20, 0, -2), (20, 0, -4), (20, -20, -4), (20, -20, 5), (60, -60, 5)]
    moved, faults = offset_contours(contour((0.0, 40.0, 5.0), pieces, 5.0))
    assert faults == ()
    expected = [
        (0, 40, 5), (0, 5, 5), (0, 5, -2), (25, 5, -2), (25, 5, -4), (25, -20, -4), (25, -20, 5), (60, -60, 5),
    ]  # fmt: skip
    np.testing.assert_allclose(moved.position, expected, atol=ROUNDING)


def test_compensation_that_is_switched_off_ends_with_the_next_move_in_the_plane():
    given = contour((0.0, 20.0), [(0, 0), (20, 0), (20, 0, 30), (30, 20, 30), (60, 20, 30)], 5.0)
    side = np.array([0, 5.0, 5.0, 0, 0, 0])
    moved, faults = offset_contours(replace(given, side_offset=side))
    assert faults == ()
    expected = [(0, 20, 0), (0, 5, 0), (20, 5, 0), (20, 5, 30), (30, 20, 30), (60, 20, 30)]
    np.testing.assert_allclose(moved.position, expected, atol=ROUNDING)


def test_a_program_may_end_while_compensation_is_on():
    given = contour((0.0, 20.0), [(0.0, 0.0), (20.0, 0.0), (20.0, -20.0)], 5.0, cancel=False)
    moved, faults = offset_contours(given)
    assert faults == ()
    np.testing.assert_allclose(moved.position[:, :2], [(0, 20), (0, 5), (25, 5), (25, -20)], atol=ROUNDING)


def test_feeds_lines_operations_and_events_stay_with_their_rows():
    given = contour((0.0, 30.0), SQUARE, 5.0)
    count = len(given)
    given = replace(
        given,
        feed=np.append(np.nan, np.arange(1.0, count)),
        operation=np.arange(count) // 3,
        operations=("first", "second", "third"),
        exact_stop=np.arange(count) == 2,
        events=(Event(0, EventKind.TOOL_CHANGE, 1), Event(3, EventKind.DWELL, 0.5), Event(count, EventKind.SPINDLE, 0)),
    )
    moved, _ = offset_contours(given, OffsetOptions("arc"))
    # Rows 3 to 6 begin with an arc about the corner before them; it has their feed.
    source = np.array([0, 1, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7])
    np.testing.assert_array_equal(moved.line, source + 1)
    np.testing.assert_array_equal(moved.operation, source // 3)
    np.testing.assert_array_equal(moved.feed[1:], source[1:])
    np.testing.assert_array_equal(np.flatnonzero(moved.exact_stop), [2])
    # Row 3 has become rows 3 and 4: its event stays before both.
    assert [event.row for event in moved.events] == [0, 3, len(moved)]
    assert not moved.side_offset.any()
    assert [event.kind for event in moved.events] == [event.kind for event in given.events]


def test_rapid_moves_go_round_corners_by_lines():
    given = contour((0.0, 30.0), SQUARE, 5.0)
    kind = given.kind.copy()
    kind[3] = Kind.RAPID
    feed = np.where(kind == Kind.RAPID, np.nan, 20.0)
    moved, faults = offset_contours(replace(given, kind=kind, feed=feed), OffsetOptions("arc"))
    assert faults == ()
    rapid = moved.line == 4
    assert set(moved.kind[rapid]) == {Kind.RAPID}
    assert np.isnan(moved.feed[rapid]).all()


def test_the_radius_may_change_where_the_path_goes_straight_on_or_outward():
    given = contour((0.0, 20.0), [(0.0, 0.0), (20.0, 0.0), (40.0, 0.0), (40.0, -20.0), (80.0, -20.0)], 5.0)
    side = np.array([0, 5.0, 5.0, 3.0, 4.0, 0])
    moved, faults = offset_contours(replace(given, side_offset=side))
    assert faults == ()
    expected = [(0, 20), (0, 5), (20, 5), (20, 3), (40, 3), (40, 4), (44, 4), (44, -20), (80, -20)]
    np.testing.assert_allclose(moved.position[:, :2], expected, atol=ROUNDING)


def test_the_radius_may_change_at_an_inner_corner():
    given = contour((0.0, 20.0), [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 70.0)], 5.0)
    moved, faults = offset_contours(replace(given, side_offset=np.array([0, 5.0, 5.0, 3.0, 0])))
    assert faults == ()
    np.testing.assert_allclose(moved.position[:, :2], [(0, 20), (0, 5), (37, 5), (37, 30), (0, 70)], atol=ROUNDING)


def test_the_side_may_change_where_the_path_comes_back():
    given = contour((0.0, 20.0), [(0.0, 0.0), (40.0, 0.0), (0.0, 0.0), (0.0, 20.0)], 5.0)
    moved, faults = offset_contours(replace(given, side_offset=np.array([0, 5.0, 5.0, -5.0, 0])))
    assert faults == ()
    np.testing.assert_allclose(moved.position[:, :2], [(0, 20), (0, 5), (40, 5), (0, 5), (0, 20)], atol=ROUNDING)


def test_a_side_that_changes_elsewhere_is_reported():
    given = contour((0.0, 20.0), [(0.0, 0.0), (40.0, 0.0), (80.0, 0.0), (80.0, -20.0)], 5.0)
    moved, faults = offset_contours(replace(given, side_offset=np.array([0, 5.0, 5.0, -5.0, 0])))
    np.testing.assert_allclose(moved.position[2:5, :2], [(40, 5), (40, -5), (80, -5)], atol=ROUNDING)
    assert [(fault.code, fault.place.line) for fault in faults] == [("N205", 4)]


def test_a_tool_change_within_a_contour_changes_nothing():
    given = contour((0.0, 30.0), SQUARE, 5.0)
    changed = replace(given, events=(*given.events, Event(4, EventKind.TOOL_CHANGE, 2)))
    np.testing.assert_array_equal(offset_contours(given)[0].position, offset_contours(changed)[0].position)


def test_side_offsets_that_are_no_numbers_are_the_callers_fault():
    given = contour((0.0, 30.0), SQUARE, np.nan)
    with pytest.raises(ValueError, match="finite side offsets"):
        offset_contours(given)


@pytest.mark.parametrize("wrong", [{"corners": "round"}, {"leads": "C"}, {"swallowed": "skip"}, {"tolerance": 0.0}])
def test_options_are_checked(wrong):
    with pytest.raises(ValueError, match=f"OffsetOptions.{next(iter(wrong))}"):
        OffsetOptions(**wrong)
