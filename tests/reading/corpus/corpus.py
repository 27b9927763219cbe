# SPDX-License-Identifier: LGPL-2.1-or-later
"""The corpus: small programs, one for each construct, with the motion that they stand for.

A file has one language or dialect, and names what it shows. A section begins with ``== title``, or with ``== title |
source | name=value ...``: the source of its motion, and options of the reader. The program follows, then ``->`` with
what it gives: rows joined by semicolons, or ``refused`` and the code of the diagnostic. A row is the kind, R rapid, L
line or A arc, and the place in mm; behind ``/`` the tool axis where it is not upright. Moves of no length are left
out.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
HEADS = {
    "rs274": "G21 G90 G94 G17 G40 G49 G54 G98 G80\n",
    "fanuc": "O1001\nG21 G17 G40 G49 G80 G90 G94 G98\nG0 X0. Y0. Z30. F100.\n",
    "siemens": "G90 G17 G71 G94 G54 F600\nG0 X0 Y0 Z10\n",
}
"""What stands before each program of a file."""
PLACES = 4
"""Decimals of a row, which are those that rs274 prints."""


@dataclass(frozen=True)
class Section:
    """A program of the corpus."""

    file: str
    title: str
    program: str
    expected: str

    @property
    def by_hand(self):
        """Whether its rows have a source of their own, or it is refused."""
        return bool(self.source) or self.expected.startswith("refused")

    @property
    def source(self):
        """Where its rows are from, empty for rs274."""
        return self.title.split("|")[1].strip() if "|" in self.title else ""

    @property
    def options(self):
        """Options of the reader, as texts."""
        parts = self.title.split("|")
        return dict(re.findall(r"(\w+)=(\S+)", parts[2])) if len(parts) > 2 else {}

    def rows(self):
        """The expected rows."""
        return [row.strip() for row in self.expected.split(";")]


def sections(file):
    """The sections of a file."""
    for part in file.read_text(encoding="utf-8").split("\n== ")[1:]:
        title, _, rest = part.partition("\n")
        program, _, expected = rest.partition("\n-> ")
        yield Section(file.stem, title, program.rstrip() + "\n", " ".join(expected.split()))


def as_row(kind, place, axis=(0.0, 0.0, 1.0)):
    """A move as a row."""
    shown = " ".join(_number(value) for value in place)
    upright = np.allclose(axis, (0, 0, 1), atol=1e-6)
    return f"{'RLA'[int(kind)]} {shown}" + ("" if upright else " / " + " ".join(map(_number, axis)))


def _number(value):
    return f"{round(float(value), PLACES) + 0.0:.{PLACES}f}".rstrip("0").rstrip(".")


def rows_of(program):
    """The moves of a ``Program`` as rows."""
    rows = [as_row(*each) for each in zip(program.kind, program.position, program.tool_axis, strict=True)]
    return without_repeats(rows)


def without_repeats(rows):
    """Rows without moves of no length."""
    return [row for index, row in enumerate(rows) if not index or row[2:] != rows[index - 1][2:]]
