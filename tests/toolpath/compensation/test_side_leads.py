# SPDX-License-Identifier: LGPL-2.1-or-later
"""How contours begin and end: leads of type A and B, what is refused, and what is reported of leads that cut."""

import numpy as np
import pytest
from contour_programs import contour

from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

ROUNDING = 1e-9
PRINTED = 5.1e-5
TYPE_A, TYPE_B, TYPE_B_ARC = OffsetOptions(), OffsetOptions(leads="B"), OffsetOptions("arc", "B")


def positions(given, options):
    moved, faults = offset_contours(given, options)
    assert "N205" in {fault.code for fault in faults} or faults == ()
    return moved.position[:, :2]


def begins(turn_deg, offset):
    """A start-up block along +x to the origin, and a contour that turns there."""
    way = np.array([np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))])
    return contour((-40.0, 0.0), [(0.0, 0.0), 40 * way, 80 * way], offset)


def ends(turn_deg, offset):
    """A contour along +x to the origin, and a cancel block that turns there."""
    way = np.array([np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))])
    return contour((-80.0, 0.0), [(-40.0, 0.0), (0.0, 0.0), 40 * way], offset)


@pytest.mark.parametrize(
    ("turn", "options", "expected"),
    [
        (90, TYPE_A, [(-5, 0)]),
        (90, TYPE_B, [(-5, 0)]),
        (-90, TYPE_A, [(5, 0)]),
        (-90, TYPE_B, [(0, 5), (5, 5)]),
        (-30, TYPE_B, [(0, 5), (1.3397, 5)]),
        (-120, TYPE_A, [(4.3301, -2.5)]),
        (-120, TYPE_B, [(0, 5), (5, 5), (6.8301, 1.8301), (4.3301, -2.5)]),
        (-120, TYPE_B_ARC, [(0, 5), (4.3301, -2.5)]),
    ],
)
def test_worked_numbers_of_start_up(turn, options, expected):
    np.testing.assert_allclose(positions(begins(turn, 5.0), options)[1:-2], expected, atol=PRINTED)


@pytest.mark.parametrize(
    ("turn", "options", "expected"),
    [
        (90, TYPE_A, [(0, 5)]),
        (90, TYPE_B, [(0, 5)]),
        (-90, TYPE_A, [(0, 5)]),
        (-90, TYPE_B, [(5, 5), (5, 0)]),
        (-30, TYPE_B, [(1.3397, 5), (2.5, 4.3301)]),
        (-120, TYPE_A, [(0, 5)]),
        (-120, TYPE_B, [(0, 5), (5, 5), (6.8301, 1.8301), (4.3301, -2.5)]),
        (-120, TYPE_B_ARC, [(0, 5), (4.3301, -2.5)]),
    ],
)
def test_worked_numbers_of_cancel(turn, options, expected):
    np.testing.assert_allclose(positions(ends(turn, 5.0), options)[2:-1], expected, atol=PRINTED)


@pytest.mark.parametrize("options", [TYPE_A, TYPE_B], ids=["A", "B"])
@pytest.mark.parametrize("offset", [4.0, -4.0])
@pytest.mark.parametrize("turn", [0, 20, -70, 110, -160, 180])
def test_cancel_is_the_mirror_image_of_start_up(turn, offset, options):
    """Travelled backwards, with the other side, a start-up block is a cancel block."""
    there = positions(begins(turn, offset), options)[:-2]
    start = begins(turn, offset).position
    back = contour(start[3, :2], [*start[[2, 1, 0], :2]], -offset)
    np.testing.assert_allclose(positions(back, options)[2:][::-1], there, atol=ROUNDING)


@pytest.mark.parametrize("options", [TYPE_A, TYPE_B], ids=["A", "B"])
def test_a_contour_may_begin_with_an_arc(options):
    pieces = [(0.0, 0.0), (10.0, -10.0, 0.0, -10.0, -1), (10.0, -30.0), (40.0, -30.0)]
    moved, faults = offset_contours(contour((0.0, 30.0), pieces, 5.0), options)
    assert faults == ()
    np.testing.assert_allclose(moved.position[1:3, :2], [(0, 5), (15, -10)], atol=ROUNDING)


def test_type_b_goes_round_to_an_arc():
    pieces = [(0.0, 0.0), (10.0, -10.0, 0.0, -10.0, -1), (10.0, -30.0), (40.0, -30.0)]
    moved, _ = offset_contours(contour((0.0, -30.0), pieces, 5.0), TYPE_B)
    # Up along x = -5 to beside the corner, to the meeting of the tangents, along the second one, then the arc.
    np.testing.assert_allclose(moved.position[1:5, :2], [(-5, 0), (-5, 5), (0, 5), (15, -10)], atol=ROUNDING)


ARC_FIRST = [(10.0, -10.0, 0.0, -10.0, -1), (10.0, -30.0), (40.0, -30.0)]
ARC_LAST = [(0.0, 0.0), (30.0, 0.0), (40.0, -10.0, 30.0, -10.0, -1)]


@pytest.mark.parametrize(("pieces", "line"), [(ARC_FIRST, 2), (ARC_LAST, 4)], ids=["start-up", "cancel"])
def test_leads_are_straight(pieces, line):
    start = (0.0, 0.0) if pieces is ARC_FIRST else (0.0, 40.0)
    moved, faults = offset_contours(contour(start, pieces, 5.0))
    assert moved is None
    assert [(fault.code, fault.place.line) for fault in faults] == [("N201", line)]


def test_a_lead_that_cuts_is_reported():
    """Along the contour's own line the tool sinks in before its begin: R (1 - cos a), with tan a = R / L."""
    moved, faults = offset_contours(begins(0, 5.0))
    assert moved is not None
    sinks = 5.0 * (1 - np.cos(np.arctan2(5.0, 40.0)))
    assert [(fault.code, fault.place.line) for fault in faults] == [("N205", 2)]
    assert f"by {sinks:.4g} mm" in faults[0].found


def test_a_lead_from_the_side_of_the_tool_is_not():
    assert offset_contours(contour((-3.0, 40.0), [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0)], 5.0))[1] == ()


def test_leads_without_a_contour_go_to_the_side_and_back():
    moved, faults = offset_contours(contour((0.0, -20.0), [(0.0, 0.0), (0.0, -20.0)], 5.0))
    assert faults == ()
    np.testing.assert_allclose(moved.position[:, :2], [(0, -20), (-5, 0), (0, -20)], atol=ROUNDING)
