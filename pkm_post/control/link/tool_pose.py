# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool pose: DRO of the tool from the six strut lengths that the controller reports, and its deviation from a start.

Input: a machine, the gauge length of its tool, states of the controller or strut lengths in mm. Output: tip in mm,
axis and spin by forward kinematics, deviations, and lines of text. The deviation uses the tool of the rest pose: the
distance that the platform has to travel is nearly the same for any other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.control.link.status import MOTORS, Status
from pkm_post.geometry import angle_between, norm
from pkm_post.machine import forward_along_path, forward_from_rotation, lengths_at, platform_rotation
from pkm_post.model import Array, Machine, Phrase
from pkm_post.toolpath import ToolPose

UNKNOWN_POSE = Phrase("no pose of the platform reachable in small steps from home has these strut lengths")
_STEPS_FROM_HOME = 128
_FIRST_STEPS = (8, _STEPS_FROM_HOME)
"""Steps solved in sequence: few, or all if some do not connect."""


class ToolPoseReadout:
    """Computes poses in sequence."""

    def __init__(self, machine: Machine, tool_length: float) -> None:
        """Start at the home of the machine.

        Args:
            tool_length: gauge length of the tool in the spindle, mm.
        """
        self._machine, self._tool = machine, np.array([tool_length])
        self._home = self._tip, self._rotation = (
            np.array([machine.home_tip]),
            platform_rotation(np.array([machine.home_axis]), np.array([machine.home_spin])),
        )

    def pose(self, status: Status) -> ToolPose | None:
        """The pose of the actual lengths nearest to the previous one; None if there is none nearby."""
        return self.pose_of(status.length)

    def pose_of(self, length: Array) -> ToolPose | None:
        """The pose of strut lengths (6,) in mm, as ``pose``."""
        for tip, rotation in ((self._tip, self._rotation), self._home):
            found = forward_from_rotation(self._machine, length[None], self._tool, tip, rotation)
            if found.converged[0]:
                self._tip, self._rotation = found.tip, found.rotation
                return found.pose(0)
        return None


def pose_from_home(machine: Machine, length: Array, tool_length: float) -> ToolPose | None:
    """The pose for strut lengths, given only that the machine reached them from its home.

    A single Newton solve may converge to another pose with the same lengths. So the lengths step from home in
    small increments: the result is the pose in the assembly mode of home.

    Args:
        length: (6,) strut lengths, mm.
        tool_length: gauge length of the tool in the spindle, mm.
    """
    tool = np.full(_STEPS_FROM_HOME, tool_length)
    home, share = ToolPose.at_home(machine), np.linspace(0.0, 1.0, _STEPS_FROM_HOME)[:, None]
    way = (1 - share) * lengths_at(machine, home, tool_length) + share * length
    for first_rows in _FIRST_STEPS:
        found = forward_along_path(machine, way, tool, home, first_rows)
        if found.converged[-1]:
            return found.pose(-1)
    return None


def pose_text(pose: ToolPose | None) -> str:
    """The tool pose, for a terminal."""
    if pose is None:
        return "tool: no pose has these strut lengths"
    tilt = np.degrees(np.arccos(np.clip(pose.axis[2], -1, 1)))
    x, y, z = pose.tip
    i, j, k = pose.axis
    position = f"tip X{x:z.3f} Y{y:z.3f} Z{z:z.3f} mm, axis I{i:z.5f} J{j:z.5f} K{k:z.5f}, {tilt:.3f} deg from upright"
    return f"{position}, spin {np.degrees(pose.spin):z.3f} deg"


def state_text(status: Status) -> str:
    """Struts, program and faults, for a terminal."""
    rows = [
        f"strut {motor}: {length:10.4f} mm, following error {off:z8.4f} mm{'' if bits.has('homed') else ', NOT HOMED'}"
        for motor, length, off, bits in zip(MOTORS, status.length, status.following_error, status.motors, strict=True)
    ]
    return "\n".join([*rows, activity_text(status), *status.fault_texts()])


def activity_text(status: Status) -> str:
    """Activity of program and struts, for a terminal."""
    return f"{_activity(status)}, override {status.override:g} %"


def _activity(status: Status) -> str:
    if not status.running:
        return "no program runs" if status.standing else "no program runs, BUT THE MACHINE MOVES"
    return "a program is held" if status.held else "a program runs"


@dataclass(frozen=True)
class PoseDeviation:
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

    def largest(self, radius: float) -> float:
        """The largest of tip distance and turns, mm, where a turn counts as the displacement of a point at a radius."""
        return max(self.tip, radius * self.axis, radius * self.spin)


def deviation_from_start(machine: Machine, length: Array, first: Array) -> PoseDeviation | None:
    """The distance of the tool from the start; None if no pose reachable from home has these lengths.

    Args:
        length: (6,) current strut lengths, mm.
        first: (6,) strut lengths of the first point, mm.
    """
    here, start = (pose_from_home(machine, each, machine.rest_tool_length) for each in (length, first))
    if here is None or start is None:
        return None
    axis = float(angle_between(here.axis[None], start.axis[None])[0])
    spin = abs(math.remainder(here.spin - start.spin, 2 * math.pi))
    return PoseDeviation(float(norm((here.tip - start.tip)[None])[0]), axis, spin)


def start_faults(machine: Machine, length: Array, first: Array, start_tolerance: float) -> tuple[str, ...]:
    """The reasons why a program may not start from the current pose, as text; empty if it may.

    Args:
        length: (6,) current strut lengths, mm.
        first: (6,) strut lengths of the first point, mm.
        start_tolerance: largest distance of the tip and, due to turns, of a point at the characteristic length, mm.
    """
    deviation = deviation_from_start(machine, length, first) if np.isfinite([length, first]).all() else None
    if deviation is None:
        return ("no pose of the platform reachable in small steps from home has the lengths of the struts",)
    if deviation.largest(machine.characteristic_length) <= start_tolerance:
        return ()
    cure = "approach leads to the start of the program; to a later block, or to a stop, go by jog or mdi"
    return (f"the tool is away from the start of the program: {deviation}; {cure}",)
