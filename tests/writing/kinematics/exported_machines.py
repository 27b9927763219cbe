# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines to export, their files, and positions of the axes that an operator jogs."""

from dataclasses import replace

import machines
import numpy as np
from kinematic_language import Controller

from pkm_post.machine import ToolPoses, machine_named
from pkm_post.writing.controllers.pmac.settings import PmacSettings
from pkm_post.writing.controllers.power_pmac import PowerPmacSettings
from pkm_post.writing.kinematics.controller_file import Export, power_text, turbo_text

TURBO_AXES = dict(zip("xyzabc", ("Q7", "Q8", "Q9", "Q1", "Q2", "Q3"), strict=True))
POWER_AXES = dict(zip("xyzabc", ("C6", "C7", "C8", "C0", "C1", "C2"), strict=True))
AXES = {"turbo": TURBO_AXES, "power": POWER_AXES}
MOTORS = {"turbo": "P", "power": "L"}


def example():
    return machine_named("example_6tps")[0]


def calibrated():
    """Joints, offsets and zero lengths that are no two alike, and counts that fall as a strut extends."""
    rng = np.random.default_rng(7)
    stated = example()
    return replace(
        stated,
        base_joints=stated.base_joints + rng.normal(0, 3, (6, 3)),
        platform_joints=stated.platform_joints + rng.normal(0, 3, (6, 3)),
        length_offset=rng.normal(0, 2, 6),
        controller=stated.controller | {
            "zero_length": tuple((1000 + rng.normal(0, 9, 6)).tolist()), "counts_per_mm": -8192.0,
        },
    )  # fmt: skip


def screwed():
    """The same with screws that turn with their joints, as the published hexapod of genhexkins may have them."""
    return machines.screwed(calibrated())


def published():
    return machine_named("nategh_agheli_calibrated")[0]


def text_of(machine, kind, **export):
    form, made = {"turbo": (PmacSettings, turbo_text), "power": (PowerPmacSettings, power_text)}[kind]
    settings = form.of(machine.controller | {"kind": form.KIND})
    return made(machine, settings, Export(**{"segment_time": 10, "tool_length": 120.0} | export))


def controller_of(machine, kind, bits=53, **export):
    return Controller(text_of(machine, kind, **export), kind, bits)


def rotation(a, b, c):
    """Rz(c) Ry(b) Rx(a) of angles in degrees, (N, 3, 3)."""
    turns = []
    for angle, (i, j) in zip(np.radians([a, b, c]), ((1, 2), (2, 0), (0, 1)), strict=True):
        turn = np.tile(np.eye(3), (len(angle), 1, 1))
        turn[:, i, i] = turn[:, j, j] = np.cos(angle)
        turn[:, i, j], turn[:, j, i] = -np.sin(angle), np.sin(angle)
        turns.append(turn)
    return turns[2] @ turns[1] @ turns[0]


def tool_poses(axes, offset=None, tool_length=120.0):
    """Poses in {M} of axis positions (N, 6) in the work frame of Q51 to Q54; the rest of a rotation is spin."""
    x, y, z, turn = (offset or {}).values() or (0.0, 0.0, 0.0, 0.0)
    work = rotation([0.0], [0.0], [turn])[0]
    turned = work @ rotation(*axes[:, 3:].T) @ work.T
    axis = turned[:, :, 2]
    # the first column of the rotation without spin, R(k, 0), by its formula; the second one is across it
    lean = 1.0 + axis[:, 2]
    first = np.stack([1 - axis[:, 0] ** 2 / lean, -axis[:, 0] * axis[:, 1] / lean, -axis[:, 0]], axis=1)
    second = np.cross(axis, first)
    spin = np.arctan2(np.sum(second * turned[:, :, 0], axis=1), np.sum(first * turned[:, :, 0], axis=1))
    return ToolPoses(axes[:, :3] @ work.T + [x, y, z], axis, spin, np.full(len(axes), tool_length))


def in_work_frame(axes, offset):
    """Axis positions with tips in {M} to tips in the work frame."""
    x, y, z, turn = offset.values()
    work = rotation([0.0], [0.0], [turn])[0]
    return np.column_stack([(axes[:, :3] - [x, y, z]) @ work, axes[:, 3:]])


def about_home(machine, count, rng, offset):
    """Random axis positions about the home of the machine, tilted by up to 25 degrees and turned by up to 12."""
    spread = [160.0, 160.0, 120.0, 25.0, 25.0, 12.0]
    axes = rng.uniform(-1, 1, (count, 6)) * spread + np.concatenate([machine.home_tip, np.zeros(3)])
    return in_work_frame(axes, offset)


def grid(machine, offset):
    """Axis positions on a grid about the home of the machine, far beyond what it reaches on all sides."""
    sides = [range(-420, 421, 140)] * 2 + [range(-240, 241, 80)] + [(-25, 0, 25)] * 2 + [(-15, 0, 15)]
    axes = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 6).astype(float)
    axes[:, :3] += machine.home_tip
    return in_work_frame(axes, offset)
