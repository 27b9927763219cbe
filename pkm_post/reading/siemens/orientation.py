# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orientation: the words of the tool axis after TRAORI as unit vectors.

Input: columns of A3= B3= C3=, of A2= B2= C2= after ORIEULER or ORIRPY, or of rotary axes under a declared notation.
Output: unit tool axes in {C}, from the tip towards the spindle. A missing component of the vector is zero
[SiemensNC, direction vector]; vectors and angles turn with the frame (ORIWKS), rotary axes are those of the machine.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from pkm_post.model import Array, forward_fill
from pkm_post.reading.gcode.modal import track_coordinate
from pkm_post.reading.gcode.options import AXIS_WORDS
from pkm_post.reading.gcode.tool_axes import axis_of
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.state import UPRIGHT, State

VECTOR, ANGLES, ROTARY = ("A3", "B3", "C3"), ("A2", "B2", "C2"), ("A", "B", "C")
_UPRIGHT_ENOUGH = 1 - 1e-15

Words = Mapping[str, Array]


def has_any(words: Words, names: tuple[str, ...], count: int) -> Array:
    """Whether each of n blocks has one of some words, (n,)."""
    given = np.zeros(count, dtype=np.bool_)
    for name in names:
        if name in words:
            given |= ~np.isnan(words[name])
    return given


def tool_axes(words: Words, relative: Array, state: State, notation: str) -> Array:
    """Tool axes of n blocks of moves after TRAORI, (n, 3), in {C}; the state keeps the last one.

    Args:
        words: by name, (n,) values, NaN where absent.
        relative: (n, 3) whether A, B and C are increments.
        state: of the program before them.
        notation: of the rotary axes, a key of ``AXIS_WORDS``.

    Raises:
        BlockFault: the words are invalid or ambiguous.
    """
    count = len(relative)
    by_vector, by_angles, by_rotary = (has_any(words, names, count) for names in (VECTOR, ANGLES, ROTARY))
    given = by_vector.astype(np.int64) + by_angles + by_rotary
    if (given > 1).any():
        raise BlockFault("G607", "two notations of the tool axis in one block")
    rows = np.flatnonzero(given)
    if not len(rows):
        return np.broadcast_to(state.axis, (count, 3))
    if state.in_machine_frame and not state.frame.is_unturned() and (by_vector | by_angles).any():
        raise BlockFault("G607", "vectors or angles after ORIMKS in a turned frame")
    axes = np.empty((count, 3))
    if by_vector.any():
        axes[by_vector] = state.frame.directions(_vectors(words, by_vector))
    if by_angles.any():
        axes[by_angles] = state.frame.directions(_from_angles(words, by_angles, state))
    if by_rotary.any():
        axes[by_rotary] = _from_rotary(words, relative, by_rotary, state, notation)
    filled = np.column_stack([forward_fill(rows, axes[rows, k], state.axis[k], count) for k in range(3)])
    state.axis = filled[-1]
    return filled


def _vectors(words: Words, rows: Array) -> Array:
    columns = [np.nan_to_num(words[name][rows]) if name in words else np.zeros(int(rows.sum())) for name in VECTOR]
    vectors = np.column_stack(columns)
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    if (length == 0).any():
        raise BlockFault("G415", "A3=0 B3=0 C3=0")
    return vectors / length[:, None]


def _from_angles(words: Words, rows: Array, state: State) -> Array:
    """Rz(A2) Rx(B2) e_z by Euler angles, Rz(C2) Ry(B2) Rx(A2) e_z by RPY angles [SiemensNC, ORIEULER, ORIRPY]."""
    if not state.angles:
        raise BlockFault("G608", "A2= B2= C2=")
    needed = ANGLES if state.angles == "ORIRPY" else ANGLES[:2]
    for name in needed:
        if name not in words or np.isnan(words[name][rows]).any():
            raise BlockFault("G405", f"{name}= beside the other angles of the tool axis")
    angles = np.radians(np.column_stack([words[name][rows] for name in needed]))
    if state.angles == "ORIRPY":
        return axis_of(angles)
    (first, second) = angles.T
    return np.column_stack([
        np.sin(first) * np.sin(second), -np.cos(first) * np.sin(second), np.cos(second)
    ])  # fmt: skip


def rotary_angles(words: Words, relative: Array, state: State) -> Array:
    """The rotary axes A, B and C after each of n blocks, (n, 3), degrees; the state keeps the last ones."""
    angles = np.empty((len(relative), 3))
    for k, name in enumerate(ROTARY):
        word = words.get(name)
        if word is None:
            angles[:, k] = state.rotary[k]
        else:
            angles[:, k], _ = track_coordinate(word, relative[:, k], float(state.rotary[k]))
    state.rotary = angles[-1]
    return angles


def axes_of_rotary(angles: Array, notation: str) -> Array:
    """Tool axes of rotary axes, (n, 3) degrees to (n, 3).

    Raises:
        BlockFault: an axis outside the notation is turned.
    """
    letters = AXIS_WORDS[notation] if notation in ("AC", "BC", "AB") else ""
    for k, name in enumerate(ROTARY):
        turned = np.flatnonzero(angles[:, k] != 0)
        if len(turned) and name not in letters:
            raise BlockFault("G607", f"{name}{angles[turned[0], k]:g}")
    return axis_of(np.radians(angles))


def _from_rotary(words: Words, relative: Array, rows: Array, state: State, notation: str) -> Array:
    axes = axes_of_rotary(rotary_angles(words, relative, state), notation)[rows]
    if not state.frame.is_unturned() and (axes @ UPRIGHT < _UPRIGHT_ENOUGH).any():
        raise BlockFault("G607", "rotary axes in a turned frame")
    return axes
