# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks: faults of a block that do not depend on the tool position.

Input: plain blocks and their modal codes. Output: faults: unsupported codes, mutually exclusive codes, words that no
code of the block uses, and missing or invalid words.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from pkm_post.model import Array, distinct, forward_fill, map_rows
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import (
    ARCS,
    NONE,
    SPINDLE_SYNCHRONISED,
    TO_REFERENCE,
    WORDS_OF_ANY_BLOCK,
    Code,
    Group,
    Word,
    word_of,
)
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.events import functions_of
from pkm_post.reading.gcode.flavours import Flavour
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.gcode.modal import Modal, changed, is_cycle, is_one_of
from pkm_post.reading.gcode.options import NORMAL_WORDS, VECTOR_WORDS, ReadOptions, axis_names
from pkm_post.reading.gcode.tools import modal_word

_WHOLE = "DHLT"
_NOT_NEGATIVE = "DFHLQST"
_DWELL, _TIME = 40, "X"
"""G4, and its word in seconds, which some flavours have beside P."""
_TURN, _END_OF_TURN = 680, 690
_MIRROR, _END_OF_MIRROR = 511, 501
_TO_THE_MACHINE = (280, 300, 530)
"""Codes that go to places of the machine, by the axes that they name."""
_LIMIT = 1e9
"""Upper bound of lengths, angles, times and numbers of a program; beyond it decimals are lost."""

_Codes = tuple[str, Array, Array, Mapping[int, Code]]
"""Letter, codes, their rows, and their definitions."""


def check(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> None:
    """Report the faults of individual plain blocks."""
    _unknown_codes(blocks, modal.flavour, faults)
    _codes_of_one_group(blocks, modal.flavour, faults)
    _unused_words(blocks, modal, options, faults)
    _missing_words(blocks, modal, faults)
    _values(blocks, modal, faults)
    _functions(modal, faults)
    _axis_words(blocks, modal, faults)
    _within_turns(blocks, modal, faults)
    _within_mirrors(blocks, modal, faults)


def _codes(blocks: Blocks, flavour: Flavour) -> tuple[_Codes, _Codes]:
    return ("G", blocks.g, blocks.g_row, flavour.g_codes), ("M", blocks.m, blocks.m_row, flavour.m_codes)


def _marked(blocks: Blocks, rows: Array) -> Array:
    """Mask of the given rows, (N,)."""
    marked = np.zeros(len(blocks), dtype=np.bool_)
    marked[rows] = True
    return marked


def _unknown_codes(blocks: Blocks, flavour: Flavour, faults: BlockDiagnostics) -> None:
    for letter, codes, rows, known in _codes(blocks, flavour):
        for code in distinct(codes).tolist():
            if code in known:
                continue
            word = word_of(code, letter)
            wrong = _marked(blocks, rows[codes == code])
            if str(word) in SPINDLE_SYNCHRONISED:
                faults.add_where("G425", wrong, word)
            elif str(word) in flavour.unsupported:
                why = f": {flavour.unsupported[str(word)]}"
                faults.add_where("G402", wrong, (word, why))
            else:
                faults.add_where("G401", wrong, word)


def _codes_of_one_group(blocks: Blocks, flavour: Flavour, faults: BlockDiagnostics) -> None:
    groups = list(Group)
    for letter, codes, rows, known in _codes(blocks, flavour):
        with_next = np.append(rows[1:] == rows[:-1], False)[: len(rows)]
        together = with_next | np.append(False, with_next[:-1])[: len(rows)]
        used, which = np.unique(codes[together], return_inverse=True)
        group = [groups.index(known[code].group) if code in known else NONE for code in used.tolist()]
        group = [NONE if number == groups.index(Group.COOLANT) else number for number in group]
        number = np.array(group, dtype=np.int64)[which]
        pairs, count = np.unique((rows[together] * len(groups) + number)[number != NONE], return_counts=True)
        for pair in pairs[count > 1].tolist():
            row, of_group = divmod(pair, len(groups))
            here = (blocks.g_of(row) if letter == "G" else blocks.m_of(row)).tolist()
            words = [word_of(code, letter) for code in here if code in known and known[code].group is groups[of_group]]
            faults.add("G403", row, (*_spaced(words), f" ({groups[of_group].value})"))
    off = _marked(blocks, blocks.rows_of_m(9))  # M7 and M8 may both be on
    on = _marked(blocks, blocks.rows_of_m(7, 8))
    faults.add_where("G403", off & on, (Word("M", 9), " with M7 or M8"))


def _functions(modal: Modal, faults: BlockDiagnostics) -> None:
    """Report machine functions in a block with a move, and M5 with a cut: controls differ in their timing."""
    codes = functions_of(modal)
    beside = (codes != NONE) & (modal.moves | (modal.takes_axes != NONE))
    faults.add_where("G437", beside, lambda row: word_of(int(codes[row]), "M"))
    if not modal.flavour.stops_first:
        cuts = modal.moves & ~is_one_of(modal.active[Group.MOTION], 0)
        cuts &= modal.programmed[Group.ONCE] != 530
        stops = is_one_of(modal.programmed[Group.SPINDLE], 5)
        faults.add_where("G437", cuts & stops, (Word("M", 5), " with a cut"))


def _unused_words(blocks: Blocks, modal: Modal, options: ReadOptions, faults: BlockDiagnostics) -> None:
    rotary = set("ABC") - set(axis_names(options.axis_words))
    turn, useless = modal.programmed[Group.ROTATION] == _TURN, {}
    for letter in blocks.words:
        if letter in rotary and (blocks.has(letter) & turn).any():  # Mach3 writes the centre of G68 as A and B
            useless[letter] = blocks.has(letter) & turn
        elif letter not in WORDS_OF_ANY_BLOCK and letter not in rotary:
            unused = blocks.has(letter) & ~_used_by_motion(letter, modal, options)
            if letter == "D" and modal.flavour.keeps_offset_number:  # it is that of the next G41, or of this one
                before = np.append(np.nan, modal_word(blocks, "D", np.nan)[:-1])
                unused &= (modal.active[Group.SIDE] != 400) & (blocks.word("D") != before)
            if letter == "H":  # H0 cancels the length, as G49 does
                unused &= (modal.programmed[Group.LENGTH] != 490) | (blocks.word("H") != 0)
            if letter in "ABC":  # tool_axes checks them
                unused &= ~np.isin(modal.takes_axes, TO_REFERENCE)
            if unused.any():
                unused[_rows_that_use(letter, blocks, modal.flavour)] = False
                useless[letter] = unused
    # A rotary axis at zero leaves the tool upright on any machine.
    turned = {name: blocks.has(name) & (word != 0) & ~turn for name, word in blocks.words.items() if name in rotary}
    _report_words("G414", turned, blocks, faults)

    def hint(row: int, words: Sequence[Word]) -> str:
        names = {word.name for word in words}
        if turn[row] and names & set("AB"):
            return ": write the centre as X and Y"
        if "D" in names and modal.at(Group.SIDE, row) != 400:
            return " while G41 or G42 is in force: write G40 before it, and the code of the side with it"
        vector = options.axis_words != "vector" and names & set(VECTOR_WORDS)
        return ", which are a tool axis after G43.5 with --axis-words vector" if vector else ""

    _report_words("G404", useless, blocks, faults, hint)


def _used_by_motion(letter: str, modal: Modal, options: ReadOptions) -> Array:
    """Whether the motion of each block uses a word, (N,)."""
    takes = np.zeros(max(modal.flavour.g_codes) + 1, dtype=np.bool_)
    for code, meaning in modal.flavour.g_codes.items():
        if meaning.group is Group.MOTION:
            turns = letter in axis_names(options.axis_words)
            takes[code] = code == 800 or letter in meaning.letters or turns or letter in NORMAL_WORDS
            if code not in (0, 10, 800) and letter in VECTOR_WORDS:  # on an arc they are its centre or invalid
                takes[code] = letter in meaning.letters
    motion, directly = modal.active[Group.MOTION], modal.programmed[Group.ONCE] == 530
    if modal.flavour.g53_is_rapid and directly.any():
        motion = np.where(directly, 0, motion)
    return modal.moves & map_rows(takes.__getitem__, motion)


def _rows_that_use(letter: str, blocks: Blocks, flavour: Flavour) -> Array:
    """Rows with a non-motion code that uses a word; an unknown code may use any word."""
    rows = []
    for _, codes, row, known in _codes(blocks, flavour):
        users = [
            code
            for code in distinct(codes).tolist()
            if code not in known or (known[code].group is not Group.MOTION and letter in known[code].letters)
        ]
        rows.append(row[np.isin(codes, users)])
    return np.concatenate(rows)


def _report_words(
    code: str,
    wrong: dict[str, Array],
    blocks: Blocks,
    faults: BlockDiagnostics,
    hint: Callable[[int, Sequence[Word]], str] | None = None,
) -> None:
    """Report invalid words, one fault per block."""

    def found(row: int) -> tuple[str | Word, ...]:
        words = [Word(name, blocks.words[name][row]) for name in wrong if wrong[name][row]]
        return (*_spaced(words), hint(row, words) if hint else "")

    if wrong:
        faults.add_where(code, np.any(list(wrong.values()), axis=0), found)


def _spaced(words: Sequence[Word]) -> tuple[str | Word, ...]:
    """Words with blanks between them."""
    parts: list[str | Word] = []
    for word in words:
        parts += [" ", word]
    return tuple(parts[1:])


def _missing_words(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> None:
    known = modal.flavour.g_codes
    for code in distinct(blocks.g).tolist():
        for letter in known[code].needs if code in known else "":
            missing = _marked(blocks, blocks.rows_of_g(code)) & ~blocks.has(letter)
            faults.add_where("G405", missing, (word_of(code), f" without {letter}"))
    if _TIME in known[_DWELL].letters:
        dwells = _marked(blocks, blocks.rows_of_g(_DWELL))
        timeless = dwells & ~blocks.has("P") & ~blocks.has(_TIME)
        faults.add_where("G405", timeless, (word_of(_DWELL), f" without P or {_TIME}"))
        two = dwells & blocks.has("P") & blocks.has(_TIME)
        faults.add_where("G404", two, (Word(_TIME), " beside ", Word("P")))
    spindle = modal.programmed[Group.SPINDLE]
    turning = is_one_of(spindle, 3, 4)
    faults.add_where("G405", turning & _before_first(blocks, "S"), lambda row: (Word("M", spindle[row]), " without S"))
    change = modal.programmed[Group.CHANGE] == 6
    faults.add_where("G405", change & _before_first(blocks, "T"), (Word("M", 6), " without T"))


def _before_first(blocks: Blocks, letter: str) -> Array:
    """Whether each block precedes the first one with a word, (N,)."""
    rows = np.flatnonzero(blocks.has(letter))
    return np.arange(len(blocks)) < (rows[0] if len(rows) else len(blocks))


def _values(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> None:
    # D of G41.1 is a diameter; below zero it changes the side of cutter compensation [LinuxCNC, rs274]
    is_number = ~is_one_of(modal.programmed[Group.SIDE], 411, 421)
    for letter, value in blocks.words.items():
        # Comparisons with NaN are false.
        wrong = (letter in _WHOLE) & (np.abs(value - np.round(value)) > 0)
        wrong |= (letter in _NOT_NEGATIVE) & (value < 0)
        wrong &= (letter != "D") | is_number
        wrong |= np.abs(value) > _LIMIT
        faults.add_where("G406", wrong, lambda row, name=letter, value=value: Word(name, value[row]))  # type: ignore[misc]
    rows = blocks.rows_of_g(40)
    for row in distinct(rows[blocks.word("P")[rows] < 0]).tolist():
        faults.add("G406", row, Word("P", blocks.word("P")[row]))


def _axis_words(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> None:
    """Report axis words that belong to no motion, or to two codes."""
    explicit, motion = modal.programmed[Group.MOTION], modal.active[Group.MOTION]
    faults.add_where(
        "G439", modal.moves & (motion == 800), ("axis words while no motion is in force (", word_of(800), ")")
    )
    both = (modal.takes_axes != NONE) & (explicit != NONE) & (explicit != 800)
    if modal.flavour.moves_beside_reference:
        of_group_1 = np.isin(explicit, (0, 10, *ARCS))
        rows = np.flatnonzero(of_group_1)
        before = forward_fill(rows + 1, explicit[rows], NONE, len(blocks) + 1)[:-1]
        both &= ~(of_group_1 & (np.isin(modal.takes_axes, TO_REFERENCE) | (explicit == before)))
    faults.add_where(
        "G407", both, lambda row: (word_of(modal.takes_axes[row]), " and ", word_of(explicit[row]), " in one block")
    )
    takers = blocks.rows_of_g(*modal.flavour.axis_takers())
    for row in distinct(takers[1:][takers[1:] == takers[:-1]]).tolist():
        faults.add("G407", row, _spaced([word_of(code) for code in blocks.g_of(row).tolist()]))
    directly = modal.programmed[Group.ONCE] == 530
    wrong = directly & modal.moves & (motion != 0) & (motion != 10) & (not modal.flavour.g53_is_rapid)
    faults.add_where("G439", wrong, lambda row: (word_of(530), " while ", word_of(motion[row]), " is in force"))
    polar = directly & (blocks.has("@") | blocks.has("^"))
    faults.add_where("G407", polar, (word_of(530), " and polar coordinates in one block"))
    relative = directly & modal.moves & (modal.active[Group.DISTANCE] == 910)
    faults.add_where("G440", relative, (word_of(530), " while ", word_of(910), " is in force"))
    both = modal.moves & (modal.programmed[Group.LENGTH] == 432)
    faults.add_where("G407", both, (word_of(432), " and a motion in one block"))
    inverse = modal.moves & is_cycle(motion) & (modal.active[Group.FEED_MODE] == 930)
    faults.add_where(
        "G441", inverse, lambda row: (word_of(motion[row]), " with inverse time feed (", word_of(930), ")")
    )


def _within_turns(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> None:
    """Report codes that may not stand within a rotation: controls forbid them, or differ in the place after them.

    Along the normal of the plane nothing turns, so G28 Z0 is one and the same on all controls.
    """
    turns = modal.programmed[Group.ROTATION]
    rows = np.flatnonzero(turns != NONE)
    turned = forward_fill(rows, turns[rows], _END_OF_TURN, len(blocks)) == _TURN
    inside = turned & np.append(False, turned[:-1])[: len(turned)]
    if not inside.any():
        return
    in_plane = np.zeros(len(blocks), dtype=np.bool_)
    for plane, axes in PLANES.items():
        words = blocks.has("XYZ"[axes[0]]) | blocks.has("XYZ"[axes[1]])
        in_plane |= words & (modal.active[Group.PLANE] == plane)
    another = changed(modal.active[Group.PLANE], 170)
    for code in modal.flavour.outside_turns:
        wrong = inside & _marked(blocks, blocks.rows_of_g(code))
        wrong &= in_plane if code in _TO_THE_MACHINE else another if code in PLANES else True
        faults.add_where("G438", wrong, (word_of(code), " within ", word_of(_TURN)))
    # R is then an angle, or is added to the one before: parameter 5400#0 of Fanuc's controls
    again = inside & (turns == _TURN) & (modal.active[Group.DISTANCE] == 910) & bool(modal.flavour.outside_turns)
    faults.add_where("G438", again, (word_of(_TURN), " within ", word_of(_TURN)))


def _within_mirrors(blocks: Blocks, modal: Modal, faults: BlockDiagnostics) -> None:
    """Report what controls forbid, or differ in, within a mirror image; along other axes it is one and the same.

    A mirror image in one axis changes the sense of a rotation in it [SiemensISO, G51.1]; no manual says where its
    centre is.
    """
    mirrored = _mirrored_axes(blocks) if modal.flavour.outside_turns else np.zeros((0, 3), dtype=np.bool_)
    if not mirrored.any():
        return
    named = np.column_stack([blocks.has(letter) for letter in "XYZ"])
    for code in (_TURN, *modal.flavour.outside_turns):
        if code in PLANES or code in (_MIRROR, _END_OF_MIRROR):
            continue
        wrong = mirrored.any(axis=1) & _marked(blocks, blocks.rows_of_g(code))
        wrong &= (named & mirrored).any(axis=1) if code in _TO_THE_MACHINE else True
        faults.add_where("G438", wrong, (word_of(code), " within ", word_of(_MIRROR)))


def _mirrored_axes(blocks: Blocks) -> Array:
    """Mask of the axes mirrored before each block, (N, 3)."""
    mirrored = np.zeros((len(blocks), 3), dtype=np.bool_)
    for index in np.flatnonzero(np.isin(blocks.g, (_MIRROR, _END_OF_MIRROR))).tolist():
        row = int(blocks.g_row[index])
        words = np.array([bool(blocks.has(letter)[row]) for letter in "XYZ"])
        begins = blocks.g[index] == _MIRROR
        mirrored[row + 1 :, words if begins or words.any() else ~words] = begins
    return mirrored
