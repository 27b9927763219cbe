# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: read a motion program back as strut motion, or report its faults.

Enters: the text of a program or of its parts, the grammar of the controller and the settings it was written for.
Leaves: knots with lengths in mm and speeds in mm/s at whole ms, and the events, as the controller executes them.
The reader is strict: an unknown or misplaced line is a fault.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from pkm_post.model import Diagnostic, Place, StrutMotion
from pkm_post.writing.controllers.pvt.moves import Lines
from pkm_post.writing.controllers.pvt.parts import joined, part_faults
from pkm_post.writing.controllers.pvt.reading import MOST_FAULTS, Reading
from pkm_post.writing.controllers.pvt.settings import Settings
from pkm_post.writing.controllers.pvt.syntax import Grammar

_CHUNK = 1 << 20


def read_parts(
    texts: Sequence[tuple[str, str]], grammar: Grammar, settings: Settings
) -> tuple[StrutMotion | None, tuple[Diagnostic, ...]]:
    """Read a motion program in one or several parts.

    Args:
        texts: file name and text of each part, in order.
        grammar: grammar of the controller.
        settings: settings of the controller it was written for.

    Returns:
        The whole motion, or None if there are faults; and the faults.
    """
    faults = part_faults(texts)
    motions = []
    for file, text in texts:
        motion, found = read_program(text, grammar, settings, file)
        motions += [motion] if motion is not None else []
        faults += found
    return (None, faults) if faults else joined(motions, [file for file, _ in texts])


def read_program(
    text: str, grammar: Grammar, settings: Settings, file: str
) -> tuple[StrutMotion | None, tuple[Diagnostic, ...]]:
    """Read a motion program, or one part of it.

    Args:
        text: the program.
        grammar: grammar of the controller.
        settings: settings of the controller it was written for.
        file: its name, for the diagnostics.

    Returns:
        The motion, or None if there are faults; and the first 20 faults in line order.
    """
    reading = Reading(grammar, file)
    number = 1
    too_long: list[Diagnostic] = []
    for chunk in _chunks(text):
        lines = reading.lines_of(chunk)
        too_long += _too_long(number, lines, settings, file)
        reading.take(number, chunk, lines)
        number += lines.complete
        if len(reading.faults) >= MOST_FAULTS:
            break
    motion = reading.finish(number)
    faults = sorted([*reading.faults, *too_long], key=lambda fault: fault.place.line)
    return (None if faults else motion), tuple(faults[:MOST_FAULTS])


def _chunks(text: str) -> Iterator[str]:
    """A text in pieces of whole lines, to limit the memory of their working arrays."""
    start = 0
    while start < len(text):
        end = text.find("\n", start + _CHUNK) + 1 or len(text)
        yield text[start:end]
        start = end


def _too_long(number: int, lines: Lines, settings: Settings, file: str) -> Iterator[Diagnostic]:
    lengths = lines.lengths()
    for row in np.flatnonzero(lengths > settings.line_limit)[:MOST_FAULTS].tolist():
        found = f"{lengths[row]} characters, the controller takes {settings.line_limit}"
        yield Diagnostic("C103", Place(file, line=number + row, column=settings.line_limit + 1), found)
