# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execution: turn the blocks as written into the blocks as executed.

Input: scanned blocks, some with parameters, expressions, O words or calls. Output: plain blocks in execution order,
every value computed, every loop and call unrolled; lines and units as in the source. A program without any of these is
returned unchanged. Semantics are those of RS274NGC as implemented by LinuxCNC, and for M98 and M99 those of Fanuc.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pkm_post.model import Array, Diagnostic, Diagnostics, Place
from pkm_post.reading.gcode.block_builders import ExecutedBlocksBuilder
from pkm_post.reading.gcode.blocks import PROGRAM_END, SUBPROGRAM_CODES, Blocks, SkippedSwitches, bits_of
from pkm_post.reading.gcode.calls import MissingProgram
from pkm_post.reading.gcode.flavours import RS274, Flavour
from pkm_post.reading.gcode.interpreter import Interpreter
from pkm_post.reading.gcode.o_words import JumpTargets, link_o_words
from pkm_post.reading.gcode.options import DEFAULT_LIMITS, ExecutionLimits
from pkm_post.reading.gcode.parameters import ExecutionFault, SystemVariables
from pkm_post.reading.gcode.statements import OWord, Statement, statement_of


def execute_as_far_as_possible(
    blocks: Blocks,
    limits: ExecutionLimits = DEFAULT_LIMITS,
    block_delete: SkippedSwitches = False,
    flavour: Flavour = RS274,
    is_whole: bool = True,
    text: bytes = b"",
    may_add: bool = False,
    where: Callable[[Blocks], SystemVariables] | None = None,
) -> tuple[Blocks, Diagnostics]:
    """Execute a program up to its first fault.

    Args:
        blocks: the scanned blocks.
        limits: bounds of the execution.
        block_delete: the switches that skip blocks that begin with their ``/``.
        flavour: flavour of the subprogram calls.
        text: of the program, where GOTO finds sequence numbers.
        is_whole: whether no block is missing; otherwise nothing is executed, and only invalid blocks are reported.
        where: returns the state after some executed blocks, for system variables.
        may_add: whether a missing subprogram may be added and the program executed again.

    Returns:
        Plain blocks and the faults. If there are any: the blocks before the one that stopped the execution, or all
        plain blocks of a program that cannot be executed.

    Raises:
        MissingProgram: a missing subprogram may be added.
    """
    if blocks.is_plain:
        return blocks, ()
    skipped = (blocks.deleted & bits_of(block_delete)) != 0
    statements, faults = _statements(blocks, skipped, block_delete)
    jumps, unlinked = link_o_words({row: word for row, word in statements.items() if isinstance(word, OWord)})
    faults.extend(unlinked if is_whole else ())
    if faults or not is_whole:
        return replace(blocks, special={}), _diagnostics(blocks, faults)
    _add_files_by_number(blocks, jumps)
    special = skipped.copy()
    special[[file.row for file in blocks.files]] = True
    special[blocks.rows_of_m(*SUBPROGRAM_CODES, *PROGRAM_END)] = True
    special[list(statements)] = True
    executed = ExecutedBlocksBuilder(blocks)
    interpreter = Interpreter(blocks, statements, jumps, skipped, limits, executed, flavour, text, where)
    try:
        interpreter.run(np.flatnonzero(special).tolist())
    except ExecutionFault as fault:
        if may_add and isinstance(fault, MissingProgram):
            raise
        return executed.blocks(), _diagnostics(blocks, [(interpreter.row, fault)])
    ended = executed.blocks()
    return replace(ended, closed=True, restarts=True) if interpreter.restarts else ended, ()


def _add_files_by_number(blocks: Blocks, jumps: JumpTargets) -> None:
    """Let M98 call files with a number in their names but none inside."""
    ends = [*(file.row for file in blocks.files), len(blocks)]
    for file, end in zip(blocks.files, ends[1:], strict=True):
        has_number = any(file.row < row < end for row in jumps.programs.values())
        if file.label.isdecimal() and not has_number:
            jumps.programs.setdefault(file.label, file.row)


def _statements(
    blocks: Blocks, skipped: Array, block_delete: SkippedSwitches
) -> tuple[dict[int, Statement], list[tuple[int, ExecutionFault]]]:
    """Compile the special blocks, by row in program order, and collect the invalid ones."""
    statements: dict[int, Statement] = {}
    faults: list[tuple[int, ExecutionFault]] = []
    for row, tree in sorted(blocks.special.items()):
        if skipped[row]:
            continue
        try:
            statements[row] = statement_of(tree, block_delete)
        except ExecutionFault as fault:
            faults.append((row, fault))
    return statements, faults


def _diagnostics(blocks: Blocks, faults: list[tuple[int, ExecutionFault]]) -> Diagnostics:
    """Convert faults by row to unique diagnostics in line order."""
    diagnostics = [
        Diagnostic(fault.code, Place(blocks.source, line=int(blocks.line[row]), column=fault.column), fault.found)
        for row, fault in faults
    ]
    return tuple(sorted(dict.fromkeys(diagnostics), key=lambda item: (item.place.line, item.place.column)))
