# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: precomputed data for a player to evaluate a segment; and the first segment of each source line.

Input: a trajectory. Output: the columns of a segment's record that follow from the others, mm and rad, and the table
of blocks. With them, the pose at a share u of the segment, from 0 to 1, is

    tip  = start_tip + u shift + (1 + u growth) (cos(u sweep) radius + sin(u sweep) quarter) - radius
    axis = cos(u angle) start_axis + sin(u angle) axis_quarter
    spin = start_spin + u (spin - start_spin)

for lines, arcs and helices alike, from a single record. [paper section 5.1: data for interpolation is computed in
advance]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array, across, cross, dot, norm, towards
from pkm_post.model import Kind, Trajectory
from pkm_post.writing.trajectory_file.layout import BLOCK, Records

TOLERANCE = 1e-6
"""mm and rad: tolerance between stored and recomputed values, as processors round differently."""
_RELATIVE_TOLERANCE = 1e-9
"""Tolerance relative to the value, for arcs of very large radius."""
_NO_RADIUS = 1e-9
"""mm: an arc that starts on its axis has no radius to grow."""


def interpolation(trajectory: Trajectory) -> dict[str, Array]:
    """The columns by their names in the record of a segment, each (N,) or (N, 3)."""
    start, axis = trajectory.tip_before(), trajectory.axis_before()
    way = trajectory.tip - start
    return {
        "start_tip": start,
        "start_axis": axis,
        "start_spin": trajectory.spin_before(),
        **_turning(trajectory, start, way),
        "axis_quarter": _axis_quarter(trajectory, axis),
    }


def _axis_quarter(trajectory: Trajectory, start: Array) -> Array:
    """The axis after a quarter turn, (N, 3); zero where it does not turn."""
    quarter = np.zeros_like(start)
    turns = np.flatnonzero(trajectory.angle > 0)
    quarter[turns] = _directions(towards(start[turns], trajectory.axis[turns]))
    return quarter


def _turning(trajectory: Trajectory, start: Array, way: Array) -> dict[str, Array]:
    """Columns of the tip: ``shift`` is the displacement of a line or the rise of a helix; the rest is zero on lines."""
    arc = trajectory.kind == Kind.ARC
    shift, radius, quarter = way.copy(), np.zeros_like(way), np.zeros_like(way)
    growth = np.zeros(len(way))
    turn, centre = trajectory.arc_axis[arc], trajectory.arc_centre[arc]
    shift[arc] = dot(way[arc], turn)[:, None] * turn
    radius[arc] = first = across(start[arc] - centre, turn)
    quarter[arc] = cross(turn, first)
    last = norm(across(trajectory.tip[arc] - centre, turn))
    size = norm(first)
    growth[arc] = np.divide(last - size, size, out=np.zeros(len(size)), where=size > _NO_RADIUS)
    return {"shift": shift, "radius": radius, "quarter": quarter, "growth": growth}


def _directions(vectors: Array) -> Array:
    """(N, 3) vectors normalized to unit length; zero vectors are unchanged."""
    length = norm(vectors)[:, None]
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def deviating_columns(trajectory: Trajectory, segments: Records) -> dict[str, Array]:
    """By column name, the segments whose stored value differs from the recomputed one, (N,)."""
    columns = interpolation(trajectory)
    # Weights of columns in the pose: a tiny turn, for example, has no well-defined direction.
    radius = np.where(trajectory.kind == Kind.ARC, norm(columns["radius"]), 1.0)
    turns = np.where(trajectory.angle > 0, trajectory.angle, 1.0)
    weights = {"growth": radius, "axis_quarter": turns}
    with np.errstate(all="ignore"):  # the file may contain any numbers
        found = {name: _apart(segments[name], column, weights.get(name, 1.0)) for name, column in columns.items()}
    return found | missed_ends(trajectory, columns)


def missed_ends(trajectory: Trajectory, columns: dict[str, Array]) -> dict[str, Array]:
    """Segments whose end a player would miss, (N,), by quantity, as with a wrong sweep or angle.

    A line always ends at its shift, by definition of the shift: only arcs and turns can end elsewhere. The speed of a
    player follows from the stated length of a segment. The trajectory violates no invariant.
    """
    off = {name: np.zeros(len(trajectory), dtype=np.bool_) for name in ("tip", "axis")}
    arcs = np.flatnonzero(trajectory.kind == Kind.ARC)
    length = norm(columns["shift"])
    length[arcs] = _arc_length(trajectory, arcs, columns)
    off["length"] = _apart(trajectory.length, length, 1.0)
    start, shift, radius, quarter, growth = (
        columns[name][arcs] for name in ("start_tip", "shift", "radius", "quarter", "growth")
    )
    tip = start + shift + (1 + growth[:, None]) * _turned(trajectory.sweep[arcs], radius, quarter) - radius
    off["tip"][arcs] = _apart(tip, trajectory.tip[arcs], 1.0)
    before = columns["start_axis"]
    x, y, z = (before != trajectory.axis).T
    turns = np.flatnonzero((trajectory.angle != 0) | x | y | z)
    axis = _turned(trajectory.angle[turns], before[turns], columns["axis_quarter"][turns])
    off["axis"][turns] = _apart(axis, trajectory.axis[turns], 1.0)
    return off


def _arc_length(trajectory: Trajectory, rows: Array, columns: dict[str, Array]) -> Array:
    """Lengths of arcs and helices, (M,) mm, with the mean of their radii at start and end."""
    last = norm(across(trajectory.tip[rows] - trajectory.arc_centre[rows], trajectory.arc_axis[rows]))
    radius = (norm(columns["radius"][rows]) + last) / 2
    return np.hypot(radius * trajectory.sweep[rows], norm(columns["shift"][rows]))


def _turned(angle: Array, start: Array, quarter: Array) -> Array:
    """Vectors (N, 3) turned by angles (N,), from the vectors and their quarter turns."""
    return np.cos(angle)[:, None] * start + np.sin(angle)[:, None] * quarter


def _apart(found: Array, computed: Array, weight: Array | float) -> Array:
    """Whether rows differ beyond the tolerance, (N,); NaN always differs."""
    if np.array_equal(found, computed):  # the usual case: written and read on the same processor
        return np.zeros(len(found), dtype=np.bool_)
    size = norm if computed.ndim > 1 else np.abs
    return ~(size(found - computed) * weight <= TOLERANCE + _RELATIVE_TOLERANCE * size(computed) * weight)


def blocks(trajectory: Trajectory) -> Records:
    """The first segment of every line of the source, ascending by operation and line, (B,) of ``layout.BLOCK``."""
    operation, line = trajectory.operation, trajectory.line
    other = np.ones(len(trajectory), dtype=np.bool_)
    np.not_equal(line[1:], line[:-1], out=other[1:])
    other[1:] |= operation[1:] != operation[:-1]
    begins = np.flatnonzero(other)
    keys = operation[begins].astype(np.int64)
    keys <<= 32
    keys |= line[begins]
    if not np.all(keys[1:] > keys[:-1]):  # lines repeat or are out of order
        _, first = np.unique(keys, return_index=True)
        begins = begins[first]
    del keys  # as large as the trajectory
    table: Records = np.zeros(len(begins), BLOCK)
    table["operation"], table["line"], table["segment"] = operation[begins], line[begins], begins
    return table
