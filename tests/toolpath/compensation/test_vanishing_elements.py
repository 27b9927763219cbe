# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows that the tool is too large for: named, refused or taken out, over any number of them."""

import numpy as np
import pytest
from contour_programs import clearance, contour, cutting_rows, samples

from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

MICRON = 1e-3
ROUNDING = 1e-9
REMOVE = OffsetOptions(swallowed="remove")


def pocket_corner(pieces, offset=5.0):
    """Along +x to a corner, through it by the pieces, and away along +y."""
    return contour((-60.0, 40.0), [(-60.0, 0.0), *pieces, (0.0, 60.0), (-40.0, 60.0)], offset)


def codes(faults):
    return [(fault.code, fault.place.line) for fault in faults]


def small_steps(count, radius):
    """An inner fillet of a radius as a number of lines."""
    angle = np.linspace(-np.pi / 2, 0, count + 1)
    return [
        tuple(point) for point in np.column_stack([radius * np.cos(angle) - radius, radius * np.sin(angle) + radius])
    ]


@pytest.mark.parametrize(
    ("pieces", "lines"),
    [
        ([(-2.0, 0.0), (0.0, 2.0)], "line of 2.82843 mm"),
        (small_steps(3, 3.0), "3 blocks up to line 6"),
        (small_steps(500, 3.0), "500 blocks up to line 503"),
        ([(-3.0, 0.0), (0.0, 3.0, -3.0, 3.0, 1)], "arc of radius 3 mm"),
    ],
    ids=["one line", "three lines", "500 lines", "arc"],
)
def test_a_corner_that_is_too_tight(pieces, lines):
    given = pocket_corner(pieces)
    moved, faults = offset_contours(given)
    assert moved is None
    assert codes(faults) == [("N202", 4)]
    assert faults[0].found == f"tool radius 5 mm, {lines}"
    moved, faults = offset_contours(given, REMOVE)
    assert codes(faults) == [("N203", 4)]
    assert faults[0].found == f"tool radius 5 mm, {lines}"
    # What is left is the corner of the two walls.
    np.testing.assert_allclose(moved.position[1:4, :2], [(-60, 5), (-5, 5), (-5, 60)], atol=ROUNDING)
    np.testing.assert_array_equal(moved.line, [1, 2, 3, len(given) - 1, len(given)])


def test_an_arc_of_the_tools_radius_is_a_corner():
    given = pocket_corner([(-5.0, 0.0), (0.0, 5.0, -5.0, 5.0, 1)])
    moved, faults = offset_contours(given)
    assert faults == ()
    np.testing.assert_allclose(moved.position[2:5, :2], [(-5, 5), (-5, 5), (-5, 60)], atol=ROUNDING)
    assert set(moved.kind[1:]) == {1}


def test_a_slot_that_is_too_narrow_is_passed_over():
    slot = [(0.0, 0.0), (20.0, 0.0), (20.0, -12.0), (26.0, -12.0), (26.0, 0.0), (50.0, 0.0), (50.0, 30.0)]
    given = contour((0.0, 30.0), slot, 5.0)
    assert codes(offset_contours(given)[1]) == [("N202", 4)]
    moved, faults = offset_contours(given, REMOVE)
    assert codes(faults) == [("N203", 4)]
    # Of the last wall, its own extension leaves the point where the tool passes.
    assert "2 blocks up to line 5" in faults[0].found
    np.testing.assert_allclose(moved.position[:, 1], [30, 5, 5, 5, 5, 30], atol=ROUNDING)


def test_a_slot_of_the_tools_width_is_cut():
    slot = [(0.0, 0.0), (20.0, 0.0), (20.0, -12.0), (30.0, -12.0), (30.0, 0.0), (50.0, 0.0), (50.0, 30.0)]
    moved, faults = offset_contours(contour((0.0, 30.0), slot, 5.0))
    assert faults == ()
    np.testing.assert_allclose(moved.position[2:6, :2], [(25, 5), (25, -7), (25, -7), (25, 5)], atol=ROUNDING)


def test_nothing_is_left_of_a_contour_that_is_too_small():
    triangle = [(0.0, 0.0), (3.0, 0.0), (0.0, 3.0), (-3.0, 0.0), (0.0, 0.0), (0.0, 1.0)]
    moved, faults = offset_contours(contour((0.0, 1.0), triangle, 5.0), REMOVE)
    assert moved is None
    assert "N202" in {fault.code for fault in faults} or "N204" in {fault.code for fault in faults}


def test_events_and_plunges_between_rows_that_are_gone_stay():
    given = pocket_corner([(-2.0, 0.0, 0.0), (-2.0, 0.0, -3.0), (0.0, 2.0, -3.0), (0.0, 2.0, -4.0)])
    moved, faults = offset_contours(given, REMOVE)
    assert codes(faults) == [("N203", 5)]
    expected = [(-5, 5, 0), (-5, 5, -3), (-5, 5, -4), (-5, 60, -4)]
    np.testing.assert_allclose(moved.position[2:6], expected, atol=ROUNDING)


@pytest.mark.slow
def test_contours_of_many_small_steps_are_refused_or_kept_clear():
    """With what is too small taken out, the tool keeps its radius or the program is refused."""
    rng = np.random.default_rng(3)
    kept = 0
    for _ in range(25):
        x = np.cumsum(rng.uniform(0.5, 4.0, 40))
        y = np.cumsum(rng.uniform(-0.6, 0.6, 40))
        given = contour((0.0, 40.0), [(0.0, 0.0), *zip(x, y, strict=True), (x[-1], 60.0)], 5.0)
        moved, faults = offset_contours(given, REMOVE)
        if moved is None or not faults:
            continue
        for row in range(2, len(moved) - 1):
            assert clearance(samples(moved, row), given, cutting_rows(given)).min() > 5.0 - MICRON
        kept += 1
    assert kept > 4


def test_a_row_that_is_passed_backwards_is_refused_where_rs274_takes_it():
    """A contour that rs274 of LinuxCNC 2.9 lets run backwards along its fifth block."""
    pieces = [
        (14.149, 6.4074), (38.0432, -11.3187), (71.4826, -2.0389), (65.6469, -9.3623),
        (70.9711, -22.8839, 54.3224, -21.6304, -1), (69.4695, -42.8275),
    ]  # fmt: skip
    moved, faults = offset_contours(contour((-1.9135, 18.3236), pieces, -3.352), OffsetOptions("arc"))
    assert moved is None
    assert ("N202", 5) in codes(faults)
