# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: planes, and the pose of the program coordinate system in {C}.

Input: points and vectors in program coordinates, mm. Output: the same in {C}: {C} = turn @ program + shift.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from pkm_post.model import Array, is_uniform, map_rows, uniform

PLANES: dict[int, tuple[int, int, int]] = {170: (0, 1, 2), 180: (2, 0, 1), 190: (1, 2, 0)}
"""First, second and normal coordinate by plane; right-handed in this order."""

_OBLIQUE = 1e-12


class ProgramFrame(NamedTuple):
    """{C} = turn @ program + shift; ``turn`` is a rotation, possibly with a reflection.

    Attributes:
        tool: (3, 3) rotation of the tool itself, by the place of the work offset or to a tilted plane.
        is_tilted: whether it is that of a tilted plane.
        is_turned: whether a rotation or a mirror image of the program is in force.
    """

    turn: Array
    shift: Array
    tool: Array
    is_tilted: bool
    is_turned: bool

    def to_work(self, point: Array) -> Array:
        """Transform a (3,) point of the program to {C}."""
        return self.turn @ point + self.shift

    def to_program(self, point: Array) -> Array:
        """Transform a (3,) point of {C} to program coordinates."""
        return self.turn.T @ (point - self.shift)

    def oblique(self) -> Array:
        """Mask of the coordinates that the frame mixes, (3,)."""
        mixed = np.abs(self.turn - np.diag(np.diag(self.turn))) > _OBLIQUE
        return mixed.any(axis=0) | mixed.any(axis=1)


def rotation(plane: int, angle: float) -> Array:
    """Rotation in a plane from its first coordinate to its second, (3, 3)."""
    first, second, _ = PLANES[plane]
    turn = np.eye(3)
    if angle:
        turn[first, first] = turn[second, second] = np.cos(angle)
        turn[second, first] = np.sin(angle)
        turn[first, second] = -np.sin(angle)
    return turn


def plane_axes(planes: Array) -> Array:
    """First, second and normal coordinate of each plane, (n,) codes to (n, 3)."""
    table = np.zeros((max(PLANES) + 1, 3), dtype=np.uint8)
    for code, axes in PLANES.items():
        table[code] = axes
    return map_rows(table.__getitem__, planes)


def normal_coordinate(planes: Array) -> Array:
    """The coordinate normal to each plane, (n,) codes to (n,)."""
    return plane_axes(planes)[:, 2]


def tool_directions(frames: Sequence[ProgramFrame], frame: Array, axes: Array, words: Array) -> Array:
    """Tool axes in {C}, (n, 3): frames turn coordinates, not the tool; a vector is one of the frame it is written in.

    Args:
        frames: the frames.
        frame: (n,) frame index of each row.
        axes: (n, 3) tool axes in program coordinates.
        words: (n,) the row whose words are the vector of each row, -1 where there are none.
    """
    of_tool = RowFrames.of([each._replace(turn=each.tool) for each in frames], frame).directions(axes)
    if all(np.array_equal(each.turn, each.tool) for each in frames) or (words < 0).all():
        return of_tool
    as_machine = (words < 0) | np.array([each.is_tilted for each in frames])[frame]
    return np.where(as_machine[:, None], of_tool, RowFrames.of(frames, frame[words]).directions(axes))


class RowFrames(NamedTuple):
    """The frames of the rows of a table.

    Attributes:
        turn: (m, 3, 3) ``turn`` of the m frames.
        shift: (m, 3) ``shift`` of the m frames.
        frame: (n,) frame index of each row.
    """

    turn: Array
    shift: Array
    frame: Array

    @classmethod
    def of(cls, frames: Sequence[ProgramFrame], frame: Array) -> RowFrames:
        """Create the frames of rows from frame indices."""
        if is_uniform(frame) and len(frame):
            frames, frame = [frames[frame[0]]], uniform(0, len(frame))
        return cls(np.array([one.turn for one in frames]), np.array([one.shift for one in frames]), frame)

    def directions(self, vectors: Array) -> Array:
        """Rotate (n, 3) program vectors to {C}; NaN propagates."""
        if (self.turn == np.eye(3)).all():
            return vectors
        if len(self.turn) == 1:
            # Not with @: for three columns BLAS threading costs more than it gains.
            return map_rows(lambda some: np.einsum("ij,nj->ni", self.turn[0], some), vectors)
        return np.einsum("nij,nj->ni", self.turn[self.frame], vectors)

    def points(self, points: Array) -> Array:
        """Transform (n, 3) program points to {C}."""
        if not self.shift.any():
            return self.directions(points)
        shift = self.shift if len(self.shift) == 1 else self.shift[self.frame]
        return self.directions(points) + shift

    def hand(self) -> Array:
        """Handedness of each frame, (n,): 1 for right-handed, -1 for mirrored."""
        return map_rows(np.sign(np.linalg.det(self.turn)).__getitem__, self.frame)

    def planes(self, normal: Array) -> tuple[Array, Array]:
        """Transform planes normal to a program coordinate.

        Args:
            normal: (n,) index of that coordinate.

        Returns:
            (n,) the coordinate of {C} closest to each plane normal, and (n,) the component of the normal along it.
        """
        plane = np.argmax(np.abs(self.turn), axis=1)
        along = np.take_along_axis(self.turn, plane[:, None, :], axis=1)[:, 0, :]
        if len(self.turn) == 1:
            return map_rows(plane[0].astype(np.uint8).__getitem__, normal), map_rows(along[0].__getitem__, normal)
        return plane[self.frame, normal], along[self.frame, normal]
