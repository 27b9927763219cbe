# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recovery: filter out faults that are consequences of others.

Input: diagnostics of a program without its faulty blocks. Output: the independent ones: all before the first faulty
block, and after it those that depend only on their own block. Equal faults are merged into one with their count and the
first of their lines.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from pkm_post.model import Diagnostic, Diagnostics, Severity
from pkm_post.reading.gcode.options import ReadOptions

_BY_ITSELF = frozenset(["G401", "G402", "G403", "G406", "G411", "G413", "G417", "G422", "G423", "G425", "G427", "G428"])
"""Faults of a block that no other block can cause."""
_OF_THE_WHOLE = ("G420", "G430", "G436")
"""Faults of a program as a whole, meaningless for a part: no motion, no end, and no position."""
_MOST_EQUAL = 3
"""Equal faults reported individually."""
_MOST_OF_A_CODE, _MOST_SHOWN = 10, 5
"""Faults of a code reported individually, and the number reported if there are more."""
_LINES_SHOWN = 5
_LAST = 1 << 60
"""After every line."""
_MORE = re.compile(r", and (\d+) more like it$")


def own_faults(found: Iterable[Diagnostic], first: int, options: ReadOptions) -> Diagnostics:
    """The faults, found without the faulty blocks, that are no consequences of these; ``first`` is their first line."""
    # Without a tool axis notation a rotary word is a fault anywhere.
    by_itself = _BY_ITSELF | ({"G414"} if options.axis_words == "none" else set())
    kept = (fault for fault in found if fault.code not in _OF_THE_WHOLE)
    return tuple(fault for fault in kept if fault.place.line < first or fault.code in by_itself)


def first_line(found: Iterable[Diagnostic]) -> int:
    """The line of the first error."""
    return min(fault.place.line for fault in found if fault.severity is Severity.ERROR)


def merged(found: Iterable[Diagnostic]) -> Diagnostics:
    """Diagnostics by line, each once; many equal ones, and many of a code, merged with their count."""
    equal: dict[tuple[str, str, str], list[Diagnostic]] = {}
    for fault in dict.fromkeys(found):
        equal.setdefault((fault.place.file, fault.code, _MORE.sub("", fault.found)), []).append(fault)
    by_code: dict[tuple[str, str], list[_Counted]] = {}
    for (file, code, _), group in equal.items():
        by_code.setdefault((file, code), []).extend(_counted(group))
    files = list(dict.fromkeys(file for file, _ in by_code))
    each = [fault for group in by_code.values() for fault in _first_of_many(group)]
    return tuple(sorted(each, key=lambda fault: _place_of(fault, files)))


def _place_of(fault: Diagnostic, files: list[str]) -> tuple[int, int, int]:
    return files.index(fault.place.file), fault.place.line or _LAST, fault.place.column


_Counted = tuple[Diagnostic, int]
"""A diagnostic, and the number of faults it represents."""


def _counted(group: list[Diagnostic]) -> list[_Counted]:
    """Equal faults: individually if there are few, else merged."""
    each = [(fault, 1 + int(more[1]) if (more := _MORE.search(fault.found)) else 1) for fault in group]
    number = sum(count for _, count in each)
    if len(group) == 1 or number <= _MOST_EQUAL:
        return each
    found = f"{_MORE.sub('', group[0].found)} ({number} times, in {_lines(group)})"
    return [(replace(group[0], found=found), number)]


def _first_of_many(group: list[_Counted]) -> list[Diagnostic]:
    """The faults of a code; if there are many, the first ones, with the count of the rest in the last."""
    if len(group) <= _MOST_OF_A_CODE:
        return [fault for fault, _ in group]
    shown, rest = [fault for fault, _ in group[:_MOST_SHOWN]], group[_MOST_SHOWN:]
    number = sum(count for _, count in rest)
    found = f"{shown[-1].found}, and {number} more like it, in {_lines([fault for fault, _ in rest])}"
    return [*shown[:-1], replace(shown[-1], found=found)]


def _lines(group: list[Diagnostic]) -> str:
    lines = list(dict.fromkeys(fault.place.line for fault in group))
    return f"lines {', '.join(map(str, lines[:_LINES_SHOWN]))}" + " and others" * (len(lines) > _LINES_SHOWN)
