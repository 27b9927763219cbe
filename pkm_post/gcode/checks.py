# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks: what can be wrong with a block before it is known where the tool is.

Plain blocks and their modal codes enter, faults leave: codes that are not supported, codes that exclude each other,
words that no code of the block uses, words that are missing or not what they have to be.
"""

from __future__ import annotations

import numpy as np

from pkm_post.gcode.blocks import LETTERS, Blocks, column_of
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.modal import (
    ANY_BLOCK,
    CYCLES,
    G_CODES,
    M_CODES,
    NONE,
    REFUSED,
    Group,
    Modal,
    name_of,
    owners,
)
from pkm_post.gcode.options import AXIS_WORDS, ReadOptions
from pkm_post.model.program import Array

_WHOLE = "HLT"
_NOT_NEGATIVE = "DFHLQST"
_LIMIT = 1e9
"""No length, angle, time or number of a program is larger; beyond it decimals are lost."""


def check(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> None:
    """Tell all that is wrong with single blocks.

    Args:
        blocks: plain blocks.
        modal: their modal codes.
        options: how they are to be read.
        faults: takes what is found.
    """
    _unknown_codes(blocks, faults)
    _codes_of_one_group(blocks, faults)
    _words_without_use(blocks, modal, options, faults)
    _words_missing(blocks, modal, faults)
    _values(blocks, modal, faults)
    _axis_words(blocks, modal, faults)


def _unknown_codes(blocks: Blocks, faults: Findings) -> None:
    for letter, codes, start, known in (
        ("G", blocks.g, blocks.g_start, G_CODES),
        ("M", blocks.m, blocks.m_start, M_CODES),
    ):
        owner = owners(start)
        for code in np.unique(codes).tolist():
            if code in known:
                continue
            name = name_of(code, letter)
            rows = np.zeros(len(blocks), dtype=np.bool_)
            rows[owner[codes == code]] = True
            if name in REFUSED:
                faults.tell_all("G402", rows, lambda _, name=name: f"{name}: {REFUSED[name]}")  # type: ignore[misc]
            else:
                faults.tell_all("G401", rows, lambda _, name=name: name)  # type: ignore[misc]


def _codes_of_one_group(blocks: Blocks, faults: Findings) -> None:
    groups = list(Group)
    for letter, codes, start, known in (
        ("G", blocks.g, blocks.g_start, G_CODES),
        ("M", blocks.m, blocks.m_start, M_CODES),
    ):
        number = {code: groups.index(row.group) for code, row in known.items() if row.group is not Group.COOLANT}
        group = np.full(int(max(codes, default=0)) + 1, NONE)
        for code in np.unique(codes).tolist():
            group[code] = number.get(code, NONE)
        pairs = owners(start) * len(groups) + group[codes]
        pairs, count = np.unique(pairs[group[codes] != NONE], return_counts=True)
        for pair in pairs[count > 1].tolist():
            row, which = divmod(pair, len(groups))
            here = blocks.g_of(row) if letter == "G" else blocks.m_of(row)
            names = [name_of(code, letter) for code in here.tolist() if number.get(code) == which]
            faults.tell("G403", row, f"{' '.join(names)} ({groups[which].value})")


def _bits(letters: str) -> int:
    return sum(1 << column_of(letter) for letter in set(letters))


def given_bits(blocks: Blocks) -> Array:
    """The words a block has, (N,), one bit by letter."""
    given = np.zeros(len(blocks), dtype=np.int32)
    for column in range(len(LETTERS)):
        given |= (~np.isnan(blocks.words[:, column])).astype(np.int32) << np.int32(column)
    return given


def _words_without_use(blocks: Blocks, modal: Modal, options: ReadOptions, faults: Findings) -> None:
    used = np.full(len(blocks), _bits(ANY_BLOCK), dtype=np.int32)
    for codes, start, known in ((blocks.g, blocks.g_start, G_CODES), (blocks.m, blocks.m_start, M_CODES)):
        owner = owners(start)
        for code in np.unique(codes).tolist():
            if code not in known:
                used[owner[codes == code]] = _bits(LETTERS)
            elif known[code].group is not Group.MOTION:
                used[owner[codes == code]] |= _bits(known[code].letters)
    motion = modal.in_force[Group.MOTION]
    for code in np.unique(motion).tolist():
        turns = AXIS_WORDS[options.axis_words] if code in (0, 10) or options.axis_words != "vector" else ""
        letters = G_CODES[code].letters + turns if code != 800 else LETTERS
        used[modal.moves & (motion == code)] |= _bits(letters)
    rotary = _bits("ABC") & ~_bits(AXIS_WORDS[options.axis_words])
    given = given_bits(blocks)
    faults.tell_all("G414", (given & rotary) != 0, lambda row: _words(blocks, row, given[row] & rotary))
    useless = given & ~used & ~rotary
    faults.tell_all("G404", useless != 0, lambda row: _words(blocks, row, useless[row]))


def _words(blocks: Blocks, row: int, bits: int) -> str:
    values = blocks.words[row]
    return " ".join(f"{letter}{values[i]:g}" for i, letter in enumerate(LETTERS) if bits >> i & 1)


def _words_missing(blocks: Blocks, modal: Modal, faults: Findings) -> None:
    owner = owners(blocks.g_start)
    for code in np.unique(blocks.g).tolist():
        for letter in G_CODES[code].needs if code in G_CODES else "":
            missing = np.zeros(len(blocks), dtype=np.bool_)
            missing[owner[blocks.g == code]] = True
            missing &= np.isnan(blocks.words[:, column_of(letter)])
            faults.tell_all("G405", missing, lambda _, c=code, w=letter: f"{name_of(c)} without {w}")  # type: ignore[misc]
    turning = np.isin(modal.explicit[Group.SPINDLE], (3, 4))
    first = ~np.isnan(blocks.words[:, column_of("S")])
    unsaid = turning & ~np.logical_or.accumulate(first) if len(blocks) else turning
    faults.tell_all("G405", unsaid, lambda row: f"M{modal.explicit[Group.SPINDLE][row]} without S")
    changes = modal.explicit[Group.CHANGE] == 6
    chosen = ~np.isnan(blocks.words[:, column_of("T")])
    unsaid = changes & ~np.logical_or.accumulate(chosen) if len(blocks) else changes
    faults.tell_all("G405", unsaid, lambda _: "M6 without T")


def _values(blocks: Blocks, modal: Modal, faults: Findings) -> None:
    for letter in LETTERS:
        value = blocks.words[:, column_of(letter)]
        given = ~np.isnan(value)
        if not given.any():
            continue
        wrong = given & ~(np.abs(value) <= _LIMIT)
        if letter in _WHOLE:
            wrong |= given & (value != np.round(value))
        if letter in _NOT_NEGATIVE:
            wrong |= given & (value < 0)
        faults.tell_all("G406", wrong, lambda row, name=letter, value=value: f"{name}{value[row]:g}")  # type: ignore[misc]
    diameter = blocks.words[:, column_of("D")]
    number = np.isin(modal.explicit[Group.SIDE], (410, 420)) & (diameter != np.round(diameter)) & ~np.isnan(diameter)
    faults.tell_all("G406", number, lambda row: f"D{diameter[row]:g}")
    dwell = np.zeros(len(blocks), dtype=np.bool_)
    dwell[owners(blocks.g_start)[blocks.g == 40]] = True
    pause = blocks.words[:, column_of("P")]
    faults.tell_all("G406", dwell & (pause < 0), lambda row: f"P{pause[row]:g}")


def _axis_words(blocks: Blocks, modal: Modal, faults: Findings) -> None:
    """Axis words that belong to no motion, or to two codes."""
    explicit, motion = modal.explicit[Group.MOTION], modal.in_force[Group.MOTION]
    faults.tell_all("G407", modal.moves & (motion == 800), lambda _: "axis words while no motion is in force (G80)")
    both = (modal.takes_axes != NONE) & (explicit != NONE) & (explicit != 800)
    faults.tell_all(
        "G407", both, lambda row: f"{name_of(modal.takes_axes[row])} and {name_of(explicit[row])} in one block"
    )
    taken = np.zeros(len(blocks), dtype=np.int64)
    for code in np.unique(blocks.g).tolist():
        if code in G_CODES and G_CODES[code].takes_axes:
            np.add.at(taken, owners(blocks.g_start)[blocks.g == code], 1)
    faults.tell_all("G407", taken > 1, lambda row: " ".join(name_of(code) for code in blocks.g_of(row).tolist()))
    directly = modal.explicit[Group.ONCE] == 530
    wrong = directly & ~np.isin(motion, (0, 10))
    faults.tell_all("G407", wrong, lambda row: f"G53 while {name_of(motion[row])} is in force")
    inverse = modal.moves & np.isin(motion, CYCLES) & (modal.in_force[Group.FEED_MODE] == 930)
    faults.tell_all("G407", inverse, lambda row: f"{name_of(motion[row])} with inverse time feed (G93)")
