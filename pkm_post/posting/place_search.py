# SPDX-License-Identifier: LGPL-2.1-or-later
"""Place search: a work offset, and if need be another spin, with which the machine can follow a program.

Takes a program, a machine and the options of the user; returns the place with its amounts, checked as posting would
check it, collisions included. The search climbs from the place as it is, then from others too, and then lets the spin
be optimised; it ends at the first place that holds. It is no proof that there is none if it finds none.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import DISPLAY_UNITS, ZERO_TORSION, ReachReport, SpinPolicy, SpinRule, best_position
from pkm_post.model import RULES, Diagnostic, Machine, Program, Severity, errors
from pkm_post.options import Options
from pkm_post.posting.path_check import check_path_of
from pkm_post.posting.placement import effective_setup, trajectory_of

_MORE_STARTS = 12
"""Places that the search climbs from if the first ones do not suffice."""
_MM, _DEGREES = 3, 4
"""Decimals of a work offset: it is checked as it can be typed."""
_STILL = 0.05
"""mm and degrees: less is not said."""
_SPARE = {True: "to spare", False: "missing"}


@dataclass(frozen=True)
class FoundPlace:
    """A place of the workpiece.

    Attributes:
        options: those of the user with its work offset and spin.
        shift: (3,) mm in {M}, of the middle of the job.
        turn: (3,) degrees about x, y and z of {M} through that middle.
        spins: whether the spin is another than before.
        reach: the margins there.
        findings: errors and warnings there.
    """

    options: Options
    shift: Array
    turn: Array
    spins: bool
    reach: ReachReport
    findings: tuple[Diagnostic, ...]

    @property
    def holds(self) -> bool:
        """Whether the machine can follow the program there."""
        return not errors(self.findings)

    def text(self) -> str:
        """What to do and what comes of it, such as "shift 12 mm in x, turn 30 degrees about z: reaches, ..."."""
        moves = [f"shift {mm:.1f} mm in {axis}" for axis, mm in zip("xyz", self.shift, strict=True) if abs(mm) > _STILL]
        turns = zip("xyz", self.turn, strict=True)
        moves += [f"turn {degrees:.1f} degrees about {axis}" for axis, degrees in turns if abs(degrees) > _STILL]
        moves += ["--spin optimise"] if self.spins else []
        said = "reaches" if self.holds else f"does not suffice: {errors(self.findings)[0].code}"
        left = [f"{abs(value):.1f} {unit} {_SPARE[value >= 0]}" for unit, value in self.spare().items()]
        return f"{', '.join(moves) or 'where it is'}: {said}, {', '.join(left)}"

    def spare(self) -> dict[str, float]:
        """The least proven margin of all checks that forbid posting, by unit: mm and degrees; negative is missing."""
        least: dict[str, float] = {}
        for each in self.reach.findings:
            unit, scale = DISPLAY_UNITS[each.subject.unit]
            if unit in ("mm", "degrees") and RULES[each.subject.code].severity is Severity.ERROR:
                margin = each.at_least if np.isfinite(each.at_least) else float(each.margin.min())
                least[unit] = min(least.get(unit, np.inf), margin * scale)
        return least


def find_place(
    program: Program,
    machine: Machine,
    options: Options,
    free: str = "xyzc",
    starts: int = 1,
    executor: Executor | None = None,
) -> tuple[FoundPlace | None, tuple[Diagnostic, ...]]:
    """Look for a place at which the machine can follow a program.

    Args:
        program: cutter locations in {C}.
        machine: geometry and limits.
        options: work offset, spin and compensation, and the set-up.
        free: letters of ``position.FREEDOMS`` in which the workpiece may be moved.
        starts: number of positions from which a better one is looked for first.
        executor: distributes the climbs; by default they run in this process.

    Returns:
        The first place that holds, otherwise the last one that was tried; None when the program cannot be placed at
        all, with the diagnostics.
    """
    placed, diagnostics = trajectory_of(program, machine, replace(options, spin=ZERO_TORSION))
    if placed is None:
        return None, diagnostics
    setup, faults = effective_setup(options, program)
    if errors(faults):
        return None, (*diagnostics, *faults)
    of_machine = placed.operation >= len(program.operations)  # the routes to tool changes and back
    found = None
    for count in (starts, max(starts, _MORE_STARTS)):
        position = best_position(placed, machine, free, None, of_machine, count, executor)
        for chosen in _with_spins(replace(options, work_offset=_as_typed(position.machine_from_work))):
            moved, diagnostics = trajectory_of(program, machine, chosen, executor)
            if moved is None:
                return None, diagnostics
            checked, findings = check_path_of(moved, machine, setup, options.tolerances)
            turn = (np.degrees(position.move[3:]) + 180.0) % 360.0 - 180.0
            spins = chosen.spin is not options.spin
            found = FoundPlace(chosen, position.move[:3], turn, spins, checked, findings)
            if found.holds:
                return found, ()
    return found, ()


def _with_spins(options: Options) -> Iterator[Options]:
    """Yield options with their own spin, and with one that is optimised."""
    yield options
    if options.spin.rule not in (SpinRule.OPTIMISED, SpinRule.FILE):
        yield replace(options, spin=SpinPolicy(SpinRule.OPTIMISED))


def _as_typed(offset: Array) -> Array:
    """A work offset, rounded as ``--work-offset`` states it, if it turns about z only."""
    if not np.allclose(offset[2, :3], [0.0, 0.0, 1.0]):
        return offset
    turn = np.radians(np.round(np.degrees(np.arctan2(offset[1, 0], offset[0, 0])), _DEGREES))
    rounded = np.eye(4)
    rounded[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    rounded[:3, 3] = np.round(offset[:3, 3], _MM)
    return rounded
