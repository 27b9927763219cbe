# SPDX-License-Identifier: LGPL-2.1-or-later
"""The check of the whole contour: narrow places far along the path, and what is no fault."""

from dataclasses import replace

import numpy as np
import pytest
from contour_programs import contour, random_contour

from pkm_post.model import Kind
from pkm_post.model.program import OPTIONAL_COLUMNS
from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions


def bottle(neck):
    """A pocket, travelled with the tool to the left, with a neck that the tool passes twice."""
    half = neck / 2
    walls = [
        (0.0, -20.0), (20.0, -20.0), (20.0, -half), (50.0, -half), (50.0, -20.0), (90.0, -20.0), (90.0, 20.0),
        (50.0, 20.0), (50.0, half), (20.0, half), (20.0, 20.0), (-20.0, 20.0), (-20.0, -20.0), (0.0, -20.0),
    ]  # fmt: skip
    return contour((0.0, 0.0), [*walls, (0.0, 0.0)], 5.0)


def codes(faults):
    return [(fault.code, fault.place.line) for fault in faults]


def test_a_neck_as_wide_as_the_tool_is_passed():
    assert offset_contours(bottle(10.0))[1] == ()
    assert offset_contours(bottle(9.9995))[1] == ()


def test_a_neck_that_is_narrower_is_a_gouge_though_no_block_is_too_short():
    moved, faults = offset_contours(bottle(9.0))
    assert moved is None
    assert codes(faults) == [("N204", 5)]
    assert faults[0].found.startswith("by 1 mm at the block of line 11, ")


def test_the_tolerance_is_that_of_the_options():
    assert offset_contours(bottle(9.9), OffsetOptions(tolerance=0.11))[1] == ()
    assert offset_contours(bottle(9.9), OffsetOptions(tolerance=0.09))[0] is None


@pytest.mark.parametrize(("height", "touched"), [(0.0, True), (-5.0, False), (5.0, True)])
def test_what_lies_lower_than_the_tip_is_not_touched(height, touched):
    """A tool along y = 5, and a wall at y = 8 that is cut later from its other side, at another height."""
    pieces = [
        (0, 0, 0), (40, 0, 0), (40, 0, 50), (60, -30, 50), (-60, -30, 50), (-60, 8, 50), (-20, 8, 50),
        (-20, 8, height), (40, 8, height), (40, 8, 50), (40, 40, 50),
    ]  # fmt: skip
    given = contour((0.0, 30.0, 0.0), pieces, 5.0)
    rapid = np.isin(np.arange(len(given)), (0, 4, 5, 6, 7))
    given = replace(given, kind=np.where(rapid, Kind.RAPID, given.kind), feed=np.where(rapid, np.nan, 10.0))
    reported = [item for item in codes(offset_contours(given)[1]) if item[0] != "N205"]
    assert reported == ([("N204", 3)] if touched else [])


@pytest.mark.parametrize("radius", [6.0, 8.0, 15.0])
def test_arcs_that_lead_onto_a_closed_contour_are_no_walls(radius):
    """The tool on the contour passes over the arcs by which it came and goes."""
    pieces = [
        (-radius, 40 - radius), (0.0, 40.0, 0.0, 40.0 - radius, -1), (40.0, 40.0), (40.0, -40.0), (-40.0, -40.0),
        (-40.0, 40.0), (0.0, 40.0), (radius, 40 - radius, 0.0, 40.0 - radius, -1), (0.0, 0.0),
    ]  # fmt: skip
    assert offset_contours(contour((0.0, 0.0), pieces, -5.0))[1] == ()


def test_arcs_that_lead_onto_a_full_circle_are_no_walls():
    pieces = [
        (10.0, -10.0),
        (20.0, 0.0, 10.0, 0.0, 1),
        (20.0, 0.0, 0.0, 0.0, 1),
        (10.0, 10.0, 10.0, 0.0, 1),
        (0.0, 0.0),
    ]
    moved, faults = offset_contours(contour((0.0, 0.0), pieces, 5.0))
    assert faults == ()
    np.testing.assert_allclose(moved.position[1:5, :2], [(10, -5), (15, 0), (15, 0), (10, 5)], atol=1e-9)


@pytest.mark.parametrize("overlap", [0.0, 5.0, 20.0])
def test_a_contour_may_be_closed_with_an_overlap(overlap):
    """The path comes straight onto a square, goes round, and leaves where it came or behind that point."""
    pieces = [
        (0.0, 20.0), (0.0, 0.0), (30.0, 0.0), (30.0, -30.0), (-30.0, -30.0), (-30.0, 0.0), (overlap, 0.0),
        (overlap, 20.0), (10.0, 30.0),
    ]  # fmt: skip
    assert offset_contours(contour((-10.0, 30.0), pieces, 5.0))[1] == ()


SQUARE = [(0.0, -11.0), (0.0, 60.0), (80.0, 60.0), (80.0, 0.0)]


@pytest.mark.parametrize("end", [[(-11.0, 0.0)], [(0.0, 0.0)], [(6.0, 0.0), (0.0, 6.0)], [(6.0, 0.0), (-6.0, 12.0)]])
def test_lines_that_begin_and_end_beyond_their_corner_are_no_walls_there(end):
    """As in many programs by hand; rs274 takes them."""
    pieces = [*SQUARE, *end, (-20.0, 20.0)]
    moved, faults = offset_contours(contour((-20.0, -20.0), pieces, 5.0), OffsetOptions(corners="arc"))
    assert {fault.code for fault in faults} <= {"N205"}
    np.testing.assert_allclose(moved.position[1:3, :2], [(-5, -11), (-5, 60)], atol=1e-9)


@pytest.mark.parametrize("start", [[], [(0.0, -7.0), (0.0, -2.0)], [(0.0, -4.0), (0.0, 0.0)]])
@pytest.mark.parametrize("end", [[(5.0, 0.0), (-4.0, 0.0)], [(0.0, 0.0), (-5.5, 0.0)], [(-3.0, 0.001)]])
@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_what_lies_beyond_their_corner_may_be_several_lines(start, end, turn):
    """The same contour in more blocks, turned and rounded to three decimals as in a program."""
    turned = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    pieces = np.array([SQUARE[0], *start, *SQUARE[1:], *end, (-11.0, 0.0), (-20.0, 20.0)]) @ turned
    _, faults = offset_contours(contour((-20.0, -20.0) @ turned, np.round(pieces, 3).tolist(), 5.0))
    assert {fault.code for fault in faults} <= {"N205"}


def test_a_bent_way_beyond_their_corner_is_a_wall():
    pieces = [*SQUARE, (-4.0, 0.0), (-11.0, 3.0), (-20.0, 20.0)]
    assert "N204" in {fault.code for fault in offset_contours(contour((-20.0, -20.0), pieces, 5.0))[1]}


@pytest.mark.parametrize(("overrun", "is_wall"), [(19.0, False), (21.0, True)])
def test_several_lines_beyond_their_corner_longer_than_four_radii_are_walls(overrun, is_wall):
    pieces = [(0.0, -overrun), (0.0, -7.0), *SQUARE[1:], (-11.0, 0.0), (-20.0, 20.0)]
    _, faults = offset_contours(contour((-20.0, -30.0), pieces, 5.0))
    assert ("N204" in {fault.code for fault in faults}) == is_wall


STRIP = [(0.0, -11.0), (0.0, 60.0), (20.0, 60.0), (20.0, 55.0), (-11.0, 55.0)]


@pytest.mark.parametrize(
    ("side", "pieces"), [(-5.0, [*SQUARE, (-11.0, 0.0)]), (-5.0, [*SQUARE, (0.0, 0.0)]), (5.0, STRIP)]
)
def test_lines_that_cross_at_an_inner_corner_or_early_on_the_way_are_walls(side, pieces):
    """With the tool inside, or where the closed part is less than half of the path."""
    _, faults = offset_contours(contour((20.0, -20.0), [*pieces, (-20.0, 20.0)], side))
    assert "N204" in {fault.code for fault in faults}


def test_arcs_are_measured_within_the_tolerance():
    """A bump of radius 7 opposite a wall: the tool passes if the gap is its diameter."""
    for gap, passes in ((10.0, True), (10.0 - 5e-4, True), (10.0 - 5e-3, False)):
        pieces = [
            (0.0, 0.0), (60.0, 0.0), (60.0, 30.0), (37.0, gap + 7.0), (23.0, gap + 7.0, 30.0, gap + 7.0, -1),
            (0.0, 30.0), (0.0, 60.0),
        ]  # fmt: skip
        given = contour((0.0, 20.0), pieces, 5.0)
        reported = {fault.code for fault in offset_contours(given)[1]}
        assert ("N204" not in reported) == passes


def test_each_contour_has_its_own_walls_and_its_own_diagnostic():
    first = bottle(9.0)
    count = len(first)
    twice = {
        name: np.concatenate([getattr(first, name)] * 2)
        for name in ("kind", "position", "tool_axis", "feed", "arc_centre", "arc_axis", "operation", "line")
    }
    twice["line"] = np.arange(1, 2 * count + 1)
    both = replace(
        first,
        **twice,
        side_offset=np.tile(first.side_offset, 2),
        **dict.fromkeys(OPTIONAL_COLUMNS.keys() - {"side_offset"}),
    )
    assert codes(offset_contours(both)[1]) == [("N204", 5), ("N204", 5 + count)]


@pytest.mark.slow
def test_rounded_end_points_and_centres_are_no_gouge():
    """With three decimals the radii of an arc differ by up to 0.001 mm, and so do directions at joints."""
    taken = 0
    for seed in range(60):
        exact = random_contour(np.random.default_rng(seed), 4.0)
        rounded = replace(exact, position=np.round(exact.position, 3), arc_centre=np.round(exact.arc_centre, 3))
        moved, _ = offset_contours(exact)
        assert (offset_contours(rounded)[0] is None) == (moved is None)
        taken += moved is not None
    assert taken > 30
