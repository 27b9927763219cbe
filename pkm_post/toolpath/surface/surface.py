# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface: interface of a face for patterns of passes, whatever its source.

Takes two functions of columns (u, v); returns points, normals and derivatives. Patterns handle a face of OpenCASCADE, a
formula in a test, and the same face with u and v exchanged in the same way. Units: mm; u and v have their own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.geometry import Array, cross, dot

NO_LENGTH = 1e-9
"""mm below which a line of the surface is a pole."""

_DIFFERENCE = 1e-4
"""Step of the finite difference of normals for a curvature, as a share of the range."""


@dataclass(frozen=True)
class ParameterRange:
    """The range of a parameter; if closed, its end coincides with its start."""

    first: float
    last: float
    closed: bool = False

    def __post_init__(self) -> None:
        if not self.first < self.last:
            raise ValueError(f"ParameterRange: expected first < last, got {self.first} and {self.last}")

    @property
    def width(self) -> float:
        """Difference of the last and the first value."""
        return self.last - self.first

    def normalise(self, values: Array) -> Array:
        """The values brought into the range: wrapped if it is closed, else clamped."""
        if self.closed:
            return self.first + np.mod(values - self.first, self.width)
        return np.clip(values, self.first, self.last)

    def clamp(self, values: Array) -> Array:
        """The values, clamped to an open range; in a closed range they may make many turns."""
        return values if self.closed else np.clip(values, self.first, self.last)


@dataclass(frozen=True)
class SurfaceSamples:
    """The surface at N pairs (u, v).

    Attributes:
        point: (N, 3) in mm.
        normal: (N, 3) unit normals, out of the material.
        along_u: (N, 3) derivatives of the point by u.
        along_v: (N, 3) derivatives of the point by v.
    """

    point: Array
    normal: Array
    along_u: Array
    along_v: Array


@dataclass(frozen=True)
class Surface:
    """A parametric surface, trimmed or not.

    Attributes:
        evaluate: from u (N,) and v (N,) to points, outward unit normals, derivatives by u and by v, (N, 3) each.
        inside: from u (N,) and v (N,) to whether they are on the face, (N,).
        u: range of the first parameter.
        v: range of the second one.
        points: from u (N,) and v (N,) to points only, (N, 3), where that is cheaper.
        normals: the same for outward unit normals.
    """

    evaluate: Callable[[Array, Array], tuple[Array, Array, Array, Array]]
    inside: Callable[[Array, Array], Array]
    u: ParameterRange
    v: ParameterRange
    points: Callable[[Array, Array], Array] | None = None
    normals: Callable[[Array, Array], Array] | None = None

    def at(self, u: Array, v: Array) -> SurfaceSamples:
        """The surface at columns of parameters; closed ones may exceed their range."""
        return SurfaceSamples(*self.evaluate(self.u.normalise(u), self.v.normalise(v)))

    def points_at(self, u: Array, v: Array) -> Array:
        """Points of the surface only, (N, 3) in mm."""
        pair = self.u.normalise(u), self.v.normalise(v)
        return self.points(*pair) if self.points else self.evaluate(*pair)[0]

    def normals_at(self, u: Array, v: Array) -> Array:
        """Outward unit normals only, (N, 3)."""
        pair = self.u.normalise(u), self.v.normalise(v)
        return self.normals(*pair) if self.normals else self.evaluate(*pair)[1]

    def oriented_at(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Points and outward unit normals without derivatives, (N, 3) each."""
        pair = self.u.normalise(u), self.v.normalise(v)
        return (self.points(*pair), self.normals(*pair)) if self.points and self.normals else self.evaluate(*pair)[:2]

    def contains(self, u: Array, v: Array) -> Array:
        """Mask of the pairs on the face, (N,)."""
        return np.asarray(self.inside(self.u.normalise(u), self.v.normalise(v)), dtype=bool)

    def swapped(self) -> Surface:
        """The same surface with u and v exchanged; the normals are unchanged."""

        def evaluate(u: Array, v: Array) -> tuple[Array, Array, Array, Array]:
            point, normal, along_u, along_v = self.evaluate(v, u)
            return point, normal, along_v, along_u

        return Surface(
            evaluate,
            lambda u, v: self.inside(v, u),
            self.v,
            self.u,
            _exchanged(self.points),
            _exchanged(self.normals),
        )


def _exchanged(columns: Callable[[Array, Array], Array] | None) -> Callable[[Array, Array], Array] | None:
    """The same columns with u and v exchanged."""
    return None if columns is None else lambda u, v: columns(v, u)


@dataclass(frozen=True)
class SurfaceGrid:
    """The surface at all pairs of u and v: columns are (M * N, ...), row by row of equal u, each made when it is used.

    Attributes:
        surface: the surface.
        u: (M,) evenly spaced over the range, both ends included.
        v: (N,) evenly spaced over the range, both ends included.
    """

    surface: Surface
    u: Array
    v: Array

    @classmethod
    def over(cls, surface: Surface, rows: int, columns: int) -> SurfaceGrid:
        """A grid of rows u and columns v."""
        u = np.linspace(surface.u.first, surface.u.last, rows)
        v = np.linspace(surface.v.first, surface.v.last, columns)
        return cls(surface, u, v)

    @property
    def pairs(self) -> tuple[Array, Array]:
        """The parameters u and v of each point, (M * N,)."""
        u, v = (each.ravel() for each in np.meshgrid(self.u, self.v, indexing="ij"))
        return u, v

    @cached_property
    def point(self) -> Array:
        """(M * N, 3) in mm."""
        return self.surface.points_at(*self.pairs)

    @cached_property
    def samples(self) -> SurfaceSamples:
        """The surface there."""
        return self.surface.at(*self.pairs)

    @cached_property
    def inside(self) -> Array:
        """(M * N,) whether the point is on the face."""
        return self.surface.contains(*self.pairs)

    def shaped(self, column: Array) -> Array:
        """A column of values as an (M, N, ...) array."""
        return column.reshape(len(self.u), len(self.v), *column.shape[1:])


def normal_curvatures(surface: Surface, u: Array, v: Array, samples: SurfaceSamples, direction: Array) -> Array:
    """Curvatures of the surface in tangent directions, (N,) in 1/mm, positive where it is convex.

    The normal is differenced along u and v; for a tangent d = a Su + b Sv the curvature is dn . d / (d . d).

    Args:
        surface: the surface.
        u: (N,) parameters.
        v: (N,) parameters.
        samples: the surface there.
        direction: (N, 3) tangent directions of any length; NaN gives NaN.
    """
    normal_u = _change_of_normal(surface.u, u, lambda moved: surface.normals_at(moved, v))
    normal_v = _change_of_normal(surface.v, v, lambda moved: surface.normals_at(u, moved))
    share_u, share_v = _components(samples, direction)
    change = share_u[:, None] * normal_u + share_v[:, None] * normal_v
    return dot(change, direction) / dot(direction, direction)


def _change_of_normal(span: ParameterRange, values: Array, normal_at: Callable[[Array], Array]) -> Array:
    """Derivative of the normal by a parameter, by a central difference, or one-sided at an end."""
    step = _DIFFERENCE * span.width
    before, after = values - step, values + step
    if not span.closed:
        before, after = span.normalise(before), span.normalise(after)
    return (normal_at(after) - normal_at(before)) / (after - before)[:, None]


def _components(samples: SurfaceSamples, direction: Array) -> tuple[Array, Array]:
    """Components a and b of direction = a Su + b Sv in the tangent plane; NaN at a pole."""
    across = cross(samples.along_u, samples.along_v)
    area = dot(across, across)
    area = np.where(area > NO_LENGTH**2, area, np.nan)
    return (
        dot(cross(direction, samples.along_v), across) / area,
        dot(cross(samples.along_u, direction), across) / area,
    )
