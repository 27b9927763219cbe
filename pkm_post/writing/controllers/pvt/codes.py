# SPDX-License-Identifier: LGPL-2.1-or-later
"""Codes: a machine's program text for its events, such as ``T3 M6`` for a tool change.

Input: an event and the machine's table of codes. Output: the program line that executes it. The table must be
invertible: no text may mean two events, so that a program can be read back and compared with its job. Values are
in the units of the event, except the dwell: s inside, ms in the program. A code may call a subprogram of the machine
(M, T, S words) or set an output with a synchronous assignment, ``M60==1 DWELL0``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from pkm_post.model import Diagnostic, Diagnostics, Event, EventKind, Place, StrutMotion
from pkm_post.writing.controllers.pvt.decimals import exact, plain


class EventCode(NamedTuple):
    """The effect of the code with one name.

    Attributes:
        kind: the kind of event.
        value: the value of the event; None if the code states it.
        sign: sign of the event's value relative to the number in the code.
    """

    kind: EventKind
    value: float | None = None
    sign: int = 1

    def covers(self, event: Event) -> bool:
        """Whether this is the code of ``event``."""
        has_value = event.value * self.sign >= 0 if self.value is None else event.value == self.value
        return self.kind == event.kind and has_value


EVENT_CODES: dict[str, EventCode] = {
    "tool_change": EventCode(EventKind.TOOL_CHANGE),
    "spindle_stop": EventCode(EventKind.SPINDLE, 0.0),
    "spindle_clockwise": EventCode(EventKind.SPINDLE),
    "spindle_counterclockwise": EventCode(EventKind.SPINDLE, sign=-1),
    "coolant_off": EventCode(EventKind.COOLANT, 0.0),
    "coolant_flood": EventCode(EventKind.COOLANT, 1.0),
    "coolant_mist": EventCode(EventKind.COOLANT, 2.0),
    "stop": EventCode(EventKind.STOP, 0.0),
    "optional_stop": EventCode(EventKind.STOP, 1.0),
    "spindle_axis": EventCode(EventKind.SPINDLE_AXIS, 1.0),
    "spindle_speed": EventCode(EventKind.SPINDLE_AXIS, 0.0),
}
"""The first entry that covers an event is its code: spindle stop comes before the two directions. The reader has
its own definition of what each code does (``syntax.effect``)."""

OF_THREADS = frozenset({"spindle_axis", "spindle_speed"})
"""Codes for threads; only machines whose spindle can be an axis need them."""

FUNCTION_NAME = re.compile(r"M[0-9]+")
"""Name of the code of a function of the machine: the M code of part programs."""


def meaning_of(name: str) -> EventCode:
    """The effect of the code with a name of ``EVENT_CODES``, or that of a function."""
    return EVENT_CODES[name] if name in EVENT_CODES else EventCode(EventKind.FUNCTION, float(name[1:]))


LONGEST_DWELL = 8388.607
"""s; the controller truncates longer dwells to this."""

FIELD = re.compile(r"\{value(?::(?P<form>d|\.[1-9]f))?\}")
"""``{value}`` is the exact number, ``{value:d}`` a whole number, ``{value:.3f}`` one with three decimals."""

_LITERAL = r"[ -:<-z|~]"
_FIXED_CODE = re.compile(rf"{_LITERAL}+")
_VALUE_CODE = re.compile(rf"(?:{_LITERAL}*(?![0-9.-]){_LITERAL})?{FIELD.pattern}(?:(?![0-9.-]){_LITERAL}+)?")
_RESERVED = ("PVT", "DWELL", "LINEAR", "CLOSE")
_COMMENTS = ("//", "/*")
_MODE_WORDS = (
    "PVT|LINEAR|LIN|RAPID|RPD|CIRCLE|CIR|SPLINE|INC|ABS|FRAX|NORMAL|NRM|OPEN|CLOSE|CLEAR|DELETE"
    "|TSEL|TINIT|ADIS|IDIS|AROT|IROT|PRELUDE|UNDEFINE"
)
_MODES = re.compile(rf"(?<![A-Z])({_MODE_WORDS})(?![A-Z])", re.IGNORECASE)
"""Words that change the interpretation of the following moves, or the program itself; long and short."""
_TIMES = re.compile(rf"(?<![A-Z])(?:{_MODE_WORDS}|ELSE|ENDIF|ENDI)?(TA|TS|TM|F|G)\s*[-+.(0-9{{]", re.IGNORECASE)
"""Times and feed of moves, and G words, whose subprograms set modes."""
_HEXADECIMAL = re.compile(r"\$[0-9A-F]+", re.IGNORECASE)
"""Constants whose digits are no words."""
_FLOW = re.compile(r"(GOTO|GOSUB|GOS|CALLSUB|CALL|RETURN|RET)(?![A-Z])", re.IGNORECASE)
"""Words after which other lines are executed than those that follow."""
_TIME_BASE = re.compile(r"\"[^\"]*?(%)\s*[0-9{]")
"""An override, within a command to the controller."""
_OF_STRUTS = re.compile(
    r"(?<![A-Z.])(H(?:OME|M)(?:Z|(?!Z)))(?!\s*(?:[7-9]|[1-9][0-9]))|(#\s*[1-6])(?![0-9])", re.IGNORECASE
)
"""Homing of all motors or of a strut, and commands to the motor of a strut; strut i is motor i."""
_PARENTHESES = re.compile(r"\([^()]*\)")
_COMPUTED = "\0"
"""Stands for text in parentheses: a condition or an index, never an assignment."""
_SET = r"\s*(?:(?:[-+*/%&|^]|<<|>>)?=|\+\+|--)"
_VARIABLES = re.compile(
    rf"(?P<name>I\s*(?P<first>[0-9]+)(?:\s*\.\.\s*(?P<last>[0-9]+))?)(?![0-9]){_SET}"
    rf"|(?P<indirect>I\s*(?:{_COMPUTED}|[0-9]*\{{[^}}]*\}}[0-9]*|[0-9]+(?:\s*(?:,|\.\.)\s*[0-9]+)+)){_SET}"
    rf"|(?P<element>(?P<kind>MOTOR|COORD|SYS)\s*(?:\[\s*(?P<index>.{{0,80}}?)\s*\])?\s*\.\s*\w[\w.\[\]]*){_SET}",
    re.IGNORECASE,
)
"""Assignments to I-variables, and to elements of a Power PMAC's data structure."""
_STRUTS = range(1, 7)
_GLOBAL = (range(10, 11), range(42, 43))
"""I10 is the servo cycle, I42 the unit of the times of PVT moves."""
_SERVO_CYCLE = ("SERVOPERIOD", "PHASEOVERSERVOPERIOD")
_SYNCHRONOUS = re.compile(r"[=&|^]=")
_WITH_DWELL = re.compile(r".* DWELL *0", re.IGNORECASE)
_OTHER_NUMBERS = ("7919", "7919.5")


def check_codes(codes: Mapping[str, str], letters: Sequence[str], system: int = 1) -> None:
    """Check that a table of codes is complete, well formed and invertible, moves no strut, and alters no later move.

    Args:
        codes: text for each name of ``EVENT_CODES``, with one field if it states the value of the event, and for the
            functions of the machine.
        letters: letters of the axes.
        system: number of the coordinate system.

    Raises:
        ValueError: a name is missing or unknown, a text is malformed, changes modes, flow or settings of the program,
            or moves an axis, or some text would mean two events.
    """
    names = {name for name in codes if not FUNCTION_NAME.fullmatch(name)}
    if names not in (set(EVENT_CODES), set(EVENT_CODES) - OF_THREADS):
        expected = ", ".join(name for name in EVENT_CODES if name not in OF_THREADS or names & OF_THREADS)
        raise ValueError(f"codes: expected the names {expected}, got {', '.join(codes)}")
    for name, template in codes.items():
        form, expected = (
            (_VALUE_CODE, "text with one {value}, {value:d} or {value:.3f}, apart from other digits")
            if meaning_of(name).value is None
            else (_FIXED_CODE, "text without ';' and braces")
        )
        reserved = template.upper().startswith(_RESERVED) or any(mark in template for mark in _COMMENTS)
        if not form.fullmatch(template) or template != template.strip() or reserved:
            besides = f"no comment, not beginning with {', '.join(_RESERVED)} or a space"
            raise ValueError(f"codes.{name}: expected {expected}, {besides}, got {template!r}")
        _check_synchronous(name, template)
        _check_no_motion(name, template, letters)
        _check_no_setting(name, template, system)
    _check_invertible(codes)


def _check_synchronous(name: str, template: str) -> None:
    """Require a dwell after a synchronous assignment, which waits for the next move or dwell and may never run."""
    if _SYNCHRONOUS.search(template) and not _WITH_DWELL.fullmatch(template):
        raise ValueError(f"codes.{name}: expected DWELL0 behind a synchronous assignment, got {template!r}")


def _check_no_motion(name: str, template: str, letters: Sequence[str]) -> None:
    """Refuse codes with moves and modes: the certificate covers only those of the program itself."""
    axes = "|".join(map(re.escape, letters))
    # the controller needs no space between words: RAPIDA10 is a mode and a move
    moves = re.compile(rf"(?<![A-Z])(?:{_MODE_WORDS}|PSET)?({axes})\s*[-+.(0-9{{]", re.IGNORECASE)
    text = _HEXADECIMAL.sub("$", template)
    patterns = (_MODES, moves, _OF_STRUTS, _TIMES, _FLOW, _TIME_BASE)
    found = next(filter(None, (pattern.search(text) for pattern in patterns)), None)
    if found:
        word = next(filter(None, found.groups()))
        raise ValueError(f"codes.{name}: expected no mode and no move of an axis, got {word} in {template!r}")


def _check_no_setting(name: str, template: str, system: int) -> None:
    """Refuse codes that set up struts or coordinate system: speed unit, limits and time base are those of the plan."""
    text, before = template, ""
    while text != before:
        text, before = _PARENTHESES.sub(_COMPUTED, text), text
    for found in _VARIABLES.finditer(text):
        if found["indirect"] or (_sets_variable(found, system) if found["name"] else _sets_element(found, system)):
            what = (found["name"] or found["element"] or found["indirect"]).replace(_COMPUTED, "(...)")
            expected = "no setting of motors 1 to 6 and of the coordinate system"
            raise ValueError(f"codes.{name}: expected {expected}, got {what} in {template!r}")


def _sets_variable(found: re.Match[str], system: int) -> bool:
    """Whether a range of I-variables has one of the struts (Ixx..), of the system (Isx..), or of the time of moves."""
    first, last = sorted((int(found["first"]), int(found["last"] or found["first"])))
    begin = 100 * (50 + system)
    refused = (range(100 * _STRUTS[0], 100 * _STRUTS[-1] + 100), range(begin, begin + 100), *_GLOBAL)
    return any(first < numbers.stop and last >= numbers.start for numbers in refused)


def _sets_element(found: re.Match[str], system: int) -> bool:
    kind, index = found["kind"].upper(), found["index"]
    if kind == "SYS":
        return found["element"].upper().rpartition(".")[2] in _SERVO_CYCLE
    return index is None or not index.isdecimal() or int(index) in (_STRUTS if kind == "MOTOR" else (system,))


def _check_invertible(codes: Mapping[str, str]) -> None:
    """Try every code with the numbers in the table and two others: if these do not clash, none do."""
    numbers = {*_OTHER_NUMBERS, *re.findall(r"[0-9]+(?:\.[0-9]+)?", " ".join(codes.values()))}
    patterns = {name: _pattern(template) for name, template in codes.items()}
    for name, template in codes.items():
        for text in sorted({FIELD.sub(number, template) for number in numbers}):
            alike = [other for other, pattern in patterns.items() if pattern.fullmatch(text)]
            if name in alike and len(alike) > 1:
                raise ValueError(f"codes: expected different texts, got {text!r} for {' and '.join(alike)}")


def _pattern(template: str) -> re.Pattern[str]:
    field = FIELD.search(template)
    if field is None:
        return re.compile(re.escape(template))
    before, after = re.escape(template[: field.start()]), re.escape(template[field.end() :])
    number = "[0-9]+" if field["form"] == "d" else r"[0-9]+(?:\.[0-9]+)?"
    return re.compile(before + number + after)


def _number_text(template: str, value: float) -> str:
    field = FIELD.search(template)
    form = field and field["form"]
    return plain(value) if form is None else format(int(value) if form == "d" else value, form)


def reason_unwritable(event: Event, codes: Mapping[str, str]) -> str:
    """The reason why ``event`` has no code, as text; empty if it has one."""
    if event.kind == EventKind.DWELL:
        return "" if 0 <= event.value <= LONGEST_DWELL else f"a dwell lasts 0 to {LONGEST_DWELL} s"
    name = _name(event)
    if name not in codes or not math.isfinite(event.value):
        return "no code has this meaning"
    number = _number_text(codes[name], abs(event.value))
    return "" if float(number) == abs(event.value) else f"the code {name} = {codes[name]!r} would write it as {number}"


def code_text(event: Event, codes: Mapping[str, str], dwell: str = "DWELL") -> str:
    """The program line that executes ``event``; ``dwell`` is the controller's word for a dwell.

    Raises:
        ValueError: the event has no code; ``event_faults`` reports this beforehand.
    """
    reason = reason_unwritable(event, codes)
    if reason:
        raise ValueError(f"event: expected one with a code, got {event}: {reason}")
    if event.kind == EventKind.DWELL:
        return f"{dwell}{plain(exact(event.value) * 1000)}"
    template = codes[_name(event)]
    return FIELD.sub(_number_text(template, abs(event.value)), template)


def event_faults(motion: StrutMotion, codes: Mapping[str, str], file: str) -> Diagnostics:
    """Diagnostics for the events of a motion without a code on the machine; ``file`` is the name of the job."""
    reasons = ((event, reason_unwritable(event, codes)) for event in motion.events)
    return tuple(
        Diagnostic("C104", Place(file), f"{event.kind.name.lower()} {event.value:.12g}: {reason}")
        for event, reason in reasons
        if reason
    )


def _name(event: Event) -> str:
    if event.kind == EventKind.FUNCTION:
        return f"M{event.value:.0f}"
    return next((name for name, meaning in EVENT_CODES.items() if meaning.covers(event)), "")
