# SPDX-License-Identifier: LGPL-2.1-or-later
"""MDI: a line of G-code, entered by hand, as a trajectory from the current pose.

Input: the line, the machine with its work offsets, and the pose of the tool, mm and rad. Output: a trajectory, or the
reasons against it. A line without moves switches its M codes at standstill.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.numerical_control.manual_moves import stationary_trajectory
from pkm_post.geometry import Array
from pkm_post.machine import SpinPolicy, SpinRule
from pkm_post.model import Diagnostic, Diagnostics, EventKind, Machine, Place, Program, Tool, Trajectory, errors
from pkm_post.options import Options
from pkm_post.posting import trajectory_of, with_machine, work_offset
from pkm_post.reading import ReadingOptions, gcode
from pkm_post.toolpath import ToolPose

_MDI, _SAYS_THE_SPIN = "MDI", "RPY"
_EMPTY_CODE, _NO_MOVES_CODE = "G420", "J103"
"""Codes that reading and placing report for a program without moves; their cures refer to files and CAM."""
_BY_HAND = dict.fromkeys(("G213", "G309", "G401", "G402"), "C224") | {"G408": "C225", "G412": "C226", "G413": "C226"}
"""Codes whose cures name options of part programs, and those for a line that is entered by hand."""
_NAMELESS = "G54.1P301"
"""Frame of a work offset without a code, as no program can name it."""
_STAY = "G90 G21 G94 G1 X{:.6f} Y{:.6f} Z{:.6f} F60"
"""Appended to a line without moves, so that its switching codes precede a move to the current position."""


@dataclass(frozen=True)
class MdiSettings:
    """Reading options of a line.

    Attributes:
        work_offset: name of a work offset in the machine file: the frame of the coordinates.
        axis_words: notation of the tool axis, a key of ``gcode.options.AXIS_WORDS``; with ``"none"`` the axis
            is unchanged.
    """

    work_offset: str = "G54"
    axis_words: str = "none"


def mdi_trajectory(
    line: str, machine: Machine, pose: ToolPose, tool_length: float, reading: MdiSettings | None = None
) -> tuple[Trajectory | None, Diagnostics]:
    """The trajectory of a line of G-code.

    Args:
        line: one line of text.
        machine: its work offsets and limits apply.
        tool_length: gauge length of the tool in the spindle, mm.
        reading: reading options of the line.

    Raises:
        ValueError: the text has more than one line.
    """
    if len(line.splitlines()) > 1:
        raise ValueError(f"line: expected one line, got {len(line.splitlines())}")
    reading = reading or MdiSettings()
    options = Options(work_offset=reading.work_offset, spin=SpinPolicy(SpinRule.FILE))
    offset, diagnostics = work_offset(machine, options)
    if offset is None:
        return None, diagnostics
    words = _read_options(machine, options, pose, offset, tool_length, reading.axis_words)
    program, faults = _read(line, pose, offset, words)
    if any(fault.code == _EMPTY_CODE for fault in faults):
        return _standing(line, machine, pose, offset, tool_length, words)
    diagnostics += faults
    if program is None or errors(diagnostics):
        return None, diagnostics
    # A trajectory starts at the home of its machine. Here that is the current pose, so the line leads straight from it.
    standing = replace(machine, home_tip=pose.tip, home_axis=pose.axis, home_spin=pose.spin, tool_change=None)
    standing = replace(standing, largest_tool_diameter=math.inf)  # diameter of the tool in the spindle is unknown
    trajectory, faults = trajectory_of(program, standing, options)
    diagnostics += tuple(replace(fault, code="C201") if fault.code == _NO_MOVES_CODE else fault for fault in faults)
    if trajectory is None or reading.axis_words == _SAYS_THE_SPIN:
        return trajectory, diagnostics
    return replace(trajectory, spin=np.full(len(trajectory), pose.spin)), diagnostics


def _standing(
    line: str, machine: Machine, pose: ToolPose, offset: Array, tool_length: float, words: gcode.ReadOptions
) -> tuple[Trajectory | None, Diagnostics]:
    """A line without a move: switching codes at standstill."""
    stay = _STAY.format(*_in_work(pose, offset))
    program, diagnostics = _read(f"{line}\n{stay}", pose, offset, words)
    if program is not None and program.events and not errors(diagnostics):
        return stationary_trajectory(machine, pose, tool_length, program.events), diagnostics
    diagnostics = tuple(fault for fault in diagnostics if fault.code != _EMPTY_CODE)
    if not errors(diagnostics):
        diagnostics += (Diagnostic("C201", Place(_MDI, line=1), line.strip() or "an empty line"),)
    return None, diagnostics


def _in_work(pose: ToolPose, machine_from_work: Array) -> tuple[float, float, float]:
    """The tip in {C}, mm."""
    x, y, z = (machine_from_work[:3, :3].T @ (pose.tip - machine_from_work[:3, 3])).tolist()
    return x, y, z


def _read_options(
    machine: Machine, options: Options, pose: ToolPose, offset: Array, tool_length: float, axis_words: str
) -> gcode.ReadOptions:
    """The chosen work offset is in force; the line may name another one of the machine."""
    known = with_machine(ReadingOptions(), machine, options)
    return gcode.ReadOptions(
        # A NaN diameter reveals cutter compensation.
        default_tool=Tool(0, "in the spindle", math.nan, 0.0, tool_length),
        start=_in_work(pose, offset),
        axis_words=axis_words,
        work_offset=str(options.work_offset) if options.work_offset in known.machine_offsets else _NAMELESS,
        machine_offsets=known.machine_offsets,
        machine_zero=known.machine_zero,
        functions=known.functions,
        flavour="rs274",  # one line is no evidence, and the same words mean the same in every line
    )


def _read(line: str, pose: ToolPose, offset: Array, words: gcode.ReadOptions) -> tuple[Program | None, Diagnostics]:
    """The line as a program in {C}."""
    program, faults = gcode.read(line, _MDI, words)
    diagnostics = tuple(replace(fault, code=_BY_HAND.get(fault.code, fault.code)) for fault in faults)
    if program is None:
        return None, diagnostics
    if np.isnan(program.side_offset).any():
        return None, (*diagnostics, Diagnostic("C227", Place(_MDI, line=1), line.splitlines()[0].strip()))
    if any(event.kind is EventKind.TOOL_CHANGE for event in program.events):
        return None, (*diagnostics, Diagnostic("C203", Place(_MDI, line=1), line.splitlines()[0].strip()))
    tools = {number: replace(each, diameter=0.0) for number, each in program.tools.items()}
    if words.axis_words == "none":
        kept = np.tile(offset[:3, :3].T @ pose.axis, (len(program), 1))
        return replace(program, tools=tools, tool_axis=kept), diagnostics
    return replace(program, tools=tools), diagnostics
