# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material: the stock of a simulated job at any time, cut by the cutters of its tools in the planned poses.

Takes a simulation with its set-up; returns a replay in the work frame {C}, which is that of the document. Holder and
shank cut nothing: posting reports contact with the stock.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.freecad_app.frames import apply
from pkm_post.freecad_app.simulation import Simulation
from pkm_post.geometry import Array, is_closed
from pkm_post.model import Mesh, Shank, Tool
from pkm_post.removal import (
    Comparison,
    CutterPath,
    Replay,
    RotatingShape,
    Stock,
    compare,
    cutting_times,
    part_distances,
)
from pkm_post.toolpath import Cutter

RESOLUTIONS: dict[str, int] = {"coarse": 60_000, "medium": 400_000, "fine": 3_000_000}
"""Approximate number of nodes in the box of the stock."""


@dataclass(frozen=True)
class Material:
    """The stock of a job.

    Attributes:
        replay: the stock, at a time.
        part: mesh of the part; None if it is unknown or not closed.
    """

    replay: Replay
    part: Mesh | None

    @cached_property
    def part_distances(self) -> Array | None:
        """Distances of the nodes from the part, (B, 512), mm; None without a part."""
        return None if self.part is None else part_distances(self.replay.stock, self.part.triangles)

    def compared(self) -> Comparison | None:
        """The current stock against the part; None without a part."""
        return None if self.part_distances is None else compare(self.replay.stock, self.part_distances)


def step_of(stock: Mesh, nodes: int) -> float:
    """Node spacing in mm, with two significant digits, for a number of nodes in the box of a stock."""
    size = np.ptp(stock.triangles.reshape(-1, 3), axis=0)
    return float(f"{(float(size.prod()) / nodes) ** (1 / 3):.2g}")


def can_be_cut(stock: Mesh | None) -> bool:
    """Whether there is a stock, and its mesh encloses a solid."""
    return stock is not None and is_closed(stock.triangles)


def material_of(simulation: Simulation, step: float) -> Material:
    """The stock of a simulation, before its first pose.

    Args:
        simulation: a plan with a stock that can be cut.
        step: node spacing, mm.

    Raises:
        ValueError: there is no stock, or its mesh is open.
    """
    setup = simulation.setup
    if setup.stock is None or not is_closed(setup.stock.triangles):
        raise ValueError("expected a simulation with a closed stock")
    part = setup.part if setup.part is not None and is_closed(setup.part.triangles) else None
    path = cutter_path(simulation, step)
    return Material(Replay(Stock.of(setup.stock.triangles, step), path), part)


def cutter_path(simulation: Simulation, step: float) -> CutterPath:
    """The poses in which the tools of a simulation cut, in {C}."""
    trajectory, motion = simulation.trajectory, simulation.motion
    numbers = list(trajectory.tools)
    setup = simulation.setup
    shapes = tuple(
        cutting_part(setup.core_of(trajectory.tools[number]), setup.shanks.get(number)) for number in numbers
    )
    known = [shape for shape in shapes if shape is not None]
    seconds = motion.time_ms / 1000.0
    if known:
        seconds = cutting_times(seconds, motion.tip, motion.axis, known, step)
    tip, axis, _, _ = simulation.pose_at(seconds)
    work_from_machine = np.linalg.inv(trajectory.machine_from_work)
    block = np.minimum(np.searchsorted(motion.joint_time, seconds), len(trajectory) - 1)
    index = {number: row for row, number in enumerate(numbers)}
    tool = np.array([index[number] for number in trajectory.tool[block].tolist()], dtype=np.int64)
    return CutterPath(seconds, apply(work_from_machine, tip), axis @ work_from_machine[:3, :3].T, tool, shapes)


def cutting_part(tool: Tool, shank: Shank | None) -> RotatingShape | None:
    """The cutting part of a tool, up to its shank, or up to the spindle if that is unknown; None without a diameter."""
    try:
        cutter = Cutter.of(tool)
    except ValueError:
        return None
    return RotatingShape.of(cutter, tool.length if shank is None else min(shank.start, tool.length))
