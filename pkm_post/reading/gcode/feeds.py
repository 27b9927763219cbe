# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feeds and path modes: F in any feed mode, and G61, G61.1 and G64.

Input: F by block, in the unit of its mode: units per minute (G94), units per revolution (G95), or inverse time in
1/min (G93); and the path control codes. Output: speeds of the tool tip in mm/s, by motion; and by block whether the
motion stops at its end (exact stop), whether corners are followed rather than rounded (exact path, as in all cycles),
and the permitted deviation of the tip from the path (G64 P), mm. A change of feed mode cancels F: the next cutting
move needs a new one. The flavour defines which of G61 and G61.1 is which. Q of G64, which merges nearly collinear
moves, is ignored: no moves are merged.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, forward_fill, uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import RIGID_TAP, Group, Word, word_of
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics, Found
from pkm_post.reading.gcode.modal import Modal, changed, is_cycle, is_one_of
from pkm_post.reading.gcode.motions import Motions
from pkm_post.reading.gcode.options import ReadOptions

INVERSE_TIME, _BY_MINUTE, _BY_TURN = 930, 940, 950


def feeds(
    blocks: Blocks,
    modal: Modal,
    spindle: Array,
    motions: Motions,
    path_length: Array,
    angle: Array,
    options: ReadOptions,
    faults: BlockDiagnostics,
) -> Array:
    """Speed of each motion, (n,), mm/s, of a turn in place degrees/s; NaN on rapids.

    Args:
        blocks: the program.
        modal: its modal codes.
        spindle: (N,) signed spindle speed, 1/min.
        motions: of the program.
        path_length: (n,) distance travelled by the tip, mm; used with G93 only.
        angle: (n,) by which the tool axis turns, degrees; used with G93 only.
        options: read options: the feed before the first F, and the unit of time of F.
        faults: collects cutting moves without a feed.
    """
    mode, word = modal.active[Group.FEED_MODE], blocks.word("F")
    rows = np.flatnonzero(blocks.has("F") | changed(mode, _BY_MINUTE))
    by_minute = bool((mode[:1] == _BY_MINUTE).all())
    before = options.feed if options.feed is not None and by_minute else np.nan
    speed = word[rows] * modal.scale[rows] / np.where(mode[rows] == _BY_MINUTE, options.feed_time, 60.0)
    speed = motions.of_blocks(forward_fill(rows, speed, before, len(blocks)))
    cuts = motions.motion != 0
    by_turn, by_time = (motions.of_blocks(mode == code) for code in (_BY_TURN, INVERSE_TIME))
    if by_turn.any():
        speed = np.where(by_turn, speed * np.abs(motions.of_blocks(spindle)), speed)
    of_block = np.bincount(motions.block, weights=path_length, minlength=len(blocks)) if by_time.any() else np.zeros(0)
    if by_time.any():
        value, way = motions.of_blocks(word), motions.of_blocks(of_block)
        # A turn in place has its speed in degrees; a block without motion takes no time, even with G93.
        speed = np.where(by_time, value * np.where(way > 0, way, angle) / 60, speed)
        still = by_time & (speed == 0) & (value > 0)
        moving = np.flatnonzero(cuts & (speed > 0))
        speed = np.where(still, forward_fill(moving, speed[moving], np.nan, len(speed)), speed)
    taps = is_one_of(modal.active[Group.MOTION], RIGID_TAP)
    if taps.any():
        by_lead = blocks.word("K") * modal.scale * np.abs(spindle) / 60
        speed = np.where(motions.of_blocks(taps), motions.of_blocks(by_lead), speed)
    missing = cuts & ~(speed > 0)
    if missing.any():
        wrong = np.zeros(len(blocks), dtype=np.bool_)
        wrong[motions.block[missing]] = True
        value = np.where(mode == INVERSE_TIME, word, forward_fill(rows, word[rows], np.nan, len(blocks)))
        faults.add_where("G408", wrong, lambda row: _feed_fault(row, mode, value, spindle, of_block))
    return np.where(cuts, speed, np.nan)


def _feed_fault(row: int, mode: Array, value: Array, spindle: Array, path_length: Array) -> Found:
    if np.isnan(value[row]):
        return ("no F in the block (", word_of(INVERSE_TIME), ")") if mode[row] == INVERSE_TIME else "no F"
    if mode[row] == _BY_TURN and not spindle[row]:
        return Word("F", value[row]), " a turn (", word_of(_BY_TURN), "), and the spindle stands still"
    if mode[row] == INVERSE_TIME and not path_length[row]:
        return "inverse time feed (", word_of(INVERSE_TIME), ") where the tip stays in its place"
    return Word("F", value[row])


_TOLERANCE = 640
_EXACT_STOP_ONCE = 90


def path_modes(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> dict[str, Array]:
    """The columns ``exact_stop``, ``exact_path`` and ``tip_tolerance`` of a program, by block, (N,) each."""
    stop, path = modal.flavour.exact_stop, modal.flavour.exact_path
    in_force = modal.active[Group.PATH]
    rests = is_one_of(in_force, stop)
    once = blocks.rows_of_g(_EXACT_STOP_ONCE)
    if len(once):
        rests = rests.copy()
        rests[once] = True
    return {
        "exact_stop": rests,
        "exact_path": is_one_of(in_force, path) | is_cycle(modal.active[Group.MOTION]),
        "tip_tolerance": _tolerances(blocks, modal, faults),
    }


def _tolerances(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> Array:
    """Tolerance of each block, mm; 0 where the program gives none, and in cycles, which LinuxCNC runs without it."""
    programmed = modal.programmed[Group.PATH]
    with_p = (programmed == _TOLERANCE) & blocks.has("P")
    if not with_p.any():
        return uniform(0.0, len(blocks))
    word = blocks.word("P")
    valid = with_p & (word > 0) & ~_p_of_another_code(blocks, modal)
    faults.add_where("G417", with_p & ~valid, lambda row: (word_of(_TOLERANCE), " ", Word("P", word[row])))
    rows = np.flatnonzero(np.isin(programmed, (610, 611, _TOLERANCE)))
    in_force = forward_fill(rows, np.where(valid, modal.in_mm(word), 0.0)[rows], 0.0, len(blocks))
    return np.where(is_cycle(modal.active[Group.MOTION]), 0.0, in_force)


def _p_of_another_code(blocks: Blocks, modal: Modal) -> Array:
    """Whether another code of each block uses its P: a dwell, a cycle, the turns of an arc, (N,)."""
    codes = modal.flavour.g_codes.items()
    takes_p = [code for code, meaning in codes if "P" in meaning.letters and code != _TOLERANCE]
    elsewhere: Array = modal.moves & np.isin(modal.active[Group.MOTION], takes_p)
    elsewhere[blocks.rows_of_g(*takes_p)] = True
    return elsewhere
