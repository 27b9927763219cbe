# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation: what a player needs to evaluate a segment, computed in advance; and where each source line begins.

Enters: a trajectory. Leaves: the columns of a segment's record that follow from the others, mm and rad, and the table
of blocks. With them the pose at a share u of the segment, from 0 to 1, is

    tip  = start_tip + u shift + (1 + u growth) (cos(u sweep) radius + sin(u sweep) quarter) - radius
    axis = cos(u angle) start_axis + sin(u angle) axis_quarter
    spin = start_spin + u (spin - start_spin)

for lines, arcs and helices alike, from one record alone. [paper section 5.1: what interpolation needs is computed in
advance]
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import norm, towards
from pkm_post.geometry.arcs import across
from pkm_post.geometry.vectors import Array, cross, dot
from pkm_post.model import Kind, Trajectory
from pkm_post.trajectory_file.layout import BLOCK, Records

NEAR = 1e-6
"""mm and rad: how far what a file has may be from what is computed here, as other processors round otherwise."""
_NEAR_SHARE = 1e-9
"""The same as a share of the value, for arcs of very large radius."""
_NO_RADIUS = 1e-9
"""mm: an arc that begins on its axis has no radius that could grow."""


def interpolation(trajectory: Trajectory) -> dict[str, Array]:
    """The columns by the names they have in the record of a segment, each (N,) or (N, 3)."""
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
    """What a quarter turn makes of the axis, (N, 3); zero where it stands."""
    quarter = np.zeros_like(start)
    turns = np.flatnonzero(trajectory.angle > 0)
    quarter[turns] = _directions(towards(start[turns], trajectory.axis[turns]))
    return quarter


def _turning(trajectory: Trajectory, start: Array, way: Array) -> dict[str, Array]:
    """How the tip goes: ``shift`` is the whole way of a line and the rise of a helix, the rest is zero on lines."""
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
    """(N, 3) vectors at unit length; those of length 0 stay."""
    length = norm(vectors)[:, None]
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def strayed(trajectory: Trajectory, segments: Records) -> dict[str, Array]:
    """By the name of each column, the segments whose record has another value than is computed here, (N,).

    Args:
        trajectory: N segments that keep their promises.
        segments: (N,) their records.
    """
    columns = interpolation(trajectory)
    # What a column counts for in the pose: a tiny turn, for one, has no sure direction.
    radius = np.where(trajectory.kind == Kind.ARC, norm(columns["radius"]), 1.0)
    turns = np.where(trajectory.angle > 0, trajectory.angle, 1.0)
    weights = {"growth": radius, "axis_quarter": turns}
    with np.errstate(all="ignore"):  # the numbers in the file may be anything
        found = {name: _apart(segments[name], column, weights.get(name, 1.0)) for name, column in columns.items()}
    return found | missed(trajectory, columns)


def missed(trajectory: Trajectory, columns: dict[str, Array]) -> dict[str, Array]:
    """Segments that a player would not end where they say, (N,), by what is elsewhere: a wrong sweep or angle does it.

    A line ends where its shift takes it, and that is how the shift was computed: only arcs and turns can end elsewhere.
    But how fast a player goes follows from the length that a segment says.

    Args:
        trajectory: N segments that keep their promises.
        columns: what ``interpolation`` makes of them.
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
    """Vectors (N, 3) turned by angles (N,), of themselves and what a quarter turn makes of them."""
    return np.cos(angle)[:, None] * start + np.sin(angle)[:, None] * quarter


def _apart(found: Array, computed: Array, weight: Array | float) -> Array:
    """Whether rows are not near each other, (N,); NaN is near nothing."""
    if np.array_equal(found, computed):  # as it is where the same processor wrote and reads
        return np.zeros(len(found), dtype=np.bool_)
    size = norm if computed.ndim > 1 else np.abs
    return ~(size(found - computed) * weight <= NEAR + _NEAR_SHARE * size(computed) * weight)


def blocks(trajectory: Trajectory) -> Records:
    """The first segment of every line of the source, by rising operation and line, (B,) of ``layout.BLOCK``."""
    operation, line = trajectory.operation, trajectory.line
    other = np.ones(len(trajectory), dtype=np.bool_)
    np.not_equal(line[1:], line[:-1], out=other[1:])
    other[1:] |= operation[1:] != operation[:-1]
    begins = np.flatnonzero(other)
    keys = operation[begins].astype(np.int64)
    keys <<= 32
    keys |= line[begins]
    if not np.all(keys[1:] > keys[:-1]):  # a line comes again, or one from further up
        _, first = np.unique(keys, return_index=True)
        begins = begins[first]
    del keys  # as long as the trajectory
    table: Records = np.zeros(len(begins), BLOCK)
    table["operation"], table["line"], table["segment"] = operation[begins], line[begins], begins
    return table
