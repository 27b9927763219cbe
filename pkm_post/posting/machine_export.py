# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine export: kinematics of a machine for its controller, with a sign-off sheet, as files written together.

Input: a machine, the controller to export to, and a folder. The strut lengths on the sheet are those of
``machine.kinematics``, not of the exported programs. Lengths in mm, angles in degrees.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from pkm_post.machine import ToolPoses, lengths_at, reach_margins, strut_lengths
from pkm_post.model import Diagnostics, Machine, errors
from pkm_post.posting.machine_check import machine_faults
from pkm_post.system import staged, staged_folder, write_fault
from pkm_post.toolpath import ToolPose
from pkm_post.writing import kinematics

_SHIFT, _TURN = 20.0, 5.0
"""mm and degrees from home to the positions of the sheet: far enough to see a wrong sign or letter."""


def export_machine(
    machine: Machine, file: str, target: str, folder: Path, export: kinematics.Export
) -> tuple[tuple[Path, ...], Diagnostics]:
    """Write the files of a machine for a controller that computes the kinematics itself.

    Args:
        file: name or path of its file; the file names start with its stem.
        target: one of ``writing.kinematics.TARGETS``.
        folder: is created if missing.
        export: settings.

    Returns:
        The files, none if the machine is refused or the folder is not writable; and the diagnostics.
    """
    diagnostics = machine_faults(machine, file)
    if errors(diagnostics):
        return (), diagnostics
    poses = check_poses(machine, export.tool_length)
    home = lengths_at(machine, ToolPose.at_home(machine), export.tool_length)
    export = replace(export, home_lengths=tuple(home.tolist()))
    texts, faults = kinematics.TARGETS[target](machine, Path(file).stem, export, poses)
    diagnostics += faults
    if texts is None:
        return (), diagnostics
    is_tree = target == kinematics.PROJECT
    place = folder / Path(file).stem if is_tree else folder
    try:
        with staged_folder(place) if is_tree else staged(folder) as private:
            for name, text in texts.items():
                (private / name).parent.mkdir(parents=True, exist_ok=True)
                (private / name).write_text(text, encoding="utf-8", newline="\n")
    except OSError as fault:
        return (), (*diagnostics, write_fault(place, fault))
    return tuple(place / name for name in texts), diagnostics


def check_poses(machine: Machine, tool_length: float) -> kinematics.CheckPoses:
    """The home position, upright, and reachable positions a step from it in each axis."""
    steps = np.diag([_SHIFT] * 3 + [_TURN] * 3)
    axes = np.concatenate([np.zeros((1, 6)), steps, -steps])
    axes[:, :3] += machine.home_tip
    a, b, c = np.radians(axes[:, 3:]).T
    # one angle at a time: A and B alone tilt without a turn about the tool, and C alone is the spin
    axis = np.stack([np.sin(b), -np.sin(a), np.cos(a) * np.cos(b)], axis=1)
    pose = ToolPoses(axes[:, :3], axis, c, np.full(len(axes), tool_length))
    margins = reach_margins(machine, *pose)
    least = [margins.shortest.min(1), margins.longest.min(1), margins.base.min(1), margins.platform.min(1)]
    reached = np.min([*least, margins.singular], axis=0) > 0.0
    return kinematics.CheckPoses(axes[reached], strut_lengths(machine, *pose)[reached], tool_length)
