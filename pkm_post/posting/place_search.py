# SPDX-License-Identifier: LGPL-2.1-or-later
"""Place search: find a work offset, and if necessary another spin, with which the machine can follow a program.

Input: a program, a machine and the options of the user. Output: the place with its shift and turn, checked as in
posting, collisions included. The search climbs from the current place, then from others. If the best place fails,
because of a collision for instance, other good ones are checked, then the best one with an optimised spin. It stops at
the first place that passes. Failing to find one is no proof that none exists.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import (
    DISPLAY_UNITS,
    ZERO_TORSION,
    ReachReport,
    SpinPolicy,
    SpinRule,
    WorkpiecePosition,
    good_positions,
)
from pkm_post.model import (
    RULES,
    Diagnostic,
    Diagnostics,
    Machine,
    Program,
    Severity,
    checkpoints,
    errors,
    required,
)
from pkm_post.options import Options, flag_of
from pkm_post.posting.placement import check_path_of, effective_setup, trajectory_of, turn_about_z
from pkm_post.posting.run import Progress, beat, no_progress

_MORE_STARTS = 12
"""Starts of the search if the first ones are not enough."""
_MOST_JUDGED = 8
"""Most places with a full check, per number of starts."""
_PLACES = 4
"""Checked places at which progress shows half of the search, as the number needed is unknown."""
PLACE_STEP = "place search"
"""The name of the step in progress."""
MENDED_BY_A_PLACE = frozenset({f"K{number}" for number in (*range(101, 106), *range(113, 118), 121, 133)})
"""Codes that another place or spin may cure: limits of struts and joints, singular poses, and machine bodies that come
too close to something."""
_MM, _DEGREES = 3, 4
"""Decimals of a work offset: the place is checked as typed."""
_STILL = 0.05
"""mm and degrees: smaller changes are not reported."""
_ONE_PLACE: Mapping[str, Array] = {}
"""No fixtures: the program has one {C}."""
_SPARE = {True: "to spare", False: "missing"}


@dataclass(frozen=True)
class FoundPlace:
    """A place of the workpiece.

    Attributes:
        options: options of the user, with the new work offset and spin.
        shift: (3,) mm in {M}, of the middle of the job.
        turn: (3,) degrees about x, y and z of {M} through that middle.
        spins: whether the spin differs from that of the user.
        reach: the margins there.
        findings: errors and warnings there.
    """

    options: Options
    shift: Array
    turn: Array
    spins: bool
    reach: ReachReport
    findings: Diagnostics

    @property
    def holds(self) -> bool:
        """Whether the machine can follow the program there."""
        return not errors(self.findings)

    def text(self) -> str:
        """The change and its result, such as "shift 12 mm in x, turn 30 degrees about z: reaches, ..."."""
        moves = [f"shift {mm:.1f} mm in {axis}" for axis, mm in zip("xyz", self.shift, strict=True) if abs(mm) > _STILL]
        turns = zip("xyz", self.turn, strict=True)
        moves += [f"turn {degrees:.1f} degrees about {axis}" for axis, degrees in turns if abs(degrees) > _STILL]
        moves += ["--spin optimise"] if self.spins else []
        said = "reaches" if self.holds else f"does not suffice: {errors(self.findings)[0].code}"
        left = [f"{abs(value):.1f} {unit} {_SPARE[value >= 0]}" for unit, value in self.spare().items()]
        return f"{', '.join(moves) or 'where it is'}: {said}, {', '.join(left)}"

    def spare(self) -> dict[str, float]:
        """The least proven margin of all checks that prevent posting, by unit: mm and degrees; negative if violated."""
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
    progress: Progress = no_progress,
) -> tuple[FoundPlace | None, Diagnostics]:
    """Search for a place at which the machine can follow a program.

    Args:
        program: cutter locations in {C}.
        options: work offset, spin and compensation, and the set-up.
        free: letters of x, y, z, a, b and c in which the workpiece may be moved.
        starts: number of starts of the first search.
        executor: distributes the climbs; by default they run in this process.
        progress: called a few times a second, with ``PLACE_STEP``; an exception from it ends the search.

    Returns:
        The first place that passes, else the last one tried, or None if the program cannot be placed; and the
        diagnostics.
    """
    placed, diagnostics = trajectory_of(program, machine, replace(options, spin=ZERO_TORSION))
    if placed is None:
        return None, diagnostics
    setup, faults = effective_setup(options, program)
    if errors(faults):
        return None, (*diagnostics, *faults)
    of_machine = placed.operation >= len(program.operations)  # moves to and from tool changes
    found, judged = None, 0
    with checkpoints(beat(lambda _share: progress(PLACE_STEP, judged / (judged + _PLACES)))):
        for count in (starts, max(starts, _MORE_STARTS)):
            positions = good_positions(placed, machine, free, of_machine, count, executor)
            for position, spin in _candidates(positions[:_MOST_JUDGED], options.spin):
                chosen = replace(options, work_offset=_as_typed(position.machine_from_work), spin=spin)
                moved, diagnostics = trajectory_of(program, machine, chosen, executor)
                if moved is None:
                    return None, diagnostics
                checked, findings = check_path_of(moved, machine, setup, options.tolerances)
                turn = (np.degrees(position.move[3:]) + 180.0) % 360.0 - 180.0
                found = FoundPlace(chosen, position.move[:3], turn, spin is not options.spin, checked, findings)
                judged += 1
                if found.holds:
                    return found, ()
    return found, ()


def may_be_mended(diagnostics: Sequence[Diagnostic]) -> bool:
    """Whether there are errors and another place of the workpiece may cure them all."""
    return bool(errors(diagnostics)) and {each.code for each in errors(diagnostics)} <= MENDED_BY_A_PLACE


def place_offer(diagnostics: Sequence[Diagnostic], subject: str) -> str:
    """Hint of the command line if another place may cure a refusal; else empty.

    Args:
        subject: the refused file, as the user named it.
    """
    if not may_be_mended(diagnostics):
        return ""
    return (
        f"{subject}: another place or spin may mend this. With the same options, `reach {subject} --place` looks for "
        "one, and says by how much to shift and turn the part, and what is left there; so does `post` with --find-place"
    )


def place_options(found: FoundPlace, places: Mapping[str, Array] = _ONE_PLACE) -> list[str]:
    """The options of the command line, and of a job, that post a program at a place.

    Args:
        found: the place.
        places: poses in {C} of the fixtures of a job, (4, 4) by name; the first is the work offset, the others move
            with it.

    Returns:
        The options; empty if an offset rotates about another axis than z, which no option can state.
    """
    offset = work_offset_text(found.reach.trajectory.machine_from_work)
    origins = [work_offset_text(pose, f"{flag_of('origin')}={name}") for name, pose in list(places.items())[1:]]
    if not all(text.startswith("--") for text in (offset, *origins)):
        return []
    spin = [f"{flag_of('spin')}={found.options.spin.rule.value}"] if found.spins else []
    return [offset, *spin, *origins]


def place_found(
    program: Program, machine: Machine, options: Options, places: Mapping[str, Array], progress: Progress = no_progress
) -> str:
    """Search for a place; return the change, its result and the options to post with, as text.

    Args:
        program: cutter locations in {C}.
        options: work offset, spin and compensation, and the set-up.
        places: as ``place_options``.
        progress: as ``find_place``.

    Raises:
        Refused: the program cannot be placed.
    """
    found = required(*find_place(program, machine, options, progress=progress))
    if not found.holds:
        return f"no place was found; the last that was tried: {found.text()}"
    stated = " ".join(place_options(found, places))
    if stated:
        return f"{found.text()}; with the same options and {stated}"
    return f"{found.text()}; with this work offset in the machine file:\n{found.reach.trajectory.machine_from_work}"


def _candidates(
    positions: Sequence[WorkpiecePosition], spin: SpinPolicy
) -> Iterator[tuple[WorkpiecePosition, SpinPolicy]]:
    """Yield positions with the spin of the user, best first, then the best one with an optimised spin."""
    for position in positions:
        yield position, spin
    if spin.rule not in (SpinRule.OPTIMISED, SpinRule.FILE):
        yield positions[0], SpinPolicy(SpinRule.OPTIMISED)


def _as_typed(offset: Array) -> Array:
    """A work offset, rounded as in ``--work-offset``, if it rotates about z only."""
    if not np.allclose(offset[2, :3], [0.0, 0.0, 1.0]):
        return offset
    turn = np.radians(np.round(np.degrees(np.arctan2(offset[1, 0], offset[0, 0])), _DEGREES))
    rounded = np.eye(4)
    rounded[:2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    rounded[:3, 3] = np.round(offset[:3, 3], _MM)
    return rounded


def work_offset_text(machine_from_work: Array, flag: str = "--work-offset") -> str:
    """A work offset as an option accepts it, or as a matrix if it rotates about another axis than z."""
    x, y, z = machine_from_work[:3, 3]
    turn = turn_about_z(machine_from_work)
    if not np.isnan(turn):
        return f"{flag}={x:z.3f},{y:z.3f},{z:z.3f},{turn:z.4f}"
    return np.array2string(machine_from_work, precision=6, suppress_small=True)
