# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rewriting a machine file: other numbers in a few entries, and every other character of the text as it was.

Enters: the text of a file that reads without fault, and arrays in mm by the name of their entry. Leaves: the text with
these arrays in the units of the file. Comments inside a list that is replaced go with it.
"""

from __future__ import annotations

import tomllib

import numpy as np

from pkm_post.machine_file.faults import entry_lines
from pkm_post.machine_file.fields import FIELDS, Name
from pkm_post.machine_file.forms import Array
from pkm_post.machine_file.units import factor, stated_units


class CannotRewriteError(Exception):
    """The entry is written in a way that is not replaced here; the text says what was expected."""


DECIMALS = 6
"""Of mm, as they are written: a nanometre; two more in inches."""
_INDENT = "    "
_DIMENSIONS = {field.entry: field.dimension for field in FIELDS}


def with_entries(text: str, entries: dict[str, Array]) -> str:
    """The text with other values for some entries.

    Args:
        text: a machine file, TOML.
        entries: for each entry the numbers it shall have, in mm, as rows or in one row.

    Raises:
        CannotRewriteError: an entry does not start a line, or is not there and its section has no head of its own that
            it could be put below.
    """
    units = stated_units(tomllib.loads(text))
    for entry, numbers in entries.items():
        scale = factor(_DIMENSIONS[entry], units)
        text = _with_entry(text, tuple(entry.split(".")), _toml(np.asarray(numbers) / scale, scale))
    return text


def _toml(numbers: Array, scale: float) -> str:
    if numbers.ndim == 2:
        rows = "".join(f"{_INDENT}{_toml(row, scale)},\n" for row in numbers)
        return f"[\n{rows}]"
    decimals = DECIMALS if scale == 1.0 else DECIMALS + 2
    # 0.0 is added so that no zero has a sign
    return f"[{', '.join(f'{round(float(number), decimals) + 0.0:.{decimals}f}' for number in numbers)}]"


def _with_entry(text: str, name: Name, value: str) -> str:
    lines = text.split("\n")
    places = entry_lines(text, tomllib.loads(text))
    if name in places and _is_key(lines[places[name] - 1], name[-1]):
        first = places[name] - 1
        return _replaced(lines, first, value)
    head = places.get(name[:-1])
    if name in places or head is None or not lines[head - 1].lstrip().startswith("["):
        raise CannotRewriteError(f"expected an entry {'.'.join(name)} at the start of a line, or a section [{name[0]}]")
    return "\n".join([*lines[:head], f"{name[-1]} = {value}", *lines[head:]])


def _is_key(line: str, key: str) -> bool:
    return line.split("=")[0].strip().rpartition(".")[2].strip().strip("\"'") == key


def _replaced(lines: list[str], first: int, value: str) -> str:
    """The lines with another value from the first equals sign of a line on, up to where its brackets close."""
    head, _, rest = lines[first].partition("=")
    last, depth = first, _depth(rest)
    while depth > 0:
        last += 1
        depth += _depth(lines[last])
    comment = lines[last].partition("#")[1:]
    tail = f"  {''.join(comment)}" if comment[0] else ""
    return "\n".join([*lines[:first], f"{head}= {value}{tail}", *lines[last + 1 :]])


def _depth(line: str) -> int:
    """How many brackets a line opens more than it closes. Lists of numbers hold no text with brackets."""
    code = line.partition("#")[0]
    return code.count("[") - code.count("]")
