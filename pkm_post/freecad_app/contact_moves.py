# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact moves: a program of contact points becomes one of tool tips, and the moves around the cuts follow.

A program of lines and rapid moves enters, with the surface normal at every row that ends on a face; the program for the
tool leaves, or what is wrong with it. A row that ends on no face moves along with its guide, one that does. A lead
moves as its guide does, and keeps its shape. A rapid move does so sideways and upwards, never downwards: it stays as
high as it was, or higher. Lengths in mm, in one frame with z upwards.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.compensation import Cutter, tip_from_contact
from pkm_post.geometry import angle_between, dot, norm
from pkm_post.geometry.vectors import cross
from pkm_post.model import Diagnostic, Kind, Program
from pkm_post.surface_path.tool_axis import AxisRule, tool_axes

Array = np.ndarray[Any, np.dtype[Any]]

_STANDING = 1e-6
"""A move shorter than this, in mm, has no direction of travel."""
_PARALLEL = 1e-6
"""Sine of the angle between normal and tool axis below which the bottom of the cutter lies on the surface."""


@dataclass(frozen=True)
class Compensation:
    """How tips follow from contact points.

    Attributes:
        cutter: the cutter.
        stock: what is left on the surface, mm; negative to go below it.
        chord_tolerance: how far the tool may leave the surface, in mm, where the normal or the axis turns between two
            points.
        lean: how the tool leans from the normal; None to keep the axes of the program.
    """

    cutter: Cutter
    stock: float = 0.0
    chord_tolerance: float = 0.05
    lean: AxisRule | None = None


def compensated(
    program: Program, normals: Array, guide: Array, rule: Compensation
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """The program for the tool.

    Args:
        program: lines and rapid moves, N rows.
        normals: (N, 3) unit surface normals towards the tool, NaN in rows that touch nothing.
        guide: (N,) the row that each row moves with, as ``contact_guides.guides`` gives them, -1 for none.
        rule: how tips follow from contact points.

    Returns:
        The program, or None when it cannot be compensated; and the diagnostics: N101 to N106, N113, N114.
    """
    rows = np.flatnonzero(np.isfinite(normals).all(axis=1))
    n = normals[rows]
    axes = _leaning(program, rows, n, rule.lean) if rule.lean else program.tool_axis[rows]
    lost = rows[np.isnan(axes).any(axis=1)]
    if len(lost):
        return None, (Diagnostic("N114", program.place(int(lost[0])), f"{len(lost)} points, this the first"),)
    offsets, diagnostics = _offsets(program, rows, n, axes, rule)
    if offsets is None:
        return None, diagnostics
    off = _off_between(program, rows, n, offsets, axes, rule)
    if off:
        return None, (*diagnostics, *off)
    return _moved(program, rows, guide, offsets + rule.stock * n, axes, rule), diagnostics


def _offsets(
    program: Program, rows: Array, normals: Array, axes: Array, rule: Compensation
) -> tuple[Array | None, tuple[Diagnostic, ...]]:
    """Tips from the surface with its stock, (n, 3), or None; and what is wrong.

    In a cut across a plane the bottom of the cutter lies on the surface all the way, and any place of the tool over the
    contact points does: then the points are those below its axis, as in any other operation.
    """
    cutter, surface = rule.cutter, program.position[rows] + rule.stock * normals
    cut = np.cumsum(np.diff(rows, prepend=rows[:1]) > 1)
    leans = norm(cross(normals, axes)) > _PARALLEL
    flat = (np.bincount(cut, leans) == 0)[cut] & (cutter.bottom_angle == 0.0)
    offsets = cutter.corner_radius * normals - cutter.axial_offset * axes
    rest = np.flatnonzero(~flat | (dot(normals, axes) < 0))
    tips, found = tip_from_contact(surface[rest], normals[rest], axes[rest], cutter)
    places = [program.place(row) for row in rows[rest].tolist()]
    diagnostics = tuple(dataclasses.replace(each, place=places[each.place.line - 1]) for each in found)
    if tips is None:
        return None, diagnostics
    offsets[rest] = tips - surface[rest]
    return offsets, diagnostics


def _moved(program: Program, rows: Array, guide: Array, shifts: Array, axes: Array, rule: Compensation) -> Program:
    """The program with its rows moved with their guides, and the axes of these if the tool leans."""
    shift, axis = np.zeros((len(program) + 1, 3)), np.vstack([program.tool_axis, [0.0, 0.0, 1.0]])
    shift[rows], axis[rows] = shifts, axes
    shift, axis = shift[guide], np.where((guide < 0)[:, None], program.tool_axis, axis[guide])
    touching = np.isin(np.arange(len(program)), rows)
    high = (program.kind == Kind.RAPID) & ~touching
    shift[high, 2] = np.maximum(shift[high, 2], 0.0)
    return dataclasses.replace(
        program, position=program.position + shift, tool_axis=axis if rule.lean else program.tool_axis
    )


def _leaning(program: Program, rows: Array, normals: Array, lean: AxisRule) -> Array:
    """Tool axes of the rows that touch, (n, 3); NaN where lead and tilt need a direction of travel and none is."""
    along = np.diff(program.position[rows], axis=0)
    length = norm(along)[:, None]
    joined = (np.diff(rows) == 1)[:, None] & (length > _STANDING)
    along = np.where(joined, along / np.maximum(length, _STANDING), 0.0)
    arriving, departing = np.vstack([np.zeros((1, 3)), along]), np.vstack([along, np.zeros((1, 3))])
    travel = arriving + departing
    turned_back = (norm(travel) < _STANDING) & (norm(arriving) > 0.0)
    axes, _ = tool_axes(normals, np.where(turned_back[:, None], arriving, travel), lean)
    return axes


def _off_between(
    program: Program, rows: Array, normals: Array, offsets: Array, axes: Array, rule: Compensation
) -> list[Diagnostic]:
    """What to tell where the tool leaves the surface on its way from one tip to the next.

    Half way the tip is in the middle of both, as if normal, direction to the axis and axis were the means of those at
    both ends; these are shorter than the unit vectors that would keep the cutter in contact.
    """
    cutter = rule.cutter
    sideways = offsets - cutter.corner_radius * normals + cutter.axial_offset * axes
    corner, bottom = (cutter.corner_radius + rule.stock) * normals, cutter.axial_offset * axes
    off = norm(_lacking(corner) + _lacking(sideways) - _lacking(bottom))
    far = (off > rule.chord_tolerance) & (np.diff(rows) == 1) & (program.kind[rows[1:]] == Kind.LINE)
    if not far.any():
        return []
    first, more = int(np.argmax(far)), int(far.sum()) - 1
    turns = [np.degrees(angle_between(units[first], units[first + 1])) for units in (normals, axes)]
    text = (
        "the normal by {:.3g}, the axis by {:.3g} degrees; half way the tool would be {:.3g} mm off the surface".format(
            *turns, off[first]
        )
    )
    return [
        Diagnostic("N113", program.place(int(rows[first + 1])), text + (f", and {more} more like it" if more else ""))
    ]


def _lacking(vectors: Array) -> Array:
    """What the means of successive vectors lack to be as long as these, (n - 1, 3)."""
    mean, length = (vectors[1:] + vectors[:-1]) / 2, norm(vectors[1:])[:, None]
    short = norm(mean)[:, None]
    opposite = short <= _STANDING * length
    lacking: Array = np.where(opposite, vectors[1:], mean * (length / np.where(opposite, 1.0, short) - 1.0))
    return lacking
