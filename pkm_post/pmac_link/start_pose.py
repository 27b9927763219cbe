# SPDX-License-Identifier: LGPL-2.1-or-later
"""Start pose: how far the tool is from where a program starts.

Enters: a machine, the strut lengths that the controller tells and those of the first point, mm. Leaves: how far tip,
axis and spin of both poses are apart, by forward kinematics from home. Both are taken for the tool of the rest pose:
what the platform has to go is nearly the same for any other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import angle_between, norm
from pkm_post.model import Machine
from pkm_post.pmac_link.readout import standing_pose
from pkm_post.pmac_link.status import Array


@dataclass(frozen=True)
class Away:
    """How far a tool is from where it ought to be.

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
        """The largest of tip and turns, mm, where a turn counts as what it moves a point at a radius."""
        return max(self.tip, radius * self.axis, radius * self.spin)


def away_from_start(machine: Machine, length: Array, first: Array) -> Away | None:
    """How far the tool is from the start; None where no pose that home leads to has these lengths.

    Args:
        machine: the geometry.
        length: (6,) strut lengths where it stands, mm.
        first: (6,) strut lengths of the first point, mm.
    """
    here, start = (standing_pose(machine, each, machine.rest_tool_length) for each in (length, first))
    if here is None or start is None:
        return None
    axis = float(angle_between(here.axis[None], start.axis[None])[0])
    spin = abs(math.remainder(here.spin - start.spin, 2 * math.pi))
    return Away(float(norm((here.tip - start.tip)[None])[0]), axis, spin)


def start_faults(machine: Machine, length: Array, first: Array, near: float) -> tuple[str, ...]:
    """Why a program may not start from where the tool is, in words; nothing when it may.

    Args:
        machine: the geometry.
        length: (6,) strut lengths where it stands, mm.
        first: (6,) strut lengths of the first point, mm.
        near: how far the tip may be away, and by its turns a point at the characteristic length, mm.
    """
    away = away_from_start(machine, length, first) if np.isfinite([length, first]).all() else None
    if away is None:
        return ("no pose of the platform that small steps from home lead to has the lengths of the struts",)
    if away.most(machine.characteristic_length) <= near:
        return ()
    return (f"the tool is away from the start of the program: {away}; let the way there be planned: approach",)
