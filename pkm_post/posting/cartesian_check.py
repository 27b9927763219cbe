# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cartesian check: read a program of tip and axis, run it through the kinematics, and certify the strut motion.

Input: texts of a program, its trajectory file, a machine. Output: axis positions and rates, a certificate and the
report. The guard of the program states the values allowed at the machine and must be the one that these values give;
with the gauge length of the trajectory, the certificate holds at every corner of this allowance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.certificate import blocks_in_a_second
from pkm_post.model import (
    Certificate,
    Diagnostic,
    Diagnostics,
    Machine,
    Place,
    Refused,
    StrutMotion,
    Trajectory,
    required,
)
from pkm_post.posting.cartesian_axes import strut_motion
from pkm_post.posting.cartesian_guard import Setting, guard_lines, stated_allowance, stated_segment_time, unguarded
from pkm_post.posting.cartesian_segments import played_in_segments, program_points
from pkm_post.posting.program_certificate import certified
from pkm_post.writing import PmacSettings, PowerPmacSettings, controller_settings, trajectory_file

Texts = Sequence[tuple[str, str]]
LETTERS = ("X", "Y", "Z", "A", "B", "C")


def certified_axes(
    texts: Texts, name: str, trajectory: Path, machine: Machine, digests: list[str]
) -> tuple[Certificate, dict[str, Any]]:
    """Certify an existing program; return its certificate, which holds, and the report.

    Args:
        texts: file name and text of each part.
        name: of the program, for the diagnostics.
        trajectory: the file it was made from.
        digests: SHA-256 of the parts, for the report.

    Raises:
        Refused: a file cannot be read, the guard does not match the program, or the certificate does not hold.
    """
    planned = planned_of_one_tool(trajectory, name)
    tool_length = float(planned.tool_length()[0])
    segment_time = stated_segment_time(texts[0][1])
    controller, settings = axis_controller(machine, segment_time)
    setting = Setting(tool_length, stated_allowance(texts[0][1]), segment_time)
    written = required(*read_axes(texts, controller, settings, setting))
    return certify_axes(written, name, trajectory, machine, setting, digests)


def read_axes(
    texts: Texts, controller: Any, settings: PmacSettings | PowerPmacSettings, setting: Setting
) -> tuple[StrutMotion | None, Diagnostics]:
    """Axis positions and rates of a program, as columns of a motion; or None with diagnostics."""
    guard, opening = guard_lines(settings, setting), controller.buffer_opening(settings)
    try:
        bare = [(name, unguarded(text, opening, guard)) for name, text in texts]
    except ValueError as fault:
        return None, (Diagnostic("C101", Place(texts[0][0]), f"guard in front of the moves: {fault}"),)
    motion, faults = controller.read_parts(bare, settings)
    return motion, faults


def certify_axes(
    axes: StrutMotion, name: str, trajectory: Path, machine: Machine, setting: Setting, digests: list[str]
) -> tuple[Certificate, dict[str, Any]]:
    """Certify the strut motion at each corner of the allowance; return certificate and report.

    Raises:
        Refused: the certificate does not hold; C115 and C116 precede the faults of a corner and of segments.
    """
    segment = setting.segment_time
    fault = Diagnostic("C116", Place(name), f"segments of {segment} ms") if segment else None
    found = _certify(axes, name, trajectory, machine, setting, digests, fault)
    for words, corner in setting.allowance.corners(machine):
        _certify(axes, name, trajectory, corner, setting, [], Diagnostic("C115", Place(name), words))
    return found


def _check_points(axes: StrutMotion, name: str, machine: Machine, segment_time: int = 1) -> None:
    """Check that the controller accepts the spacing of the points.

    Raises:
        Refused: points are too close together, or within a segment.
    """
    within = np.flatnonzero(axes.time_ms % segment_time)
    if len(within):
        found = f"point at {axes.time_ms[within[0]]} ms, expected whole segments of {segment_time} ms from each rest"
        raise Refused([Diagnostic("C101", Place(name), found)])
    shortest, most = np.diff(axes.time_ms).min(), blocks_in_a_second(axes.time_ms).max()
    faults = []
    if shortest < machine.shortest_interval:
        found = f"shortest interval {shortest:g} ms, at least {machine.shortest_interval:g} ms"
        faults.append(Diagnostic("V116", Place(name), found))
    if most > machine.block_rate:
        found = f"blocks in one second {most:g} 1/s, allowed {machine.block_rate:g} 1/s"
        faults.append(Diagnostic("V117", Place(name), found))
    if faults:
        raise Refused(faults)


def _certify(
    axes: StrutMotion,
    name: str,
    trajectory: Path,
    machine: Machine,
    setting: Setting,
    digests: list[str],
    fault: Diagnostic | None,
) -> tuple[Certificate, dict[str, Any]]:
    """Certify the axes on one machine; ``fault`` precedes its faults."""
    if setting.segment_time:
        _check_points(axes, name, machine, setting.segment_time)
        played = played_in_segments(machine, axes, setting.tool_length, setting.segment_time)
        # segments are not points of a program; how far a feed reaches into another one depends on them
        machine = replace(machine, block_rate=math.inf, shortest_interval=setting.segment_time)
        points = program_points(machine, axes, setting.tool_length, setting.segment_time)
    else:
        played, points = strut_motion(machine, axes, setting.tool_length), None
    try:
        return certified(played, name, trajectory, machine, digests, points)
    except Refused as refused:
        raise Refused((*filter(None, [fault]), *refused.diagnostics)) from None


def axis_controller(machine: Machine, segment_time: int) -> tuple[Any, PmacSettings | PowerPmacSettings]:
    """The controller of a machine, and its settings with X Y Z A B C as axes."""
    controller, settings = required(*controller_settings(machine))
    if segment_time and not isinstance(settings, PowerPmacSettings):
        expected = "controller.kind: expected power_pmac for a segment time, as a Turbo PMAC has none in PVT mode"
        raise Refused([Diagnostic("M104", Place(machine.name), f"{expected}, got {settings.KIND!r}")])
    try:
        return controller, replace(settings, letters=LETTERS)
    except ValueError as fault:  # a code moves X, Y or Z
        raise Refused([Diagnostic("M104", Place(machine.name), f"controller.{fault}")]) from fault


def planned_of_one_tool(file: Path, name: str) -> Trajectory:
    """Read the trajectory of a program; all its tools must have the same length."""
    planned = required(*trajectory_file.read(file))
    lengths = np.unique(planned.tool_length())
    if len(lengths) > 1:
        found = ", ".join(f"{length:g} mm" for length in lengths)
        raise Refused([Diagnostic("C111", Place(name), f"gauge lengths {found}")])
    return planned
