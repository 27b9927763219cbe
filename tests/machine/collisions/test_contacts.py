# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contacts: closed-form scenes, and random ones against many poses and many points of the triangles."""

import dataclasses

import numpy as np
import pytest
from machines import direction, example
from meshes import ball, box

from pkm_post.geometry.distances import point_to_cylinder, segment_to_segment
from pkm_post.geometry.polygons import subdivide
from pkm_post.machine.collisions import contacts as contacts_module
from pkm_post.machine.collisions.contacts import contacts, contacts_at_ends
from pkm_post.machine.collisions.moving_bodies import (
    ToolCylinder,
    cutter_hull,
    cutter_pieces,
    platform_body,
    strut_bodies,
    tool_body,
)
from pkm_post.machine.kinematics.placed_machine import PlacedMachine, StrutCapsules
from pkm_post.machine.reach.collision_mesh import CollisionMesh
from pkm_post.machine.reach.limit_checks import HUNDREDTH
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model import Tool, largest_corner_radius
from pkm_post.model.machine import Body
from pkm_post.toolpath.compensation.cutter import Cutter, CutterProfile

LENGTH = 120.0
PECKS = [[0, 0, 10], [0, 0, -24], [0, 0, -4], [0, 0, 10]]
HAIR, FACETS = 0.1, 0.04
"""mm of gap; and how far the facets of a ball are below its surface."""
NOSE = example().spindle_nose
HOLDER = Body("holder", 25.0, -NOSE - 50.0, -NOSE)
"""70 mm above the tip of a tool of 120 mm."""


def straight(tips, axes=None, length=LENGTH, spins=0.0):
    tips = np.array(tips, dtype=float)
    axes = np.tile([0.0, 0.0, 1.0], (len(tips), 1)) if axes is None else np.array(axes, dtype=float)
    return PosePath.straight(tips, axes, np.broadcast_to(spins, len(tips)).astype(float), np.full(len(tips), length))


def found(path, mover, mesh, clearance, longest=25.0):
    return contacts(path, mover, CollisionMesh.of(subdivide(mesh, longest)), clearance, np.zeros(len(path), dtype=int))


@pytest.mark.parametrize("clearance", [0.5, 3.0])
@pytest.mark.parametrize(
    ("mesh", "distance"),
    [
        (box([-80, 40, 0], [80, 60, 300]), 15.0),  # a wall beside: 40 - 25
        (box([-80, -80, 0], [80, 80, 160]), 10.0),  # a plate below: 100 + 70 - 160
        (box([28, 4, 0], [60, 60, 167]), 3.0),  # a post that ends below the holder and beside its way: 170 - 167
        (ball([0, 0, 150], 10.0, 40), 10.0),  # its top below the holder: 170 - 160
        (ball([0, 55, 190], 18.0, 40), 12.0),  # beside it: 55 - 18 - 25
    ],
)  # fmt: skip
@pytest.mark.slow
def test_a_holder_that_just_clears_is_clear_and_one_that_does_not_is_found(mesh, distance, clearance):
    path = straight([[-30, 0, 100], [40, 0, 100]])
    mover = platform_body(example(), path, HOLDER)
    towards = np.array([0.0, -1.0, 0.0] if distance in (15.0, 12.0) else [0.0, 0.0, 1.0])
    for hair in (HAIR, -HAIR):
        met = found(path, mover, mesh + towards * (distance - clearance - hair), clearance)
        assert bool(len(met)) == (hair < 0)
        if len(met):
            assert abs(met.distance.min() - clearance - hair) < FACETS + HUNDREDTH


def test_a_thin_pin_between_two_far_poses_is_found_and_where_it_is():
    path = straight([[-150, 0, 100], [150, 0, 100]])
    pin = box([37.0, 3.0, 0.0], [37.2, 3.2, 175.0])
    met = found(path, platform_body(example(), path, HOLDER), pin, 0.001)
    assert len(met) and set(met.cell) == {1}
    at = -150 + 300 * met.share
    assert np.all(np.abs(at - 37.1) < 25.2)
    assert not len(contacts_at_ends(path, platform_body(example(), path, HOLDER), CollisionMesh.of(pin), 0.001))


def test_a_turn_of_the_axis_alone_swings_the_holder():
    axes = direction(np.array([0.0, 30.0]), np.array([0.0, 0.0])).T
    path = straight([[0, 0, 100], [0, 0, 100]], axes)
    # The lower rim of the holder comes down to 100 + 70 cos 30 - 25 sin 30 and out to 70 sin 30 + 25 cos 30.
    down = 100 + 70 * np.cos(np.pi / 6) - 25 * np.sin(np.pi / 6)
    for below, hit in ((0.05, False), (-0.05, True)):
        plate = box([-200, -200, 0], [200, 200, down - below])
        assert bool(len(found(path, platform_body(example(), path, HOLDER), plate, 0.001))) == hit


def test_only_cells_in_use_are_looked_at():
    path = straight([[-100, 0, 100], [-50, 0, 100], [50, 0, 100], [100, 0, 100]])
    post = box([-5, -5, 0], [5, 5, 130])
    pieces = [ToolCylinder(0.0, 40.0, 5.0)]
    for cells, hit in ([[1, 3], False], [[1, 2, 3], True], [[2], True], [[], False]):
        mover = tool_body("cutter", path, np.array(cells, dtype=int), pieces)
        met = found(path, mover, post, 0.001)
        assert bool(len(met)) == hit and set(met.cell) <= {2}


def test_rounding_grows_a_piece_all_round():
    path = straight([[0, 0, 100], [1, 0, 100]])
    mover = tool_body("ball", path, np.array([1]), [ToolCylinder(6.0, 40.0, 0.0, 6.0)])
    for height, hit in ((99.97, False), (100.03, True)):
        assert bool(len(found(path, mover, box([-50, -50, 0], [50, 50, height]), 0.001))) == hit
    # Across the corner a ball nose leaves what a flat end mill would touch.
    corner, gap = box([5.0, -50, 0], [50, 50, 101.0]), np.hypot(4.0, 5.0) - 6.0
    for hair, hit in ((2 * HUNDREDTH, False), (-2 * HUNDREDTH, True)):
        assert bool(len(found(path, mover, corner, gap - hair))) == hit


def points_of(mesh, apart):
    """Points of triangles, no point of the surface farther from one of them than ``apart``."""
    small = subdivide(mesh, apart)
    return np.unique(small.reshape(-1, 3).round(9), axis=0)


def sampled_distance(path, cells, shares, cylinders_of, pieces, points):
    """Least distances by pose, (M,), of cylinders from points: the other way to compute them."""
    cylinders = cylinders_of(path.inside(np.repeat(cells, len(shares)), np.tile(shares, len(cells))))
    least = []
    for middle, axis, half, radius in zip(
        cylinders.middle, cylinders.axis, cylinders.half, cylinders.radius, strict=True
    ):
        away = points - middle
        high = away @ axis
        out = np.linalg.norm(away - high[:, None] * axis, axis=1)
        least.append(point_to_cylinder(np.column_stack([out, 0 * out, high]), radius, -half, half).min())
    return np.reshape(least, (-1, pieces)).min(axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_nothing_is_missed_and_nothing_is_found_that_is_not_there(seed):
    rng = np.random.default_rng(seed)
    rows = 6
    axes = direction(rng.uniform(0, 30, rows), rng.uniform(0, 360, rows)).T
    path = straight(rng.uniform([-80, -80, 90], [80, 80, 150], (rows, 3)), axes, spins=rng.uniform(-0.5, 0.5, rows))
    mesh = box(*np.sort(rng.uniform([-60, -60, 0], [60, 60, 190], (2, 3)), axis=0))
    if seed % 2:
        mesh = ball(rng.uniform([-60, -60, 80], [60, 60, 200]), rng.uniform(5, 25), 10)
    body = dataclasses.replace(HOLDER, radius=float(rng.uniform(5, 30)))
    tool = [ToolCylinder(5.0, 30.0, 3.0), ToolCylinder(30.0, 70.0, 8.0)]
    apart, shares = 6.0, np.linspace(0, 1, 17)
    points = points_of(mesh, apart)
    for mover in (platform_body(example(), path, body), tool_body("tool", path, np.arange(1, rows), tool)):
        cells, pieces = np.arange(1, rows), len(mover.rounding)
        brute = sampled_distance(path, cells, shares, mover.cylinders, pieces, points)
        for clearance in (0.01, 4.0, 12.0):
            met = found(path, mover, mesh, clearance, longest=20.0)
            # No finding is missed: what samples see is seen.
            if brute.min() < clearance:
                assert len(met)
                cells_hit = np.unique(np.repeat(cells, len(shares))[brute < clearance])
                assert set(cells_hit) <= set(met.cell) or len(met) >= 40
            # No false alarm: at each contact a point of the mesh is as near, by more than a sample can miss.
            for row in range(0, len(met), 4):
                there = sampled_distance(
                    path, met.cell[row : row + 1], met.share[row : row + 1], mover.cylinders, pieces, points
                )
                assert there[0] <= clearance + HUNDREDTH + apart


@pytest.mark.parametrize("seed", range(3))
def test_struts_are_those_of_the_kinematics(seed):
    rng = np.random.default_rng(seed)
    machine = dataclasses.replace(example(), tube_radius=32.0, tube_length=700.0, rod_radius=20.0, rod_length=650.0)
    path = straight(rng.uniform([-80, -80, 120], [80, 80, 200], (5, 3)), spins=rng.uniform(-0.3, 0.3, 5))
    mover = strut_bodies(machine, path)
    middle = PlacedMachine.of(machine, path.inside(np.array([2]), np.array([0.5])))
    pieces = StrutCapsules.of(machine, middle.distance)
    start, end = pieces.ends(machine.base_joints, middle.direction)
    spot = (start + end)[0, 1, int(rng.integers(6))] / 2
    pin = box(spot - 1.0, spot + 1.0)
    met = found(path, mover, pin, 0.001)
    assert len(met) and 2 in met.cell
    # Far from all struts at dense samples, and from all points between them: nothing.
    far = spot + [0, 0, 400.0]
    samples = PlacedMachine.of(machine, path.inside(np.repeat(np.arange(1, 5), 21), np.tile(np.linspace(0, 1, 21), 4)))
    pieces = StrutCapsules.of(machine, samples.distance)
    start, end = pieces.ends(machine.base_joints, samples.direction)
    apart = (segment_to_segment(start, end, far, far) - pieces.radius[:, None]).min()
    met = found(path, mover, box(far - 0.5, far + 0.5), 0.001)
    assert bool(len(met)) == (apart < 1.0) or abs(apart) < 40.0


SLANTED = 0.1
"""mm by which cylinders may be off a slanted outline."""


def inside(pieces, radius, level):
    """Whether points are in one of the pieces."""
    met = np.zeros(len(radius), dtype=bool)
    for piece in pieces:
        at = np.column_stack([radius, 0 * radius, level - (piece.start + piece.end) / 2])
        met |= (
            point_to_cylinder(at, piece.radius, *(s * (piece.end - piece.start) / 2 for s in (-1, 1))) <= piece.rounding
        )
    return met


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bottom", "side", "corner"),
    [
        (0, 10, 0),
        (45, 0, 0),
        (31, 0, 0),
        (0, 45, 0),
        (0, 1.5, 1),
        (20, 20, 0.5),
        (5, -20, 0),
        (10, -30, 0.2),
        (0, 0, 0.4),
    ],
)
@pytest.mark.parametrize("allowance", [0.25, 0.45])
def test_cylinders_of_a_slanted_cutter_are_off_its_outline_by_a_tenth_at_most(bottom, side, corner, allowance):
    bottom, side = np.radians([bottom, side]).tolist()
    corner *= min(largest_corner_radius(12.0, bottom, side), 6.0)
    tool, length = Tool(1, "", 12.0, corner, 100.0, bottom, side), 9.0
    outline = CutterProfile.of(Cutter.of(tool), 1e4)
    rng = np.random.default_rng(0)
    radius, level = rng.uniform(0, 24, 20_000), rng.uniform(-1, 6, 20_000)  # below the rounded top
    depth = -outline.distance(radius, level)
    reduced, around = cutter_pieces(tool, length, allowance), cutter_hull(tool, length)
    assert inside(reduced, radius, level)[depth > allowance].all() and (depth > allowance).sum() > 500
    assert not inside(reduced, radius, level)[depth < allowance - SLANTED - 1e-3].any()
    assert inside(around, radius, level)[depth > 0].all()
    assert not inside(around, radius, level)[depth < -SLANTED - 0.02].any()


def bored(radius, depth, facets=48):
    """The wall of a bore about the z axis, below z = 0, and the face around it; its facets are inside the circle."""
    turn = np.linspace(0, 2 * np.pi, facets + 1)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    rings = [radius * circle - [0, 0, depth], radius * circle, 6 * radius * circle]
    bands = [
        [[low[:-1], low[1:], high[1:]], [low[:-1], high[1:], high[:-1]]]
        for low, high in zip(rings, rings[1:], strict=False)
    ]
    return np.concatenate([np.stack(corners, axis=1) for band in bands for corners in band])


@pytest.mark.parametrize(
    ("gap", "hits"), [(0.25, False), (0.03, False), pytest.param(-0.3, True, marks=pytest.mark.slow)]
)
def test_a_drill_in_a_bore_of_its_size_is_proven_clear_in_a_few_steps(monkeypatch, gap, hits):
    """By spheres about the motion it took as many steps as gaps fit into the retract, and minutes for a few bores."""
    steps, distances_at = [], contacts_module._distances_at

    def counted(stretches, mover, part, at, change, clearance):
        steps.append(len(at))
        return distances_at(stretches, mover, part, at, change, clearance)

    monkeypatch.setattr(contacts_module, "_distances_at", counted)
    inside = 3.0 * np.cos(np.pi / 48)
    mover = tool_body("drill", straight(PECKS), np.arange(1, 4), [ToolCylinder(0.0, 60.0, inside - gap)])
    assert bool(len(found(straight(PECKS), mover, bored(3.0, 25.0), 0.001, 1.1))) == hits
    assert hits or sum(steps) < 10


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_a_sliding_tool_meets_what_it_meets_by_bisection(seed):
    """Random moves along the tool axis past a ball, with the proof of slides and without it."""
    random = np.random.default_rng(seed)
    axis = direction(np.array([random.uniform(0, 40)]), np.array([random.uniform(0, 360)])).T[0]
    tips = np.array([0, 0, 100]) + np.outer([0, random.uniform(5, 40), random.uniform(-20, 0)], axis)
    path = straight(tips, np.tile(axis, (3, 1)))
    mover = tool_body(
        "cutter", path, np.array([1, 2]), [ToolCylinder(0.0, 20.0, 4.0), ToolCylinder(22.0, 50.0, 6.0, 1)]
    )
    mesh = ball(tips[1] + random.uniform(-12, 12, 3) + random.uniform(-10, 40) * axis, 5.0, 24)
    met, bisected = (
        found(path, dataclasses.replace(mover, is_about_axis=slides), mesh, 0.5) for slides in (True, False)
    )
    assert set(met.cell) == set(bisected.cell)
