# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames: the coordinate systems of TRANS, ROT, SCALE and MIRROR, and their chains.

Input: words of frame statements, mm and degrees. Output: points and directions of the program in {C}:
{C} = matrix @ program + shift. A frame without the prefix A replaces the programmable frame with all its parts, one
with A is chained after it [SiemensNC, programmable coordinate transformations].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.frames import PLANES, rotation
from pkm_post.reading.siemens.diagnostics import BlockFault

_SAME = 1e-12
_AXES = "XYZ"


@dataclass(frozen=True)
class ProgrammableFrame:
    """{C} = matrix @ program + shift.

    Attributes:
        matrix: (3, 3) with scale factors.
        shift: (3,) mm.
        turn: (3, 3) without scale factors: a rotation, possibly with a reflection.
    """

    matrix: Array = field(default_factory=lambda: np.eye(3))
    shift: Array = field(default_factory=lambda: np.zeros(3))
    turn: Array = field(default_factory=lambda: np.eye(3))

    def then(self, inner: ProgrammableFrame) -> ProgrammableFrame:
        """The chain of two frames, the inner one nearer to the program."""
        return ProgrammableFrame(
            self.matrix @ inner.matrix, self.matrix @ inner.shift + self.shift, self.turn @ inner.turn
        )

    def points(self, points: Array) -> Array:
        """Transform (n, 3) or (3,) points of the program to {C}."""
        if self.is_plain():
            return points
        return np.einsum("ij,...j->...i", self.matrix, points) + self.shift

    def directions(self, vectors: Array) -> Array:
        """Transform (n, 3) or (3,) unit vectors to {C}."""
        return vectors if self.is_unturned() else np.einsum("ij,...j->...i", self.turn, vectors)

    def to_program(self, point: Array) -> Array:
        """Transform a (3,) point of {C} to the program."""
        if self.is_plain():
            return point
        return np.linalg.solve(self.matrix, point - self.shift)

    def is_plain(self) -> bool:
        """Whether it is the identity."""
        return bool((self.matrix == np.eye(3)).all() and not self.shift.any())

    def is_unturned(self) -> bool:
        """Whether it preserves all directions."""
        return bool((self.turn == np.eye(3)).all())

    def hand(self) -> float:
        """1 for a right-handed frame, -1 for a mirrored one."""
        return float(np.sign(np.linalg.det(self.turn)))

    def mixed(self) -> Array:
        """Mask of the coordinates that the frame mixes, (3,)."""
        off = np.abs(self.matrix - np.diag(np.diag(self.matrix))) > _SAME
        return off.any(axis=0) | off.any(axis=1)

    def keeps_circles(self, plane: int) -> bool:
        """Whether circles in a plane remain circles."""
        first, second, normal = PLANES[plane]
        metric = self.matrix.T @ self.matrix
        even = abs(metric[first, first] - metric[second, second]) <= _SAME * metric[first, first]
        off = max(abs(metric[i, j]) for i, j in ((first, second), (first, normal), (second, normal)))
        return bool(even and off <= _SAME * metric[first, first])


def about(axis: int, degrees: float) -> Array:
    """Rotation about X, Y or Z, 0 to 2, (3, 3)."""
    return rotation({0: 190, 1: 180, 2: 170}[axis], float(np.radians(degrees)))


def turned(matrix: Array) -> ProgrammableFrame:
    """A frame of a rotation or reflection, (3, 3)."""
    return ProgrammableFrame(matrix, np.zeros(3), matrix)


def _translation(words: Mapping[str, float], plane: int) -> ProgrammableFrame:
    return ProgrammableFrame(shift=np.array([words.get(axis, 0.0) for axis in _AXES]))


def _rotation(words: Mapping[str, float], plane: int) -> ProgrammableFrame:
    """Rotate about Z, new Y and new X, in this order [SiemensNC, ROT: RPY notation Z, Y', X'']; or in the plane."""
    if "RPL" in words:
        if len(words) > 1:
            raise BlockFault("G601", "RPL beside X, Y or Z")
        return turned(rotation(plane, float(np.radians(words["RPL"]))))
    x, y, z = (words.get(axis, 0.0) for axis in _AXES)
    return turned(about(2, z) @ about(1, y) @ about(0, x))


def _scaling(words: Mapping[str, float], plane: int) -> ProgrammableFrame:
    factors = [words.get(axis, 1.0) for axis in _AXES]
    if min(factors) <= 0:
        raise BlockFault("G606", f"a factor of {min(factors):g}")
    return ProgrammableFrame(matrix=np.diag(factors))


def _mirroring(words: Mapping[str, float], plane: int) -> ProgrammableFrame:
    """Mirror image; the values of the words are ignored [SiemensNC, MIRROR]."""
    return turned(np.diag([-1.0 if axis in words else 1.0 for axis in _AXES]))


MAKERS = {"TRANS": _translation, "ROT": _rotation, "SCALE": _scaling, "MIRROR": _mirroring}
FRAMES = frozenset([*MAKERS, *(f"A{name}" for name in MAKERS)])
"""Names of frame statements."""
LENGTHS = frozenset({"TRANS", "ATRANS"})
"""Frame statements whose words are lengths."""


def frame_of(name: str, words: Mapping[str, float], plane: int, before: ProgrammableFrame) -> ProgrammableFrame:
    """The programmable frame after a frame statement.

    Args:
        name: of the statement.
        words: X, Y, Z and RPL; lengths in mm.
        plane: code of the active plane, 170 for G17.
        before: the programmable frame so far.

    Raises:
        BlockFault: a word is unknown or invalid.
    """
    for word in words:
        if word not in _AXES and not (word == "RPL" and name.endswith("ROT")):
            raise BlockFault("G404", f"{word} beside {name}")
    if name in MAKERS:
        return MAKERS[name](words, plane)
    return before.then(MAKERS[name[1:]](words, plane))
