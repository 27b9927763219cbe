# SPDX-License-Identifier: LGPL-2.1-or-later
"""State: the modal state between two blocks of a Siemens program.

Input and output: none; ``machine`` and related modules change it. Lengths in mm, angles in degrees, positions in
coordinates of the program, directions in {C}.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.siemens.frames import ProgrammableFrame

NO_MOTION, RAPID, LINE, CLOCKWISE, COUNTERCLOCKWISE, BY_POINT, TANGENT = range(-1, 6)
"""Motion codes: G0 to G3, CIP and CT."""
UPRIGHT = np.array([0.0, 0.0, 1.0])
_TILTED = 1e-9
"""rad: a tool axis closer to vertical counts as vertical."""


@dataclass
class State:
    """Modal state.

    Attributes:
        motion: one of the motion codes above.
        plane: 170 for G17, 180 for G18, 190 for G19.
        relative: whether words are increments (G91).
        scale: mm per unit of lengths.
        feed_scale: mm per unit of feeds.
        feed_mode: 93, 94 or 95.
        feed: F as written, NaN if none is active.
        speed: S, 1/min, NaN before the first.
        sense: 1 for M3, -1 for M4, 0.
        coolant: value of the last coolant event.
        tool: number of the tool in the spindle, -1 before the first change.
        selected: number of the tool that M6 will load.
        has_offset: whether X Y Z are those of the tip: not after D0.
        side: 1 for G41, -1 for G42, 0.
        stops: whether each block ends at rest (G60).
        exact_path: whether corners are followed rather than rounded, as in cycles.
        smoothing: the last of the codes of continuous path, 64 or 641 to 645.
        compressor: whether a compressor is on.
        contour_tolerance: CTOL or that of CYCLE832; 0 for none.
        high_speed: whether CYCLE832 is on.
        traori: whether TRAORI is on.
        angles: "ORIEULER", "ORIRPY", or empty before either is programmed.
        rotary: (3,) A, B, C.
        axis: (3,) unit tool axis in {C}.
        swivelled: whether CYCLE800 has set the tool along Z of its plane.
        system: the settable offset in which the program moves, None before the first.
        unplaced: an active one with unknown origin; empty if there is none.
        in_machine_frame: whether ORIMKS is on.
        offset: frame of the settable offset.
        swivel: frame of CYCLE800.
        programmed: programmable frame.
        position: (3,) of the tool tip.
        placed: (3,) the same in the frame of the last word for each coordinate.
        known: (3,) which coordinates are known.
        has_moved: whether it was known before.
        tangent: (3,) direction of the last motion at its end in {C}; zero before the first.
        frame: from coordinates of the program to {C}.
    """

    motion: int = NO_MOTION
    plane: int = 170
    relative: bool = False
    scale: float = 1.0
    feed_scale: float = 1.0
    feed_mode: int = 94
    feed: float = math.nan
    speed: float = math.nan
    sense: float = 0.0
    coolant: float = 0.0
    tool: int = -1
    selected: int | None = None
    has_offset: bool = True
    side: float = 0.0
    stops: bool = False
    exact_path: bool = False
    smoothing: int = 64
    compressor: bool = False
    contour_tolerance: float = 0.0
    high_speed: bool = False
    traori: bool = False
    angles: str = ""
    rotary: Array = field(default_factory=lambda: np.zeros(3))
    axis: Array = field(default_factory=lambda: UPRIGHT)
    swivelled: bool = False
    system: int | None = None
    unplaced: str = ""
    in_machine_frame: bool = False
    offset: ProgrammableFrame = field(default_factory=ProgrammableFrame)
    swivel: ProgrammableFrame = field(default_factory=ProgrammableFrame)
    programmed: ProgrammableFrame = field(default_factory=ProgrammableFrame)
    position: Array = field(default_factory=lambda: np.zeros(3))
    placed: Array = field(default_factory=lambda: np.zeros(3))
    known: Array = field(default_factory=lambda: np.zeros(3, dtype=np.bool_))
    has_moved: bool = False
    tangent: Array = field(default_factory=lambda: np.zeros(3))
    frame: ProgrammableFrame = field(default_factory=ProgrammableFrame)

    def set_frames(self, offset: ProgrammableFrame, swivel: ProgrammableFrame, programmed: ProgrammableFrame) -> None:
        """Change the frames; the tool stays in place, and its coordinates change."""
        mixed = self.frame.mixed()
        point = self.frame.points(self.position)
        self.offset, self.swivel, self.programmed = offset, swivel, programmed
        self.frame = offset.then(swivel).then(programmed)
        mixed |= self.frame.mixed()
        self.position = self.frame.to_program(point)
        if mixed.any():
            self.known = np.where(mixed, self.known[mixed].all(), self.known)

    def set_unit(self, length: float, feed: float | None) -> None:
        """Change the mm per unit of lengths, and of feeds unless None; the feed in force stays as fast as it is."""
        self.scale = length
        if feed is not None:
            self.feed, self.feed_scale = self.feed * self.feed_scale / feed, feed

    def restore(self, before: State) -> None:
        """Restore a copy made earlier."""
        self.__dict__.update(before.__dict__)

    def lose_position(self) -> None:
        """Mark the tip position as unknown: it depends on the original machine."""
        self.known = np.zeros(3, dtype=np.bool_)

    def spindle(self) -> float:
        """Signed spindle speed, 1/min."""
        return 0.0 if not self.sense else self.sense * self.speed

    def is_tilted(self) -> bool:
        """Whether the tool axis is tilted in {C}."""
        return bool(abs(self.axis[0]) > _TILTED or abs(self.axis[1]) > _TILTED or self.axis[2] < 0)

    def tip_tolerance(self) -> float:
        """The active tolerance of the tip, mm; 0 for none."""
        in_force = self.high_speed or self.compressor or self.smoothing in (642, 643, 645)
        return self.contour_tolerance if in_force and not (self.stops or self.exact_path) else 0.0
