# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cutters for the tests, and their solids as clouds of points: sampled profiles, turned about the axis."""

import math

import numpy as np

from pkm_post.toolpath.compensation.cutter import Cutter

BALL = Cutter(5.0, 0.0, 5.0)
FLAT = Cutter(0.0, 5.0, 0.0)
BULL_NOSE = Cutter(4.0, 6.0, 4.0)
DRILL = Cutter.apt(6.0, a=math.radians(31.0))
TAPERED = Cutter.apt(10.0, 2.0, b=math.radians(10.0))
TAPERED_BALL = Cutter.apt(2 * math.tan(math.radians(40.0)) * 3.0, 3.0, b=math.radians(10.0))
CONED = Cutter.apt(10.0, 1.0, a=math.radians(15.0), b=math.radians(5.0))
DOVETAIL = Cutter.apt(16.0, 1.0, b=math.radians(-20.0), h=12.0)
LENS = Cutter(20.0, -12.0, 20.0)
ALL = {
    "ball": BALL, "flat": FLAT, "bull nose": BULL_NOSE, "drill": DRILL, "tapered": TAPERED,
    "tapered ball": TAPERED_BALL, "coned bottom": CONED, "dovetail": DOVETAIL, "lens": LENS,
}  # fmt: skip


def profile(cutter, height, arc_steps, line_steps=20):
    """Points (radius, level) along bottom, corner and side."""
    r, e, f = cutter.corner_radius, cutter.radial_offset, cutter.axial_offset
    turn = np.linspace(cutter.corner_start, cutter.corner_end, arc_steps)
    arc = np.column_stack([e + r * np.sin(turn), f - r * np.cos(turn)])
    foot = np.array([0.0, 0.0]) if e >= 0.0 else arc[0]
    share = np.linspace(0.0, 1.0, line_steps)[:, None]
    top = np.array([arc[-1, 0] + (height - arc[-1, 1]) * math.tan(cutter.side_angle), height])
    return np.vstack([foot + share * (arc[0] - foot), arc, arc[-1] + share * (top - arc[-1])])


def cloud(cutter, height, turn_steps, arc_steps):
    """Points on the cutter with its tip at the origin and its axis along z."""
    radius, level = profile(cutter, height, arc_steps).T
    turn = np.linspace(0.0, 2 * np.pi, turn_steps, endpoint=False)[:, None]
    return np.stack(np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), level), axis=-1).reshape(-1, 3)


def frame_with_z(axis):
    """A rotation, (3, 3), that takes z to the axis."""
    side = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.9 else [0.0, 1.0, 0.0])
    side /= np.linalg.norm(side)
    return np.column_stack([side, np.cross(axis, side), axis])
