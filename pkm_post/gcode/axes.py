# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes: the words that say the tool axis become unit vectors.

I J K after G43.5, or rotary words in degrees under a declared kinematic, enter as columns; unit tool axes in
coordinates of the program leave, from the tip towards the spindle. k = Rz(C) Ry(B) Rx(A) e_z, with zero for an angle
that the kinematic has not: (sin B cos C, sin B sin C, cos B) for a BC head, (sin A sin C, -sin A cos C, cos A) for an
AC head.
"""

from __future__ import annotations

import numpy as np

from pkm_post.gcode.blocks import Blocks, column_of
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.modal import ARCS, Group, Modal, carried
from pkm_post.gcode.options import AXIS_WORDS, ReadOptions
from pkm_post.gcode.positions import follow
from pkm_post.geometry import norm
from pkm_post.model.program import Array

_BY_ANGLES, _BY_VECTOR = 434, 435


def tool_axes(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> Array:
    """Unit tool axis at the end of each block, (N, 3)."""
    if options.axis_words == "vector":
        return _vectors(blocks, modal, faults)
    if options.axis_words != "none":
        return _angles(blocks, modal, options, faults)
    return np.tile([0.0, 0.0, 1.0], (len(blocks), 1))


def _columns(blocks: Blocks, letters: str) -> Array:
    return blocks.words[:, [column_of(letter) for letter in letters]]


def _vectors(blocks: Blocks, modal: Modal, faults: Findings) -> Array:
    words = _columns(blocks, "IJK")
    turning = modal.moves & ~np.isin(modal.in_force[Group.MOTION], ARCS)
    count = np.where(turning, (~np.isnan(words)).sum(axis=1), 0)
    length = norm(np.where((count == 3)[:, None], words, 1.0))
    inactive = (count > 0) & (modal.in_force[Group.LENGTH] != _BY_VECTOR)
    faults.tell_all("G415", inactive, lambda _: "I J K without G43.5")
    faults.tell_all("G415", ~inactive & (count > 0) & (count < 3), lambda row: f"{count[row]} of the words I J K")
    faults.tell_all("G415", ~inactive & (length == 0), lambda _: "I0 J0 K0")
    usable = (count == 3) & (length > 0)
    unit = words / np.where(length > 0, length, 1.0)[:, None]
    return np.column_stack([carried(unit[:, axis], usable, upright) for axis, upright in enumerate((0.0, 0.0, 1.0))])


def _angles(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> Array:
    words = np.where(modal.moves[:, None], _columns(blocks, "ABC"), np.nan)
    for column, letter in enumerate("ABC"):
        if letter not in AXIS_WORDS[options.axis_words]:
            words[:, column] = np.nan
    given = ~np.isnan(words).all(axis=1)
    if options.axis_words != "RPY":
        # Without G43.4 a machine with such a head would take X Y Z for places of its slides, not of the tip.
        inactive = given & (modal.in_force[Group.LENGTH] != _BY_ANGLES)
        faults.tell_all("G414", inactive, lambda row: f"{_first(words[row])} without G43.4")
    degrees, _ = follow(words, modal.in_force[Group.DISTANCE] == 910, np.zeros(3))
    return axis_of(np.radians(degrees))


def _first(angles: Array) -> str:
    """The first rotary word of a block, as it is written."""
    column = int(np.argmin(np.isnan(angles)))
    return f"{'ABC'[column]}{angles[column]:g}"


def axis_of(angles: Array) -> Array:
    """Unit tool axes of angles A, B, C in rad, (n, 3) to (n, 3): k = Rz(C) Ry(B) Rx(A) e_z."""
    (sin_a, sin_b, sin_c), (cos_a, cos_b, cos_c) = np.sin(angles).T, np.cos(angles).T
    return np.column_stack([
        cos_c * cos_a * sin_b + sin_c * sin_a,
        sin_c * cos_a * sin_b - cos_c * sin_a,
        cos_a * cos_b,
    ])  # fmt: skip
