# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where offset lines and circles meet: on both of them, the right one of two points, and none where there is none."""

import numpy as np

from pkm_post.toolpath.compensation.contour_corners import Curves, meetings

ROUNDING = 1e-9
UP = np.array([[0.0, 0.0, 1.0]])


def plane(*points):
    return np.array([[*point, 0.0] for point in points], dtype=float)


def line(point, angle):
    nowhere = np.full((1, 3), np.nan)
    tangent = plane((np.cos(angle), np.sin(angle)))
    return Curves(plane(point), tangent, nowhere, np.array([np.nan]), np.array([False]))


def circle(centre, radius, at):
    point = plane(np.add(centre, [radius * np.cos(at), radius * np.sin(at)]))
    return Curves(point, plane((-np.sin(at), np.cos(at))), plane(centre), np.array([radius]), np.array([True]))


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
        point = meetings(*curves, UP)[0]
        if np.isnan(point).any():
            assert curves[0].arc[0] or curves[1].arc[0]
            continue
        assert max(off(curve, point) for curve in curves) < 1e-7
        met += 1
    assert met > 200


def test_the_nearer_of_two_points_is_taken():
    # The line y = 1 and the circle of radius 2 about (3, 1) meet at x = 1 and x = 5; the joint is the origin.
    near = meetings(line((0.0, 1.0), 0.0), circle((3.0, 1.0), 2.0, np.pi), UP)
    np.testing.assert_allclose(near, plane((1.0, 1.0)), atol=ROUNDING)
    back = meetings(circle((3.0, 1.0), 2.0, np.pi), line((0.0, 1.0), 0.0), UP)
    np.testing.assert_allclose(back, near, atol=ROUNDING)
    # Circles of radius 5 about (-3, 1) and (3, 1) meet at (0, 5) and (0, -3).
    both = meetings(circle((-3.0, 1.0), 5.0, 0.0), circle((3.0, 1.0), 5.0, 0.0), UP)
    np.testing.assert_allclose(both, plane((0.0, -3.0)), atol=ROUNDING)


def test_what_does_not_meet_says_so():
    assert np.isnan(meetings(line((0, 0), 0.0), line((0, 1), 0.0), UP)).all()
    assert np.isnan(meetings(line((0, 0), 0.0), line((0, 0), np.pi), UP)).all()
    assert np.isnan(meetings(line((0, 3), 0.0), circle((0, 0), 2.0, 0.0), UP)).all()
    assert np.isnan(meetings(circle((5, 0), 2.0, 0.0), circle((0, 0), 2.0, 0.0), UP)).all()
    assert np.isnan(meetings(circle((0, 0), 1.0, 0.0), circle((0, 0), 2.0, 0.0), UP)).all()


def test_a_line_goes_on_in_itself():
    np.testing.assert_allclose(meetings(line((1, 2), 0.3), line((1, 2), 0.3), UP), plane((1, 2)), atol=ROUNDING)
