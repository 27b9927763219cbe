# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact path: cutter contact points of passes in surface parameters, as columns, and their trimming to the face.

The tool travels the rows of one run consecutively on the surface; between runs it is lifted. Rows of a link join two
passes of a run. The border between a point inside the face and its neighbour outside is found by bisection; features
narrower than the point spacing are missed.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from pkm_post.geometry import Array, cross, dot
from pkm_post.toolpath.surface.surface import ParameterRange, Surface, SurfaceSamples

_ROUNDS = 8
"""Newton steps to a plane: each squares the error."""
_ON_PLANE = 1e-9
_STEEP = 1e-6
"""Relative slope of the surface against a plane below which it counts as parallel to it."""
_HALVINGS = 40


@dataclass(frozen=True)
class ContactPath:
    """Columns of N points, in the order of travel within each pass.

    Attributes:
        u: (N,) first parameter; continues beyond the range if that is closed.
        v: (N,) second parameter.
        number: (N,) number of the pass, counted in the direction of the stepover.
        run: (N,) number of the run, travelled without lifting the tool; rows of one run are contiguous.
        sense: (N,) 1 where the feed has the direction of the pattern, -1 where it is opposite.
        link: (N,) completed share of a link at this row, NaN where the row belongs to a pass.
    """

    u: Array
    v: Array
    number: Array
    run: Array
    sense: Array
    link: Array

    @classmethod
    def of(cls, u: Array, v: Array, number: Array, run: Array | None = None) -> ContactPath:
        """A path in the direction of the pattern; each pass is a run unless runs are given."""
        rows = len(u)
        return cls(u, v, number, number if run is None else run, np.ones(rows), np.full(rows, np.nan))

    def __len__(self) -> int:
        return len(self.u)

    def take(self, rows: Array) -> ContactPath:
        """The rows selected by indices or a mask."""
        return ContactPath(*(getattr(self, column.name)[rows] for column in fields(self)))

    @staticmethod
    def concatenate(parts: list[ContactPath]) -> ContactPath:
        """Concatenated paths; their runs keep their numbers."""
        return ContactPath(
            *(np.concatenate([getattr(part, item.name) for part in parts]) for item in fields(ContactPath))
        )

    def with_rows(self, behind: Array, rows: ContactPath) -> ContactPath:
        """The path with additional rows, each directly after the row with the given index, in order."""
        return ContactPath(
            *(np.insert(getattr(self, item.name), behind + 1, getattr(rows, item.name)) for item in fields(self))
        )

    def with_runs(self, run: Array) -> ContactPath:
        """The path with the given runs."""
        return replace(self, run=run)


@dataclass(frozen=True)
class PassPattern:
    """The lines of the passes: constant v, or sections by parallel planes.

    Attributes:
        plane: (3,) unit normal of the planes; None for lines along u.
        level: (P,) position of each pass along that normal, mm; its v for lines along u.
    """

    plane: Array | None
    level: Array

    def direction(self, samples: SurfaceSamples) -> Array:
        """Tangents along the lines, (N, 3), of any length: with rising u, or n x plane, its normal to the right."""
        return samples.along_u if self.plane is None else cross(samples.normal, self.plane)

    def snap(self, surface: Surface, u: Array, v: Array, number: Array) -> tuple[Array, Array]:
        """The nearest points on the lines of the passes with the given numbers, (N,) each.

        On a border of the surface a point stays on that border.
        """
        if self.plane is None:
            return u, v
        for _ in range(_ROUNDS):
            samples = surface.at(u, v)
            off = dot(samples.point, self.plane) - self.level[number]
            if not np.any(np.abs(off) > _ON_PLANE):
                break
            step_u, step_v = _to_plane(samples, self.plane, off, _free(surface.u, u), _free(surface.v, v))
            u, v = surface.u.clamp(u + step_u), surface.v.clamp(v + step_v)
        return u, v


def _free(span: ParameterRange, values: Array) -> Array:
    """Values that are not at an end of an open range."""
    if span.closed:
        return np.ones(len(values), dtype=bool)
    return (values > span.first) & (values < span.last)


def _to_plane(samples: SurfaceSamples, plane: Array, off: Array, free_u: Array, free_v: Array) -> tuple[Array, Array]:
    """Newton steps in u and v along the slope of the surface, in its metric, to distance 0 from the plane."""
    slope_u, slope_v = dot(samples.along_u, plane) * free_u, dot(samples.along_v, plane) * free_v
    scale_u, scale_v = (np.maximum(dot(each, each), 1e-300) for each in (samples.along_u, samples.along_v))
    steepness = slope_u**2 / scale_u + slope_v**2 / scale_v
    factor = np.where(steepness > _STEEP**2, -off / np.maximum(steepness, _STEEP**2), 0.0)
    return factor * slope_u / scale_u, factor * slope_v / scale_v


def trimmed(surface: Surface, pattern: PassPattern, path: ContactPath) -> ContactPath:
    """The pieces of a path on the face, each a run with its ends on the border.

    The inside of ``surface`` is the face; ``pattern`` has the lines on which points are settled.
    """
    if not len(path):
        return path
    inside = surface.contains(path.u, path.v)
    crossing = np.flatnonzero((inside[:-1] != inside[1:]) & (path.run[:-1] == path.run[1:]))
    whole = path.with_rows(crossing, _border(surface, pattern, path, crossing, inside))
    kept = np.insert(inside, crossing + 1, True)
    cut = (whole.run[:-1] != whole.run[1:]) | ~kept[:-1] | ~kept[1:]
    return whole.with_runs(np.concatenate([[0], np.cumsum(cut)])).take(kept)


def _border(surface: Surface, pattern: PassPattern, path: ContactPath, crossing: Array, inside: Array) -> ContactPath:
    """The last points inside between the rows at the crossings and the next rows."""
    before, after = path.take(crossing), path.take(crossing + 1)
    within = inside[crossing]
    near_u, near_v = np.where(within, before.u, after.u), np.where(within, before.v, after.v)
    far_u, far_v = np.where(within, after.u, before.u), np.where(within, after.v, before.v)
    for _ in range(_HALVINGS):
        u, v = pattern.snap(surface, (near_u + far_u) / 2, (near_v + far_v) / 2, before.number)
        held = surface.contains(u, v)
        near_u, near_v = np.where(held, u, near_u), np.where(held, v, near_v)
        far_u, far_v = np.where(held, far_u, u), np.where(held, far_v, v)
    return replace(before, u=near_u, v=near_v)


def thinned(path: ContactPath, every: int) -> ContactPath:
    """The first and last row of each run and every n-th between: trimming needs more points than stepping."""
    if not len(path):
        return path
    rows = np.arange(len(path))
    begins = np.concatenate([[True], path.run[1:] != path.run[:-1]])
    since = rows - np.maximum.accumulate(np.where(begins, rows, 0))
    return path.take(begins | np.concatenate([begins[1:], [True]]) | (since % every == 0))
