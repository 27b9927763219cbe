# SPDX-License-Identifier: LGPL-2.1-or-later
"""MDI: one line of G-code typed by hand, as a trajectory from where the tool is.

Each line stands by itself: nothing that an earlier line switched on holds, and a cutting move says its own feed. What
the line does not say of the tool axis stays as it is. Enters: text in mm or inch as it says, the pose of the tool in
{M}. Leaves: a trajectory in {M}, or what is wrong with the line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from pkm_post import gcode
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, EventKind, Machine, Place, Program, Tool, Trajectory
from pkm_post.model.diagnostics import errors
from pkm_post.pipeline import Options, trajectory_of, work_offset
from pkm_post.pmac_link.readout import Pose
from pkm_post.spin import Policy, Rule

SOURCE = "MDI"
_SAYS_THE_SPIN = "RPY"
_NO_MOVE = "J103"
"""What placing tells of a program that moves nothing; its cure speaks of CAM."""

Findings = tuple[Diagnostic, ...]


@dataclass(frozen=True)
class Reading:
    """How a line is read.

    Attributes:
        work_offset: name of a work offset of the machine file: the frame of the coordinates.
        axis_words: how the line says the tool axis, a key of ``gcode.options.AXIS_WORDS``; with ``"none"`` the axis
            stays as it is.
    """

    work_offset: str = "G54"
    axis_words: str = "none"


def line_trajectory(
    line: str, machine: Machine, here: Pose, tool_length: float, reading: Reading | None = None
) -> tuple[Trajectory | None, Findings]:
    """The way that a line of G-code describes.

    Args:
        line: one line of text.
        machine: its work offsets and limits.
        here: where the tool is.
        tool_length: gauge length of the tool in the spindle, mm.
        reading: how the line is read.

    Raises:
        ValueError: the text is more than one line.
    """
    if len(line.splitlines()) > 1:
        raise ValueError(f"line: expected one line, got {len(line.splitlines())}")
    reading = reading or Reading()
    options = Options(work_offset=reading.work_offset, spin=Policy(Rule.FILE))
    offset, told = work_offset(machine, options)
    if offset is None:
        return None, told
    program, faults = _read(line, here, offset, tool_length, reading)
    told += faults
    if program is None or errors(told):
        return None, told
    # A trajectory begins at the home of its machine: here that is where the tool is.
    standing = replace(machine, home_tip=here.tip, home_axis=here.axis, home_spin=here.spin)
    trajectory, faults = trajectory_of(program, standing, options)
    told += tuple(replace(fault, code="C201") if fault.code == _NO_MOVE else fault for fault in faults)
    if trajectory is None or reading.axis_words == _SAYS_THE_SPIN:
        return trajectory, told
    return replace(trajectory, spin=np.full(len(trajectory), here.spin)), told


def _read(
    line: str, here: Pose, machine_from_work: Array, tool_length: float, reading: Reading
) -> tuple[Program | None, Findings]:
    """The line as a program in {C}."""
    turn, origin = machine_from_work[:3, :3], machine_from_work[:3, 3]
    x, y, z = (turn.T @ (here.tip - origin)).tolist()
    # A diameter that is no number shows where cutter compensation used it.
    tool = Tool(0, "in the spindle", math.nan, 0.0, tool_length)
    options = gcode.ReadOptions(default_tool=tool, start=(x, y, z), axis_words=reading.axis_words)
    program, told = gcode.read(line, SOURCE, options)
    if program is None:
        return None, told
    if np.isnan(program.side_offset).any():
        found = "cutter compensation with a tool of unknown diameter"
        return None, (*told, Diagnostic("G411", Place(SOURCE, line=1), found))
    if any(event.kind is EventKind.TOOL_CHANGE for event in program.events):
        return None, (*told, Diagnostic("C203", Place(SOURCE, line=1), line.strip()))
    tools = {number: replace(each, diameter=0.0) for number, each in program.tools.items()}
    if reading.axis_words == "none":
        kept = np.tile(turn.T @ here.axis, (len(program), 1))
        return replace(program, tools=tools, tool_axis=kept), told
    return replace(program, tools=tools), told
