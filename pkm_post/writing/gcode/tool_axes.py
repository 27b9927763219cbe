# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialects of G-code that a program can be written in, and the tool axis words of each.

Input: unit tool axes in {C}. Output: columns of words: vector components, or angles in degrees under a kinematic,
continuous from row to row. The formulas invert those of ``axes.py``. Where linear interpolation of the angles leaves
the great circle between two tool axes, the deviation is reported.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from pkm_post.geometry import along, angle_between, torsion_free_axes, towards
from pkm_post.model import Array
from pkm_post.reading import axis_of

POLE = 2e-6
"""rad: a tool axis closer to +z or -z does not rotate C. Vectors with six decimals have no azimuth within this."""


MAX_AXIS_DEVIATION = np.radians(0.1)
"""Deviation of the tool axis from the great circle between two rows, rad, above which it is reported."""

_SAMPLES = (0.25, 0.5, 0.75)
"""Fractions of a move at which its tool axis is compared with the great circle."""


class GcodeDialect(Enum):
    """Tool axis notation; the values are those of the command line."""

    VECTOR = "vector"
    """I J K after G43.5."""
    AC = "AC"
    """Rotary words of an AC head after G43.4: k = Rz(C) Rx(A) e_z."""
    BC = "BC"
    """Rotary words of a BC head after G43.4: k = Rz(C) Ry(B) e_z."""
    LINUXCNC = "linuxcnc"
    """A B C of LinuxCNC's hexapod: R = Rz(C) Ry(B) Rx(A) takes z to k, with the spin of the program."""
    PLAIN = "3axis"
    """No words: the tool axis is vertical on every row."""


@dataclass(frozen=True)
class AxisWords:
    """Tool axis words of a dialect.

    Attributes:
        letters: of the words.
        length_code: code that enables tool length compensation.
        as_vector: whether the words are written all or none, and never with an arc, where I J K are its centre.
        values: maps (N, 3) unit axes and (N,) spins to (N, len(letters)) words.
    """

    letters: str
    length_code: str
    as_vector: bool
    values: Callable[[Array, Array], Array]


def _head(axis: Array, lead: float) -> Array:
    """Tilt and rotation of a head in degrees, (N, 2), with continuous C.

    An axis has two solutions, (tilt, C) and (-tilt, C + half a turn). The one whose C is closer to the previous row is
    chosen: through the pole the tilt changes sign and C is continuous.
    """
    level = np.hypot(axis[:, 0], axis[:, 1])
    azimuth = _azimuth_at_pole(np.arctan2(axis[:, 1], axis[:, 0]), level < POLE)
    unbroken = np.unwrap(azimuth, period=np.pi)
    odd = np.rint((unbroken - azimuth) / np.pi).astype(np.int64) % 2 == 1
    tilt = np.arctan2(np.where(odd, -level, level), axis[:, 2])
    return np.degrees(np.column_stack([tilt, unbroken + lead]))


def _azimuth_at_pole(azimuth: Array, at_pole: Array) -> Array:
    """Fill in azimuths at the pole from their neighbours.

    The first row of a run at the pole keeps the azimuth before it, the others take the one after it: a necessary
    rotation of C happens while the tool is vertical.
    """
    known = np.flatnonzero(~at_pole)
    if not len(known):
        return np.zeros_like(azimuth)
    rows = np.arange(len(azimuth))
    after = np.searchsorted(known, rows)
    keeps = at_pole & ~np.append(False, at_pole[:-1])
    source = np.where((keeps & (after > 0)) | (after == len(known)), after - 1, after)
    return azimuth[known[source]]


def _roll_pitch_yaw(axis: Array, spin: Array) -> Array:
    """A, B, C in degrees, (N, 3), of R(k, psi) = Rmin(k) Rz(psi): without torsion where no spin is known."""
    straight, across = torsion_free_axes(axis)
    cosine, sine = np.cos(np.nan_to_num(spin))[:, None], np.sin(np.nan_to_num(spin))[:, None]
    x, y = cosine * straight + sine * across, cosine * across - sine * straight
    pitch, yaw = np.arcsin(np.clip(-x[:, 2], -1, 1)), np.arctan2(x[:, 1], x[:, 0])
    return np.degrees(np.unwrap(np.column_stack([np.arctan2(y[:, 2], axis[:, 2]), pitch, yaw]), axis=0))


NOTATIONS: dict[GcodeDialect, AxisWords] = {
    GcodeDialect.VECTOR: AxisWords("IJK", "G43.5", True, lambda axis, spin: axis),
    # k = (sin A sin C, -sin A cos C, cos A): C leads the azimuth of k by a quarter turn.
    GcodeDialect.AC: AxisWords("AC", "G43.4", False, lambda axis, spin: _head(axis, np.pi / 2)),
    GcodeDialect.BC: AxisWords("BC", "G43.4", False, lambda axis, spin: _head(axis, 0.0)),
    GcodeDialect.LINUXCNC: AxisWords("ABC", "G43", False, _roll_pitch_yaw),
    GcodeDialect.PLAIN: AxisWords("", "G43", False, lambda axis, spin: np.empty((len(axis), 0))),
}


def axis_deviation(axis: Array, spin: Array, dialect: GcodeDialect) -> Array:
    """Deviation of the tool axis from its great circle under linear interpolation of the angles, (N,), rad.

    Row i holds the deviation of the move to it. It is 0 for forms without angles, and is measured at equal fractions of
    both motions, so lag counts, too.

    Args:
        axis: (N, 3) unit tool axes.
        spin: (N,) rotations about them, rad, or NaN.
        dialect: tool axis notation.
    """
    swing = np.zeros(len(axis))
    words = NOTATIONS[dialect]
    if words.as_vector or not words.letters:
        return swing
    angles = np.zeros_like(axis)
    angles[:, ["ABC".index(letter) for letter in words.letters]] = np.radians(words.values(axis, spin))
    turning = np.flatnonzero(np.any(angles[1:] != angles[:-1], axis=1)) + 1
    before, after = axis[turning - 1], axis[turning]
    way, step = towards(before, after), angles[turning] - angles[turning - 1]
    for part in _SAMPLES:
        led = axis_of(angles[turning - 1] + part * step)
        swing[turning] = np.maximum(swing[turning], angle_between(led, along(before, part * way)))
    return swing


_LEVEL, _UPSIDE_DOWN = "the tool axis is {:.6f} deg from upright", "the tool axis is ({:.6f}, {:.6f}, {:.6f})"


def unsupported_axis(axis: Array, dialect: GcodeDialect) -> tuple[int, str, str] | None:
    """The first row whose tool axis a dialect cannot express, with fault code and finding; or None."""
    if dialect is GcodeDialect.PLAIN:
        level = np.hypot(axis[:, 0], axis[:, 1])
        tilted = np.flatnonzero((level > POLE) | (axis[:, 2] < 0))
        if len(tilted):
            angle = np.degrees(np.arctan2(level[tilted[0]], axis[tilted[0], 2]))
            return int(tilted[0]), "G501", _LEVEL.format(angle)
    if dialect is GcodeDialect.LINUXCNC:
        hanging = np.flatnonzero(1 + axis[:, 2] < POLE)
        if len(hanging):
            return int(hanging[0]), "G502", _UPSIDE_DOWN.format(*axis[hanging[0]])
    return None
