# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start pose: the distance of the tool from the start of a program.

Enters: a machine, the strut lengths that the controller reports and those of the first point, mm. Leaves: the distances
of tip, axis and spin between the two poses, by forward kinematics from home. Both poses use the tool of the rest pose:
the distance the platform has to travel is nearly the same for any other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.control.link.readout import standing_pose
from pkm_post.control.link.status import Array
from pkm_post.geometry import angle_between, norm
from pkm_post.model import Machine


@dataclass(frozen=True)
class Away:
    """Distance of a tool from its target pose.

    Attributes:
        tip: mm.
        axis: rad.
        spin: rad.
    """

    tip: float
    axis: float
    spin: float

    def __str__(self) -> str:
        axis, spin = math.degrees(self.axis), math.degrees(self.spin)
        return f"tip {self.tip:.3f} mm, axis {axis:.4f} degrees, spin {spin:.4f} degrees"

    def most(self, radius: float) -> float:
        """The largest of tip distance and turns, mm, where a turn counts as the displacement of a point at a radius."""
        return max(self.tip, radius * self.axis, radius * self.spin)


def away_from_start(machine: Machine, length: Array, first: Array) -> Away | None:
    """The distance of the tool from the start; None if no pose reachable from home has these lengths.

    Args:
        machine: the geometry.
        length: (6,) current strut lengths, mm.
        first: (6,) strut lengths of the first point, mm.
    """
    here, start = (standing_pose(machine, each, machine.rest_tool_length) for each in (length, first))
    if here is None or start is None:
        return None
    axis = float(angle_between(here.axis[None], start.axis[None])[0])
    spin = abs(math.remainder(here.spin - start.spin, 2 * math.pi))
    return Away(float(norm((here.tip - start.tip)[None])[0]), axis, spin)


def start_faults(machine: Machine, length: Array, first: Array, near: float) -> tuple[str, ...]:
    """Why a program may not start from the current pose, in plain text; empty if it may.

    Args:
        machine: the geometry.
        length: (6,) current strut lengths, mm.
        first: (6,) strut lengths of the first point, mm.
        near: largest distance of the tip, and, by its turns, of a point at the characteristic length, mm.
    """
    away = away_from_start(machine, length, first) if np.isfinite([length, first]).all() else None
    if away is None:
        return ("no pose of the platform that small steps from home lead to has the lengths of the struts",)
    if away.most(machine.characteristic_length) <= near:
        return ()
    return (f"the tool is away from the start of the program: {away}; let the way there be planned: approach",)
