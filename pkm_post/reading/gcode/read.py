# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read: convert the text of a G-code program to motions, in three independent steps.

Enters: the content of a file, in its own units. Leaves: a ``Program`` in mm, rad and mm/s, or all faults of the first
step that fails: a block that cannot be parsed cannot be processed further.
"""

from __future__ import annotations

from dataclasses import replace

from pkm_post.model import Diagnostic, Program
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.execute import execute
from pkm_post.reading.gcode.flavours import FLAVOURS, Flavour
from pkm_post.reading.gcode.guess import guessed_flavour
from pkm_post.reading.gcode.options import DEFAULT_LIMITS, DEFAULT_OPTIONS, ExecutionLimits, ReadOptions
from pkm_post.reading.gcode.resolve import resolve
from pkm_post.reading.gcode.scan import scan

_RESTARTS = ("M99 ends the main program, which a control would begin again: it is carried out once",)


def read(
    text: bytes | str,
    file: str,
    options: ReadOptions = DEFAULT_OPTIONS,
    limits: ExecutionLimits = DEFAULT_LIMITS,
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """Read a G-code program.

    Args:
        text: content of the file; any bytes.
        file: its name, for diagnostics.
        options: read options.
        limits: bounds of loops and calls.

    Returns:
        The program, or None if there are errors; and the diagnostics.

    Raises:
        ImportError: lark is not installed.
    """
    scanned, syntax = scan(text, file)
    if scanned is None:
        return None, syntax
    flavour, why = _flavour(scanned, options)
    executed, execution = execute(scanned, limits, options.block_delete, flavour)
    if executed is None:
        return None, syntax + execution
    program, meaning = resolve(executed, replace(options, flavour=flavour.name), text)
    diagnostics = syntax + execution + meaning
    if program is None:
        return None, diagnostics
    return replace(program, reading=(why, *program.reading, *_RESTARTS[: executed.restarts])), diagnostics


def _flavour(blocks: Blocks, options: ReadOptions) -> tuple[Flavour, str]:
    """The flavour as chosen or guessed, and why, for the report."""
    if options.flavour is not None:
        return FLAVOURS[options.flavour], f"flavour {options.flavour}, as chosen"
    guess = guessed_flavour(blocks)
    return guess.flavour, str(guess)
