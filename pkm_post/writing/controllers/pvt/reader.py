# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: read a motion program back as strut motion, or report its faults.

Input: the text of a program or of its parts, the grammar of the controller and the settings it was written for.
Output: knots with lengths in mm and speeds in mm/s at whole ms, and the events, as the controller executes them.
The reader is strict: an unknown or misplaced line is a fault.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from decimal import Decimal

import numpy as np

from pkm_post.model import (
    NO_TURNS,
    Array,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Place,
    SpindleTurns,
    StrutMotion,
    checkpoint,
    read_only,
)
from pkm_post.writing.controllers.pvt.moves import TextLines, lines_of
from pkm_post.writing.controllers.pvt.parts import join_motions, part_faults
from pkm_post.writing.controllers.pvt.settings import PvtSettings
from pkm_post.writing.controllers.pvt.syntax import (
    FINISHED,
    IN_THREAD,
    START,
    ProgramGrammar,
    effect,
    is_code,
    state_after,
)

MOST_FAULTS = 20
_INTERVAL_MS = 4095
_DWELL_MS = 8_388_607
_SHOWN = 40


class LineReader:
    """The state of the reader, line by line.

    Attributes:
        forms: the forms of its lines.
        faults: faults so far.
    """

    def __init__(self, grammar: ProgramGrammar, file: str) -> None:
        self.forms = grammar.forms
        self.faults: list[Diagnostic] = []
        self._due = {
            state: [name for name in self.forms if _kind(name) in kinds] for state, kinds in grammar.flow.items()
        }
        self._grammar, self._file = grammar, file
        self._state = START
        self._lengths: list[Array] = []
        self._speeds: list[Array] = []
        self._knots = self._interval = 0
        self._intervals: list[Array] = []
        self._halts: list[tuple[int, int]] = []
        self._events: list[Event] = []
        self._acts = {"feed": self._feed, "approach": self._approach, "halt": self._halt, "dwell": self._dwell}
        self._acts |= {"interval": self._new_interval, "move": self._move, IN_THREAD: self._move_in_thread}
        self._in_thread = False
        self._turns: list[tuple[int, float, float]] = []

    def lines_of(self, text: str) -> TextLines:
        """The lines of a text, with moves and intervals already found."""
        # one byte per character: others than Latin-1 become question marks, which match no form
        return lines_of(text.encode("latin-1", "replace"), self.forms["move"], self.forms["interval"], _INTERVAL_MS)

    def take(self, number: int, text: str, lines: TextLines) -> None:
        """Process the lines of a text, starting at line ``number``."""
        for row, end in lines.runs():
            if len(self.faults) >= MOST_FAULTS:
                break
            self._line(number + row, text[lines.edges[row] : lines.edges[row + 1]].removesuffix("\n"))
            if row + 1 < end:
                self._moves(*lines.moves(row + 1, end, self._interval))

    def _line(self, number: int, line: str) -> None:
        name, numbers = self._form_of(line)
        if numbers is None:
            name = self._malformed(number, line)
        elif name not in self._due[self._state]:
            self._fault(number, 0, line, self._expected())
        if name:
            self._state = state_after(self._grammar.flow, self._state, _kind(name))
        if numbers is not None:
            self._act(name, number, line, numbers)

    def finish(self, number: int) -> StrutMotion | None:
        """The motion of a text that ended before line ``number``; None if there were faults."""
        if self._state != FINISHED:
            self._fault(number, 0, "", self._expected())
        elif self._in_thread:
            self._fault(number, 0, "", "the end of the thread")
        if self.faults:
            return None
        motion = self._motion()
        self._check_rest(motion)
        return None if self.faults else motion

    def _motion(self) -> StrutMotion:
        time_ms = np.cumsum(np.concatenate([[0], *self._intervals]))
        turns = SpindleTurns(*map(np.array, zip(*self._turns, strict=True))) if self._turns else NO_TURNS
        return StrutMotion(
            read_only(time_ms), _joined(self._lengths), _joined(self._speeds), tuple(self._events), turns
        )

    def _check_rest(self, motion: StrutMotion) -> None:
        """Check that the struts rest at every interruption; the end is checked with the whole motion."""
        eventful = {event.row for event in motion.events}
        halts = {knot for knot, _ in self._halts}
        turning = [knot for knot, _, speed in self._turns if speed and knot in halts]
        if turning:
            self._fault(dict(self._halts)[turning[0]], 0, self.forms["halt"].name, "the spindle at rest")
        for knot, number in self._halts:
            if motion.speed[knot].any() and (knot < len(motion) - 1 or knot in eventful):
                self._fault(number, 0, self.forms["halt"].name, "struts at rest")

    def _form_of(self, line: str) -> tuple[str, Sequence[str] | None]:
        """The form of a line, preferably an expected one, and its numbers; empty if it has no known form."""
        for name in (*self._due[self._state], *self.forms):
            match = self.forms[name].match(line)
            if match:
                return name, match.groups()
        return "", None

    def _act(self, name: str, number: int, line: str, numbers: Sequence[str]) -> None:
        if is_code(name):
            self._code(number, line, Event(self._knots - 1, *effect(name, numbers)))
        elif name in self._acts:
            self._acts[name](number, line, numbers)

    def _code(self, number: int, line: str, event: Event) -> None:
        if event.kind is EventKind.SPINDLE_AXIS:
            begins = event.value != 0
            if begins == self._in_thread:
                self._fault(number, 0, line, "the end of the thread" if begins else "a thread to end")
            self._in_thread = begins
        self._events.append(event)

    def _feed(self, number: int, line: str, numbers: Sequence[str]) -> None:
        if tuple(map(float, numbers)) != self._grammar.feed:
            expected = "{}, {} and {}".format(*self._grammar.feed)
            self._fault(number, 0, line, f"the numbers {expected}")

    def _approach(self, number: int, line: str, numbers: Sequence[str]) -> None:
        self._lengths.append(np.array([[float(length) for length in numbers]]))
        self._speeds.append(np.zeros((1, 6)))
        self._knots += 1

    def _move_in_thread(self, number: int, line: str, numbers: Sequence[str]) -> None:
        if not self._in_thread:
            self._fault(number, 0, line, self.forms["move"].name)
        *struts, angle, speed = map(float, numbers)
        self._turns.append((self._knots, angle, speed))
        self._moves(np.array(struts).reshape(1, 6, 2), np.array([self._interval]))

    def _move(self, number: int, line: str, numbers: Sequence[str]) -> None:
        # the first line of a run of moves is read here, and with it any change between the two kinds of move
        if self._in_thread:
            self._fault(number, 0, line, self.forms[IN_THREAD].name)
        self._moves(np.array([[float(number) for number in numbers]]).reshape(1, 6, 2), np.array([self._interval]))

    def _moves(self, values: Array, intervals: Array) -> None:
        """Append moves: their lengths and speeds, (M, 6, 2), and the duration of each in ms, (M,)."""
        self._lengths.append(values[:, :, 0].copy())
        self._speeds.append(values[:, :, 1].copy())
        self._intervals.append(intervals)
        self._knots += len(values)
        self._interval = int(intervals[-1])

    def _new_interval(self, number: int, line: str, numbers: Sequence[str]) -> None:
        self._interval = int(numbers[0])
        if self._interval > _INTERVAL_MS:
            self._fault(number, len("PVT"), line, f"at most {_INTERVAL_MS} ms")

    def _halt(self, number: int, line: str, numbers: Sequence[str]) -> None:
        self._halts.append((self._knots - 1, number))

    def _dwell(self, number: int, line: str, numbers: Sequence[str]) -> None:
        milliseconds = Decimal(numbers[0])
        if milliseconds > _DWELL_MS:
            self._fault(number, len("DWELL"), line, f"at most {_DWELL_MS} ms")
        self._events.append(Event(self._knots - 1, EventKind.DWELL, float(milliseconds / 1000)))

    def _malformed(self, number: int, line: str) -> str:
        """Report a line of no known form; return the intended kind of line, empty if unclear."""
        agreed, expected, name = max(
            ((*self.forms[name].agreement(line), name) for name in self._due[self._state]),
            default=(0, "", ""),
            key=lambda item: item[0],
        )
        self._fault(number, agreed, line, expected if agreed else self._expected())
        return name if agreed else ""

    def _expected(self) -> str:
        due = self._due[self._state]
        names = [self.forms[name].name for name in due if not is_code(name)]
        return " or ".join([*names, "a code"] if len(names) < len(due) else names) or "nothing more"

    def _fault(self, number: int, position: int, line: str, expected: str) -> None:
        shown = repr(line[position : position + _SHOWN]) if line[position:] else "the end"
        place = Place(self._file, line=number, column=position + 1)
        self.faults.append(Diagnostic("C101", place, f"{shown}, expected {expected}"))


def _joined(pieces: list[Array]) -> Array:
    """Join pieces into one column and release them: a long program does not fit into memory twice."""
    checkpoint()
    column = np.concatenate(pieces)
    pieces.clear()
    checkpoint()
    return read_only(column)


def _kind(name: str) -> str:
    return "code" if is_code(name) else "move" if name == IN_THREAD else name


_CHUNK = 1 << 20


def read_parts(
    texts: Sequence[tuple[str, str]], grammar: ProgramGrammar, settings: PvtSettings
) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a motion program in one or several parts, file name and text of each, in order.

    Returns:
        The whole motion, or None if there are faults; and the faults.
    """
    faults = part_faults(texts)
    motions = []
    for file, text in texts:
        motion, found = read_program(text, grammar, settings, file)
        motions += [motion] if motion is not None else []
        faults += found
    return (None, faults) if faults else join_motions(motions, [file for file, _ in texts])


def read_program(
    text: str, grammar: ProgramGrammar, settings: PvtSettings, file: str
) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a motion program, or one part of it.

    Returns:
        The motion, or None if there are faults; and the first 20 faults in line order.
    """
    reading = LineReader(grammar, file)
    number = 1
    too_long: list[Diagnostic] = []
    for chunk in _chunks(text):
        checkpoint()
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


def _too_long(number: int, lines: TextLines, settings: PvtSettings, file: str) -> Iterator[Diagnostic]:
    lengths = lines.lengths()
    for row in np.flatnonzero(lengths > settings.line_limit)[:MOST_FAULTS].tolist():
        found = f"{lengths[row]} characters, the controller takes {settings.line_limit}"
        yield Diagnostic("C103", Place(file, line=number + row, column=settings.line_limit + 1), found)
