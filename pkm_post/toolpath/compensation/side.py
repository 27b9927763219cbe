# SPDX-License-Identifier: LGPL-2.1-or-later
"""Side: 2D cutter compensation resolved into tips beside the programmed contour.

Takes a program whose ``side_offset`` and ``plane`` define the compensation of each row; returns it with its tips moved
and its offsets zero, or diagnostics. mm, in {C}: compensation precedes symmetry and placement.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Diagnostic, Program, errors
from pkm_post.toolpath.compensation.compensated import compensated
from pkm_post.toolpath.compensation.contour import Elements, Role, elements_of
from pkm_post.toolpath.compensation.contour_gouge import gouges
from pkm_post.toolpath.compensation.joints import Joint
from pkm_post.toolpath.compensation.options import OffsetOptions
from pkm_post.toolpath.compensation.swallowed import Offsets, offsets_of

_DEFAULT = OffsetOptions()


def offset_contours(
    program: Program, options: OffsetOptions = _DEFAULT
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """Apply the 2D cutter compensation of a program.

    Args:
        program: its ``side_offset`` is the radius to keep to the left of the path, mm, negative to the right; the first
            row with an offset leads onto the contour, the first row without one that moves in the plane leads off it.
        options: rounding of corners, leads of contours, treatment of rows the tool is too large for.

    Returns:
        The program with ``side_offset`` 0, or None when a contour cannot be compensated; and the diagnostics.

    Raises:
        ValueError: a side offset is not finite.

    Source: [paper section 5.3, eq. 10, 11].
    """
    if not np.isfinite(program.side_offset).all():
        raise ValueError("offset_contours: expected finite side offsets, got NaN or infinity")
    if not program.side_offset.any():
        return program, ()
    elements, faults = elements_of(program)
    if faults:
        return None, faults
    if not len(elements):
        return replace(program, side_offset=np.zeros(len(program))), ()
    offsets = offsets_of(elements, options)
    told = _swallowed(program, elements, offsets, options)
    if errors(told):
        return None, told
    moved, source, extra = compensated(program, elements, offsets)
    leads = _leads(program, elements, offsets, source, extra)
    told = (*told, *gouges(program, elements, moved, source, leads, options.tolerance))
    return (None if errors(told) else moved), told


def _swallowed(
    program: Program, elements: Elements, offsets: Offsets, options: OffsetOptions
) -> tuple[Diagnostic, ...]:
    """A diagnostic for every run of removed rows; an error where removal is not allowed, or nothing is left."""
    left = np.zeros(len(elements), dtype=np.int64)
    np.add.at(left, elements.contour, offsets.kept & (elements.role == Role.CUT))
    refused = (options.swallowed == "refuse") | (left[elements.contour] == 0)
    gone = ~offsets.kept
    first = np.flatnonzero(gone & np.append(True, ~gone[:-1])[: len(gone)])
    last = np.flatnonzero(gone & np.append(~gone[1:], True)[: len(gone)])
    return tuple(
        Diagnostic(
            "N202" if refused[i] else "N203", program.place(int(elements.row[i])), _gone(program, elements, i, j)
        )
        for i, j in zip(first.tolist(), last.tolist(), strict=True)
    )


def _gone(program: Program, elements: Elements, first: int, last: int) -> str:
    """Description of a run of elements that the tool is too large for."""
    tool = f"tool radius {abs(elements.offset[first]):g} mm"
    if last > first:
        return f"{tool}, {last - first + 1} blocks up to line {program.line[elements.row[last]]}"
    if elements.turn[first]:
        return f"{tool}, arc of radius {np.linalg.norm(elements.spoke[first, 0]):.6g} mm"
    return f"{tool}, line of {elements.length[first]:.6g} mm"


def _leads(program: Program, elements: Elements, offsets: Offsets, source: Array, extra: Array) -> Array:
    """Rows of the new program before a contour is cut, after it, or where it changes its side, (K,)."""
    role = np.full(len(program), Role.CUT)
    role[elements.row] = elements.role
    joint = np.full(len(program), Joint.STRAIGHT_ON)
    joint[elements.row] = offsets.kind
    first_cut = np.zeros(len(program), dtype=np.bool_)
    first_cut[elements.row[1:]] = elements.role[:-1] == Role.START
    to_or_from = extra & (first_cut | (joint == Joint.SWITCHED))[source]
    leads: Array = (role[source] != Role.CUT) | to_or_from
    return leads
