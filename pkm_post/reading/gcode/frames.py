# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: the pose of the program coordinate system in {C}, and the offsets that change it.

Enters: offsets as set by codes, in mm and rad. Leaves: a frame: {C} = turn @ program + shift. From the program
outwards: mirror (G51.1), rotation (G68), local offset (G52, G92), angle and origin of the work offset (G54 to G59.3),
and along Z the excess of the active length offset over the tool's own gauge length: program positions are tool tips.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array, is_uniform, map_rows, uniform
from pkm_post.reading.gcode.options import ReadOptions

SYSTEMS = (540, 550, 560, 570, 580, 590, 591, 592, 593)
"""The work offsets in order of the P word of G10."""

PLANES: dict[int, tuple[int, int, int]] = {170: (0, 1, 2), 180: (2, 0, 1), 190: (1, 2, 0)}
"""First, second and normal coordinate by plane; right-handed in this order."""

_SMALL = 1e-12


@dataclass(frozen=True)
class Frame:
    """{C} = turn @ program + shift; ``turn`` is a rotation, possibly with a reflection."""

    turn: Array
    shift: Array

    def out(self, point: Array) -> Array:
        """Transform a (3,) point of the program to {C}."""
        return self.turn @ point + self.shift

    def into(self, point: Array) -> Array:
        """Transform a (3,) point of {C} to program coordinates."""
        return self.turn.T @ (point - self.shift)

    def oblique(self) -> Array:
        """Mask of the coordinates that the frame mixes, (3,)."""
        mixed = np.abs(self.turn - np.diag(np.diag(self.turn))) > _SMALL
        return mixed.any(axis=0) | mixed.any(axis=1)


@dataclass
class Offsets:
    """All offsets that determine the frame; mutable.

    Attributes:
        system: code of the active work offset.
        origins: (3,) origin of each known work offset, by code.
        angles: its angle about Z, by code.
        local: (3,) offset of G52 and G92.
        kept: (3,) offset that G92.3 restores after G92.2.
        mirrored: (3,) mirrored coordinates; ``mirror_at`` holds the mirror positions.
        rotation: plane, (3,) centre and angle of G68.
        length: (3,) active length offset; None while the machine handles tool lengths (G49).
        own_length: gauge length of the active tool.
    """

    system: int = SYSTEMS[0]
    origins: dict[int, Array] = field(default_factory=dict)
    angles: dict[int, float] = field(default_factory=dict)
    local: Array = field(default_factory=lambda: np.zeros(3))
    kept: Array = field(default_factory=lambda: np.zeros(3))
    mirrored: Array = field(default_factory=lambda: np.zeros(3, dtype=np.bool_))
    mirror_at: Array = field(default_factory=lambda: np.zeros(3))
    rotation: tuple[int, Array, float] | None = None
    length: Array | None = None
    own_length: float = 0.0

    @classmethod
    def of(cls, options: ReadOptions) -> Offsets:
        """Create the offsets from the options."""
        offsets = cls()
        for name, (x, y, z, degrees) in options.work_offsets.items():
            code = round(10 * float(name.removeprefix("G")))
            offsets.origins[code] = np.array([x, y, z])
            offsets.angles[code] = float(np.radians(degrees))
        return offsets

    def inner(self, point: Array) -> Array:
        """Apply mirror and rotation to a (3,) point of the program."""
        turn, shift = self._inner()
        return turn @ point + shift

    def _inner(self) -> tuple[Array, Array]:
        turn = np.diag(np.where(self.mirrored, -1.0, 1.0))
        shift = np.where(self.mirrored, 2 * self.mirror_at, 0.0)
        if self.rotation is not None:
            plane, centre, angle = self.rotation
            about = rotation(plane, angle)
            turn, shift = about @ turn, about @ (shift - centre) + centre
        return turn, shift

    def system_turn(self, system: int) -> Array:
        """Rotation matrix of a work offset, (3, 3)."""
        return rotation(170, self.angles.get(system, 0.0))

    def frame(self, system: int | None = None) -> Frame:
        """The active frame, or the frame with another work offset."""
        system = self.system if system is None else system
        turn, shift = self._inner()
        about = self.system_turn(system)
        longer = np.zeros(3) if self.length is None else self.length - np.array([0.0, 0.0, self.own_length])
        origin = self.origins.get(system, np.zeros(3))
        return Frame(about @ turn, about @ (shift + self.local) + origin + longer)

    def call_here(self, words: Array, position: Array) -> None:
        """G92: set the coordinates of the current (3,) position to the (3,) words, NaN where absent."""
        wanted = np.where(np.isnan(words), position, words)
        self.local = self.kept = self.local + self.inner(position) - self.inner(wanted)

    def set_origin_here(self, system: int, words: Array, place: Array) -> None:
        """G10 L20: set a work offset so that the (3,) ``place`` in {C} has the coordinates of the words."""
        position = self.frame(system).into(place)
        wanted = np.where(np.isnan(words), position, words)
        moved = self.system_turn(system) @ (self.inner(position) - self.inner(wanted))
        self.origins[system] = self.origins.get(system, np.zeros(3)) + moved


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


@dataclass(frozen=True)
class RowFrames:
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
    def of(cls, frames: Sequence[Frame], frame: Array) -> RowFrames:
        """Create the frames of rows from frame indices."""
        if is_uniform(frame):
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
