# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pose paths for tests, and a machine with bodies of every kind."""

import dataclasses

import numpy as np
from machines import direction, example

from pkm_post.machine import PosePath
from pkm_post.machine.kinematics.placed_machine import PlacedMachine
from pkm_post.model.machine import Body, Box

LENGTH = 120.0


def bodied():
    """The example machine with tubes, rods, bodies of the platform, a table and a vice jaw."""
    rest = PlacedMachine.of(example(), PosePath.straight(*upright([[0.0, 0.0, 200.0]])).rows(slice(None)))
    return dataclasses.replace(
        example(),
        base_rest=rest.direction[0], base_cone=np.radians(25), platform_rest=-rest.in_platform()[0],
        platform_cone=np.radians(45), least_singular_value=0.1, strut_stiffness=1e5, clearance=2.0,
        tube_radius=32.0, tube_length=700.0, rod_radius=20.0, rod_length=600.0,
        base_joint_radius=70.0, platform_joint_radius=60.0,
        bodies=(Body("spindle", 60.0, -80.0, 200.0), Body("tool holder", 25.0, -130.0, -80.0)),
        fixtures=(
            Box("table", [-500.0, -500.0, -100.0], [500.0, 500.0, 0.0]),
            Box("jaw", [150.0, -80.0, 0.0], [190.0, 80.0, 250.0]),
        ),
    )  # fmt: skip


def upright(tips):
    tips = np.array(tips, dtype=float)
    return tips, np.tile([0.0, 0.0, 1.0], (len(tips), 1)), np.zeros(len(tips)), np.full(len(tips), LENGTH)


def wandering(rng, rows, tilt_deg=25.0, spin_deg=20.0):
    """A way with long cells: tips anywhere in the workspace, axes and spins too, with two tools."""
    tip = rng.uniform([-120, -120, 120], [120, 120, 300], (rows, 3))
    axis = direction(rng.uniform(0, tilt_deg, rows), rng.uniform(0, 360, rows)).T
    length = np.where(np.arange(rows) < rows // 2, LENGTH, LENGTH + 30)
    return PosePath.straight(tip, axis, np.radians(rng.uniform(-spin_deg, spin_deg, rows)), length)


def samples(way, cells, shares):
    """The poses at all shares of all cells, cell by cell."""
    return way.inside(np.repeat(cells, len(shares)), np.tile(shares, len(cells)))


def with_limit(check, limit):
    """The check with another limit: margins are less by it."""
    return dataclasses.replace(check, margins=lambda placed: check.margins(placed) - limit)


def counted(checks):
    """The checks as they are, and a list that takes how many poses each call of one of them looks at."""
    looked_at = []

    def counting(check):
        def margins(placed):
            looked_at.append(len(placed))
            return check.margins(placed)

        return dataclasses.replace(check, margins=margins)

    return tuple(map(counting, checks)), looked_at
