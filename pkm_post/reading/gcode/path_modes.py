# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path modes: the effect of G61, G61.1 and G64 on the corners of each block.

Enters: blocks and their modal codes. Leaves: columns: whether the motion stops at the end (exact stop), whether corners
are followed rather than rounded (exact path), and the permitted deviation of the tip from the path (G64 P), mm.
LinuxCNC swaps the first two codes; a program for its hexapod is read accordingly. Q of G64, which merges nearly
collinear moves, is not needed: no moves are merged.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, map_rows, uniform
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.codes import G_CODES, Group
from pkm_post.reading.gcode.findings import Findings
from pkm_post.reading.gcode.modal import Modal, carried

_TOLERANCE = 640
_TAKES_P = [code for code, meaning in G_CODES.items() if "P" in meaning.letters and code != _TOLERANCE]


def exact_codes(axis_words: str) -> tuple[int, int]:
    """The codes of exact stop and of exact path, in tenths.

    Args:
        axis_words: tool axis notation; "RPY" is specific to LinuxCNC.
    """
    return (611, 610) if axis_words == "RPY" else (610, 611)


def path_modes(blocks: Blocks, modal: Modal, axis_words: str, faults: Findings) -> dict[str, Array]:
    """The columns ``exact_stop``, ``exact_path`` and ``tip_tolerance`` of a program, by block, (N,) each.

    Args:
        blocks: the program.
        modal: its modal codes.
        axis_words: tool axis notation.
        faults: collects rejected tolerances.
    """
    stop, path = exact_codes(axis_words)
    in_force = modal.in_force[Group.PATH]
    return {
        "exact_stop": map_rows(lambda codes: codes == stop, in_force),
        "exact_path": map_rows(lambda codes: codes == path, in_force),
        "tip_tolerance": _tolerances(blocks, modal, faults),
    }


def _tolerances(blocks: Blocks, modal: Modal, faults: Findings) -> Array:
    """Tolerance of each block, mm; 0 where the program gives none."""
    said = modal.explicit[Group.PATH]
    wanted = (said == _TOLERANCE) & blocks.has("P")
    if not wanted.any():
        return uniform(0.0, len(blocks))
    word = blocks.word("P")
    taken = wanted & (word > 0) & ~_belongs_elsewhere(blocks, modal)
    faults.tell_all("G417", wanted & ~taken, lambda row: f"G64 P{word[row]:g}")
    rows = np.flatnonzero(np.isin(said, (610, 611, _TOLERANCE)))
    return carried(rows, np.where(taken, modal.in_mm(word), 0.0)[rows], 0.0, len(blocks))


def _belongs_elsewhere(blocks: Blocks, modal: Modal) -> Array:
    """Whether another code of each block uses its P: a dwell, a cycle, the turns of an arc, (N,)."""
    elsewhere: Array = modal.moves & np.isin(modal.in_force[Group.MOTION], _TAKES_P)
    elsewhere[blocks.g_row[np.isin(blocks.g, _TAKES_P)]] = True
    return elsewhere
