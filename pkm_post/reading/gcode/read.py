# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read: convert the text of a G-code program to motions, in three independent steps.

Enters: the content of a file, in its own units. Leaves: a ``Program`` in mm, rad and mm/s, or all faults of the first
step that fails: a block that cannot be parsed cannot be processed further.
"""

from __future__ import annotations

from pkm_post.model import Diagnostic, Program
from pkm_post.reading.gcode.execute import execute
from pkm_post.reading.gcode.options import DEFAULT_LIMITS, DEFAULT_OPTIONS, ExecutionLimits, ReadOptions
from pkm_post.reading.gcode.resolve import resolve
from pkm_post.reading.gcode.scan import scan


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
    executed, execution = execute(scanned, limits, options.block_delete)
    if executed is None:
        return None, syntax + execution
    program, meaning = resolve(executed, options, text)
    return program, syntax + execution + meaning
