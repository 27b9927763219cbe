# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine file rewriting: replace the values of a few entries and keep all other text unchanged.

Input: the text of a valid file, and arrays in mm or texts by entry name. Output: the text with these arrays in the
units of the file. Comments inside a replaced list are lost.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping

import numpy as np

from pkm_post.machine.description.faults import entry_lines
from pkm_post.machine.description.fields import FIELDS, Name
from pkm_post.machine.description.units import factor, stated_units
from pkm_post.model import Array


class CannotRewriteError(Exception):
    """The entry is written in an unsupported form; the text names the expected one."""


DECIMALS = 6
"""Decimals of a written mm value: one nanometre; two more in inches."""
_INDENT = "    "
_DIMENSIONS = {field.entry: field.dimension for field in FIELDS}


def with_entries(text: str, entries: Mapping[str, Array | str]) -> str:
    """Return the text with new values for some entries.

    Args:
        text: a machine file, TOML.
        entries: new numbers of each entry, in mm, as rows or in one row; or its new text.

    Raises:
        CannotRewriteError: an entry does not start a line, or is absent and its section has no header to
            insert it below.
    """
    units = stated_units(tomllib.loads(text))
    for entry, new in entries.items():
        scale = factor(_DIMENSIONS[entry], units)
        value = json.dumps(new, ensure_ascii=False) if isinstance(new, str) else _toml(np.asarray(new) / scale, scale)
        text = _with_entry(text, tuple(entry.split(".")), value)
    return text


def _toml(numbers: Array, scale: float) -> str:
    if numbers.ndim == 2:
        rows = "".join(f"{_INDENT}{_toml(row, scale)},\n" for row in numbers)
        return f"[\n{rows}]"
    decimals = DECIMALS if scale == 1.0 else DECIMALS + 2
    # adding 0.0 removes the sign of negative zeros
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
    """Replace a value from the first equals sign of a line to its closing bracket."""
    head, _, rest = lines[first].partition("=")
    last, depth = first, _depth(rest)
    while depth > 0:
        last += 1
        depth += _depth(lines[last])
    comment = lines[last].partition("#")[1:]
    tail = f"  {''.join(comment)}" if comment[0] else ""
    return "\n".join([*lines[:first], f"{head}= {value}{tail}", *lines[last + 1 :]])


def _depth(line: str) -> int:
    """Opening minus closing brackets of a line. Lists of numbers hold no text with brackets."""
    code = line.partition("#")[0]
    return code.count("[") - code.count("]")
