# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tools take from a stock has the volume that geometry gives, upright and tilted."""

import math
from copy import deepcopy
from functools import cache

import numpy as np
import pytest
from meshes import ball, box

from pkm_post.geometry.polygons import is_closed, volume
from pkm_post.removal import RotatingShape, Stock, brick_surfaces
from pkm_post.removal.grid import Grid
from pkm_post.removal.mesh_distance import mesh_distances
from pkm_post.toolpath import Cutter
from pkm_post.toolpath.compensation.cutter import CutterProfile

BLOCK = (-20.0, -15.0, -20.0), (20.0, 15.0, 0.0)
RADIUS, TOP = 5.0, 60.0
BALL = RotatingShape.of(Cutter(RADIUS, 0.0, RADIUS), TOP)
FLAT = RotatingShape.of(Cutter(0.0, RADIUS, 0.0), TOP)
Z = np.array([0.0, 0.0, 1.0])
STEP = 1.0
CUTTERS = {
    "flat": Cutter.apt(10.0),
    "ball": Cutter.apt(10.0, 5.0),
    "bull nose": Cutter.apt(12.0, 2.0),
    "tapered": Cutter.apt(4.0, 1.0, b=math.radians(10)),
    "dovetail": Cutter.apt(16.0, b=math.radians(-20), h=20.0),
    "drill": Cutter.apt(8.0, a=math.radians(31)),
    "everything": Cutter.apt(10.0, 1.0, a=math.radians(8), b=math.radians(12), h=30.0),
}


@cache
def whole_block(step):
    """The block before anything is cut, made once; nobody cuts this one."""
    return Stock.of(box(*BLOCK), step)


def after(step, tips, axis, shape):
    """The block when a tool was in some poses."""
    stock = deepcopy(whole_block(step))
    tips = np.atleast_2d(tips).astype(float)
    for _ in stock.cut(tips, np.broadcast_to(axis, tips.shape), shape):
        pass
    return stock


def taken(step, *cut):
    """Volume that the tool takes; the edges of the block itself are known to a thousandth of it."""
    whole = whole_block(step).volume
    assert whole == pytest.approx(40 * 30 * 20, rel=0.003)
    return whole - after(step, *cut).volume


def line(start, end):
    return np.linspace(start, end, 160)


def area_below_top(corners):
    """Area of a convex polygon (x, z) below z = 0."""
    clipped = []
    for (x0, z0), (x1, z1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if z0 <= 0:
            clipped.append((x0, z0))
        if (z0 < 0) != (z1 < 0):
            clipped.append((x0 + (x1 - x0) * z0 / (z0 - z1), 0.0))
    x, z = np.array(clipped).T
    return abs(np.dot(x, np.roll(z, -1)) - np.dot(z, np.roll(x, -1))) / 2


def tilted(degrees):
    """The axis of a tool that leans towards x, and the direction across it in the plane of both."""
    tilt = math.radians(degrees)
    return np.array([math.sin(tilt), 0.0, math.cos(tilt)]), np.array([math.cos(tilt), 0.0, -math.sin(tilt)])


def test_a_slot_of_a_flat_end_mill_is_a_box():
    assert taken(STEP, line([-40, 0, -6], [40, 0, -6]), Z, FLAT) == pytest.approx(40 * 10 * 6, rel=0.01)


def test_a_slot_of_a_ball_is_half_round_below():
    found = taken(STEP, line([-40, 0, -8], [40, 0, -8]), Z, BALL)
    assert found == pytest.approx(40 * (math.pi * 25 / 2 + 10 * 3), rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("depth", [2.0, 3.5, 5.0])
def test_a_ball_that_dips_in_takes_a_cap(depth):
    found = taken(0.5, [0.3, 0.2, -depth], Z, BALL)
    assert found == pytest.approx(math.pi * depth**2 * (RADIUS - depth / 3), rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [15.0, 30.0, 50.0])
def test_a_slot_of_a_tilted_end_mill_is_a_tilted_rectangle_below_the_top(degrees):
    axis, side = tilted(degrees)
    tip = np.array([-4.0, 0.0, -7.0])
    corners = np.array([tip + width * side + height * axis for width, height in ((-5, 0), (5, 0), (5, 60), (-5, 60))])
    found = taken(STEP, line(tip - [0, 40, 0], tip + [0, 40, 0]), axis, FLAT)
    assert found == pytest.approx(30 * area_below_top(corners[:, [0, 2]]), rel=0.015)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [15.0, 30.0, 50.0])
def test_a_slot_of_a_tilted_ball_is_a_tilted_half_round_below_the_top(degrees):
    axis, side = tilted(degrees)
    centre = np.array([-4.0, 0.0, -3.0])
    around = np.linspace(np.pi, 2 * np.pi, 500)
    low = centre + RADIUS * (np.cos(around)[:, None] * side + np.sin(around)[:, None] * axis)
    corners = np.vstack([low, centre + 5 * side + 60 * axis, centre - 5 * side + 60 * axis])
    found = taken(STEP, line(centre - 5 * axis - [0, 40, 0], centre - 5 * axis + [0, 40, 0]), axis, BALL)
    assert found == pytest.approx(30 * area_below_top(corners[:, [0, 2]]), rel=0.01)


@pytest.mark.slow
def test_a_finer_grid_is_nearer_to_the_truth():
    exact = 40 * (math.pi * 25 / 2 + 10 * 3)
    errors = [abs(taken(step, line([-40, 0, -8], [40, 0, -8]), Z, BALL) - exact) for step in (2.0, 0.7)]
    assert errors[1] < errors[0] / 3


def test_a_tool_above_the_stock_and_one_beside_it_take_nothing():
    stock = after(1.0, [0, 0, 30], Z, BALL)
    assert not sum(len(brick) for brick, _ in stock.cut(np.array([[0.0, 60.0, -5.0]]), Z[None], FLAT))


@pytest.mark.parametrize("name", CUTTERS)
def test_a_shape_is_negative_inside_the_cutter_alone_and_a_distance_below_it(name):
    cutter = CUTTERS[name]
    shape, true = RotatingShape.of(cutter, 25.0), CutterProfile.of(cutter, 25.0)
    top = min(25.0, cutter.height, true.top)
    rng = np.random.default_rng(5)
    radius, height = rng.uniform(0, 15, 20_000), rng.uniform(-5, top, 20_000)
    level, distance = shape.level(radius, height), true.distance(radius, height)
    clear = np.abs(distance) > 1e-9
    np.testing.assert_array_equal((level < 0)[clear], (distance < 0)[clear])
    outside = (distance > 0) & (height < top - 10)
    if cutter.bottom_angle == 0.0:  # a point on the axis is blunt farther out
        assert outside.any()
        np.testing.assert_allclose(level[outside], distance[outside], atol=1e-9)
    assert np.all(np.abs(level) <= np.abs(distance) + 1e-9)
    assert np.all(radius[distance < 0] <= shape.widest + 1e-9)


def test_distances_of_a_box_and_of_a_ball_are_theirs():
    grid = Grid.enclosing(np.array([-9.0, -7.0, -5.0]), np.array([9.0, 7.0, 5.0]), 0.8)
    x, y, z = np.meshgrid(*grid.axes, indexing="ij")
    points = np.stack([x, y, z], axis=-1)
    beyond = np.abs(points) - [9.0, 7.0, 5.0]
    of_box = np.linalg.norm(np.maximum(beyond, 0), axis=-1) + np.minimum(beyond.max(axis=-1), 0)
    of_ball = np.linalg.norm(points, axis=-1) - 4.5
    for triangles, exact, far in (
        (box([-9, -7, -5], [9, 7, 5]), of_box, 0.005),
        (ball([0, 0, 0], 4.5, 96), of_ball, 0.2),
    ):
        found = mesh_distances(grid, triangles, 2.4)
        exact = grid.by_brick(np.clip(exact, -2.4, 2.4))
        near = np.abs(exact) < 0.8
        np.testing.assert_allclose(found[near], exact[near], atol=0.002)
        np.testing.assert_allclose(found, exact, atol=far)
        assert np.all(np.abs(found) >= np.abs(exact) - 0.002)


def test_the_surface_is_closed_faces_outwards_and_holds_the_volume():
    stock = after(0.8, line([-40, 3, -8], [40, -2, -5]), tilted(25)[0], BALL)
    quads = np.concatenate(
        [surface.points[surface.faces] for surface in brick_surfaces(stock, np.arange(stock.grid.count))]
    )
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    assert is_closed(triangles)
    assert volume(triangles) == pytest.approx(stock.volume, rel=0.01)


@pytest.mark.slow
def test_points_and_normals_of_the_surface_are_those_of_the_ball_that_dipped_in():
    stock, centre = after(0.5, [0.3, 0.2, -8.0], Z, BALL), np.array([0.3, 0.2, -3.0])
    found = list(brick_surfaces(stock, np.arange(stock.grid.count)))
    points, normals = (np.concatenate([getattr(surface, name) for surface in found]) for name in ("points", "normals"))
    away = points - centre
    on_ball = (points[:, 2] < -3.5) & (np.linalg.norm(away, axis=1) < 6)
    assert on_ball.sum() > 300
    np.testing.assert_allclose(np.linalg.norm(away[on_ball], axis=1), RADIUS, atol=0.03)
    np.testing.assert_allclose(normals[on_ball], -away[on_ball] / RADIUS, atol=0.05)
