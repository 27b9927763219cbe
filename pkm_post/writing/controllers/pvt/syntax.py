# SPDX-License-Identifier: LGPL-2.1-or-later
"""Syntax: the lines of a strut program and their valid order, for the reader.

Input: the settings of the controller. Output: the form of each kind of line, a sequence of pieces, so that faults are
located to the column; the effect of each code; and the flow, the order of the program. These rules are independent of
the writer, so that the reader detects a fault of the writer. Each controller defines the opening of its programs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from pkm_post.model import EventKind
from pkm_post.writing.controllers.pvt.codes import FIELD
from pkm_post.writing.controllers.pvt.settings import PvtSettings


class LinePiece(NamedTuple):
    """A part of a line: its pattern, its name for the user, and its text if constant."""

    pattern: str
    name: str
    fixed: str = ""


Parts = tuple[str | LinePiece, ...]

IN_THREAD = "move in a thread"
"""Kind of a line of moves with the spindle as an axis; it is valid wherever a move is."""

WHOLE = LinePiece(r"(0|[1-9][0-9]{0,14})", "a whole number")
POSITIVE = LinePiece(r"([1-9][0-9]{0,14})", "a whole number above zero")
DECIMAL = LinePiece(r"((?:0|[1-9][0-9]{0,14})(?:\.[0-9]+)?)", "a plain decimal")
SIGNED = LinePiece(r"(-?(?:0|[1-9][0-9]{0,14})(?:\.[0-9]+)?)", "a plain decimal")
PRINTABLE = LinePiece(r"[ -~]*", "printable ASCII")
END = LinePiece(r"\Z", "the end of the line")


class LineForm(NamedTuple):
    """The form of one kind of line.

    Attributes:
        name: name of the line for the user.
        pieces: its parts, in order; they have one group for each number.
        pattern: the compiled pattern of all pieces.
    """

    name: str
    pieces: tuple[LinePiece, ...]
    pattern: re.Pattern[str]

    def match(self, line: str) -> re.Match[str] | None:
        """The match if the whole line has this form."""
        return self.pattern.fullmatch(line)

    def with_numbers(self, number: str) -> str:
        """The line with ``number`` in place of each of its numbers."""
        return "".join(piece.fixed or number for piece in self.pieces)

    def agreement(self, line: str) -> tuple[int, str]:
        """The number of characters in which a line agrees with this form, and the expected text there."""
        position = 0
        for piece in (*self.pieces, END):
            match = re.compile(piece.pattern).match(line, position)
            if match is None:
                return position, piece.name
            position = match.end()
        return position, ""


def line_form(name: str, *parts: str | LinePiece) -> LineForm:
    """A form from literal text and pieces."""
    pieces = tuple(LinePiece(re.escape(part), repr(part), part) if isinstance(part, str) else part for part in parts)
    return LineForm(name, pieces, re.compile("".join(piece.pattern for piece in pieces)))


def body_forms(settings: PvtSettings, spelt: Callable[[str], str]) -> dict[str, LineForm]:
    """The forms of the lines common to all controllers of the family, by kind; codes of events by their names.

    ``spelt`` converts a word in capitals to the spelling of this controller's programs.
    """
    lengths: list[Parts] = [(letter, SIGNED, " ") for letter in settings.letters]
    lengths_and_speeds: list[Parts] = [(letter, SIGNED, ":", SIGNED, " ") for letter in settings.letters]
    axis = settings.spindle_axis
    forms = {
        "close": _word(spelt("CLOSE")),
        "absolute": _word(spelt("ABS")),
        "feed axes": line_form(spelt("FRAX"), spelt("FRAX") + "(", ",".join(settings.letters), ")"),
        "linear": _word(spelt("LINEAR")),
        "feed": line_form(
            f"{spelt('TA')}, {spelt('TS')} and F", spelt("TA"), WHOLE, spelt(" TS"), WHOLE, " F", DECIMAL
        ),
        "approach": line_form("six lengths", *list(chain.from_iterable(lengths))[:-1]),
        "halt": _word(spelt("DWELL0")),
        "interval": line_form(spelt("PVT"), spelt("PVT"), POSITIVE),
        "move": line_form("six lengths with speeds", *list(chain.from_iterable(lengths_and_speeds))[:-1]),
        "dwell": line_form(spelt("DWELL"), spelt("DWELL"), DECIMAL),
    }
    if axis is not None:
        forms[IN_THREAD] = line_form(
            "six lengths and the turns of the spindle, with speeds",
            *list(chain.from_iterable(lengths_and_speeds))[:-1],
            f" {axis.letter}",
            SIGNED,
            ":",
            SIGNED,
        )
    return forms | {name: _code_form(name, template) for name, template in settings.codes.items()}


def _word(word: str) -> LineForm:
    return line_form(word, word)


def _code_form(name: str, template: str) -> LineForm:
    field = FIELD.search(template)
    if field is None:
        return line_form(f"the code {name}", template)
    number = WHOLE if field["form"] == "d" else DECIMAL
    parts = (template[: field.start()], number, template[field.end() :])
    return line_form(f"the code {name}", *(part for part in parts if part))


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
    "spindle_axis": (EventKind.SPINDLE_AXIS, 1.0),
    "spindle_speed": (EventKind.SPINDLE_AXIS, 0.0),
}
"""Effect of the code of each name: the kind of event, and its value, or the value by the number in the code. The names
are those of ``[controller.codes]`` in machine files, which describe the action of the machine; those of ``functions``
there are M codes."""


_FUNCTION = re.compile(r"M(\d+)")
"""Names of functions of the machine: the M codes that part programs have for them."""


def is_code(name: str) -> bool:
    """Whether a kind of line is the code of an event."""
    return name in EFFECTS or _FUNCTION.fullmatch(name) is not None


def effect(name: str, numbers: Sequence[str]) -> tuple[EventKind, float]:
    """Kind and value of the event that a code executes, by its name and the numbers in its line."""
    if function := _FUNCTION.fullmatch(name):
        return EventKind.FUNCTION, float(function[1])
    kind, value = EFFECTS[name]
    return kind, value(float(numbers[0])) if callable(value) else value


START, FINISHED = "start", "finished"
Flow = Mapping[str, Mapping[str, str]]
"""For each state of the program the kinds of line that may follow, and the state each leads to."""

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
"""The flow after the program buffer is cleared."""

_FIRST_OF_BODY = "approached"


def state_after(flow: Flow, state: str, kind: str) -> str:
    """The state that a line leads to, even if it is misplaced.

    A misplaced line counts as if the missing lines before it were present, within the head or the body of the program,
    so that one fault is reported once. A line that belongs to the other part leads nowhere.
    """
    states = list(flow)
    here, body = states.index(state), states.index(_FIRST_OF_BODY)
    near = states[here : body + 1] if here < body else states[here:] + states[body:here]
    return next((flow[candidate][kind] for candidate in near if kind in flow[candidate]), state)


class ProgramGrammar(NamedTuple):
    """The grammar of one controller's programs.

    Attributes:
        forms: forms of all lines, by kind.
        flow: flow of the program.
        feed: values in the line of the approach: ms of acceleration, ms of rounding, mm/s.
    """

    forms: Mapping[str, LineForm]
    flow: Flow
    feed: tuple[float, float, float]
