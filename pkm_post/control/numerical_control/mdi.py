# SPDX-License-Identifier: LGPL-2.1-or-later
"""MDI: one line of G-code typed by the operator, as a trajectory from the current pose.

Each line is independent: no modal state carries over from earlier lines, and a cutting move states its own feed. The
tool axis stays as it is unless the line states it. A line may also switch spindle or coolant without a move.

Enters: text in mm or inch, as it states, and the pose of the tool in {M}. Leaves: a trajectory in {M}, or what is wrong
with the line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.link.readout import Pose
from pkm_post.control.numerical_control import moves
from pkm_post.geometry import Array
from pkm_post.machine import Policy, Rule
from pkm_post.model import Diagnostic, EventKind, Machine, Place, Program, Tool, Trajectory, errors
from pkm_post.options import Options
from pkm_post.posting import trajectory_of, work_offset
from pkm_post.reading import gcode

SOURCE = "MDI"
_SAYS_THE_SPIN = "RPY"
_EMPTY, _NO_MOVE = "G420", "J103"
"""Codes that reading and placing report for a program without moves; their cures refer to files and CAM."""
_STAY = "G90 G21 G94 G1 X{:.6f} Y{:.6f} Z{:.6f} F60"
"""Appended to a line without moves, so that its switching codes precede a move to the current position."""

Findings = tuple[Diagnostic, ...]


@dataclass(frozen=True)
class Reading:
    """How to read a line.

    Attributes:
        work_offset: name of a work offset in the machine file: the frame of the coordinates.
        axis_words: how the line states the tool axis, a key of ``gcode.options.AXIS_WORDS``; with ``"none"`` the axis
            stays as it is.
    """

    work_offset: str = "G54"
    axis_words: str = "none"


def line_trajectory(
    line: str, machine: Machine, here: Pose, tool_length: float, reading: Reading | None = None
) -> tuple[Trajectory | None, Findings]:
    """The trajectory of a line of G-code.

    Args:
        line: one line of text.
        machine: its work offsets and limits apply.
        here: current pose of the tool.
        tool_length: gauge length of the tool in the spindle, mm.
        reading: how to read the line.

    Raises:
        ValueError: the text has more than one line.
    """
    if len(line.splitlines()) > 1:
        raise ValueError(f"line: expected one line, got {len(line.splitlines())}")
    reading = reading or Reading()
    options = Options(work_offset=reading.work_offset, spin=Policy(Rule.FILE))
    offset, told = work_offset(machine, options)
    if offset is None:
        return None, told
    program, faults = _read(line, here, offset, tool_length, reading)
    if any(fault.code == _EMPTY for fault in faults):
        return _standing(line, machine, here, offset, tool_length, reading)
    told += faults
    if program is None or errors(told):
        return None, told
    # A trajectory starts at the home of its machine. Here that is the current pose, so that the line leads straight
    # from it.
    standing = replace(machine, home_tip=here.tip, home_axis=here.axis, home_spin=here.spin, tool_change=None)
    standing = replace(standing, largest_tool_diameter=math.inf)  # diameter of the tool in the spindle is unknown
    trajectory, faults = trajectory_of(program, standing, options)
    told += tuple(replace(fault, code="C201") if fault.code == _NO_MOVE else fault for fault in faults)
    if trajectory is None or reading.axis_words == _SAYS_THE_SPIN:
        return trajectory, told
    return replace(trajectory, spin=np.full(len(trajectory), here.spin)), told


def _standing(
    line: str, machine: Machine, here: Pose, machine_from_work: Array, tool_length: float, reading: Reading
) -> tuple[Trajectory | None, Findings]:
    """A line without a move: switching codes at standstill."""
    stay = _STAY.format(*_in_work(here, machine_from_work))
    program, told = _read(f"{line}\n{stay}", here, machine_from_work, tool_length, reading)
    if program is not None and program.events and not errors(told):
        return moves.standing(machine, here, tool_length, program.events), told
    told = tuple(fault for fault in told if fault.code != _EMPTY)
    if not errors(told):
        told += (Diagnostic("C201", Place(SOURCE, line=1), line.strip() or "an empty line"),)
    return None, told


def _in_work(here: Pose, machine_from_work: Array) -> tuple[float, float, float]:
    """The tip in {C}, mm."""
    x, y, z = (machine_from_work[:3, :3].T @ (here.tip - machine_from_work[:3, 3])).tolist()
    return x, y, z


def _read(
    line: str, here: Pose, machine_from_work: Array, tool_length: float, reading: Reading
) -> tuple[Program | None, Findings]:
    """The line as a program in {C}."""
    # A NaN diameter reveals cutter compensation.
    tool = Tool(0, "in the spindle", math.nan, 0.0, tool_length)
    options = gcode.ReadOptions(
        default_tool=tool, start=_in_work(here, machine_from_work), axis_words=reading.axis_words
    )
    program, told = gcode.read(line, SOURCE, options)
    if program is None:
        return None, told
    if np.isnan(program.side_offset).any():
        found = "cutter compensation with a tool of unknown diameter"
        return None, (*told, Diagnostic("G411", Place(SOURCE, line=1), found))
    if any(event.kind is EventKind.TOOL_CHANGE for event in program.events):
        return None, (*told, Diagnostic("C203", Place(SOURCE, line=1), line.splitlines()[0].strip()))
    tools = {number: replace(each, diameter=0.0) for number, each in program.tools.items()}
    if reading.axis_words == "none":
        kept = np.tile(machine_from_work[:3, :3].T @ here.axis, (len(program), 1))
        return replace(program, tools=tools, tool_axis=kept), told
    return replace(program, tools=tools), told
