# SPDX-License-Identifier: LGPL-2.1-or-later
"""The forms of G-code that a program can be written in, and the words by which each says the tool axis.

Unit tool axes in {C} enter, columns of words leave: components of the vector, or angles in degrees under a kinematic,
chosen so that they go on from row to row. The formulas are those of ``axes.py``, the other way round. Where angles that
go evenly from row to row lead a control off the great circle between two tool axes, it is told how far.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from pkm_post.gcode.axes import axis_of
from pkm_post.geometry import along, angle_between, towards, untwisted
from pkm_post.model.program import Array

POLE = 2e-6
"""rad: a tool axis nearer to +z or -z does not turn C. Vectors with six decimals have no direction within this."""


SWING = np.radians(0.1)
"""rad that the tool axis may leave the great circle between two rows before it is told."""

_LOOKED_AT = (0.25, 0.5, 0.75)
"""Parts of a move where its tool axis is compared with the great circle."""


class Form(Enum):
    """How the tool axis is said; the values are what people type."""

    VECTOR = "vector"
    """I J K after G43.5."""
    AC = "AC"
    """Rotary words of an AC head after G43.4: k = Rz(C) Rx(A) e_z."""
    BC = "BC"
    """Rotary words of a BC head after G43.4: k = Rz(C) Ry(B) e_z."""
    LINUXCNC = "linuxcnc"
    """A B C of LinuxCNC's hexapod: R = Rz(C) Ry(B) Rx(A) takes z to k, with the spin of the program."""
    PLAIN = "3axis"
    """No words: the tool axis is upright on every row."""


@dataclass(frozen=True)
class AxisWords:
    """What a form writes for the tool axis.

    Attributes:
        letters: of the words.
        follows: the code that switches tool length compensation on.
        as_vector: whether the words are said all or none, and not at all with an arc, where they are its centre.
        values: from (N, 3) unit axes and (N,) spins to (N, len(letters)) words.
    """

    letters: str
    follows: str
    as_vector: bool
    values: Callable[[Array, Array], Array]


def _vector(axis: Array, spin: Array) -> Array:
    return axis


def _nothing(axis: Array, spin: Array) -> Array:
    return np.empty((len(axis), 0))


def _ac(axis: Array, spin: Array) -> Array:
    # k = (sin A sin C, -sin A cos C, cos A): C is a quarter turn ahead of the azimuth of k.
    return _head(axis, np.pi / 2)


def _bc(axis: Array, spin: Array) -> Array:
    return _head(axis, 0.0)


def _head(axis: Array, lead: float) -> Array:
    """Tilt and turn of a head in degrees, (N, 2), with C unbroken.

    An axis has two answers, (tilt, C) and (-tilt, C + half a turn). The one whose C is nearer to the row before is
    taken: through the pole the tilt changes its sign and C goes on.
    """
    level = np.hypot(axis[:, 0], axis[:, 1])
    azimuth = _filled(np.arctan2(axis[:, 1], axis[:, 0]), level < POLE)
    unbroken = np.unwrap(azimuth, period=np.pi)
    odd = np.rint((unbroken - azimuth) / np.pi).astype(np.int64) % 2 == 1
    tilt = np.arctan2(np.where(odd, -level, level), axis[:, 2])
    return np.degrees(np.column_stack([tilt, unbroken + lead]))


def _filled(azimuth: Array, at_pole: Array) -> Array:
    """Azimuths with those at the pole filled in from their neighbours.

    The first row of a stretch at the pole keeps the azimuth before it, its others have the one after it: where C must
    turn, it turns while the tool stands upright.
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
    straight, across = untwisted(axis)
    cosine, sine = np.cos(np.nan_to_num(spin))[:, None], np.sin(np.nan_to_num(spin))[:, None]
    x, y = cosine * straight + sine * across, cosine * across - sine * straight
    pitch, yaw = np.arcsin(np.clip(-x[:, 2], -1, 1)), np.arctan2(x[:, 1], x[:, 0])
    return np.degrees(np.unwrap(np.column_stack([np.arctan2(y[:, 2], axis[:, 2]), pitch, yaw]), axis=0))


FORMS: dict[Form, AxisWords] = {
    Form.VECTOR: AxisWords("IJK", "G43.5", True, _vector),
    Form.AC: AxisWords("AC", "G43.4", False, _ac),
    Form.BC: AxisWords("BC", "G43.4", False, _bc),
    Form.LINUXCNC: AxisWords("ABC", "G43", False, _roll_pitch_yaw),
    Form.PLAIN: AxisWords("", "G43", False, _nothing),
}


def swings(axis: Array, spin: Array, form: Form) -> Array:
    """How far angles that go evenly from row to row lead the tool axis off its great circle, (N,), rad.

    Row i holds that of the move to it. It is 0 for forms that have no angles, and measured where both ways have done
    the same part, so a lag counts as well.

    Args:
        axis: (N, 3) unit tool axes.
        spin: (N,) turns about them, rad, or NaN.
        form: how they are said.
    """
    swing = np.zeros(len(axis))
    words = FORMS[form]
    if words.as_vector or not words.letters:
        return swing
    angles = np.zeros_like(axis)
    angles[:, ["ABC".index(letter) for letter in words.letters]] = np.radians(words.values(axis, spin))
    turning = np.flatnonzero(np.any(angles[1:] != angles[:-1], axis=1)) + 1
    before, after = axis[turning - 1], axis[turning]
    way, step = towards(before, after), angles[turning] - angles[turning - 1]
    for part in _LOOKED_AT:
        led = axis_of(angles[turning - 1] + part * step)
        swing[turning] = np.maximum(swing[turning], angle_between(led, along(before, part * way)))
    return swing


_LEVEL, _UPSIDE_DOWN = "the tool axis is {:.6f} deg from upright", "the tool axis is ({:.6f}, {:.6f}, {:.6f})"


def impossible_axis(axis: Array, form: Form) -> tuple[int, str, str] | None:
    """The first row whose tool axis a form cannot say, with the code of the fault and what was found; or None."""
    if form is Form.PLAIN:
        level = np.hypot(axis[:, 0], axis[:, 1])
        tilted = np.flatnonzero((level > POLE) | (axis[:, 2] < 0))
        if len(tilted):
            angle = np.degrees(np.arctan2(level[tilted[0]], axis[tilted[0], 2]))
            return int(tilted[0]), "G501", _LEVEL.format(angle)
    if form is Form.LINUXCNC:
        hanging = np.flatnonzero(1 + axis[:, 2] < POLE)
        if len(hanging):
            return int(hanging[0]), "G502", _UPSIDE_DOWN.format(*axis[hanging[0]])
    return None
