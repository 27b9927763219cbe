# SPDX-License-Identifier: LGPL-2.1-or-later
"""Syntax: the lines of a strut program, and which may follow which, for the reader.

Enters: the settings of the controller. Leaves: for each kind of line its form, a sequence of pieces, so that a wrong
line can be told to the column; what each code does; and the flow, the order of the program. These rules are stated here
on their own, not taken from the writer: a fault of the writer must not be read as if it were none. What opens a program
each controller states for itself.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from pkm_post.controllers.pvt.codes import FIELD
from pkm_post.controllers.pvt.settings import Settings
from pkm_post.model import EventKind


@dataclass(frozen=True)
class Piece:
    """A part of a line: its pattern, what people call it, and what it says if that is always the same."""

    pattern: str
    name: str
    fixed: str = ""


Parts = tuple[str | Piece, ...]

WHOLE = Piece(r"(0|[1-9][0-9]{0,14})", "a whole number")
POSITIVE = Piece(r"([1-9][0-9]{0,14})", "a whole number above zero")
DECIMAL = Piece(r"((?:0|[1-9][0-9]{0,14})(?:\.[0-9]+)?)", "a plain decimal")
SIGNED = Piece(r"(-?(?:0|[1-9][0-9]{0,14})(?:\.[0-9]+)?)", "a plain decimal")
PRINTABLE = Piece(r"[ -~]*", "printable ASCII")
END = Piece(r"\Z", "the end of the line")


@dataclass(frozen=True)
class Form:
    """The form of one kind of line.

    Attributes:
        name: what people call the line.
        pieces: its parts, in order; they have one group for each number.
        pattern: all of them, compiled.
    """

    name: str
    pieces: tuple[Piece, ...]
    pattern: re.Pattern[str]

    def fits(self, line: str) -> re.Match[str] | None:
        """The match when the whole line has this form."""
        return self.pattern.fullmatch(line)

    def with_numbers(self, number: str) -> str:
        """The line with this in the place of each of its numbers."""
        return "".join(piece.fixed or number for piece in self.pieces)

    def agreement(self, line: str) -> tuple[int, str]:
        """How far a line agrees with this form, in characters, and what is expected there."""
        position = 0
        for piece in (*self.pieces, END):
            match = re.compile(piece.pattern).match(line, position)
            if match is None:
                return position, piece.name
            position = match.end()
        return position, ""


def form(name: str, *parts: str | Piece) -> Form:
    """A form from literal text and pieces."""
    pieces = tuple(Piece(re.escape(part), repr(part), part) if isinstance(part, str) else part for part in parts)
    return Form(name, pieces, re.compile("".join(piece.pattern for piece in pieces)))


def body_forms(settings: Settings, spelt: Callable[[str], str]) -> dict[str, Form]:
    """The forms of the lines that all controllers of the family have, by kind; the codes of events by their names.

    Args:
        settings: of the controller.
        spelt: a word in capitals as this controller's programs have it.
    """
    lengths: list[Parts] = [(letter, SIGNED, " ") for letter in settings.letters]
    lengths_and_speeds: list[Parts] = [(letter, SIGNED, ":", SIGNED, " ") for letter in settings.letters]
    forms = {
        "close": _word(spelt("CLOSE")),
        "absolute": _word(spelt("ABS")),
        "feed axes": form(spelt("FRAX"), spelt("FRAX") + "(", ",".join(settings.letters), ")"),
        "linear": _word(spelt("LINEAR")),
        "feed": form(f"{spelt('TA')}, {spelt('TS')} and F", spelt("TA"), WHOLE, spelt(" TS"), WHOLE, " F", DECIMAL),
        "approach": form("six lengths", *list(chain.from_iterable(lengths))[:-1]),
        "halt": _word(spelt("DWELL0")),
        "interval": form(spelt("PVT"), spelt("PVT"), POSITIVE),
        "move": form("six lengths with speeds", *list(chain.from_iterable(lengths_and_speeds))[:-1]),
        "dwell": form(spelt("DWELL"), spelt("DWELL"), DECIMAL),
    }
    return forms | {name: _code_form(name, template) for name, template in settings.codes.items()}


def _word(word: str) -> Form:
    return form(word, word)


def _code_form(name: str, template: str) -> Form:
    field = FIELD.search(template)
    if field is None:
        return form(f"the code {name}", template)
    number = WHOLE if field["form"] == "d" else DECIMAL
    parts = (template[: field.start()], number, template[field.end() :])
    return form(f"the code {name}", *(part for part in parts if part))


_Effect = tuple[EventKind, Callable[[float], float] | float]
EFFECTS: Mapping[str, _Effect] = {
    "spindle_clockwise": (EventKind.SPINDLE, lambda number: +number),
    "spindle_counterclockwise": (EventKind.SPINDLE, lambda number: -number),
    "spindle_stop": (EventKind.SPINDLE, 0.0),
    "tool_change": (EventKind.TOOL_CHANGE, lambda number: +number),
    "stop": (EventKind.STOP, 0.0),
    "optional_stop": (EventKind.STOP, 1.0),
    "coolant_mist": (EventKind.COOLANT, 2.0),
    "coolant_flood": (EventKind.COOLANT, 1.0),
    "coolant_off": (EventKind.COOLANT, 0.0),
}
"""What the code of each name does: the kind of event, and its value, or the value by the number in the code. The names
are those of ``[controller.codes]`` in machine files, which say in words what the code makes the machine do."""


def effect(name: str, numbers: Sequence[str]) -> tuple[EventKind, float]:
    """Kind and value of the event that a code makes happen.

    Args:
        name: of the code.
        numbers: that stand in its line.
    """
    kind, value = EFFECTS[name]
    return kind, value(float(numbers[0])) if callable(value) else value


START, FINISHED = "start", "finished"
Flow = Mapping[str, Mapping[str, str]]
"""For each state of the program the kinds of line that may come next, and the state each leads to."""

FLOW_FROM_MODES: Flow = {
    "cleared": {"absolute": "absolute"},
    "absolute": {"feed axes": "feed axes"},
    "feed axes": {"linear": "linear"},
    "linear": {"feed": "feed"},
    "feed": {"approach": "approached"},
    "approached": {"halt": "halted"},
    "timed": {"move": "moved"},
    "moved": {"move": "moved", "interval": "timed", "halt": "halted"},
    "halted": {"dwell": "halted", "code": "halted", "interval": "timed", "linear": "ending"},
    "ending": {"close": FINISHED},
    FINISHED: {},
}
"""The flow from the program's empty buffer on."""

_FIRST_OF_BODY = "approached"


def state_after(flow: Flow, state: str, kind: str) -> str:
    """The state a line leads to, also when it is out of place.

    It then counts as if the lines missing before it had been there, within the head or the body of the program, so
    that one fault is told once. A line that belongs to the other part leads nowhere.

    Args:
        flow: of the whole program.
        state: before the line.
        kind: of the line.
    """
    states = list(flow)
    here, body = states.index(state), states.index(_FIRST_OF_BODY)
    near = states[here : body + 1] if here < body else states[here:] + states[body:here]
    return next((flow[candidate][kind] for candidate in near if kind in flow[candidate]), state)


@dataclass(frozen=True)
class Grammar:
    """All that the reader needs to know of one controller's programs.

    Attributes:
        forms: of all lines, by kind.
        flow: of the program.
        feed: what the line of the approach states: ms to reach the speed, ms of rounding, mm/s.
    """

    forms: Mapping[str, Form]
    flow: Flow
    feed: tuple[float, float, float]
