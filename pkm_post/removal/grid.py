# SPDX-License-Identifier: LGPL-2.1-or-later
"""Grid: evenly spaced nodes around the stock, in bricks of 8 x 8 x 8.

A cutter changes only the bricks that it touches, and only those are redrawn. A value per node is an array
(B, 512), brick by brick; within a brick x is the slowest index and z the fastest. Units: mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.geometry import Array

BRICK = 8
"""Nodes along the side of a brick."""
_MARGIN = 1.5
"""Steps by which the nodes go beyond the box: the surface of the stock is then between nodes everywhere."""


@dataclass(frozen=True)
class Grid:
    """The nodes.

    Attributes:
        origin: (3,) the first node.
        step: node spacing, mm.
        bricks: number of bricks along x, y and z.
    """

    origin: Array
    step: float
    bricks: tuple[int, int, int]

    @classmethod
    def enclosing(cls, low: Array, high: Array, step: float) -> Grid:
        """The smallest grid around a box, with a margin.

        Args:
            low: (3,) lowest corner of the box.
            high: (3,) highest corner.
            step: node spacing, mm.
        """
        nodes = np.ceil((high - low) / step + 2 * _MARGIN) + 1
        count = np.ceil(nodes / BRICK).astype(np.int64)
        origin = (low + high) / 2 - (count * BRICK - 1) / 2 * step
        return cls(origin, step, (int(count[0]), int(count[1]), int(count[2])))

    @property
    def count(self) -> int:
        """Number of bricks."""
        x, y, z = self.bricks
        return x * y * z

    @property
    def half_diagonal(self) -> float:
        """Distance from the centre of a brick to its outermost node, mm."""
        return float(np.sqrt(3.0) * (BRICK - 1) / 2 * self.step)

    @cached_property
    def axes(self) -> tuple[Array, Array, Array]:
        """Coordinates of the nodes along x, y and z."""
        x, y, z = (at + self.step * np.arange(BRICK * n) for at, n in zip(self.origin, self.bricks, strict=True))
        return x, y, z

    @cached_property
    def centres(self) -> Array:
        """Centres of the bricks, (B, 3)."""
        index = np.stack(np.unravel_index(np.arange(self.count), self.bricks), axis=1)
        return np.asarray(self.origin + (index * BRICK + (BRICK - 1) / 2) * self.step)

    @cached_property
    def offsets(self) -> Array:
        """Nodes of a brick from its centre, (512, 3)."""
        line = (np.arange(BRICK) - (BRICK - 1) / 2) * self.step
        return np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)

    def by_brick(self, values: Array) -> Array:
        """Values of an (X, Y, Z) array, brick by brick, (B, 512)."""
        x, y, z = self.bricks
        split = values.reshape(x, BRICK, y, BRICK, z, BRICK)
        return np.ascontiguousarray(split.transpose(0, 2, 4, 1, 3, 5)).reshape(self.count, BRICK**3)

    def node_indices(self, brick: Array, before: int, after: int) -> Array:
        """Flat indices into (B, 512) of the nodes of bricks and of some layers around them.

        Beyond the grid the outermost nodes are repeated.

        Args:
            brick: (K,) numbers of bricks.
            before: layers on the lower sides.
            after: layers on the upper sides.

        Returns:
            (K, n, n, n) with n = 8 + before + after.
        """
        along = np.arange(-before, BRICK + after)
        index = np.stack(np.unravel_index(brick, self.bricks))[:, :, None] * BRICK + along
        index = np.clip(index, 0, np.array(self.bricks)[:, None, None] * BRICK - 1)
        _, y, z = self.bricks
        strides = (y * z, z, 1), (BRICK * BRICK, BRICK, 1)
        x, y, z = (
            (one // BRICK) * far * BRICK**3 + one % BRICK * near for one, far, near in zip(index, *strides, strict=True)
        )
        return np.asarray(x[:, :, None, None] + y[:, None, :, None] + z[:, None, None, :])
