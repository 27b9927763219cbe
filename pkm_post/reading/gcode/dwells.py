# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dwells: duration from P of G4 and of the cycles that dwell at the bottom.

Enters: blocks and the dwell unit chosen by the user. Leaves: seconds, and warnings about doubtful values. P is in
seconds on LinuxCNC and in milliseconds, without a decimal point, on Fanuc-style controls [LinuxCNC; Weihong]. With a
point some of these read seconds [Haas], so it is refused there.
"""

from __future__ import annotations

import re

import numpy as np

from pkm_post.model import Array, map_rows
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import Group
from pkm_post.reading.gcode.cycles import DWELLS
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.modal import Modal
from pkm_post.reading.gcode.options import DWELL_UNITS, ReadOptions

LONG = 60.0
"""s: a longer dwell may be in milliseconds."""
_POINTED = re.compile(r"P[ \t]*\d*\.", re.IGNORECASE)
_COMMENT = re.compile(r"\([^)]*\)?|;.*")


def dwell_words(blocks: Blocks, options: ReadOptions) -> Array:
    """P of each block in s, (N,), NaN where absent; meaningful only for dwells."""
    return blocks.word("P") * DWELL_UNITS[options.dwell_unit]


def check_dwells(blocks: Blocks, modal: Modal, options: ReadOptions, text: bytes | str, faults: Findings) -> None:
    """Report dwells that may be meant in the other unit.

    Args:
        blocks: plain blocks.
        modal: their modal codes.
        options: read options.
        text: source text of the program: only there is the point after an integer visible.
        faults: collects the faults.
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
    """Blocks whose P is a time; only the first execution of each."""
    waits = modal.moves & map_rows(lambda codes: np.isin(codes, DWELLS), modal.in_force[Group.MOTION])
    waits[blocks.g_row[blocks.g == 40]] = True
    rows = np.flatnonzero(waits & blocks.has("P"))
    return np.sort(rows[np.unique(blocks.line[rows], return_index=True)[1]])


def _both_ways(word: float, unit: str) -> str:
    """A long dwell in the assumed unit and in the alternatives."""
    units = sorted(DWELL_UNITS, key=lambda each: each != unit)
    return f"P{word:g} in " + ", or in ".join(f"{each}: {word * DWELL_UNITS[each]:g} s" for each in units)
