# SPDX-License-Identifier: LGPL-2.1-or-later
"""Replay: the stock at any time of a motion, forwards and backwards.

Takes poses by time. Forwards, they cut. Backwards, the changed bricks get back their values at the start of the
stretch, and the stretch is cut again up to the time. Units: mm, s.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, angle_between, expand_counts, norm
from pkm_post.removal.rotating_shape import RotatingShape
from pkm_post.removal.stock import Stock

_POSES_PER_RUN = 64
"""Poses per stretch, whose changed bricks are saved."""
_MOST_KEPT = 100_000
"""Saved bricks, of 2 kB each; beyond this, stretches are joined in pairs."""
_RIDGE = 0.05
"""Steps: height of the ridges that a round tool leaves between two poses."""
_STAIR = 0.25
"""Steps: height of the stairs that a sharp edge leaves in a slanting motion."""


@dataclass(frozen=True)
class CutterPath:
    """P poses of the tools, by time.

    Attributes:
        seconds: (P,) times, ascending.
        tip: (P, 3) tool tips in {C}.
        axis: (P, 3) unit tool axes.
        tool: (P,) index into the shapes.
        shapes: cutting parts of the tools; None for a tool of unknown size, which cuts nothing.
    """

    seconds: Array
    tip: Array
    axis: Array
    tool: Array
    shapes: tuple[RotatingShape | None, ...]


def cutting_times(seconds: Array, tip: Array, axis: Array, shapes: Sequence[RotatingShape], step: float) -> Array:
    """Times between which any of some tools moves too little for ridges or gaps that the grid would resolve.

    Args:
        seconds: (K,) times of poses, ascending; between them the tool moves smoothly.
        tip: (K, 3) tool tips.
        axis: (K, 3) unit tool axes.
        shapes: the tools, at least one.
        step: node spacing of the grid.
    """
    narrowest, longest = min(shape.widest for shape in shapes), max(shape.top for shape in shapes)
    side = min(shape.top - shape.centre[1] for shape in shapes)
    way = np.diff(tip, axis=0)
    length = norm(way)
    along = np.abs(np.einsum("kj,kj->k", way, axis[1:]))
    across = np.sqrt(np.maximum(length**2 - along**2, 0.0)) + longest * angle_between(axis[:-1], axis[1:])
    round_step = min(np.sqrt(8.0 * narrowest * _RIDGE * step), 2.0 * step)
    # straight plunges and straight cuts across leave no stairs, but plunges longer than the side of the tool leave gaps
    stairs, gaps = np.minimum(across, along) / (_STAIR * step), along / max(side - step, step)
    count = np.maximum.reduce([across / round_step, stairs, gaps])
    count = np.maximum(np.ceil(count), (length > 0.0)).astype(np.int64)
    row, number = expand_counts(count)
    inside = seconds[row] + (number + 1) / count[row] * (seconds[row + 1] - seconds[row])
    return np.append(seconds[:1], inside)


class Replay:
    """A stock and the poses that cut it.

    Attributes:
        stock: the material at the present time.
        done: number of poses that have cut.
    """

    def __init__(self, stock: Stock, path: CutterPath) -> None:
        self.stock, self.path, self.done = stock, path, 0
        self._kept: list[tuple[int, dict[int, Array]]] = []
        self._count = 0

    @property
    def seconds(self) -> float:
        """Time of the last pose that has cut; 0 before the first."""
        return float(self.path.seconds[self.done - 1]) if self.done else 0.0

    def is_at(self, seconds: float) -> bool:
        """Whether the stock is at a time."""
        return self.done == self._due(seconds)

    def go_to(self, seconds: float, most: int | None = None) -> Array:
        """Move to a time.

        Args:
            seconds: the time.
            most: poses to cut in this call; None for all. After fewer, ``is_at`` is False.

        Returns:
            Numbers of the bricks that changed, ascending.
        """
        due, changed = self._due(seconds), []
        while self._kept and self.done > due:
            changed.append(self._undo())
        end = due if most is None else min(due, self.done + most)
        while self.done < end:
            changed += self._cut(min(end, self._run_end()))
        return np.unique(np.concatenate(changed)) if changed else np.empty(0, dtype=np.int64)

    def _due(self, seconds: float) -> int:
        return int(np.searchsorted(self.path.seconds, seconds, side="right"))

    def _run_end(self) -> int:
        """The last pose of the current stretch and tool."""
        if not self._kept or self.done >= self._kept[-1][0] + _POSES_PER_RUN:
            self._kept.append((self.done, {}))
            self._forget()
        end = min(self._kept[-1][0] + _POSES_PER_RUN, len(self.path.seconds))
        same = self.path.tool[self.done : end] == self.path.tool[self.done]
        return end if same.all() else self.done + int(np.argmin(same))

    def _cut(self, end: int) -> list[Array]:
        rows, kept, changed = slice(self.done, end), self._kept[-1][1], []
        shape = self.path.shapes[int(self.path.tool[self.done])]
        if shape is not None:
            for brick, before in self.stock.cut(self.path.tip[rows], self.path.axis[rows], shape):
                changed.append(brick)
                new = [row for row, number in enumerate(brick.tolist()) if number not in kept]
                kept.update((int(brick[row]), before[row]) for row in new)
                self._count += len(new)
        self.done = end
        return changed

    def _undo(self) -> Array:
        """Go back to the start of the last stretch."""
        self.done, kept = self._kept.pop()
        self._count -= len(kept)
        brick = np.array(list(kept), dtype=np.int64)
        if len(brick):
            self.stock.put_back(brick, np.stack(list(kept.values())))
        return brick

    def _forget(self) -> None:
        """Join stretches in pairs when too many bricks are saved; stepping back then cuts more poses again."""
        if self._count <= _MOST_KEPT:
            return
        joined = []
        for (begin, older), (_, newer) in zip(self._kept[:-1:2], self._kept[1:-1:2], strict=False):
            joined.append((begin, newer | older))
        rest = self._kept[len(joined) * 2 :]
        self._kept = joined + rest
        self._count = sum(len(kept) for _, kept in self._kept)
