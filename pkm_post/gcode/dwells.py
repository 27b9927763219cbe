# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dwells: how long the tool waits, P of G4 and of the cycles that wait at the bottom.

Blocks and the unit that the user says enter; seconds leave, and what is doubtful about them. P is in seconds for
LinuxCNC and in milliseconds, without a decimal point, for controls of the kind of Fanuc's [LinuxCNC; Weihong]. With a
point some of these take it for seconds [Haas], so that it is refused there.
"""

from __future__ import annotations

import re

import numpy as np

from pkm_post.gcode.blocks import Blocks
from pkm_post.gcode.codes import Group
from pkm_post.gcode.cycles import DWELLS
from pkm_post.gcode.findings import Findings
from pkm_post.gcode.modal import Modal
from pkm_post.gcode.options import DWELL_UNITS, ReadOptions
from pkm_post.model.columns import by_row
from pkm_post.model.program import Array

LONG = 60.0
"""s: a dwell that lasts longer may be one of milliseconds."""
_POINTED = re.compile(r"P[ \t]*\d*\.", re.IGNORECASE)
_COMMENT = re.compile(r"\([^)]*\)?|;.*")


def dwell_words(blocks: Blocks, options: ReadOptions) -> Array:
    """P of each block in s, (N,), NaN where it has none; of use where it is that of a dwell."""
    return blocks.word("P") * DWELL_UNITS[options.dwell_unit]


def check_dwells(blocks: Blocks, modal: Modal, options: ReadOptions, text: bytes | str, faults: Findings) -> None:
    """Tell dwells that may be meant in the other unit.

    Args:
        blocks: plain blocks.
        modal: their modal codes.
        options: how they are to be read.
        text: the program that they were read from: a point behind a whole number stands there alone.
        faults: takes what is found.
    """
    rows = _dwells(blocks, modal)
    words = blocks.word("P")[rows]
    for row, word in zip(rows[words * DWELL_UNITS[options.dwell_unit] > LONG].tolist(), words, strict=False):
        faults.tell("G428", row, _both_ways(float(word), options.dwell_unit))
    if options.dwell_unit == "ms" and len(rows):
        lines = re.split(r"\r\n|\n|\r", text.decode("latin-1") if isinstance(text, bytes) else text)
        for row, word in zip(rows.tolist(), words.tolist(), strict=True):
            written = _POINTED.search(_COMMENT.sub("", lines[blocks.line[row] - 1])) if lines != [""] else None
            if written or word != round(word):
                faults.tell("G427", row, f"P{word:g}")


def _dwells(blocks: Blocks, modal: Modal) -> Array:
    """The blocks whose P is a time; of those that are executed several times the first time."""
    waits = modal.moves & by_row(lambda codes: np.isin(codes, DWELLS), modal.in_force[Group.MOTION])
    waits[blocks.g_row[blocks.g == 40]] = True
    rows = np.flatnonzero(waits & blocks.has("P"))
    return np.sort(rows[np.unique(blocks.line[rows], return_index=True)[1]])


def _both_ways(word: float, unit: str) -> str:
    """A long dwell in the unit it is read in, and in the other ones."""
    units = sorted(DWELL_UNITS, key=lambda each: each != unit)
    return f"P{word:g} in " + ", or in ".join(f"{each}: {word * DWELL_UNITS[each]:g} s" for each in units)
