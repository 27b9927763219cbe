# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rate bounds: bounds of strut length rates along a path with known derivative magnitudes only.

With r the greatest distance of a platform joint from the tip, w the angular velocity and d the shortest distance of a
strut's joints: the joint moves by |V| <= |q'| + r |w|, |A| <= |q''| + r (|w'| + |w|^2), and so

    |l'| <= |V|,    |l''| <= |A| + |V|^2 / d

w and w' are bounded as in ``way`` and ``pace``. Units: mm, rad, by path length or time.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.kinematics.checks import arms_from_tip
from pkm_post.model import Machine

_NEARER = 0.99
"""Rounded corners and cubics may make a strut slightly shorter than on the path that is proven within the stroke."""

Pair = tuple[Array, Array]


def nearest_joints(machine: Machine) -> float:
    """Least distance between the two joints of a strut within the stroke, mm."""
    return _NEARER * (machine.strut_stroke[0] + float(machine.length_offset.min()))


def strut_rate_bounds(
    machine: Machine, tip: Pair, axis: Pair, spin: Pair, half_tilt: Array, tool_length: Array
) -> Pair:
    """Bounds of the first and second derivative of any strut length, (N,) each, while struts are within their stroke.

    Infinite for a screw without a key, whose correction has no bound here, and without a shortest length.

    Args:
        machine: the geometry.
        tip: sizes of first and second derivatives of the tip, (N,) each.
        axis: of the unit tool axis.
        spin: of the spin.
        half_tilt: (N,) tangent of half the highest tilt.
        tool_length: (N,) gauge lengths.
    """
    shortest = nearest_joints(machine)
    if machine.screw_lead != 0.0 or shortest <= 0:
        endless = np.full(len(half_tilt), np.inf)
        return endless, endless
    arm = float(arms_from_tip(machine, tool_length).max())
    turn, turn_1 = _turning(axis, spin, half_tilt)
    speed = tip[0] + arm * turn
    return speed, tip[1] + arm * (turn_1 + turn**2) + speed**2 / shortest


def _turning(axis: Pair, spin: Pair, half_tilt: Array) -> Pair:
    """Bounds of angular velocity and acceleration; the zero-torsion frame itself also turns about the axis."""
    about = spin[0] + half_tilt * axis[0]
    about_1 = spin[1] + half_tilt * axis[1] + half_tilt * (1 + half_tilt**2) / 2 * axis[0] ** 2
    return np.hypot(axis[0], about), axis[1] + about_1 + about * axis[0]
