# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools and the seven numbers of APT become cutters."""

import dataclasses
import math

import numpy as np
import pytest
from cutters import ALL, BALL, FLAT, profile

from pkm_post.model import Tool
from pkm_post.model.setup import largest_corner_radius
from pkm_post.toolpath.compensation.cutter import Cutter, CutterProfile

ROUNDING = 1e-12


def tool(diameter, corner_radius, bottom_angle=0.0, side_angle=0.0):
    return Tool(3, "cutter", diameter, corner_radius, 100.0, bottom_angle, side_angle)


@pytest.mark.parametrize(
    ("diameter", "corner_radius", "corner"),
    [
        # APT cutters (d, r, e, f) worked by hand: CUTTER/10,5,0,5; CUTTER/10,0,5,0; CUTTER/20,4,6,4
        (10.0, 5.0, Cutter(5.0, 0.0, 5.0)),
        (10.0, 0.0, Cutter(0.0, 5.0, 0.0)),
        (20.0, 4.0, Cutter(4.0, 6.0, 4.0)),
    ],
    ids=["ball", "flat", "bull nose"],
)
def test_corner_of_a_tool(diameter, corner_radius, corner):
    assert Cutter.of(tool(diameter, corner_radius)) == corner


# d, r, a, b in degrees; e and f to the decimals they were worked out with. The drill's are those of the CL file of an
# NCL user, CUTTER/6.,0,3.,1.802582,31.,0.
WORKED = {
    "drill": ((6.0, 0.0, 31.0, 0.0), 3.0, 1.802582, 1e-6),
    "tapered": ((10.0, 2.0, 0.0, 10.0), 3.3218, 2.0, 5e-5),
    "coned bottom": ((10.0, 1.0, 15.0, 0.0), 4.0, 2.10707, 6e-6),
}


@pytest.mark.parametrize(("sizes", "e", "f", "decimals"), WORKED.values(), ids=WORKED.keys())
def test_centre_of_the_corner_follows_from_the_other_sizes(sizes, e, f, decimals):
    d, r, a, b = sizes
    found = Cutter.apt(d, r, a=math.radians(a), b=math.radians(b))
    assert (found.radial_offset, found.axial_offset) == pytest.approx((e, f), abs=decimals)
    assert found == Cutter.of(tool(d, r, math.radians(a), math.radians(b)))
    assert Cutter.apt(d, r, e, f, math.radians(a), math.radians(b), 80.0) == dataclasses.replace(found, height=80.0)
    assert found.radius == pytest.approx(d / 2.0, abs=ROUNDING)


def test_corner_touches_bottom_and_side_and_leaves_them_on_one_side():
    rng = np.random.default_rng(1)
    for _ in range(200):
        a, b = rng.uniform(0.0, 1.2), rng.uniform(-1.2, 0.3)
        d = rng.uniform(1.0, 50.0)
        r = rng.uniform(0.0, largest_corner_radius(d, a, b))
        cutter = Cutter.apt(d, r, a=a, b=b)
        assert cutter.radial_offset >= 0.0
        # distances of the arc's centre from both lines through the circle where they meet
        across, up = d / 2.0 - cutter.radial_offset, cutter.axial_offset - d / 2.0 * math.tan(a)
        assert across * math.sin(a) + up * math.cos(a) == pytest.approx(r, abs=1e-9)
        assert across * math.cos(b) + up * math.sin(b) == pytest.approx(r, abs=1e-9)


@pytest.mark.parametrize("cutter", ALL.values(), ids=ALL.keys())
def test_profile_is_convex_from_the_axis_outwards(cutter):
    steps = np.diff(profile(cutter, 60.0, 50), axis=0)
    steps = steps[np.linalg.norm(steps, axis=1) > 1e-9]
    turns = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    assert np.all(turns >= -1e-9)


def test_lens_begins_where_its_arc_meets_the_axis():
    lens = ALL["lens"]
    assert lens.radial_offset + lens.corner_radius * math.sin(lens.corner_start) == pytest.approx(0.0, abs=ROUNDING)
    assert lens.radius == pytest.approx(8.0)


def test_largest_corner_makes_a_ball():
    assert largest_corner_radius(12.0) == pytest.approx(6.0, abs=ROUNDING)
    tapered = tool(12.0, largest_corner_radius(12.0, 0.0, 0.1), side_angle=0.1)
    assert Cutter.of(tapered).radial_offset == pytest.approx(0.0, abs=ROUNDING)


@pytest.mark.parametrize("diameter", [0.0, -10.0, math.nan, math.inf])
def test_unknown_or_senseless_diameter_is_the_callers_fault(diameter):
    with pytest.raises(ValueError, match=r"tool 3: expected a diameter above 0 mm, got"):
        Cutter.of(tool(diameter, 0.0))
    with pytest.raises(ValueError, match=r"expected a diameter above 0, got"):
        Cutter.apt(diameter)


@pytest.mark.parametrize("corner_radius", [-0.1, 5.001, math.nan])
def test_corner_that_does_not_fit_the_diameter_is_the_callers_fault(corner_radius):
    with pytest.raises(ValueError, match=r"tool 3: expected a corner radius from 0 to 5.0 mm, got"):
        Cutter.of(tool(10.0, corner_radius))


@pytest.mark.parametrize("sizes", [(-1.0, 5.0, 0.0), (1.0, -5.0, 1.0), (1.0, 5.0, math.nan), (0.0, 0.0, 0.0)])
def test_corner_without_extent_or_with_negative_sizes_is_refused(sizes):
    with pytest.raises(ValueError, match="expected"):
        Cutter(*sizes)


@pytest.mark.parametrize(
    ("a", "b"), [(90.0, 0.0), (-1.0, 0.0), (0.0, 90.0), (0.0, -90.0), (45.0, 45.0), (math.nan, 0.0)]
)
def test_angles_whose_lines_do_not_meet_are_refused(a, b):
    with pytest.raises(ValueError, match=r"expected a bottom angle from 0 and a side angle from -90"):
        Cutter.apt(10.0, 1.0, a=math.radians(a), b=math.radians(b))


@pytest.mark.parametrize(("e", "f", "named"), [(5.0, 4.0, "e = 6"), (6.0, 3.9, "f = 4"), (math.nan, 4.0, "e = 6")])
def test_arc_that_does_not_touch_bottom_and_side_is_refused(e, f, named):
    with pytest.raises(ValueError, match=f"expected {named}, where the corner touches"):
        Cutter.apt(20.0, 4.0, e, f)


@pytest.mark.parametrize("height", [0.0, -1.0, math.nan])
def test_cutter_without_height_is_refused(height):
    with pytest.raises(ValueError, match="expected a height above 0"):
        Cutter.apt(20.0, 4.0, h=height)


def test_a_cutter_cannot_change():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Cutter(4.0, 6.0, 4.0).corner_radius = 5.0


NANOMETRE = 1e-6
TALLEST = 40.0
CUTTERS = pytest.mark.parametrize("cutter", ALL.values(), ids=ALL.keys())


def outline(cutter, top):
    """Points of the outline from the axis to the axis, and the longest step between two of them."""
    side = profile(cutter, top, 2000, 8000)
    across = np.column_stack([np.linspace(side[-1, 0], 0.0, 2000), np.full(2000, top)])
    ring = np.vstack([side, across])
    return ring, np.max(np.linalg.norm(np.diff(ring, axis=0), axis=1))


def winding(point, ring):
    """How often the outline, closed along the axis, turns about the point."""
    away = np.vstack([ring, ring[:1]]) - point
    angle = np.arctan2(away[:, 1], away[:, 0])
    return round(np.sum((np.diff(angle) + np.pi) % (2 * np.pi) - np.pi) / (2 * np.pi))


@pytest.mark.slow
@CUTTERS
def test_distance_and_side_are_those_of_the_outline(cutter):
    solid = CutterProfile.of(cutter, TALLEST)
    ring, step = outline(cutter, solid.top)
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(0.01, 25.0, 300), rng.uniform(-10.0, TALLEST + 10.0, 300)])
    found = solid.distance(*points.T)
    expected = np.array([np.min(np.linalg.norm(ring - point, axis=1)) for point in points])
    # Between two samples the outline is nearer than both; its bend does little on so short a step.
    assert np.all(np.abs(found) <= expected + ROUNDING)
    assert np.all(np.abs(found) >= np.sqrt(np.maximum(expected**2 - (step / 2) ** 2, 0.0)) - NANOMETRE)
    assert np.array_equal(found < 0, [winding(point, ring) != 0 for point in points])


@CUTTERS
def test_no_distance_changes_faster_than_the_way(cutter):
    solid = CutterProfile.of(cutter, TALLEST)
    rng = np.random.default_rng(2)
    points = np.column_stack([rng.uniform(0.0, 20.0, 2000), rng.uniform(-5.0, 50.0, 2000)])
    other = np.abs(points + rng.normal(0.0, 1.0, points.shape) * [1, 0]) + rng.normal(0.0, 1.0, points.shape) * [0, 1]
    change = np.abs(solid.distance(*points.T) - solid.distance(*other.T))
    assert np.all(change <= np.linalg.norm(points - other, axis=1) + 1e-9)


def test_numbers_of_a_ball_and_a_flat():
    radius, level = np.array([0.0, 3.0, 0.0, 7.0]), np.array([0.0, 1.0, -2.0, 20.0])
    ball, flat = CutterProfile.of(BALL, TALLEST), CutterProfile.of(FLAT, TALLEST)
    assert ball.distance(radius, level) == pytest.approx([0.0, 0.0, 2.0, 2.0], abs=ROUNDING)
    assert flat.distance(radius, level) == pytest.approx([0.0, -1.0, 2.0, 2.0], abs=ROUNDING)
    assert flat.reach == pytest.approx(np.hypot(5.0, TALLEST))


def test_cutter_ends_at_its_height_or_where_its_side_closes():
    assert CutterProfile.of(ALL["dovetail"], TALLEST).top == 12.0
    closing = CutterProfile.of(ALL["dovetail"].apt(16.0, 1.0, b=np.radians(-60.0)), TALLEST)
    assert closing.distance(np.array([0.0]), np.array([closing.top])) == pytest.approx([0.0], abs=1e-9)
    assert closing.top == pytest.approx(8.0 * np.tan(np.radians(30.0)), abs=1e-9)
