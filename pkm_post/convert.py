# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert: a part program is read and written in another form of G-code.

A file enters, a file leaves, or the diagnostics that say why not. With an error nothing is written.
"""

from __future__ import annotations

from pathlib import Path

from pkm_post.files import staged
from pkm_post.gcode import Form, write
from pkm_post.model import Diagnostic
from pkm_post.model.diagnostics import errors
from pkm_post.sources import AS_WRITTEN, Reading, read_part_program
from pkm_post.unwritten import unwritten

TARGETS: dict[str, Form] = {f"gcode:{form.value}": form for form in Form}
"""What a program can be converted to, by the word that people type."""


def convert(
    file: Path, target: str, out: Path, reading: Reading = AS_WRITTEN, decimals: int = 4, inch: bool = False
) -> tuple[Diagnostic, ...]:
    """Write a part program in another form.

    Args:
        file: the part program.
        target: a key of ``TARGETS``.
        out: the file to write.
        reading: what the part program does not say itself.
        decimals: of lengths.
        inch: whether to write inches.

    Returns:
        What was found; the file is written when none of it is an error.

    Raises:
        ValueError: the target or the suffix of the file is not known.
    """
    if target not in TARGETS:
        raise ValueError(f"target: expected one of {', '.join(TARGETS)}, got {target!r}")
    program, found = read_part_program(file, reading)
    if program is None or errors(found):
        return found
    text, told = write(program, TARGETS[target], decimals=decimals, inch=inch)
    if text is None:
        return (*found, *told)
    try:
        with staged(out.parent) as folder:
            (folder / out.name).write_text(text, encoding="ascii", newline="\n")
    except OSError as fault:
        return (*found, *told, unwritten(out, fault))
    return (*found, *told)
