# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool axes: convert tool axis words to unit vectors.

Input: columns of I J K after G43.5, of its equivalents on other controls, or of rotary words in degrees under a
declared kinematic. Output: unit tool axes in program coordinates, from the tip towards the spindle, and unit surface
normals. k = Rz(C) Ry(B) Rx(A) e_z, with zero for an angle that the kinematic lacks: (sin B cos C, sin B sin C, cos B)
for a BC head, (sin A sin C, -sin A cos C, cos A) for an AC head.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import torsion
from pkm_post.model import Array, checkpoint, forward_fill, read_only, uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, TO_REFERENCE, Group, Word, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.frames import normal_coordinate, tool_directions
from pkm_post.reading.gcode.modal import Modal, is_arc, is_cycle, track_coordinate
from pkm_post.reading.gcode.motions import KEPT, LOST, OTHERS_LOST, Motions, as_slice
from pkm_post.reading.gcode.options import AXIS_WORDS, NORMAL_WORDS, VECTOR_WORDS, ReadOptions

_BY_ANGLES, _BY_VECTOR, _TURN_TO_PLANE = 434, 435, 531
_UPRIGHT = (0.0, 0.0, 1.0)
_TILTED = 1e-9
"""rad: a tool axis closer to vertical counts as vertical."""
_ALONG = 1 - 1e-12
"""Cosine of a millionth of a radian, the resolution of six decimals: a tool axis within this counts as aligned."""
_LENGTH_ERROR = 1e-3
"""A normal whose length differs more from 1 is reported; less is rounding."""


def tool_axes(
    blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics
) -> tuple[Array, Array, Array]:
    """Tool axes, and blocks that turn the tool while X, Y and Z are slide positions rather than the tip.

    Returns:
        (N, 3) unit tool axis at the end of each block, (N,) ``KEPT``, ``OTHERS_LOST`` or ``LOST``, and (N,) whether the
        block has words for the axis.
    """
    if options.axis_words == "none":
        return uniform(_UPRIGHT, len(blocks)), uniform(KEPT, len(blocks), np.uint8), uniform(False, len(blocks))
    find, code = (_vectors, _BY_VECTOR) if options.axis_words == "vector" else (_angles, _BY_ANGLES)
    axes, given = find(blocks, modal, options, faults)
    lost = uniform(KEPT, len(blocks), np.uint8)
    if options.axis_words != "RPY":
        # Without tip control, X Y Z are slide positions, and the tip position depends on the machine; the place of
        # rapid moves with G53 is the tip's.
        checkpoint()
        idle = modal.moves & (modal.active[Group.LENGTH] != code)
        if idle.any():
            idle &= given | ~_to_machine_positions(modal)
        if find is _angles and idle.any():
            lost = _unknown_positions(modal, axes, given, idle, faults)
            idle &= lost == KEPT
        faults.add_where("G424", idle & ~given & _tilted(axes), lambda row: shown_axis(axes[row]))
    checkpoint()
    return read_only(axes), lost, given


def _to_machine_positions(modal: Modal) -> Array:
    """Whether each block is a rapid move with G53, (N,)."""
    rapid = modal.flavour.g53_is_rapid | (modal.active[Group.MOTION] == 0)
    return np.asarray((modal.programmed[Group.ONCE] == 530) & rapid)


def axes_in_work_frame(
    motions: Motions, axes: Array, written: Array, spin: Array, options: ReadOptions, faults: BlockDiagnostics
) -> Array:
    """Tool axes in {C}, (n, 3); reports words for rotary axes, which no rotation turns, while one is in force.

    ``axes``, ``written`` and ``spin`` are those of ``BlockStates``.
    """
    own, words = motions.of_blocks(axes), uniform(NONE, len(motions))
    if options.axis_words == "vector" and written.any():
        blocks = np.flatnonzero(written)
        last = motions.of_blocks(forward_fill(blocks, blocks, NONE, len(written)))
        words = np.where(last < 0, NONE, motions.block.searchsorted(last))
    elif written.any():
        in_turned = np.array([frame.is_turned for frame in motions.frames])[motions.frame]
        wrong = np.zeros(len(written), dtype=np.bool_)
        wrong[motions.block[in_turned]] = True
        wrong &= written & (_tilted(axes) | (np.nan_to_num(spin) != 0))
        faults.add_where("G414", wrong, "rotary axes, which do not turn with the coordinates")
    return tool_directions(motions.frames, motions.frame, own, words)


def _tilted(axes: Array) -> Array:
    """Whether each tool axis is tilted, (N,)."""
    return (np.abs(axes[:, 0]) > _TILTED) | (np.abs(axes[:, 1]) > _TILTED) | (axes[:, 2] < 0)


def shown_axis(axis: Array) -> str:
    """A (3,) tool axis as text."""
    return f"({axis[0]:.6f}, {axis[1]:.6f}, {axis[2]:.6f})"


def _unknown_positions(modal: Modal, axes: Array, given: Array, idle: Array, faults: BlockDiagnostics) -> Array:
    """Knowledge of the tip position after rapid moves without tip control that tilt the tool or bring it upright, (N,).

    A head then turns about its own axes, and the tip position depends on the original machine. The next positions with
    tip control are those of the tip again.
    """
    tilted = _tilted(axes)
    before = np.append(False, tilted[:-1])[: len(tilted)]
    # A tool tilted with tip control that continues without it is another fault: its position was known.
    words = np.flatnonzero(given)
    by_idle = forward_fill(words, idle[words].astype(np.uint8), 0, len(given)) == 1
    turns = idle & (modal.active[Group.MOTION] == 0) & (modal.programmed[Group.ONCE] == NONE) & by_idle
    turns &= tilted | (before & given)
    faults.add_where("G431", turns & tilted & ~before, lambda row: f"tool axis {shown_axis(axes[row])}")
    return np.select([turns & tilted, turns], [LOST, OTHERS_LOST], KEPT).astype(np.uint8)


def check_cycles(modal: Modal, axes: Array, faults: BlockDiagnostics) -> None:
    """Report holes not drilled along the tool axis, (N, 3): a cycle always moves along the normal of its plane."""
    rows = np.flatnonzero(modal.moves & is_cycle(modal.active[Group.MOTION]))
    axis, across = axes[rows], normal_coordinate(modal.active[Group.PLANE][rows])
    along = np.abs(np.take_along_axis(axis, across[:, None].astype(np.int64), axis=1)[:, 0])
    for row in rows[(along < _ALONG) & (axis[:, 2] < _ALONG)].tolist():
        faults.add("G429", row, f"tool axis {shown_axis(axes[row])}")
    upright = rows[(along < _ALONG) & (axis[:, 2] >= _ALONG)] if modal.flavour.may_drill_along_z else rows[:0]
    for row in upright.tolist():
        plane = word_of(modal.at(Group.PLANE, row))
        faults.add("G429", row, (plane, ", where parameter 5101#0 may say Z: write G17"))


def _vectors(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> tuple[Array, Array]:
    """Tool axes, (N, 3), and the blocks with words for them, (N,)."""
    on_arc, in_cycle = is_arc(modal.active[Group.MOTION]), is_cycle(modal.active[Group.MOTION])
    words = [_component(blocks, letter, modal.moves & on_arc, in_cycle, faults) for letter in "IJK"]
    checkpoint()
    count = np.where(modal.moves & ~on_arc, np.sum([~np.isnan(word) for word in words], axis=0, dtype=np.uint8), 0)
    checkpoint()
    inactive = (count > 0) & (modal.active[Group.LENGTH] != _BY_VECTOR)
    faults.add_where("G415", inactive, "I J K without G43.5")
    faults.add_where("G415", ~inactive & (count > 0) & (count < 3), lambda row: f"{count[row]} of the words I J K")
    checkpoint()
    whole = np.flatnonzero(count == 3)
    unit, length = _unit([word[as_slice(whole)] for word in words])
    for row in whole[length == 0].tolist():
        if not inactive[row]:
            faults.add("G415", row, (Word("I", 0), " ", Word("J", 0), " ", Word("K", 0)))
    if not len(whole):
        return uniform(_UPRIGHT, len(blocks)), count > 0
    axes = np.empty((len(blocks), 3))
    for column, before in enumerate(_UPRIGHT):
        checkpoint()
        axes[:, column] = forward_fill(whole, unit[column], before, len(blocks))
    return axes, count > 0


def _component(blocks: Blocks, letter: str, on_arc: Array, in_cycle: Array, faults: BlockDiagnostics) -> Array:
    """Values of a tool axis component, from the words of any dialect, (N,); K of a cycle is a repeat count."""
    value = np.where(in_cycle, np.nan, blocks.word(letter)) if in_cycle.any() else blocks.word(letter)
    for name in VECTOR_WORDS[letter]:
        if name != letter and name in blocks.words:
            given = blocks.has(name)
            faults.add_where("G317", given & on_arc, lambda row, name=name: (Word(name), " on an arc"))  # type: ignore[misc]
            twice = given & ~on_arc & ~np.isnan(value)
            faults.add_where("G317", twice, lambda row, name=name: (Word(name), f" and another word for {letter}"))  # type: ignore[misc]
            value = np.where(given, blocks.words[name], value)
    return value


def _unit(vectors: list[Array]) -> tuple[list[Array], Array]:
    """Normalise vectors given by component, and return their former lengths; zero vectors are unchanged."""
    length = np.sqrt(vectors[0] ** 2 + vectors[1] ** 2 + vectors[2] ** 2)
    return [component / np.where(length > 0, length, 1.0) for component in vectors], length


def surface_normals(blocks: Blocks, faults: BlockDiagnostics) -> Array:
    """Unit surface normals, (N, 3), NaN where a block gives none: they are not modal."""
    given = [blocks.has(name) for name in NORMAL_WORDS if name in blocks.words]
    if not given:
        return uniform((np.nan, np.nan, np.nan), len(blocks))
    count = np.asarray(np.sum(given, axis=0, dtype=np.uint8))
    faults.add_where("G422", (count > 0) & (count < 3), lambda row: f"{count[row]} of the words NX NY NZ")
    unit, length = _unit([blocks.word(name) for name in NORMAL_WORDS])
    faults.add_where("G422", length == 0, (Word("NX", 0), " ", Word("NY", 0), " ", Word("NZ", 0)))
    faults.add_where(
        "G423", (np.abs(length - 1) > _LENGTH_ERROR) & (length > 0), lambda row: f"length {length[row]:.6f}"
    )
    return read_only(np.column_stack(unit))


def _angles(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> tuple[Array, Array]:
    """Tool axes, (N, 3), and the blocks with words for them, (N,)."""
    words = _rotary_words(blocks, modal, options)
    axes = axis_of(_in_rad(modal, words))
    given: Array = modal.moves & np.any([~np.isnan(word) for word in words.values()], axis=0)
    _check_references(blocks, modal, words, faults)
    if options.axis_words != "RPY":
        # Without G43.4 a machine with such a head takes X Y Z as slide positions, not as the tip position.
        inactive = given & (modal.active[Group.LENGTH] != _BY_ANGLES) & (modal.active[Group.MOTION] != 0)
        inactive &= _tilted(axes)
        faults.add_where("G414", inactive, lambda row: (_first(words, row), " without ", word_of(_BY_ANGLES)))
    return axes, given


def _check_references(blocks: Blocks, modal: Modal, words: dict[str, Array], faults: BlockDiagnostics) -> None:
    """Report rotary words of G28 and G30, unless they and the angles in force are 0: then nothing turns."""
    rows = np.flatnonzero(np.isin(modal.takes_axes, TO_REFERENCE))
    if not len(rows):
        return
    here = {letter: blocks.word(letter)[rows] for letter in words}
    turns = _in_rad(modal, words)[rows].any(axis=1) | np.any(
        [np.nan_to_num(word) != 0 for word in here.values()], axis=0
    )
    for index in np.flatnonzero(turns & np.any([~np.isnan(word) for word in here.values()], axis=0)).tolist():
        code = word_of(int(modal.takes_axes[rows[index]]))
        found = _first(here, index), " of ", code, ", a way to a place that is not known: turn with G0"
        faults.add("G404", int(rows[index]), found)


def spins(blocks: Blocks, modal: Modal, options: ReadOptions) -> Array:
    """Rotation of the platform about the tool axis in rad, (N,), from A B C of a hexapod; NaN where unspecified."""
    if options.axis_words != "RPY":
        return uniform(np.nan, len(blocks))
    angles = _in_rad(modal, _rotary_words(blocks, modal, options))
    return read_only(np.unwrap(torsion(axis_of(angles), x_of(angles))))


def _rotary_words(blocks: Blocks, modal: Modal, options: ReadOptions) -> dict[str, Array]:
    """Rotary words by letter, (N,); G53.1 puts 0, the tool along Z of its plane, in place of words before it."""
    words = {letter: np.where(modal.moves, blocks.word(letter), np.nan) for letter in AXIS_WORDS[options.axis_words]}
    for word in words.values():
        word[blocks.rows_of_g(_TURN_TO_PLANE)] = 0.0
    return words


def _in_rad(modal: Modal, words: dict[str, Array]) -> Array:
    """Angles A, B, C in each block, (N, 3)."""
    relative = modal.moves & (modal.active[Group.DISTANCE] == 910)
    degrees = np.zeros((len(relative), 3))
    for letter, word in words.items():
        degrees[:, "ABC".index(letter)], _ = track_coordinate(word, relative, 0.0)
    return np.radians(degrees)


def _first(words: dict[str, Array], row: int) -> Word:
    """The first rotary word of a block."""
    return next(Word(letter, word[row]) for letter, word in words.items() if not np.isnan(word[row]))


def x_of(angles: Array) -> Array:
    """The x axes of platforms at angles A, B, C in rad, (n, 3) to (n, 3): Rz(C) Ry(B) Rx(A) e_x."""
    (_, sin_b, sin_c), (_, cos_b, cos_c) = np.sin(angles).T, np.cos(angles).T
    return np.column_stack([cos_c * cos_b, sin_c * cos_b, -sin_b])


def axis_of(angles: Array) -> Array:
    """Unit tool axes of angles A, B, C in rad, (n, 3) to (n, 3): k = Rz(C) Ry(B) Rx(A) e_z."""
    (sin_a, sin_b, sin_c), (cos_a, cos_b, cos_c) = np.sin(angles).T, np.cos(angles).T
    return np.column_stack([
        cos_c * cos_a * sin_b + sin_c * sin_a,
        sin_c * cos_a * sin_b - cos_c * sin_a,
        cos_a * cos_b,
    ])  # fmt: skip
