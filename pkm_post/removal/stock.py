# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stock: a block of material from which rotating tools remove their swept volume.

Each node of a grid stores its distance from the surface, negative in the material, within a band of some steps. A tool
in a pose replaces it by the larger of itself and the negative value of the tool's shape, so the surface between nodes
is accurate to a small part of a step. Motions are sampled by the caller. Units: mm.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, expand_counts, height_and_radius
from pkm_post.removal.grid import BRICK, Grid
from pkm_post.removal.mesh_distance import mesh_distances
from pkm_post.removal.rotating_shape import RotatingShape

BAND = 3.0
"""Steps up to which distances from the surface are stored."""
_BAND = 1.75
"""Steps around a tool within which nodes are updated: all nodes of a cell that its surface passes."""
_PAIRS = 2048
"""Pairs of a brick and a pose per pass: their arrays stay in the cache."""
_POSES = 64


class Stock:
    """The material.

    Attributes:
        band: largest stored distance, mm.
        field: (B, 512) distance of each node from the surface, negative in the material, mm.
    """

    def __init__(self, grid: Grid, field: Array, band: float) -> None:
        self.grid, self.band, self.field = grid, band, field
        self._least = field.min(axis=1)
        self._amount = shares(field, grid.step).sum(axis=1)
        self._offsets = grid.offsets.astype(np.float32)
        self._square = (self._offsets**2).sum(axis=1)

    @classmethod
    def of(cls, triangles: Array, step: float) -> Stock:
        """The stock inside a closed mesh.

        Args:
            triangles: (T, 3, 3) in {C}, anticlockwise as seen from outside.
            step: node spacing, mm.
        """
        corners = triangles.reshape(-1, 3)
        grid = Grid.enclosing(corners.min(axis=0), corners.max(axis=0), step)
        return cls(grid, mesh_distances(grid, triangles, BAND * step), BAND * step)

    @property
    def on_surface(self) -> Array:
        """Whether the surface passes a brick, (B,)."""
        return np.asarray((self.field.min(axis=1) < self.band) & (self.field.max(axis=1) > -self.band))

    @property
    def volume(self) -> float:
        """Volume of the material, mm^3."""
        return float(self._amount.sum() * self.grid.step**3)

    def cut(self, tip: Array, axis: Array, shape: RotatingShape) -> Iterator[tuple[Array, Array]]:
        """Remove the material inside a tool in some poses.

        Args:
            tip: (P, 3) tool tips in {C}.
            axis: (P, 3) unit tool axes.

        Yields:
            Bricks that have changed, (K,), and their values before, (K, 512), in steps.
        """
        for first in range(0, len(tip), _POSES):
            rows = slice(first, first + _POSES)
            pose, brick = self._touched(tip[rows], axis[rows], shape)
            for some in (slice(at, at + _PAIRS) for at in range(0, len(pose), _PAIRS)):
                yield self._take(brick[some], tip[rows][pose[some]], axis[rows][pose[some]], shape)

    def put_back(self, brick: Array, before: Array) -> None:
        """Restore the earlier values (K, 512) of bricks (K,)."""
        self.field[brick] = before
        self._changed(brick)

    def _touched(self, tip: Array, axis: Array, shape: RotatingShape) -> tuple[Array, Array]:
        """Pairs of poses and bricks that may cut, sorted by brick."""
        grid, room = self.grid, self.grid.half_diagonal + _BAND * self.grid.step
        ends = np.stack([tip, tip + shape.top * axis])
        wide = shape.widest * np.sqrt(np.maximum(1.0 - axis * axis, 0.0)) + _BAND * grid.step
        size = BRICK * grid.step
        low, high = (ends.min(axis=0) - wide - grid.origin) / size, (ends.max(axis=0) + wide - grid.origin) / size
        begin = np.clip(np.floor(low).astype(np.int64), 0, grid.bricks)
        count = np.maximum(np.clip(np.floor(high).astype(np.int64) + 1, 0, grid.bricks) - begin, 0)
        pose, number = expand_counts(count.prod(axis=1))
        number, z = np.divmod(number, count[pose, 2])
        x, y = np.divmod(number, count[pose, 1])
        brick = np.ravel_multi_index(tuple((begin[pose] + np.column_stack([x, y, z])).T), grid.bricks)
        kept = self._least[brick] < self.band
        pose, brick = pose[kept], brick[kept]
        height, radius = height_and_radius(grid.centres[brick] - tip[pose], axis[pose])
        kept = shape.level(radius, height) < room
        pose, brick = pose[kept], brick[kept]
        order = np.argsort(brick, kind="stable")
        return pose[order], brick[order]

    def _take(self, brick: Array, tip: Array, axis: Array, shape: RotatingShape) -> tuple[Array, Array]:
        """Cut K bricks, sorted, by one pose each; return those that changed, and their values before."""
        middle, turned = (self.grid.centres[brick] - tip).astype(np.float32), axis.astype(np.float32)
        height = turned @ self._offsets.T
        height += np.einsum("kj,kj->k", middle, turned)[:, None]
        square = 2.0 * middle @ self._offsets.T
        square += self._square + np.einsum("kj,kj->k", middle, middle)[:, None]
        square -= height * height
        level = shape.level(np.sqrt(np.maximum(square, 0.0, out=square), out=square), height)
        starts = np.flatnonzero(np.append(True, np.diff(brick) > 0))
        taken = np.minimum(-np.minimum.reduceat(level, starts, axis=0), np.float32(self.band))
        brick = brick[starts]
        before = self.field[brick]
        changed = (taken > before).any(axis=1)
        brick, before = brick[changed], before[changed]
        self.field[brick] = np.maximum(before, taken[changed])
        self._changed(brick)
        return brick, before

    def _changed(self, brick: Array) -> None:
        values = self.field[brick]
        self._least[brick] = values.min(axis=1)
        self._amount[brick] = shares(values, self.grid.step).sum(axis=1)


def shares(field: Array, step: float) -> Array:
    """Share of the cell around each node that is material, of the shape of the distances; exact for level planes."""
    filled: Array = np.clip(0.5 - field / np.float32(step), 0.0, 1.0)
    return filled
