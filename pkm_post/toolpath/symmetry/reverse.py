# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reversal: a program with its passes reversed, so climb milling stays climb milling after a mirror.

Takes and returns a program; no point is added. Each pass is reversed in itself, and the passes keep their order, so
depths are still cut from the top. Point columns stay with the points, feeds and arcs with their segments; an arc turns
about the opposite axis, and left of the path becomes right of it.

A closed pass keeps its approach and departure. An open pass is approached along its old departure path and left along
its old approach path. Downward moves take rapid and feed by height from the plunge, upward moves from the lift, so the
tool never reaches the start of such a pass by a rapid move.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.geometry import Array, dot
from pkm_post.model import PROGRAM_COLUMNS, Diagnostic, Diagnostics, Event, EventKind, Kind, Phrase, Program, errors
from pkm_post.toolpath.symmetry.leads import LEVEL, LeadPair, Rows, lead_pairs, unchanged_rows
from pkm_post.toolpath.symmetry.passes import LinkMoves, closed_passes, links, pass_rows, same_pose, without_plunges

_ANYWHERE = (EventKind.DWELL, EventKind.STOP)
"""Events allowed in the middle of a pass: they belong to a point."""
_POINT_COLUMNS = ("position", "tool_axis", "normal", "contact", "spin", "exact_stop", "side_offset", "smaller_tool")
"""Columns that describe the end of a row: on the row where compensation begins, only its end has the offset. All other
columns describe the path to that point."""
_POSE = ("position", "tool_axis")


def reversed_passes(program: Program) -> tuple[Program | None, Diagnostics]:
    """The program with every pass reversed, or the errors that prevent it (K122 to K125).

    Two reversals give the same program: ``docs/conventions.md`` states where a rapid move may stay a feed move.
    """
    runs = without_plunges(program, pass_rows(program))
    if not len(runs):
        return program, ()
    between, whole = links(program, runs), closed_passes(program, runs)
    leads = lead_pairs(program, runs, between, whole)
    parts = _parts(program, runs, between, whole, leads)
    faults = tuple(_faults(program, runs, parts, between, whole, leads))
    if errors(faults):
        return None, faults
    made = _taken(program, [part.rows for part in parts])
    sizes = np.cumsum([0, *(len(part.rows.path_row) for part in parts)]).tolist()
    begins = {(part.name, part.number): begin for part, begin in zip(parts, sizes, strict=False)}
    events = moved_events(program, len(made), runs, between, _unchanged(whole), begins)
    return dataclasses.replace(made, events=events), faults


def _parts(
    program: Program, runs: Array, between: list[LinkMoves], whole: Array, leads: Mapping[int, LeadPair]
) -> list[_RowGroup]:
    """The parts of the new program in order."""
    kept = _unchanged(whole)
    parts: list[_RowGroup] = []
    tip = -1
    for number, (first, behind) in enumerate(runs):
        before, after = between[number], between[number + 1]
        if number in leads:
            enter, leave, top, end = leads[number].exchanged()
        else:
            enter, leave = unchanged_rows(program, before.approach), unchanged_rows(program, after.departure)
            top = int(before.approach[0] if len(before.approach) else first) - 1
            end = int(after.departure[-1] if len(after.departure) else behind - 1)
        travel = unchanged_rows(program, before.travel) if kept[number] else _to(program, before, tip, top, number == 0)
        tip = end
        way = np.arange(behind - 1, first - 1, -1)
        parts += [
            _RowGroup("travel", number, travel),
            _RowGroup("enter", number, enter),
            _RowGroup("pass", number, Rows(way - 1, way, program.feed[way], back=True)),
            _RowGroup("leave", number + 1, leave),
        ]
    return [*parts, _RowGroup("travel", len(runs), unchanged_rows(program, between[-1].travel))]


@dataclass(frozen=True)
class _RowGroup:
    """Rows that stay together in the new program.

    Attributes:
        name: "leave", "travel", "enter" of the link with this number, or "pass".
        number: number of the link or the pass.
        rows: its rows.
    """

    name: str
    number: int
    rows: Rows


def _unchanged(whole: Array) -> Array:
    """Links between closed passes, (P + 1,)."""
    return np.append(True, whole) & np.append(whole, True)


def _to(program: Program, link: LinkMoves, tip: int, top: int, at_start: bool) -> Rows:
    """One rapid move to the point above a pass, none if the tool is already there.

    At the start of the program, rows before the old point above the pass are kept.
    """
    if not at_start and same_pose(program, tip, top):
        return unchanged_rows(program, link.travel[:0])
    kept = link.travel[:-1] if at_start else link.travel[:0]
    way = np.append(kept, link.travel[-1] if len(link.travel) else top)
    return Rows(np.append(kept, top), way, np.append(program.feed[kept], np.nan))


def _faults(
    program: Program,
    runs: Array,
    parts: list[_RowGroup],
    between: list[LinkMoves],
    whole: Array,
    leads: Mapping[int, LeadPair],
) -> Iterator[Diagnostic]:
    sizes = {(part.name, part.number): len(part.rows.path_row) for part in parts}
    for number in (np.flatnonzero(~_unchanged(whole)[1:-1]) + 1).tolist():
        lost = _lost(program, between[number], sizes["leave", number], sizes["enter", number])
        if lost:
            yield Diagnostic("K122", program.place(int(runs[number, 0])), lost)
    if not sizes["enter", 0] and not whole[0]:
        # Only a path that already starts in the material may start in it at its other end.
        code = "K122" if len(between[0].approach) else "K123"
        yield Diagnostic(
            code, program.place(int(runs[0, 1]) - 1), Phrase("no lift leads away from the end of this pass")
        )
    for number in np.flatnonzero(~whole).tolist():
        first, behind = runs[number].tolist()
        if not leads[number].is_high():
            yield Diagnostic(
                "K122", program.place(behind - 1), Phrase("the lift from this pass ends below where rapid moves went")
            )
        down = float(dot(program.position[first - 1] - program.position[behind - 1], program.tool_axis[first]))
        if down > LEVEL:
            yield Diagnostic("K124", program.place(first), f"{down:.3f} mm")
    yield from _misplaced_events(program, runs)


def _lost(program: Program, link: LinkMoves, leaving: int, entering: int) -> str:
    """The reason why the tool cannot reach the next reversed pass, or an empty string."""
    if not np.any(program.kind[link.rows] == Kind.RAPID):
        return "no rapid move leads to this pass"
    if not leaving or not entering:
        return "the tool is not lifted before this pass, or not lowered to it"
    if len(link.travel) > 1:
        return "the rapid way to this pass has corners"
    return ""


def _misplaced_events(program: Program, runs: Array) -> Iterator[Diagnostic]:
    """K125 for events that change a state in the middle of a pass: reversed, it would apply to other segments."""
    for event in program.events:
        number = int(np.searchsorted(runs[:, 0], event.row)) - 1
        if number >= 0 and event.row < runs[number, 1] and event.kind not in _ANYWHERE:
            yield Diagnostic("K125", program.place(event.row), event.kind.name.lower().replace("_", " "))


def _taken(program: Program, parts: list[Rows]) -> Program:
    """The rows of all parts as a program, still with the old events."""
    end_row = np.concatenate([part.end_row for part in parts])
    path_row = np.concatenate([part.path_row for part in parts])
    feed = np.concatenate([part.feed for part in parts])
    back = np.repeat([part.back for part in parts], [len(part.path_row) for part in parts])
    names = PROGRAM_COLUMNS.keys() - {*_POINT_COLUMNS}
    columns: dict[str, Any] = {name: getattr(program, name)[path_row] for name in names}
    columns |= {name: getattr(program, name)[end_row] for name in _POINT_COLUMNS}
    columns |= {
        name: np.concatenate([part.poses(program)[number] for part in parts]) for number, name in enumerate(_POSE)
    }
    arc = back & (columns["kind"] == Kind.ARC)
    columns["kind"] = np.where(arc, Kind.ARC, np.where(np.isnan(feed), Kind.RAPID, Kind.LINE))
    columns["feed"] = feed
    columns["arc_centre"] = np.where(arc[:, None], columns["arc_centre"], np.nan)
    columns["arc_axis"] = np.where(arc[:, None], -columns["arc_axis"], np.nan)
    columns["side_offset"] = np.where(back, -1.0, 1.0) * columns["side_offset"] + 0.0
    return dataclasses.replace(program, **columns, events=())


def moved_events(
    program: Program,
    rows: int,
    runs: Array,
    between: Sequence[LinkMoves],
    kept: Array,
    begins: Mapping[tuple[str, int], int],
) -> tuple[Event, ...]:
    """The events at their new rows: within a pass at their point, between two passes after the lift.

    Args:
        program: the old one.
        rows: number of rows of the new program.
        runs: (P, 2) the old passes.
        between: the P + 1 old links.
        kept: (P + 1,) unchanged links.
        begins: first row of each part of the new program.
    """
    moved = []
    for event in program.events:
        old, number = event.row, int(np.searchsorted(runs[:, 0], event.row))
        if old in (0, len(program)):
            new = 0 if old == 0 else rows
        elif number and old < runs[number - 1, 1]:
            new = begins["pass", number - 1] + int(runs[number - 1, 1]) - old
        elif kept[number]:
            link = between[number]
            same = np.concatenate([link.departure, link.travel, link.approach])
            new = begins.get(("leave", number), 0) + int(np.sum(same < old))
        else:
            new = begins["travel", number] + (min(old, len(between[0].travel)) if number == 0 else 0)
        moved.append(dataclasses.replace(event, row=new))
    return tuple(sorted(moved, key=lambda event: event.row))
