# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execution: turn the blocks as written into the blocks as executed.

Enters: scanned blocks, some with parameters, expressions, O words or calls. Leaves: plain blocks in execution order,
every value computed, every loop and call unrolled; lines and units as in the source. A program without any of these is
returned unchanged. Semantics are those of RS274NGC as implemented by LinuxCNC, and for M98 and M99 those of Fanuc.
"""

from __future__ import annotations

import numpy as np

from pkm_post.model import Array, Diagnostic, Place
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.executed import ExecutedBlocks
from pkm_post.reading.gcode.flow import link
from pkm_post.reading.gcode.limits import ExecutionLimits
from pkm_post.reading.gcode.parameters import ExecutionFault
from pkm_post.reading.gcode.run import PROGRAM_END, SUBPROGRAM_CODES, Run
from pkm_post.reading.gcode.statements import OWord, Statement, statement_of

__all__ = ["DEFAULT_LIMITS", "ExecutionLimits", "execute"]

DEFAULT_LIMITS = ExecutionLimits()


def execute(
    blocks: Blocks, limits: ExecutionLimits = DEFAULT_LIMITS, block_delete: bool = False
) -> tuple[Blocks | None, tuple[Diagnostic, ...]]:
    """Execute a program.

    Args:
        blocks: the scanned blocks; returned unchanged when there is nothing to execute.
        limits: bounds of the execution.
        block_delete: whether to skip blocks that begin with ``/``.

    Returns:
        Plain blocks, or None if there are faults; and the faults: all those found before execution, or else the one
        that stopped it.
    """
    if not blocks.special and not np.isin(blocks.m, SUBPROGRAM_CODES).any():
        return blocks, ()
    left_out = blocks.deleted if block_delete else np.zeros(len(blocks), dtype=np.bool_)
    statements, faults = _statements(blocks, left_out)
    flow, unlinked = link({row: word for row, word in statements.items() if isinstance(word, OWord)})
    faults.extend(unlinked)
    if faults:
        return None, _diagnostics(blocks, faults)
    ruled = left_out.copy()
    ruled[blocks.m_row[np.isin(blocks.m, (*SUBPROGRAM_CODES, *PROGRAM_END))]] = True
    ruled[list(statements)] = True
    executed = ExecutedBlocks(blocks)
    run = Run(blocks, statements, flow, left_out, limits, executed)
    try:
        run.to_the_end(np.flatnonzero(ruled).tolist())
    except ExecutionFault as fault:
        return None, _diagnostics(blocks, [(run.row, fault)])
    return executed.table(), ()


def _statements(blocks: Blocks, left_out: Array) -> tuple[dict[int, Statement], list[tuple[int, ExecutionFault]]]:
    """Compile the special blocks, by row in program order, and collect the invalid ones."""
    statements: dict[int, Statement] = {}
    faults: list[tuple[int, ExecutionFault]] = []
    for row, tree in sorted(blocks.special.items()):
        if left_out[row]:
            continue
        try:
            statements[row] = statement_of(tree)
        except ExecutionFault as fault:
            faults.append((row, fault))
    return statements, faults


def _diagnostics(blocks: Blocks, faults: list[tuple[int, ExecutionFault]]) -> tuple[Diagnostic, ...]:
    """Convert faults by row to unique diagnostics in line order."""
    told = [
        Diagnostic(fault.code, Place(blocks.source, line=int(blocks.line[row]), column=fault.column), fault.found)
        for row, fault in faults
    ]
    return tuple(sorted(dict.fromkeys(told), key=lambda item: (item.place.line, item.place.column)))
