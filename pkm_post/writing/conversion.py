# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert: read a part program and write it in another form of G-code.

Input: a file. Output: a file, or diagnostics. On an error nothing is written.
"""

from __future__ import annotations

from pathlib import Path

from pkm_post.model import Diagnostics, errors
from pkm_post.reading import AS_WRITTEN, ReadingOptions, read_part_program
from pkm_post.system import require_other, require_usable, staged, write_fault
from pkm_post.writing.gcode import GcodeDialect, write

TARGETS: dict[str, GcodeDialect] = {f"gcode:{form.value}": form for form in GcodeDialect}
"""Target forms by command line name."""


def convert(
    file: Path,
    target: str,
    out: Path,
    reading: ReadingOptions = AS_WRITTEN,
    decimals: int | None = None,
    inch: bool = False,
) -> Diagnostics:
    """Write a part program in another form.

    Args:
        file: the part program.
        target: a key of ``TARGETS``.
        out: the file to write.
        reading: settings that the part program does not contain.
        decimals: of lengths; None for four in mm and six in inches.
        inch: whether to write inches.

    Returns:
        The diagnostics; nothing is written if one is an error.

    Raises:
        ValueError: the target or the suffix of the file is not known.
    """
    if target not in TARGETS:
        raise ValueError(f"target: expected one of {', '.join(TARGETS)}, got {target!r}")
    program, found = read_part_program(file, reading)
    if program is None or errors(found):
        return found
    text, warnings = write(program, TARGETS[target], decimals=decimals, inch=inch)
    if text is None:
        return (*found, *warnings)
    try:
        require_usable(out.name)
        require_other(out, [file, *reading.files])
        with staged(out.parent) as folder:
            (folder / out.name).write_text(text, encoding="ascii", newline="\n")
    except OSError as fault:
        return (*found, *warnings, write_fault(out, fault))
    return (*found, *warnings)
