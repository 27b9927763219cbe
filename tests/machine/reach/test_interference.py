# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies that meet: against many points on tubes, rods, bodies and boxes, put in place one by one."""

import dataclasses

import numpy as np
import pytest
from pose_paths import LENGTH, bodied, upright, wandering

from pkm_post.geometry import unit
from pkm_post.machine.kinematics.inverse import platform_joints, platform_rotation
from pkm_post.machine.kinematics.placed_machine import PlacedMachine, StrutCapsules
from pkm_post.machine.reach.collision_mesh import CollisionMesh
from pkm_post.machine.reach.limit_checks import shortest_distance
from pkm_post.machine.reach.path_checks import all_checks
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model.machine import Box

STEP = 8.0
"""mm between points on the axes of struts."""
PART = CollisionMesh.of(boxes=[Box("part", [-40.0, -40, 100], [40.0, 40, 180])])


def margins_of(machine, path, code, part=PART):
    """Margins at the rows of all checks with a code, side by side, and what their columns are called."""
    checks = [one for one in all_checks(machine, path, shortest_distance(machine, path), part) if one.code == code]
    placed = PlacedMachine.of(machine, path.rows(slice(None)))
    return [name for one in checks for name in one.parts], np.hstack([one.margins(placed) for one in checks])


def stretches(machine, distance):
    """From and to along a strut from the base joint, and the radius, of what is there: tube, rod, rod behind."""
    ahead = machine.base_joint_radius
    yield ahead, machine.tube_length, machine.tube_radius
    inner = distance - machine.rod_length
    yield max(inner, ahead), distance - machine.platform_joint_radius, machine.rod_radius
    if inner < -ahead:
        yield inner, -ahead, machine.rod_radius


def strut_points(machine, pose):
    """For each strut the points of its axis with their radii."""
    joints = platform_joints(machine, *(column[None] for column in pose))[0]
    for base, end in zip(machine.base_joints, joints, strict=True):
        distance = np.linalg.norm(end - base)
        along = [(np.linspace(a, b, int((b - a) / STEP) + 2), r) for a, b, r in stretches(machine, distance)]
        places = np.concatenate([s for s, _ in along])
        yield base + places[:, None] * (end - base) / distance, np.concatenate([np.full(len(s), r) for s, r in along])


def poses(path):
    return list(zip(*path.rows(slice(None)), strict=True))


@pytest.mark.parametrize("rod_length", [600.0, 1300.0], ids=["inside", "behind"])
def test_struts_are_as_far_apart_as_their_points(rod_length):
    machine = dataclasses.replace(bodied(), rod_length=rod_length)
    path = wandering(np.random.default_rng(1), 6, tilt_deg=35, spin_deg=70)
    parts, margins = margins_of(machine, path, "K113")
    for row, pose in enumerate(poses(path)):
        struts = list(strut_points(machine, pose))
        for pair, name in enumerate(parts):
            (p, r), (q, s) = (struts[int(number) - 1] for number in name.split(" and "))
            apart = np.linalg.norm(p[:, None] - q[None], axis=2) - r[:, None] - s
            assert apart.min() - STEP < margins[row, pair] + machine.clearance < apart.min() + 1e-6


def test_a_rod_that_comes_out_behind_counts_there():
    # The rods cross above the base where those inside do not.
    path = PosePath.straight(*upright([[0.0, 0, 250]]))
    _, inside = margins_of(bodied(), path, "K113")
    _, behind = margins_of(dataclasses.replace(bodied(), rod_length=1700.0), path, "K113")
    assert np.all(behind <= inside + 1e-9) and np.any(behind < inside - 5)


def test_a_rod_comes_out_behind_where_the_joints_are_nearer_than_the_controller_counts():
    """Rods as long as the shortest strut by the controller: joints nearer by 5 mm leave 5 mm of them behind."""
    machine = dataclasses.replace(bodied(), base_joint_radius=0.0)
    least = machine.strut_stroke[0]
    machine = dataclasses.replace(machine, rod_length=least, length_offset=np.full(6, -5.0))
    pieces = StrutCapsules.of(machine, np.full((1, 6), least - 5.0))
    assert pieces.start.min() == pytest.approx(-5.0)
    assert StrutCapsules.of(machine, np.full((1, 6), least)).start.min() == 0


def test_struts_bodies_and_boxes_are_as_far_apart_as_their_points():
    machine, path = bodied(), wandering(np.random.default_rng(2), 12, tilt_deg=35)
    (to_bodies, bodies), (to_boxes, boxes) = margins_of(machine, path, "K114"), margins_of(machine, path, "K115")
    for row, pose in enumerate(poses(path)):
        tip, axis, spin, length = pose
        origin = tip + (machine.spindle_nose + length) * axis
        rotation = platform_rotation(axis[None], spin[None])[0]
        for strut, (points, radius) in enumerate(strut_points(machine, pose)):
            seen = (points - origin) @ rotation
            for number, body in enumerate(machine.bodies):
                out = np.maximum(np.hypot(seen[:, 0], seen[:, 1]) - body.radius, 0)
                high = np.maximum(np.maximum(body.start - seen[:, 2], seen[:, 2] - body.end), 0)
                least = (np.hypot(out, high) - radius).min() - machine.clearance
                column = 6 * number + strut
                assert to_bodies[column] == f"{strut + 1} and {body.name}"
                assert least - STEP < bodies[row, column] < least + 1e-3
            for number, box in enumerate(machine.fixtures):
                away = points - np.clip(points, box.lowest, box.highest)
                least = (np.linalg.norm(away, axis=1) - radius).min() - machine.clearance
                column = 6 * number + strut
                assert to_boxes[column] == f"{strut + 1} and {box.name}"
                assert least - STEP < boxes[row, column] < least + 1e-3


def body_points(machine, pose, body):
    """Points all over a body."""
    tip, axis, spin, length = pose
    rotation = platform_rotation(axis[None], spin[None])[0]
    turn, height, out = np.meshgrid(
        np.linspace(0, 2 * np.pi, 90), np.linspace(body.start, body.end, 30), np.linspace(0, body.radius, 6)
    )
    local = np.column_stack([(out * np.cos(turn)).ravel(), (out * np.sin(turn)).ravel(), height.ravel()])
    return tip + (machine.spindle_nose + length) * axis + local @ rotation.T


def test_bodies_are_never_nearer_than_reported():
    machine, path = bodied(), wandering(np.random.default_rng(3), 30, tilt_deg=35)
    parts, margins = margins_of(machine, path, "K116")
    lost = []
    for row, pose in enumerate(poses(path)):
        for column, (body, box) in enumerate((body, box) for body in machine.bodies for box in machine.fixtures):
            points = body_points(machine, pose, body)
            least = np.linalg.norm(points - np.clip(points, box.lowest, box.highest), axis=1).min() - machine.clearance
            assert parts[column] == f"{body.name} and {box.name}"
            assert margins[row, column] < least + 1e-9
            lost.append(least - margins[row, column])
    assert np.quantile(lost, 0.9) < 6.0  # points are up to 12 mm apart


def lathe(rows, columns):
    """A round part of 2 rows columns triangles, 60 mm in radius and 100 mm high, standing on z = 60."""
    turn, high = np.meshgrid(np.linspace(0, 2 * np.pi, columns + 1), np.linspace(0, 1, rows + 1))
    radius = 60 - 15 * high + 4 * np.sin(5 * turn)
    p = np.stack([radius * np.cos(turn), radius * np.sin(turn), 60 + 100 * high], axis=-1)
    halves = [[p[:-1, :-1], p[1:, :-1], p[:-1, 1:]], [p[1:, 1:], p[1:, :-1], p[:-1, 1:]]]
    return np.concatenate([np.stack(half, axis=-2).reshape(-1, 3, 3) for half in halves])


def test_a_mesh_is_never_nearer_than_reported_and_groups_do_not_show():
    machine, path = bodied(), wandering(np.random.default_rng(4), 30, tilt_deg=35)
    triangles = lathe(40, 60)
    parts, margins = margins_of(machine, path, "K117", CollisionMesh.of(triangles))
    one_by_one = np.min(
        [margins_of(machine, path, "K117", CollisionMesh.of(triangles[n::7]))[1] for n in range(7)], axis=0
    )
    np.testing.assert_allclose(margins, one_by_one, atol=0.006)  # each may be too low by 0.003 mm
    corners = triangles.reshape(-1, 3)
    _, of_points = margins_of(machine, path, "K117", CollisionMesh.of(points=corners))
    assert np.all(margins <= of_points + 1e-9)
    assert np.all(of_points - margins < 8.0)  # the triangles are up to 7 mm large
    assert parts == ["spindle", "tool holder"]


def test_struts_are_as_far_from_a_part_as_from_a_fixture():
    box = Box("post", [240.0, -60, 300], [300.0, 60, 800])
    machine = dataclasses.replace(bodied(), fixtures=(box,))
    path = wandering(np.random.default_rng(6), 60, tilt_deg=35)
    _, as_fixture = margins_of(machine, path, "K115")
    _, as_part = margins_of(machine, path, "K121", CollisionMesh.of(boxes=[box]))
    # A fixture is never reported nearer than touching, and the ends of a strut are round there, flat here.
    near = (as_fixture > 0) & (as_fixture < 45)
    assert near.sum() > 20
    assert np.median(np.abs(as_part - as_fixture)[near]) < 0.01
    np.testing.assert_allclose(as_part[near], as_fixture[near], atol=25.0)


def test_a_box_as_part_is_a_box_as_fixture():
    box = Box("stock", [-40.0, -30, 100], [50.0, 60, 190])
    machine = dataclasses.replace(bodied(), fixtures=(box,))
    path = wandering(np.random.default_rng(5), 60, tilt_deg=35)
    _, as_part = margins_of(machine, path, "K117", CollisionMesh.of(boxes=[box]))
    _, as_fixture = margins_of(machine, path, "K116")
    near = (as_fixture > 0) & (as_fixture < 45)
    assert near.sum() > 10
    # Other directions are tried for twelve triangles than for one box; both are lower bounds, and close.
    np.testing.assert_allclose(as_part[near], as_fixture[near], atol=3.0)
    assert np.median(np.abs(as_part - as_fixture)[near]) < 1e-6


def test_a_part_of_nothing_is_refused():
    with pytest.raises(ValueError, match="at least one"):
        CollisionMesh.of()


def test_what_is_not_stated_is_not_checked():
    path = PosePath.straight(*upright([[0.0, 0, 200]]))

    def codes(machine, part=None):
        return {check.code for check in all_checks(machine, path, 700, part)} - {"K101", "K102", "K103", "K104", "K105"}

    machine = bodied()
    assert codes(machine, PART) == {"K113", "K114", "K115", "K116", "K117", "K121"}
    assert codes(dataclasses.replace(machine, tube_radius=0.0, rod_radius=0.0)) == {"K116"}
    assert codes(dataclasses.replace(machine, rod_radius=0.0, fixtures=())) == {"K113", "K114"}
    assert codes(dataclasses.replace(machine, bodies=()), PART) == {"K113", "K115", "K121"}


def test_joints_of_one_ball_are_no_collision():
    # Base joints of two struts in one place: within the radius of the joint the tubes overlap by design.
    machine = bodied()
    joints = machine.base_joints.copy()
    joints[1] = joints[2] = joints[1:3].mean(axis=0)
    path = PosePath.straight(*upright([[0.0, 0, 200]]))
    shared = dataclasses.replace(machine, base_joints=joints, tube_radius=15.0)
    parts, margins = margins_of(dataclasses.replace(shared, base_joint_radius=0.0), path, "K113")
    pair = parts.index("2 and 3")
    assert margins[0, pair] < -30
    _, margins = margins_of(dataclasses.replace(shared, base_joint_radius=120.0), path, "K113")
    u, v = unit(PlacedMachine.of(shared, path.rows(slice(None))).direction[0, 1:3])
    opening = np.arccos(u @ v)
    assert margins[0, pair] == pytest.approx(2 * 120 * np.sin(opening / 2) - 2 * 15 - 2, abs=0.01)
    assert LENGTH == 120.0
