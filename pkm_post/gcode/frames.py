# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: where the coordinates that a program is written in lie in {C}, and what moves them.

Offsets enter as codes set them, in mm and rad; a frame leaves: {C} = turn @ program + shift. From the program outwards:
mirror (G51.1), rotation (G68), local offset (G52, G92), angle and origin of the work offset (G54 to G59.3), and along Z
what the length offset in force is longer than the tool's own gauge length: positions of a program are tool tips.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from pkm_post.gcode.options import ReadOptions
from pkm_post.model.columns import by_row, is_uniform, uniform
from pkm_post.model.program import Array

SYSTEMS = (540, 550, 560, 570, 580, 590, 591, 592, 593)
"""The work offsets in the order of the P word of G10."""

PLANES: dict[int, tuple[int, int, int]] = {170: (0, 1, 2), 180: (2, 0, 1), 190: (1, 2, 0)}
"""By plane its first, second and normal coordinate; right-handed in this order."""

_SMALL = 1e-12


@dataclass(frozen=True)
class Frame:
    """{C} = turn @ program + shift; ``turn`` is a rotation, or one with a mirror."""

    turn: Array
    shift: Array

    def out(self, point: Array) -> Array:
        """A (3,) point of the program in {C}."""
        return self.turn @ point + self.shift

    def into(self, point: Array) -> Array:
        """A (3,) point of {C} in coordinates of the program."""
        return self.turn.T @ (point - self.shift)

    def oblique(self) -> Array:
        """The coordinates that the frame mixes, (3,)."""
        mixed = np.abs(self.turn - np.diag(np.diag(self.turn))) > _SMALL
        return mixed.any(axis=0) | mixed.any(axis=1)


@dataclass
class Offsets:
    """All that moves the frame, in the making.

    Attributes:
        system: code of the work offset in force.
        origins: (3,) origin of each work offset that is known, by code.
        angles: its angle about Z.
        local: (3,) offset of G52 and G92.
        kept: (3,) what G92.3 makes of it again after G92.2 switched it off.
        mirrored: (3,) coordinates that are mirrored, and ``mirror_at`` where.
        rotation: plane, (3,) centre and angle of G68.
        length: (3,) length offset in force; None while lengths are left to the machine (G49).
        own_length: gauge length of the tool in use.
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
        """Those that are given as options."""
        offsets = cls()
        for name, (x, y, z, degrees) in options.work_offsets.items():
            code = round(10 * float(name.removeprefix("G")))
            offsets.origins[code] = np.array([x, y, z])
            offsets.angles[code] = float(np.radians(degrees))
        return offsets

    def inner(self, point: Array) -> Array:
        """A (3,) point of the program after mirror and rotation."""
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
        """Rotation of a work offset, (3, 3)."""
        return rotation(170, self.angles.get(system, 0.0))

    def frame(self, system: int | None = None) -> Frame:
        """The frame in force, or that of another work offset in its place."""
        system = self.system if system is None else system
        turn, shift = self._inner()
        about = self.system_turn(system)
        longer = np.zeros(3) if self.length is None else self.length - np.array([0.0, 0.0, self.own_length])
        origin = self.origins.get(system, np.zeros(3))
        return Frame(about @ turn, about @ (shift + self.local) + origin + longer)

    def call_here(self, words: Array, position: Array) -> None:
        """G92: give the present (3,) position the (3,) coordinates of the words, NaN where there is none."""
        wanted = np.where(np.isnan(words), position, words)
        self.local = self.kept = self.local + self.inner(position) - self.inner(wanted)

    def set_origin_here(self, system: int, words: Array, place: Array) -> None:
        """G10 L20: move a work offset so that the (3,) ``place`` in {C} gets the coordinates of the words in it."""
        position = self.frame(system).into(place)
        wanted = np.where(np.isnan(words), position, words)
        moved = self.system_turn(system) @ (self.inner(position) - self.inner(wanted))
        self.origins[system] = self.origins.get(system, np.zeros(3)) + moved


def rotation(plane: int, angle: float) -> Array:
    """The rotation in a plane from its first coordinate to its second, (3, 3)."""
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
    return by_row(table.__getitem__, planes)


def normal_coordinate(planes: Array) -> Array:
    """The coordinate each plane is normal to, (n,) codes to (n,)."""
    return plane_axes(planes)[:, 2]


@dataclass(frozen=True)
class RowFrames:
    """The frames that the rows of a table are written in.

    Attributes:
        turn: (m, 3, 3) of the m frames.
        shift: (m, 3) of them.
        frame: (n,) the frame of each row.
    """

    turn: Array
    shift: Array
    frame: Array

    @classmethod
    def of(cls, frames: Sequence[Frame], frame: Array) -> RowFrames:
        """Those of rows whose frames are known by index."""
        if is_uniform(frame):
            frames, frame = [frames[frame[0]]], uniform(0, len(frame))
        return cls(np.array([one.turn for one in frames]), np.array([one.shift for one in frames]), frame)

    def directions(self, vectors: Array) -> Array:
        """(n, 3) vectors of the program in {C}; a vector with NaN becomes one."""
        if (self.turn == np.eye(3)).all():
            return vectors
        if len(self.turn) == 1:
            # Not with @: for three columns the threads of a BLAS cost more than they give.
            return by_row(lambda some: np.einsum("ij,nj->ni", self.turn[0], some), vectors)
        return np.einsum("nij,nj->ni", self.turn[self.frame], vectors)

    def points(self, points: Array) -> Array:
        """(n, 3) points of the program in {C}."""
        if not self.shift.any():
            return self.directions(points)
        shift = self.shift if len(self.shift) == 1 else self.shift[self.frame]
        return self.directions(points) + shift

    def hand(self) -> Array:
        """Whether a frame is right-handed, 1, or a mirror image, -1, (n,)."""
        return by_row(np.sign(np.linalg.det(self.turn)).__getitem__, self.frame)

    def planes(self, normal: Array) -> tuple[Array, Array]:
        """What becomes of planes that are normal to a coordinate of the program.

        Args:
            normal: (n,) that coordinate.

        Returns:
            (n,) the coordinate of {C} that each is most nearly normal to, and (n,) the part of its normal along it.
        """
        plane = np.argmax(np.abs(self.turn), axis=1)
        along = np.take_along_axis(self.turn, plane[:, None, :], axis=1)[:, 0, :]
        if len(self.turn) == 1:
            return by_row(plane[0].astype(np.uint8).__getitem__, normal), by_row(along[0].__getitem__, normal)
        return plane[self.frame, normal], along[self.frame, normal]
