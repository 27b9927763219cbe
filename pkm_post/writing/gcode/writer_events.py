# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines between the blocks of a written program: heading, comments, and one line per event.

Enters: a ``Program``. Leaves: lines by the row that follows them. Dwells in s, spindle in revolutions per minute.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.model import EventKind, Program
from pkm_post.writing.gcode.writer_axes import FORMS, Form

_MODES = "{unit} G17 G90 G94 G40 G49 G80 G64\n"
_COOLANT = {0: "M9", 1: "M8", 2: "M7"}
_STOP = {0: "M0", 1: "M1"}
_AT_TIP = ("G43.4", "G43.5")
"""Tip control codes to cancel before a tool change."""
_LONGEST_COMMENT = 200
"""Characters; LinuxCNC reads lines of 255."""


def heading(program: Program, form: Form, inch: bool) -> str:
    """The lines before the first block: source, tools, modes."""
    tools = [program.tools[number] for number in sorted(program.tools)]
    lines = [
        _comment(f"from {program.source}"),
        *(
            _comment(
                f"tool {tool.number}: {tool.name}, diameter {_short(tool.diameter)}, "
                f"corner radius {_short(tool.corner_radius)}, length {_short(tool.length)} mm"
            )
            for tool in tools
        ),
    ]
    follows = FORMS[form].follows
    starts_with_tool = any(event.row == 0 and event.kind is EventKind.TOOL_CHANGE for event in program.events)
    if not starts_with_tool and follows in _AT_TIP:
        return "".join(lines) + _MODES.format(unit="G20" if inch else "G21") + follows + "\n"
    return "".join(lines) + _MODES.format(unit="G20" if inch else "G21")


def between_blocks(program: Program, form: Form) -> dict[int, str]:
    """Whole lines by the row that follows them; the row count as key places lines after the last row."""
    lines: dict[int, str] = {}
    for row in _first_rows(program):
        lines[row] = _comment(f"operation: {program.operations[program.operation[row]]}")
    say = _EVENTS | {EventKind.TOOL_CHANGE: _tool_change(form)}
    for event in program.events:
        lines[event.row] = lines.get(event.row, "") + say[event.kind](event.value)
    return lines


def _first_rows(program: Program) -> list[int]:
    """First rows of operations."""
    changes = np.append(True, np.diff(program.operation) != 0)[: len(program)]
    rows: list[int] = np.flatnonzero(changes).tolist()
    return rows


def _tool_change(form: Form) -> Callable[[float], str]:
    follows = FORMS[form].follows
    cancel = "G49\n" if follows in _AT_TIP else ""

    def say(number: float) -> str:
        return f"{cancel}T{number:.0f} M6\n{follows} H{number:.0f}\n"

    return say


def _spindle(speed: float) -> str:
    return f"S{_short(abs(speed))} M{3 if speed > 0 else 4}\n" if speed else "M5\n"


_EVENTS: dict[EventKind, Callable[[float], str]] = {
    EventKind.SPINDLE: _spindle,
    EventKind.COOLANT: lambda value: _COOLANT[int(value)] + "\n",
    EventKind.DWELL: lambda seconds: f"G4 P{seconds:.4f}\n",  # without a point some controls read it as ms
    EventKind.STOP: lambda value: _STOP[int(value)] + "\n",
}


def _short(value: float) -> str:
    """A number with up to four decimals, without trailing zeros."""
    return f"{value:.4f}".rstrip("0").rstrip(".")


def _comment(text: str) -> str:
    """A comment that every control accepts: ASCII, one line, limited length, no nested parentheses."""
    plain = text[:_LONGEST_COMMENT].translate({ord("("): "[", ord(")"): "]"}).encode("ascii", "replace").decode("ascii")
    return "(" + "".join(character if character.isprintable() else " " for character in plain) + ")\n"
