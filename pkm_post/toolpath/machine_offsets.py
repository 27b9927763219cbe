# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine offsets: a work offset and tool lengths changed at the machine after posting.

The path moves with the part, and each tool keeps its tip on it: the trajectory is that of a new posting with these
offsets. Everything tied to the machine stays: the start; the tool-change pose, with the spindle nose in its place; and
the safe height, where the way there meets a line along the tool axis of the moved path.

Input: a posted trajectory. Output: the trajectory for the current offsets. Units: mm.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import Diagnostic, Diagnostics, Kind, Machine, Place, Trajectory
from pkm_post.toolpath.tool_change import is_detour

_SAME_MM = 1e-6


@dataclass(frozen=True)
class MachineOffsets:
    """The changes.

    Attributes:
        shift: displacement of the work offset in {M}, mm.
        lengths: gauge lengths by tool number, mm; other tools keep those of the posting.
    """

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lengths: dict[int, float] = field(default_factory=dict)

    @property
    def is_empty(self) -> bool:
        """Whether nothing was changed."""
        return not (any(self.shift) or self.lengths)


def with_machine_offsets(
    trajectory: Trajectory, machine: Machine, offsets: MachineOffsets
) -> tuple[Trajectory | None, Diagnostics]:
    """The trajectory with these offsets, or the reason against it (C209)."""
    if offsets.is_empty:
        return trajectory, ()
    unknown = sorted(set(offsets.lengths) - {tool.number for tool in trajectory.tools.values()})
    if unknown:
        found = f"tool {', '.join(map(str, unknown))}"
        return None, (Diagnostic("C209", Place(trajectory.source), found),)
    moved = _moved(trajectory, machine, offsets)
    before, shift = moved.tip_before() - trajectory.tip_before(), moved.tip - trajectory.tip
    apart = norm(shift - before)
    torn = np.flatnonzero((moved.kind == Kind.ARC) & (apart > _SAME_MM))
    if len(torn):
        found = f"an arc begins {apart[torn[0]]:.3f} mm from where it did"
        return None, (Diagnostic("C209", trajectory.place(int(torn[0])), found),)
    bent = apart > _SAME_MM  # the direction of these rows changes
    length = np.where(bent, norm(moved.tip - moved.tip_before()), moved.length)
    return replace(moved, length=length, smooth=moved.smooth & ~bent & ~np.append(bent[1:], False)), ()


def _moved(trajectory: Trajectory, machine: Machine, offsets: MachineOffsets) -> Trajectory:
    """Move tips, centres and tools; lengths of rows stay those of the posting."""
    tools = {
        key: replace(tool, length=offsets.lengths.get(tool.number, tool.length))
        for key, tool in trajectory.tools.items()
    }
    lengthened = replace(trajectory, tools=tools)
    frame: Array = np.array(trajectory.machine_from_work)
    frame[:3, 3] += offsets.shift
    return replace(
        lengthened,
        tip=trajectory.tip + _tip_shifts(trajectory, machine, lengthened.tool_length(), np.array(offsets.shift)),
        arc_centre=trajectory.arc_centre + np.array(offsets.shift),
        machine_from_work=frame,
    )


def _tip_shifts(trajectory: Trajectory, machine: Machine, length: Array, shift: Array) -> Array:
    """Shift of the end of each row, (N, 3): that of the part, except on moves of tool changes and approaches."""
    shifts, pose = np.tile(shift, (len(trajectory), 1)), machine.tool_change
    if pose is None:
        return shifts
    tip, axis, before = trajectory.tip, trajectory.axis, trajectory.tool_length()
    detours = np.array([is_detour(name) for name in trajectory.operations])[trajectory.operation]
    high = detours & (np.abs(tip[:, 2] - pose.safe_height) < _SAME_MM)
    shifts[high] -= (shift[2] / axis[high, 2])[:, None] * axis[high]
    from_start, up = tip - trajectory.start_tip, trajectory.start_axis
    beside = norm(from_start - (from_start @ up)[:, None] * up)
    shifts[detours & (beside < _SAME_MM) & (norm(axis - up) < _SAME_MM)] = 0.0
    changes = detours & (norm(tip + before[:, None] * axis - pose.nose) < _SAME_MM)
    shifts[changes] = -(length - before)[changes, None] * axis[changes]
    return shifts
