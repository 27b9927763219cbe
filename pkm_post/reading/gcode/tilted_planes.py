# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tilted planes: the blocks of a program in a plane of G68.2, to which G53.1 turns the tool.

Input: plain blocks with their codes. Output: faults where the tool orientation is ambiguous. A control keeps the tool
direction from G68.2 to G53.1, and from G69 until rotary words turn it back; meanwhile X, Y and Z are not those of the
tip [Fanuc, tilted working plane command]. Here cuts are refused meanwhile, and the tip position after the turn is
unknown: the next positions with X, Y and Z are those of the tip again.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from pkm_post.model import Array, distinct, forward_fill
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import NONE, Group, Word, name_of, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.modal import Modal, is_one_of
from pkm_post.reading.gcode.motions import Motions
from pkm_post.reading.gcode.work_offsets import SETS_OFFSETS, TILTED_PLANE

TURN_TO_PLANE, _END = 531, 690
_UPRIGHT, _CHOSEN, _TURNED, _LEFT = range(4)
"""The tool stands as its words say; a plane is selected; the tool is turned to it; the plane is cancelled with the
tool turned."""
_TILTED = 1e-9


def check_tilted_planes(blocks: Blocks, modal: Modal, axes: Array, faults: BlockDiagnostics) -> None:
    """Report blocks whose meaning on a control depends on the tool orientation.

    ``axes``, (N, 3), are tool axes in program coordinates, from their own words.
    """
    turns = np.zeros(len(blocks), np.bool_)
    turns[blocks.rows_of_g(TURN_TO_PLANE)] = True
    if TILTED_PLANE not in blocks.g and not turns.any():
        return
    state, report = _states(blocks), partial(faults.add_where, "G432")
    report(modal.moves & (state == _CHOSEN), "a move between G68.2 and G53.1")
    cuts = modal.moves & (modal.active[Group.MOTION] != 0)
    report(cuts & (state == _LEFT), "a cut after G69 before rotary words have turned the tool back")
    inside = (state == _CHOSEN) | (state == _TURNED)
    changes = is_one_of(modal.programmed[Group.ONCE], *SETS_OFFSETS)
    report(inside & changes, "another origin within the plane")
    rotary = np.any([blocks.has(letter) & (blocks.word(letter) != 0) for letter in "ABC"], axis=0)
    tilted = (np.abs(axes[:, :2]) > _TILTED).any(axis=1)
    report((inside & rotary) | (tilted & (state == _TURNED)), "words for the tool axis within the plane")
    half = ~inside & rotary & tilted & _one_word_since_turn(blocks, np.flatnonzero(turns))
    report(half, "a rotary word without the other one, which G53.1 has turned")
    rotation = modal.programmed[Group.ROTATION]
    report(inside & (rotation == 680), "G68 within the plane")
    report(turns & ~inside, "G53.1 without G68.2")
    planes = rotation == TILTED_PLANE
    for group, kind in ((Group.ROTATION, 680), (Group.MIRROR, 511)):
        codes = np.flatnonzero(modal.programmed[group] != NONE)
        before = forward_fill(codes + 1, modal.programmed[group][codes], NONE, len(blocks) + 1)[:-1]
        report(planes & (before == kind), f"a plane while {name_of(kind)} is in force")
    for row in np.flatnonzero(planes).tolist():
        _check_words(blocks, row, faults)
    for row in np.flatnonzero(turns & inside).tolist():
        faults.add("G433", row, word_of(TURN_TO_PLANE))


def _one_word_since_turn(blocks: Blocks, turns: Array) -> Array:
    """Mask of blocks after G53.1 with only one of the program's rotary words written again since, (N,)."""
    count = len(blocks)
    turn = forward_fill(turns, turns, -1, count)
    words = [rows for letter in "ABC" if len(rows := np.flatnonzero(blocks.has(letter)))]
    again = sum(forward_fill(rows, rows, -1, count) > turn for rows in words)
    return (turn >= 0) & (again < min(len(words), 2))


_EULER, _ROLL_PITCH_YAW = 0.0, 1.0
_REFUSED = {
    _ROLL_PITCH_YAW: "several of the angles roll, pitch and yaw; one alone is understood",
    2.0: "a plane through three points",
    3.0: "a plane by two vectors",
    4.0: "a plane by projection angles",
}
"""Refused kinds by P [Fanuc, tilted working plane command; Mazak]."""


def _check_words(blocks: Blocks, row: int, faults: BlockDiagnostics) -> None:
    """Report missing or useless words of G68.2, and planes not given by Euler angles.

    Roll, pitch and yaw apply in the order of Q; a single one is a turn about its axis, in any order.
    """
    words = {letter: float(blocks.word(letter)[row]) for letter in "XYZIJKPQR"}
    given = {letter for letter, value in words.items() if value == value}
    kind = words["P"] if "P" in given else _EULER
    several = sum(words[letter] != 0 for letter in given & set("IJK")) > 1
    if kind in _REFUSED and (several or kind != _ROLL_PITCH_YAW):
        faults.add("G402", row, (word_of(TILTED_PLANE), " ", Word("P", kind), f": {_REFUSED[kind]}"))
    elif kind not in (_EULER, _ROLL_PITCH_YAW):
        faults.add("G406", row, (word_of(TILTED_PLANE), " ", Word("P", kind)))
    else:
        for letter in sorted(set("XYZIJK") - given) if kind == _EULER else ():
            faults.add("G405", row, (word_of(TILTED_PLANE), f" without {letter}"))
        for letter in sorted(given & set("QR" if kind == _EULER else "R")):
            faults.add("G404", row, Word(letter, words[letter]))


def check_unknown_positions_after_turns(blocks: Blocks, motions: Motions, faults: BlockDiagnostics) -> None:
    """Report moves that start or end at an unknown tip position after the tool was turned to a plane.

    Cuts that start there are refused; after G69 such rapid moves are a warning, as they are retracts that are left out.
    """
    turns = blocks.rows_of_g(TURN_TO_PLANE)
    if not len(turns):
        return
    cuts = np.flatnonzero((motions.motion != 0) & (motions.block > turns[0]))
    _, known = motions.starts(cuts)
    for block in distinct(motions.block[cuts[~known]]).tolist():
        faults.add("G416", block, "a cut from where the tool was turned to")
    left_out = ~motions.known & (motions.motion == 0) & (_states(blocks)[motions.block] == _LEFT)
    for block in distinct(motions.block[left_out]).tolist():
        faults.add("G443", block, "a move after G69")


def _states(blocks: Blocks) -> Array:
    """The tool state in each block, (N,); codes act before the motion."""
    codes = np.isin(blocks.g, (TILTED_PLANE, TURN_TO_PLANE, _END))
    # C alone tilts no tool; A and C, or B and C, give its axis.
    tilting = blocks.has("A") | blocks.has("B")
    turned = np.flatnonzero((blocks.word("A") == 0) | (blocks.word("B") == 0) | (tilting & blocks.has("C")))
    rows = np.concatenate([blocks.g_row[codes], turned])
    order = np.argsort(rows, kind="stable")
    found = np.concatenate([blocks.g[codes], np.zeros(len(turned), np.int32)])[order].tolist()
    state, states = _UPRIGHT, []
    for code in found:
        state = _AFTER.get((state, code), state)
        states.append(state)
    return forward_fill(rows[order], np.array(states, np.uint8), _UPRIGHT, len(blocks))


_AFTER = {
    **{(state, TILTED_PLANE): _CHOSEN for state in range(4)},
    (_CHOSEN, TURN_TO_PLANE): _TURNED,
    (_CHOSEN, _END): _UPRIGHT,
    (_TURNED, _END): _LEFT,
    (_LEFT, 0): _UPRIGHT,
}
"""The next state by state and code, 0 for rotary words that say how the tool stands. A further plane starts from the
tool in this one."""
