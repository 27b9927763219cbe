# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cutter contact: converts a program of contact points to tool tips; the moves around the cuts follow.

Takes a program of lines and rapid moves, with the surface normal at every row that ends on a face; returns the program
of the tool, or its faults. A row that ends on no face moves with its guide, a row that does: ``guide_rows`` finds it. A
lead takes its guide's shift and keeps its shape. A rapid move takes it sideways and upwards, never downwards: it stays
at least as high as it was. Lengths in mm, in one frame with z upwards.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, angle_between, cross, dot, norm
from pkm_post.model import Diagnostic, Diagnostics, Kind, Phrase, Program
from pkm_post.toolpath import AxisRule, Cutter, tip_from_contact, tool_axes

_SHORTEST = 1e-6
"""A move shorter than this, in mm, has no feed direction."""
_PARALLEL = 1e-6
"""Sine of the angle between normal and tool axis below which the bottom of the cutter lies flat on the surface."""


_STEEP = 1e-6
"""A rapid move with less horizontal travel than this, in mm, is vertical."""


@dataclass(frozen=True)
class Compensation:
    """Rule for computing tool tips from contact points.

    Attributes:
        stock: allowance left on the surface, mm; negative to cut below it.
        chord_tolerance: largest deviation of the tool from the surface, in mm, where normal or axis turns between two
            points.
        lean: lean of the tool from the normal; None to keep the axes of the program.
    """

    cutter: Cutter
    stock: float = 0.0
    chord_tolerance: float = 0.05
    lean: AxisRule | None = None


def guide_rows(program: Program, touching: Array, lead_length: float) -> tuple[Array, Array]:
    """Find the row that each row moves with.

    Touching rows are their own guides. A feed move between a rapid move and a cut, up to ``lead_length`` along the
    path from it, is a lead and moves with the nearest row of that cut. Vertical rapid moves after a cut move with the
    cut, and so does the first in any direction if more follow; all others move with the next cut.

    Args:
        program: lines and rapid moves, N rows.
        touching: (N,) which rows end on a face.
        lead_length: largest length of a lead, mm.

    Returns:
        The guides (N,), -1 for rows without one; and a mask of the feed moves that neither touch nor are leads, (N,).
    """
    row, rapid = np.arange(len(program)), (program.kind == Kind.RAPID) & ~touching
    before, after = _latest(touching), _next(touching)
    since, until = _latest(rapid), _next(rapid)
    travelled = np.cumsum(norm(np.diff(program.position, axis=0, prepend=program.position[:1])))
    leads_in = (after < until) & (before <= since) & (travelled[np.minimum(after, row[-1:])] - travelled <= lead_length)
    leads_out = (before > since) & (until <= after) & (travelled - travelled[np.maximum(before, 0)] <= lead_length)
    backwards = np.where(rapid, _belongs_to_previous_cut(program, rapid), leads_out) & (before >= 0)
    guide = np.where(backwards | (after == len(row)), before, after)
    off_face = ~touching & ~rapid & ~leads_in & ~leads_out
    return np.where(touching, row, guide), off_face


def _belongs_to_previous_cut(program: Program, rapid: Array) -> Array:
    """Mask of the rapid moves that belong to the preceding cut, (N,)."""
    row = np.arange(len(rapid))
    sideways = np.hypot(*np.diff(program.position[:, :2], axis=0, prepend=program.position[:1, :2]).T) > _STEEP
    turns = np.cumsum(rapid & sideways)
    last_cut = _latest(~rapid)
    first_of_several = (last_cut == row - 1) & np.append(rapid[1:], False)
    leaves: Array = (last_cut >= 0) & ((turns == turns[np.maximum(last_cut, 0)]) | first_of_several)
    return leaves


def _latest(marked: Array) -> Array:
    """Index of the last marked row up to each row, (N,), -1 if there is none."""
    latest: Array = np.maximum.accumulate(np.where(marked, np.arange(len(marked)), -1))
    return latest


def _next(marked: Array) -> Array:
    """Index of the first marked row from each row on, (N,), N if there is none."""
    following: Array = np.minimum.accumulate(np.where(marked, np.arange(len(marked)), len(marked))[::-1])[::-1]
    return following


def compensate_contacts(
    program: Program, normals: Array, guide: Array, rule: Compensation
) -> tuple[Program | None, Diagnostics]:
    """Compute the program of the tool.

    Args:
        program: lines and rapid moves, N rows.
        normals: (N, 3) unit surface normals towards the tool, NaN in rows that touch nothing.
        guide: (N,) the row that each row moves with, from ``guide_rows``, -1 for none.
        rule: rule for computing tips from contact points.

    Returns:
        The program, or None when it cannot be compensated; and the diagnostics: N101 to N106, N113, N114.
    """
    rows = np.flatnonzero(np.isfinite(normals).all(axis=1))
    n = normals[rows]
    axes = _tool_axes(program, rows, n, rule.lean) if rule.lean else program.tool_axis[rows]
    without_axis = rows[np.isnan(axes).any(axis=1)]
    if len(without_axis):
        place = program.place(int(without_axis[0]))
        return None, (Diagnostic("N114", place, Phrase("{} points, this the first", len(without_axis))),)
    offsets, diagnostics = _offsets(program, rows, n, axes, rule)
    if offsets is None:
        return None, diagnostics
    faults = _chord_faults(program, rows, n, offsets, axes, rule)
    if faults:
        return None, (*diagnostics, *faults)
    return _shifted(program, rows, guide, offsets + rule.stock * n, axes, rule), diagnostics


def _offsets(
    program: Program, rows: Array, normals: Array, axes: Array, rule: Compensation
) -> tuple[Array | None, Diagnostics]:
    """Tips relative to the surface with its allowance, (n, 3), or None; and the faults.

    In a cut across a plane the bottom of the cutter lies flat on the surface throughout, and any position of the tool
    over the contact points is valid: the points are then taken to lie on its axis, as in any other operation.
    """
    cutter, surface = rule.cutter, program.position[rows] + rule.stock * normals
    cut = np.cumsum(np.diff(rows, prepend=rows[:1]) > 1)
    leans = norm(cross(normals, axes)) > _PARALLEL
    flat = (np.bincount(cut, leans) == 0)[cut] & (cutter.bottom_angle == 0.0)
    offsets = cutter.corner_radius * normals - cutter.axial_offset * axes
    rest = np.flatnonzero(~flat | (dot(normals, axes) < 0))
    tips, faults = tip_from_contact(surface[rest], normals[rest], axes[rest], cutter)
    places = [program.place(row) for row in rows[rest].tolist()]
    diagnostics = tuple(dataclasses.replace(each, place=places[each.place.line - 1]) for each in faults)
    if tips is None:
        return None, diagnostics
    offsets[rest] = tips - surface[rest]
    return offsets, diagnostics


def _shifted(program: Program, rows: Array, guide: Array, shifts: Array, axes: Array, rule: Compensation) -> Program:
    """The program with its rows shifted by their guides, and with the guides' axes if the tool leans."""
    shift, axis = np.zeros((len(program) + 1, 3)), np.vstack([program.tool_axis, [0.0, 0.0, 1.0]])
    shift[rows], axis[rows] = shifts, axes
    shift, axis = shift[guide], np.where((guide < 0)[:, None], program.tool_axis, axis[guide])
    touching = np.isin(np.arange(len(program)), rows)
    high = (program.kind == Kind.RAPID) & ~touching
    shift[high, 2] = np.maximum(shift[high, 2], 0.0)
    return dataclasses.replace(
        program, position=program.position + shift, tool_axis=axis if rule.lean else program.tool_axis
    )


def _tool_axes(program: Program, rows: Array, normals: Array, lean: AxisRule) -> Array:
    """Tool axes of the touching rows, (n, 3); NaN where lead and tilt need a feed direction and there is none."""
    along = np.diff(program.position[rows], axis=0)
    length = norm(along)[:, None]
    joined = (np.diff(rows) == 1)[:, None] & (length > _SHORTEST)
    along = np.where(joined, along / np.maximum(length, _SHORTEST), 0.0)
    arriving, departing = np.vstack([np.zeros((1, 3)), along]), np.vstack([along, np.zeros((1, 3))])
    travel = arriving + departing
    turned_back = (norm(travel) < _SHORTEST) & (norm(arriving) > 0.0)
    axes, _ = tool_axes(normals, np.where(turned_back[:, None], arriving, travel), lean)
    return axes


def _chord_faults(
    program: Program, rows: Array, normals: Array, offsets: Array, axes: Array, rule: Compensation
) -> list[Diagnostic]:
    """Report where the tool leaves the surface between one tip and the next.

    Halfway the tip is at the midpoint of both, as if normal, direction to the axis and axis were the means of those at
    both ends; these are shorter than the unit vectors that would keep the cutter in contact.
    """
    cutter = rule.cutter
    sideways = offsets - cutter.corner_radius * normals + cutter.axial_offset * axes
    corner, bottom = (cutter.corner_radius + rule.stock) * normals, cutter.axial_offset * axes
    off = norm(_chord_deficit(corner) + _chord_deficit(sideways) - _chord_deficit(bottom))
    far = (off > rule.chord_tolerance) & (np.diff(rows) == 1) & (program.kind[rows[1:]] == Kind.LINE)
    if not far.any():
        return []
    first, more = int(np.argmax(far)), int(far.sum()) - 1
    turns = [np.degrees(angle_between(units[first], units[first + 1])) for units in (normals, axes)]
    text = "the normal by {:.3g}, the axis by {:.3g} degrees; halfway the tool would be {:.3g} mm off the surface"
    found = text.format(*turns, off[first]) + (f", and {more} more like it" if more else "")
    return [Diagnostic("N113", program.place(int(rows[first + 1])), found)]


def _chord_deficit(vectors: Array) -> Array:
    """Difference between the means of successive vectors and vectors of full length, (n - 1, 3)."""
    mean, length = (vectors[1:] + vectors[:-1]) / 2, norm(vectors[1:])[:, None]
    short = norm(mean)[:, None]
    opposite = short <= _SHORTEST * length
    deficit: Array = np.where(opposite, vectors[1:], mean * (length / np.where(opposite, 1.0, short) - 1.0))
    return deficit
