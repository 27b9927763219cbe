# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach study: whether a machine can follow a program, and the effect of another spin or workpiece position.

Takes a program, a machine and the options of the user; returns the report of all checks, with the margins before and
after each option. No file is written.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

from pkm_post.geometry import Array
from pkm_post.machine import ZERO_TORSION, ReachReport, SpinRule, least_normalised_margins
from pkm_post.model import Diagnostics, Machine, Program, errors
from pkm_post.options import Options
from pkm_post.posting.place_search import FoundPlace, find_place, work_offset_text
from pkm_post.posting.placement import check_path_of, effective_setup, trajectory_of

_LABELS = ("stroke", "joints", "from singular")


@dataclass(frozen=True)
class Study:
    """Result of the study.

    Attributes:
        reach: all checks of the path as driven.
        stages: each option, in order, and the least shares (3,) after it.
        machine_from_work: (4, 4) the work offset of the last stage.
        place: the place found, if the workpiece may be moved.
    """

    reach: ReachReport
    stages: tuple[tuple[str, Array], ...]
    machine_from_work: Array
    place: FoundPlace | None = None

    def as_dict(self) -> dict[str, Any]:
        """The study for JSON."""
        stages = [{"stage": name} | dict(zip(_LABELS, _rounded(left), strict=True)) for name, left in self.stages]
        place = {"place": self.place.text()} if self.place else {}
        return self.reach.as_dict() | {"left": stages, "machine_from_work": self.machine_from_work.tolist()} | place

    def text(self) -> str:
        """The study as text."""
        head = f"{'what is left (1 best, 0 at the limit)':<40}" + "".join(f"{label:>15}" for label in _LABELS)
        rows = [f"{name:<40}" + "".join(f"{share:>15.3f}" for share in left) for name, left in self.stages]
        place = [f"place: {self.place.text()}"] if self.place else []
        return "\n".join(
            [self.reach.text(), head, *rows, "", *place, f"work offset: {work_offset_text(self.machine_from_work)}"]
        )


def study(
    program: Program,
    machine: Machine,
    options: Options,
    free: str = "",
    starts: int = 1,
    executor: Executor | None = None,
) -> tuple[Study | None, Diagnostics]:
    """Check a program on a machine.

    Args:
        program: cutter locations in {C}.
        options: work offset, spin and compensation, and the set-up.
        free: letters of x, y, z, a, b and c in which the workpiece may be moved; empty for none.
        starts: number of starts of the search; more are added if it finds no place.
        executor: distributes the searches for position and spin; by default they run in this process.

    Returns:
        The study, or None when the program cannot be placed; and the diagnostics, including those of the checks.
    """
    placed, diagnostics = trajectory_of(program, machine, replace(options, spin=ZERO_TORSION))
    if placed is None:
        return None, diagnostics
    stages = [("as it is, zero torsion", least_normalised_margins(placed, machine))]
    place = None
    if free:
        place, diagnostics = find_place(program, machine, options, free, starts, executor)
        if place is None:
            return None, diagnostics
        options = place.options
        placed, diagnostics = trajectory_of(program, machine, replace(options, spin=ZERO_TORSION))
        if placed is None:
            return None, diagnostics
        stages.append((f"moved in {', '.join(free)}", least_normalised_margins(placed, machine)))
    if options.spin.rule is not SpinRule.ZERO:
        placed, diagnostics = trajectory_of(program, machine, options, executor)
        if placed is None:
            return None, diagnostics
        stages.append((f"spin {options.spin.rule.value}", least_normalised_margins(placed, machine)))
    setup, faults = effective_setup(options, program)
    if errors(faults):
        return None, (*diagnostics, *faults)
    checked, both = check_path_of(placed, machine, setup, options.tolerances)
    return Study(checked, tuple(stages), placed.machine_from_work, place), (*diagnostics, *both)


def _rounded(left: Array) -> list[float]:
    return [round(float(share), 6) for share in left]
