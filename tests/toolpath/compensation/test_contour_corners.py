# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints of two elements: worked numbers, the kinds by the turn, and the guards where the rule says nothing.

The worked numbers are those of a tool of radius 5 that comes along +x to the origin, computed by hand from the
intersection of the offset lines and printed with four decimals.
"""

import numpy as np
import pytest
from contour_programs import contour

from pkm_post.toolpath.compensation.contour_corners import OffsetCurves, Transition, intersections, transitions
from pkm_post.toolpath.compensation.contour_elements import elements_of
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

PRINTED = 5.1e-5
ROUNDING = 1e-9

CHORDS, ARCS = OffsetOptions(), OffsetOptions(corners="arc")


def towards(turn_deg, length=40.0):
    return length * np.cos(np.radians(turn_deg)), length * np.sin(np.radians(turn_deg))


def joint(pieces, offset, options=CHORDS, start=(-80.0, 0.0)):
    """The joint at the origin, between the second and the third piece: kind, and the points of the path there."""
    elements, faults = elements_of(contour(start, pieces, offset))
    assert faults == ()
    found = transitions(elements, np.array([1]), np.array([2]), options, np.array([options.corners == "arc"]))
    between = found.added[0][~np.isnan(found.added[0, :, 0])]
    return Transition(found.kind[0]), np.vstack([found.first, between, found.last])[:, :2]


def corner(turn_deg, offset, options=CHORDS):
    end = towards(turn_deg)
    return joint([(-40.0, 0.0), (0.0, 0.0), end, towards(turn_deg, 80.0)], offset, options)


@pytest.mark.parametrize(
    ("turn", "offset", "kind", "points"),
    [
        (90, 5, Transition.SHORTENED, [(-5, 5), (-5, 5)]),
        (135, 5, Transition.SHORTENED, [(-12.0711, 5), (-12.0711, 5)]),
        (30, 5, Transition.SHORTENED, [(-1.3397, 5), (-1.3397, 5)]),
        (-90, -5, Transition.SHORTENED, [(-5, -5), (-5, -5)]),
        (-30, 5, Transition.EXTENDED, [(1.3397, 5), (1.3397, 5)]),
        (-90, 5, Transition.EXTENDED, [(5, 5), (5, 5)]),
        (90, -5, Transition.EXTENDED, [(5, -5), (5, -5)]),
        (-120, 5, Transition.CHORD, [(0, 5), (5, 5), (6.8301, 1.8301), (4.3301, -2.5), (4.3301, -2.5)]),
        (-150, 5, Transition.CHORD, [(0, 5), (5, 5), (6.8301, -1.8301), (2.5, -4.3301), (2.5, -4.3301)]),
        (135, -5, Transition.CHORD, [(0, -5), (5, -5), (7.0711, 0), (3.5355, 3.5355), (3.5355, 3.5355)]),
    ],
)
def test_worked_numbers_of_two_lines(turn, offset, kind, points):
    found, path = corner(turn, offset)
    assert found is kind
    np.testing.assert_allclose(path, points, atol=PRINTED)


def test_worked_numbers_of_a_line_and_an_arc():
    # The line y = 4 meets the circle of radius 6 about (-6, 8) at x = -1.5279 and at -10.4721, which is passed before.
    kind, path = joint([(-40.0, 0.0), (0.0, 0.0), (-6.0, 18.0, -6.0, 8.0, 1), (-46.0, 18.0)], 4.0)
    assert kind is Transition.SHORTENED
    np.testing.assert_allclose(path, [(-1.5279, 4), (-1.5279, 4)], atol=PRINTED)


def test_an_arc_and_a_line_meet_where_the_line_and_the_arc_do_the_other_way_round():
    pieces = [(-6.0, 18.0), (0.0, 0.0, -6.0, 8.0, -1), (-40.0, 0.0), (-80.0, 0.0)]
    kind, path = joint(pieces, -4.0, start=(-46.0, 18.0))
    assert kind is Transition.SHORTENED
    np.testing.assert_allclose(path, [(-1.5279, 4), (-1.5279, 4)], atol=PRINTED)


def test_two_arcs_meet_at_the_distance_of_the_tool_from_both():
    # Two bulges of radius 10 side by side, with a notch at the origin: the tool of 3 sits in it at equal distances.
    pieces = [(-16.0, 0.0), (0.0, 0.0, -8.0, -6.0, -1), (16.0, 0.0, 8.0, -6.0, -1), (16.0, -20.0)]
    kind, path = joint(pieces, 3.0, start=(-16.0, -20.0))
    assert kind is Transition.SHORTENED
    np.testing.assert_allclose(path[0], [0.0, np.sqrt(13.0**2 - 8.0**2) - 6.0], atol=ROUNDING)


@pytest.mark.parametrize(
    ("pieces", "count"),
    [
        ([(-40.0, 0.0), (0.0, 0.0), (6.0, -18.0, -4.0, -18.0, -1), (6.0, -60.0)], 3),  # line, arc that turns away
        ([(-12.0, 0.0), (0.0, 0.0, -6.0, -8.0, -1), (0.0, -30.0), (0.0, -60.0)], 3),
        ([(-12.0, 0.0), (0.0, 0.0, -6.0, -8.0, -1), (-6.0, -18.0, -9.0, -9.0, -1), (-60.0, -18.0)], 4),
    ],
    ids=["line arc", "arc line", "arc arc"],
)
def test_arcs_are_extended_by_their_tangents(pieces, count):
    """Every point of the path is on one of the tangents of the offsets, and an arc keeps its own end."""
    radius = 3.0
    elements, _ = elements_of(contour((-40.0, -40.0), pieces, radius))
    kind, path = joint(pieces, radius, start=(-40.0, -40.0))
    assert (kind, len(path)) == (Transition.EXTENDED, count)
    tangents = elements.tangent[1, 1, :2], elements.tangent[2, 0, :2]
    sides = [radius * np.array([-t[1], t[0]]) for t in tangents]
    off = [np.abs((path - side) @ [-t[1], t[0]]) for t, side in zip(tangents, sides, strict=True)]
    assert np.min(off, axis=0).max() < ROUNDING
    if elements.turn[1]:
        np.testing.assert_allclose(path[0], sides[0], atol=ROUNDING)
    if elements.turn[2]:
        np.testing.assert_allclose(path[-1], sides[1], atol=ROUNDING)
    corner_point = path[1] if elements.turn[1] else path[0]
    assert np.hypot(*corner_point) == pytest.approx(radius / np.sqrt((1 + tangents[0] @ tangents[1]) / 2), abs=ROUNDING)


@pytest.mark.parametrize("turn", [1e-9, -1e-9, 0.0])
@pytest.mark.parametrize("offset", [5.0, -5.0])
def test_straight_on_is_neither_shortened_nor_extended(turn, offset):
    kind, path = corner(np.degrees(turn), offset)
    assert kind is Transition.STRAIGHT_ON
    np.testing.assert_allclose(path, [(0, offset), (0, offset)], atol=1e-8)


@pytest.mark.parametrize("options", [CHORDS, ARCS], ids=["chord", "arc"])
@pytest.mark.parametrize("offset", [5.0, -5.0])
def test_a_reversal_goes_round_the_end(offset, options):
    kind, path = corner(180.0, offset, options)
    assert kind in (Transition.CHORD, Transition.ARC)
    np.testing.assert_allclose(path[[0, -1]], [(0, offset), (0, -offset)], atol=ROUNDING)
    if options is CHORDS:
        np.testing.assert_allclose(path[1:3], [(5, offset), (5, -offset)], atol=ROUNDING)


@pytest.mark.slow
@pytest.mark.parametrize("offset", [5.0, -3.0])
def test_the_kind_follows_from_the_turn(offset):
    for turn in np.random.default_rng(1).uniform(-179, 179, 200):
        kind, path = corner(turn, offset)
        outward = -np.sign(offset) * turn
        expected = Transition.SHORTENED if outward < 0 else Transition.EXTENDED if outward <= 90 else Transition.CHORD
        assert kind is expected
        # The chord S3 S4 passes the corner at R sqrt2 cos(|turn| / 2 - 45 deg).
        if kind is Transition.CHORD:
            chord = path[2] - path[1]
            passes = abs(chord[0] * path[1][1] - chord[1] * path[1][0]) / np.hypot(*chord)
            assert passes == pytest.approx(abs(offset) * np.sqrt(2) * np.cos(np.radians(abs(turn) / 2 - 45)), abs=1e-9)


def test_arcs_go_round_outer_corners_but_for_the_smallest():
    assert corner(-60.0, 5.0, ARCS)[0] is Transition.ARC
    assert corner(-120.0, 5.0, ARCS)[0] is Transition.ARC
    assert corner(60.0, 5.0, ARCS)[0] is Transition.SHORTENED
    kind, path = corner(-2.0, 5.0, ARCS)
    assert kind is Transition.EXTENDED
    assert 0 <= np.hypot(*path[0]) - 5.0 < 0.0003 * 5.0


def test_radius_vectors_are_those_of_the_paper():
    """Equations 10 and 11, said again with coordinates."""
    pieces = [(-40.0, 0.0), (0.0, 0.0), (6.0, 8.0, 6.0, -2.0, -1), (-30.0, 8.0), (-60.0, 8.0)]
    for offset in (4.0, -4.0):
        elements, _ = elements_of(contour((-80.0, 0.0), pieces, offset))
        g, size = np.sign(offset), abs(offset)
        left = np.cross(elements.normal, elements.tangent)[..., :2] * elements.offset[:, None, None]
        step = elements.end[1] - elements.start[1]
        line = g * size / np.hypot(*step[:2]) * np.array([-step[1], step[0]])
        np.testing.assert_allclose(left[1, 1], line, atol=ROUNDING)
        spoke = elements.end[2] - [6.0, -2.0, 0.0]
        # G2: + with G41.
        np.testing.assert_allclose(left[2, 1], g * size * spoke[:2] / np.hypot(*spoke[:2]), atol=ROUNDING)


UP = np.array([[0.0, 0.0, 1.0]])


def plane(*points):
    return np.array([[*point, 0.0] for point in points], dtype=float)


def line(point, angle):
    nowhere = np.full((1, 3), np.nan)
    tangent = plane((np.cos(angle), np.sin(angle)))
    return OffsetCurves(plane(point), tangent, nowhere, np.array([np.nan]), np.array([False]))


def circle(centre, radius, at):
    point = plane(np.add(centre, [radius * np.cos(at), radius * np.sin(at)]))
    return OffsetCurves(point, plane((-np.sin(at), np.cos(at))), plane(centre), np.array([radius]), np.array([True]))


def off(curve, point):
    """Distance of a point from a line or circle."""
    if curve.arc[0]:
        return abs(np.linalg.norm(point - curve.centre[0]) - curve.radius[0])
    return np.linalg.norm(np.cross(curve.tangent[0], point - curve.point[0]))


def test_meetings_are_on_both_curves():
    rng = np.random.default_rng(4)
    met = 0
    for _ in range(400):
        curves = [
            line(rng.uniform(-3, 3, 2), rng.uniform(-3, 3))
            if rng.random() < 0.5
            else circle(rng.uniform(-6, 6, 2), rng.uniform(0.5, 8), rng.uniform(-3, 3))
            for _ in range(2)
        ]
        point = intersections(*curves, UP)[0]
        if np.isnan(point).any():
            assert curves[0].arc[0] or curves[1].arc[0]
            continue
        assert max(off(curve, point) for curve in curves) < 1e-7
        met += 1
    assert met > 200


def test_the_nearer_of_two_points_is_taken():
    # The line y = 1 and the circle of radius 2 about (3, 1) meet at x = 1 and x = 5; the joint is the origin.
    near = intersections(line((0.0, 1.0), 0.0), circle((3.0, 1.0), 2.0, np.pi), UP)
    np.testing.assert_allclose(near, plane((1.0, 1.0)), atol=ROUNDING)
    back = intersections(circle((3.0, 1.0), 2.0, np.pi), line((0.0, 1.0), 0.0), UP)
    np.testing.assert_allclose(back, near, atol=ROUNDING)
    # Circles of radius 5 about (-3, 1) and (3, 1) meet at (0, 5) and (0, -3).
    both = intersections(circle((-3.0, 1.0), 5.0, 0.0), circle((3.0, 1.0), 5.0, 0.0), UP)
    np.testing.assert_allclose(both, plane((0.0, -3.0)), atol=ROUNDING)


def test_what_does_not_meet_says_so():
    assert np.isnan(intersections(line((0, 0), 0.0), line((0, 1), 0.0), UP)).all()
    assert np.isnan(intersections(line((0, 0), 0.0), line((0, 0), np.pi), UP)).all()
    assert np.isnan(intersections(line((0, 3), 0.0), circle((0, 0), 2.0, 0.0), UP)).all()
    assert np.isnan(intersections(circle((5, 0), 2.0, 0.0), circle((0, 0), 2.0, 0.0), UP)).all()
    assert np.isnan(intersections(circle((0, 0), 1.0, 0.0), circle((0, 0), 2.0, 0.0), UP)).all()


def test_a_line_goes_on_in_itself():
    np.testing.assert_allclose(intersections(line((1, 2), 0.3), line((1, 2), 0.3), UP), plane((1, 2)), atol=ROUNDING)
