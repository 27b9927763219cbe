# SPDX-License-Identifier: LGPL-2.1-or-later
"""Guess: the flavour of a program, from constructs that only one family of controls accepts.

Input: scanned blocks. Output: the flavour and its evidence, for the report. Evidence is a code, word or order of blocks
that the other flavour lacks or refuses; each kind counts once, wherever it occurs. Without evidence the program is
RS274NGC, the stricter of the two: constructs with another meaning there are errors, or give the same motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from pkm_post.model import Array, forward_fill, is_among
from pkm_post.reading.gcode.adapt import without_idle_g80
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import CANCEL_CYCLE, CYCLES, G_CODES, Group, name_of
from pkm_post.reading.gcode.flavours import FANUC, RS274, Flavour

_MOST_SHOWN = 4
"""Most pieces of evidence in a line of the report."""

_FANUC_G = (150, 160, 401, 510, 531, 541, 650, 660, 670, 682, 1870, 2340, 2550)
_WITHOUT_PLACE = (50, 51)
"""G5 and G5.1: splines in LinuxCNC, which need X or Y."""
_RS274_G = (281, 301, 382, 383, 384, 385, 431, 432, 901, 911, 922, 923)
_RS274_M = (62, 63, 64, 65, 66, 67, 68, 70, 71, 72, 73)

_Found = Iterator[tuple[str, int]]
"""Evidence, and its row."""


@dataclass(frozen=True)
class FlavourGuess:
    """A flavour, with the evidence for and against it, as text with lines."""

    flavour: Flavour
    evidence: tuple[str, ...]
    against: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Describe it for the report."""
        if not self.evidence:
            return f"flavour {self.flavour.name}: nothing in the program speaks for another"
        against = f"; although {_listed(self.against)}" if self.against else ""
        return f"flavour {self.flavour.name}, by {_listed(self.evidence)}{against}"


def _listed(evidence: tuple[str, ...]) -> str:
    more = len(evidence) - _MOST_SHOWN
    return ", ".join(evidence[:_MOST_SHOWN]) + (f" and {more} more" if more > 0 else "")


def guessed_flavour(blocks: Blocks) -> FlavourGuess:
    """Guess the flavour of scanned blocks."""
    fanuc, rs274 = (tuple(_first_of_each(blocks, found)) for found in (_for_fanuc(blocks), _for_rs274(blocks)))
    if len(fanuc) > len(rs274):
        return FlavourGuess(FANUC, fanuc, rs274)
    return FlavourGuess(RS274, rs274, fanuc)


def _first_of_each(blocks: Blocks, found: _Found) -> Iterator[str]:
    for what, row in found:
        yield f"{what} in line {int(blocks.line[row])}"


def _for_fanuc(blocks: Blocks) -> _Found:
    yield from _o_words(blocks, lambda keyword: not keyword)
    yield from _macro_jumps(blocks)
    yield from _macro_calls(blocks)
    yield from _codes(blocks.g, blocks.g_row, _FANUC_G, "G")
    here = np.flatnonzero(is_among(blocks.g, _WITHOUT_PLACE))
    here = here[~(blocks.has("X") | blocks.has("Y"))[blocks.g_row[here]]] if len(here) else here
    yield from _codes(blocks.g[here], blocks.g_row[here], _WITHOUT_PLACE, "G")
    yield from _codes(blocks.m, blocks.m_row, (29,), "M")
    yield from _word_with_code(blocks, (80,), "P", "G8 P")
    yield from _word_with_code(blocks, (40,), "X", "G4 X", without="P")
    yield from _word_with_code(blocks, (921,), "X", "G92.1 X")
    yield from _word_with_code(blocks, CYCLES, "K", "K in a cycle")
    yield from _after_g80(blocks)


def _for_rs274(blocks: Blocks) -> _Found:
    yield from _o_words(blocks, bool)
    yield from _named_parameters(blocks)
    yield from _codes(blocks.g, blocks.g_row, _RS274_G, "G")
    yield from _codes(blocks.m, blocks.m_row, _RS274_M, "M")
    yield from _word_with_code(blocks, (640,), "P", "G64 P")


def _codes(codes: Array, rows: Array, wanted: tuple[int, ...], letter: str) -> _Found:
    """The first of each of some codes."""
    found = np.flatnonzero(is_among(codes, wanted))
    for index in np.sort(found[np.unique(codes[found], return_index=True)[1]]).tolist():
        yield name_of(int(codes[index]), letter), int(rows[index])


def _word_with_code(blocks: Blocks, codes: tuple[int, ...], letter: str, name: str, without: str = "") -> _Found:
    """The first block with one of some codes and a word, and without another word."""
    if letter in blocks.words:
        rows = blocks.rows_of_g(*codes)
        rows = rows[blocks.has(letter)[rows] & ~blocks.has(without)[rows]]
        if len(rows):
            yield name, int(rows[0])


def _after_g80(blocks: Blocks) -> _Found:
    """The first block with X, Y or Z after G80 and without a motion code, which RS274NGC refuses."""
    blocks = without_idle_g80(blocks)
    if CANCEL_CYCLE not in blocks.g:
        return
    here = is_among(blocks.g, (code for code, meaning in G_CODES.items() if meaning.group is Group.MOTION))
    active = forward_fill(blocks.g_row[here], blocks.g[here], 0, len(blocks))
    moves = blocks.has("X") | blocks.has("Y") | blocks.has("Z")
    moves[blocks.rows_of_g(*RS274.axis_takers())] = False
    found = np.flatnonzero(moves & (active == CANCEL_CYCLE))
    if len(found):
        yield "axis words after G80", int(found[0])


def _o_words(blocks: Blocks, wanted: Callable[[str], bool]) -> _Found:
    """The first O word with a wanted keyword, which is empty for a bare number."""
    for row, tree in sorted(blocks.special.items()):
        for child in tree.children:
            if not isinstance(child, str) and child.data in ("o_word", "program_name"):
                label, *rest = child.children
                keyword = str(rest[0]).lower() if rest else ""
                if wanted(keyword) and (rest or getattr(label, "type", "") != "NAME"):  # O<PART-1> speaks for neither
                    sign = "O" * (child.data == "o_word")
                    yield f"{sign}{label if isinstance(label, str) else ''} {keyword}".strip(), row
                    return


def _macro_jumps(blocks: Blocks) -> _Found:
    """The first GOTO, IF GOTO or WHILE DO."""
    for row, tree in sorted(blocks.special.items()):
        for child in tree.children:
            if not isinstance(child, str) and child.data == "macro":
                words = [leaf.upper() for leaf in child.children if isinstance(leaf, str) and leaf.type != "NUMBER"]
                yield " ".join(words), row
                return


def _macro_calls(blocks: Blocks) -> _Found:
    """The first G65 or G66."""
    from pkm_post.reading.gcode.parse import is_macro_call

    for row, tree in sorted(blocks.special.items()):
        if is_macro_call(tree):
            yield "a macro call", row
            return


def _named_parameters(blocks: Blocks) -> _Found:
    """The first block with a named parameter."""
    for row, tree in sorted(blocks.special.items()):
        for (name,) in (parameter.children for parameter in tree.find_data("parameter")):
            if getattr(name, "type", "") == "NAME":
                yield f"#{name}", row
                return
