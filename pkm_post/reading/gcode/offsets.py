# SPDX-License-Identifier: LGPL-2.1-or-later
"""Offsets: all that lies between the coordinates of a program and {C}, and the frame that they give.

From the program outwards: mirror (G51.1), rotation (G68), local offset (G52, G92), angle and origin of the work offset
(G54 to G59.3), and along Z the excess of the active length offset over the tool's own gauge length: program positions
are tool tips. ``work_offsets`` has the codes that change them. Units: mm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.codes import FURTHER_OFFSET, WORK_OFFSETS
from pkm_post.reading.gcode.frames import ProgramFrame, rotation
from pkm_post.reading.gcode.options import ReadOptions


@dataclass
class Offsets:
    """All offsets that determine the frame; mutable.

    Attributes:
        system: code of the active work offset.
        origins: (3,) origin of each known work offset, by code.
        angles: its angle about Z, by code; G10 sets it without turning the tool [LinuxCNC, rs274].
        placed: its angle in the options, by code, which turns part and tool.
        local: (3,) offset of G52 and G92.
        kept: (3,) offset that G92.3 restores after G92.2, or that of G92, where G52 adds to it.
        mirrored: (3,) mirrored coordinates; ``mirror_at`` holds the mirror positions.
        rotation: (3, 3) turn and (3,) shift of G68 or G68.2.
        tilted: whether it is that of a tilted plane, G68.2.
        length: (3,) active length offset; None while the machine handles tool lengths (G49).
        own_length: gauge length of the active tool.
    """

    system: int = WORK_OFFSETS[0]
    origins: dict[int, Array] = field(default_factory=dict)
    angles: dict[int, float] = field(default_factory=dict)
    placed: dict[int, float] = field(default_factory=dict)
    local: Array = field(default_factory=lambda: np.zeros(3))
    kept: Array = field(default_factory=lambda: np.zeros(3))
    mirrored: Array = field(default_factory=lambda: np.zeros(3, dtype=np.bool_))
    mirror_at: Array = field(default_factory=lambda: np.zeros(3))
    rotation: tuple[Array, Array] | None = None
    tilted: bool = False
    length: Array | None = None
    own_length: float = 0.0

    @classmethod
    def of(cls, options: ReadOptions) -> Offsets:
        """Create the offsets from the options."""
        offsets = cls()
        offsets.take(options.work_offsets)
        if options.work_offset:
            offsets.system = work_offset_code(options.work_offset)
            offsets.origins[offsets.system] = np.zeros(3)
        return offsets

    def take(self, poses: Mapping[str, tuple[float, float, float, float]]) -> None:
        """Take work offsets by name, origin in mm and rotation about Z in degrees."""
        for name, (x, y, z, degrees) in poses.items():
            code = work_offset_code(name)
            self.origins[code] = np.array([x, y, z])
            self.angles[code] = self.placed[code] = float(np.radians(degrees))

    def inner(self, point: Array) -> Array:
        """Apply mirror and rotation to a (3,) point of the program."""
        turn, shift = self._inner()
        return turn @ point + shift

    def _inner(self) -> tuple[Array, Array]:
        turn = np.diag(np.where(self.mirrored, -1.0, 1.0))
        shift = np.where(self.mirrored, 2 * self.mirror_at, 0.0)
        if self.rotation is not None:
            about, by = self.rotation
            turn, shift = about @ turn, about @ shift + by
        return turn, shift

    def origin(self, system: int) -> Array:
        """Origin of a work offset, (3,) in mm; zero until it is set."""
        return self.origins.get(system, np.zeros(3))

    def work_offset_turn(self, system: int) -> Array:
        """Rotation matrix of a work offset, (3, 3)."""
        return rotation(170, self.angles.get(system, 0.0))

    def frame(self, system: int | None = None) -> ProgramFrame:
        """The active frame, or the frame with another work offset."""
        system = self.system if system is None else system
        turn, shift = self._inner()
        about = self.work_offset_turn(system)
        longer = np.zeros(3) if self.length is None else self.length - np.array([0.0, 0.0, self.own_length])
        to_plane = self.rotation[0] if self.rotation is not None and self.tilted else None
        tool = rotation(170, self.placed.get(system, 0.0)) if to_plane is None else about @ to_plane
        shift = about @ (shift + self.local) + self.origin(system) + longer
        return ProgramFrame(about @ turn, shift, tool, self.tilted, not (self.tilted or np.allclose(turn, np.eye(3))))

    def set_local_here(self, words: Array, position: Array) -> None:
        """G92: set the coordinates of the current (3,) position to the (3,) words, NaN where absent."""
        coordinates = np.where(np.isnan(words), position, words)
        self.local = self.local + self.inner(position) - self.inner(coordinates)

    def set_origin_here(self, system: int, words: Array, place: Array) -> None:
        """G10 L20: set a work offset so that the (3,) ``place`` in {C} has the coordinates of the words."""
        position = self.frame(system).to_program(place)
        coordinates = np.where(np.isnan(words), position, words)
        moved = self.work_offset_turn(system) @ (self.inner(position) - self.inner(coordinates))
        self.origins[system] = self.origin(system) + moved


def work_offset_code(name: str) -> int:
    """The code of a work offset, such as 540 for G54; also of G54.1P7."""
    number, _, further = name.removeprefix("G").partition("P")
    return FURTHER_OFFSET - int(further) if further else round(10 * float(number))
