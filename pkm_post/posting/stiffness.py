# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness study: stiffness of the tool tip along a job, and of an upright tool over the whole table.

Takes a trajectory in {M} and its machine; returns the maps of both, with the softest place of each operation. The table
is mapped at the lowest height of the tip in the job, with the longest tool of the job. Units: mm, N/mm; N/um in texts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import StiffnessMap, pose_path_of, stiffness_map, table_poses
from pkm_post.model import Diagnostic, Diagnostics, Machine, Place, Trajectory

STEP = 25.0
"""mm: default spacing on the table."""
_PER_MICRON = 1e-3


@dataclass(frozen=True)
class SoftestPlace:
    """The softest place of an operation.

    Attributes:
        operation: its name.
        line: of the source.
        row: of the map of the job.
        stiffness: in the softest direction, N/mm.
        direction: (3,) that direction in {M}.
    """

    operation: str
    line: int
    row: int
    stiffness: float
    direction: Array

    def text(self) -> str:
        """As text, such as "Finish, line 12: 31.4 N/um along (0.71, 0.70, 0.05)"."""
        along = ", ".join(f"{value:z.2f}" for value in self.direction.tolist())
        where = f"{self.operation}, line {self.line}" if self.operation else f"line {self.line}"
        return f"{where}: {self.stiffness * _PER_MICRON:.1f} N/um along ({along})"


@dataclass(frozen=True)
class StiffnessStudy:
    """Result of the study.

    Attributes:
        trajectory: the job in {M}.
        machine: name of the machine.
        job: the map along the job.
        segment: (N,) segment of the trajectory of each row of that map.
        table: the map over the table.
    """

    trajectory: Trajectory
    machine: str
    job: StiffnessMap
    segment: Array
    table: StiffnessMap

    def softest(self) -> tuple[SoftestPlace, ...]:
        """The softest place of each operation, in the order of the job."""
        return tuple(self._softest())

    def _softest(self) -> Iterator[SoftestPlace]:
        operation = self.trajectory.operation[self.segment]
        for number in np.unique(operation):
            rows = np.flatnonzero(operation == number)
            row = int(rows[np.argmin(self.job.stiffness[rows, 0])])
            place = self.trajectory.place(int(self.segment[row]))
            value, direction = float(self.job.stiffness[row, 0]), self.job.softest[row]
            yield SoftestPlace(place.operation, place.line, row, value, direction)

    def as_dict(self) -> dict[str, Any]:
        """The study for JSON."""
        return {
            "source": self.trajectory.source,
            "machine": self.machine,
            "unit": "N/um",
            "operations": [
                {
                    "operation": each.operation,
                    "line": each.line,
                    "stiffness": each.stiffness * _PER_MICRON,
                    "direction": each.direction.tolist(),
                }
                for each in self.softest()
            ],
            "table": self._table() | {"height": float(self.table.tip[0, 2])},
        }

    def text(self) -> str:
        """The study as text."""
        head = f"{self.trajectory.source} on {self.machine}: stiffness of the tool tip in its softest direction"
        found, height = self._table(), self.table.tip[0, 2]
        table = f"table at z = {height:.1f} mm, tool upright: out of reach"
        if found["reached"]:
            table = (
                f"table at z = {height:.1f} mm, tool upright: {found['least']:.1f} to {found['most']:.1f} N/um, "
                f"reached at {found['reached']} of {found['places']} places"
            )
        return "\n".join([head, *(f"  {each.text()}" for each in self.softest()), table])

    def _table(self) -> dict[str, Any]:
        least = self.table.least[self.table.reached] * _PER_MICRON
        found: dict[str, Any] = {"places": len(self.table.tip), "reached": len(least)}
        return found | ({"least": float(least.min()), "most": float(least.max())} if len(least) else {})


def stiffness_study(
    trajectory: Trajectory, machine: Machine, step: float = STEP
) -> tuple[StiffnessStudy | None, Diagnostics]:
    """Map the stiffness of the tool tip.

    Args:
        trajectory: in {M}, at least one segment.
        step: spacing on the table, mm.

    Returns:
        The study, or None with K158 when the machine file states no stiffness.
    """
    if machine.strut_stiffness is None:
        return None, (Diagnostic("K158", Place(trajectory.source), machine.name),)
    path, segment, _ = pose_path_of(trajectory)
    tool_length = float(trajectory.tool_length().max())
    table = table_poses(machine, float(path.tip[:, 2].min()), tool_length, step)
    along = stiffness_map(machine, path.rows(slice(None)))
    return StiffnessStudy(trajectory, machine.name, along, segment, stiffness_map(machine, table)), ()
