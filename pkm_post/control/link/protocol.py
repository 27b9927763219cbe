# SPDX-License-Identifier: LGPL-2.1-or-later
"""Protocol: commands, events, and the base of all protocols of a controller.

A command starts an exchange of bytes; one event ends it. A protocol does no I/O and has no clock: its caller
passes the bytes and the time in seconds, from any monotonic clock.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

from pkm_post.model import Amount, Phrase


class CommandKind(Enum):
    """The effect of a command, which determines whether it may be resent."""

    QUERY = "query"
    """Reads only; may be repeated."""
    SET = "set"
    """Changes something; never resent unless it certainly was not executed."""
    BUFFER = "buffer"
    """Lines for an open program buffer; resent like a set."""
    BLIND = "blind"
    """Its answer cannot be parsed, as the handshake is unknown: it ends when the controller falls silent."""


@dataclass(frozen=True)
class ControllerCommand:
    r"""One command; only one is outstanding at a time.

    Attributes:
        text: without its terminator. Printable ASCII; the lines of a ``CommandKind.BUFFER`` are separated by ``\n``.
        kind: its effect.
        answer_timeout: timeout of the answer: seconds without a byte.
        most: maximum bytes of an answer; a longer one is invalid.

    Raises:
        ValueError: the text contains other characters.
    """

    text: str
    kind: CommandKind = CommandKind.QUERY
    answer_timeout: float = 2.0
    most: int = 1 << 16

    def __post_init__(self) -> None:
        plain = self.text.replace("\n", "") if self.kind is CommandKind.BUFFER else self.text
        # The controller obeys control characters even inside a line: ^K cuts motor power.
        if not plain or not all(" " <= character <= "~" for character in plain):
            raise ValueError(f"text: expected printable ASCII, got {self.text!r}")


@dataclass(frozen=True)
class Answer:
    """The command was executed; the lines of the answer."""

    lines: tuple[str, ...] = ()


@dataclass(frozen=True)
class Refusal:
    """The controller refused the command.

    Attributes:
        number: of the error, None if it gave none.
        line: index of the refused line, for lines of a buffer.
        words: number and meaning, if the controller gives them.
    """

    number: int | None
    line: int = 0
    words: str = ""


@dataclass(frozen=True)
class Lost:
    """The answer was invalid, or did not arrive.

    Attributes:
        why: the reason as text.
        untouched: whether the controller certainly did not execute the command.
        too_long: whether it has more bytes than the command allows.
    """

    why: str
    untouched: bool = False
    too_long: bool = False


@dataclass(frozen=True)
class Message:
    """An unsolicited line from a program in the controller."""

    text: str


Event = Answer | Refusal | Lost | Message


class CommandProtocol(Protocol):
    """A protocol without I/O: bytes in, bytes out.

    Attributes:
        deadline: when ``expire`` is due unless bytes arrive first; None while nothing is outstanding.
        handshake: the assignments that make the controller answer in the expected form; empty if ``reset`` is enough.
    """

    deadline: float | None
    handshake: str

    def begin(self, command: ControllerCommand, now: float) -> None:
        """Start a command.

        Raises:
            ValueError: another one is outstanding, or it exceeds the link's limit.
        """

    def reset(self, now: float, control: int | None = None) -> None:
        """Drop outstanding work, here and in the controller; ends with an ``Answer``, or with ``Lost``.

        Args:
            now: current time.
            control: code of a control character to send first; the controller obeys it in any state.
        """

    def receive(self, data: bytes, now: float) -> None:
        """Take bytes from the controller."""

    def expire(self, now: float) -> None:
        """The deadline has passed."""

    def outgoing(self) -> bytes:
        """Bytes to send; each call returns new ones only."""

    def events(self) -> list[Event]:
        """Events so far; each call returns new ones only."""

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """How many of these lines one ``CommandKind.BUFFER`` command may hold."""


_Step = Callable[[int, float], None]
"""Called with a byte and the time."""
_Timeout = Callable[[float], None]
"""Called with the time when the deadline has passed."""


class ByteProtocol:
    """Common base of the protocols."""

    def __init__(self, silence: float) -> None:
        """Create a protocol.

        Args:
            silence: seconds without a byte that end an answer; longer than the longest pause within one.
        """
        self.deadline: float | None = None
        self._silence = silence
        self._command = ControllerCommand("?")
        self._step: _Step | None = None
        self._on_timeout: _Timeout = self._no_answer
        self._out = bytearray()
        self._events: list[Event] = []
        self._collected = bytearray()
        self._received = 0

    def receive(self, data: bytes, now: float) -> None:
        """As ``CommandProtocol``."""
        at = 0
        while at < len(data) and self._step is not None:  # else nothing is outstanding: stray bytes
            taken = self._take_text(data[at : at + self._command.most - self._received], now)
            at += taken
            self._received += taken
            if taken:
                continue
            self._received += 1
            self._step(data[at], now)
            at += 1
            if self._received > self._command.most and self._step is not None:
                self._end(Lost(f"more than {self._command.most} bytes", self._is_untouched(), too_long=True))

    def expire(self, now: float) -> None:
        """As ``CommandProtocol``."""
        if self._step is not None:
            self._on_timeout(now)

    def outgoing(self) -> bytes:
        """As ``CommandProtocol``."""
        data, self._out = bytes(self._out), bytearray()
        return data

    def events(self) -> list[Event]:
        """As ``CommandProtocol``."""
        events, self._events = self._events, []
        return events

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """One line at a time: each is confirmed separately."""
        return min(len(lines), 1)

    def _take_up(self, command: ControllerCommand, most: int) -> None:
        """Make a command the outstanding one.

        Raises:
            ValueError: another one is outstanding, or the command exceeds ``most`` characters.
        """
        if self._step is not None:
            raise ValueError(f"command: expected none outstanding, got {self._command.text!r} before {command.text!r}")
        if len(command.text) > most:
            raise ValueError(f"command: expected up to {most} characters, got {len(command.text)}")
        self._begin_with(command)

    def _forget(self) -> None:
        """Drop the outstanding command; bytes until the next silence are discarded."""
        self._begin_with(ControllerCommand("forget", CommandKind.BLIND, self._silence))

    def _begin_with(self, command: ControllerCommand) -> None:
        self._command, self._received = command, 0
        self._collected.clear()

    def _wait(self, step: _Step, on_timeout: _Timeout, deadline: float) -> None:
        self._step, self._on_timeout, self.deadline = step, on_timeout, deadline

    def _wait_for_answer(self, step: _Step, now: float) -> None:
        self._wait(step, self._no_answer, now + self._command.answer_timeout)

    def _wait_for_silence(self, now: float) -> None:
        # The first byte of an answer may take longer than the others.
        self._collected.clear()
        self._wait(self._collect, self._silent, now + self._command.answer_timeout)

    def _collect(self, byte: int, now: float) -> None:
        self._collected.append(byte)
        self.deadline = now + self._silence

    def _silent(self, now: float) -> None:
        self._end(Answer(tuple(self._collected.decode("latin-1").split("\r"))))

    def _no_answer(self, now: float) -> None:
        self._end(Lost(Phrase("no answer for {}", Amount(self._command.answer_timeout, "s", "g"))))

    def _take_text(self, data: bytes, now: float) -> int:
        """Take the leading text inside a line of an answer; return its number of bytes, 0 if the first needs a step."""
        return 0

    def _is_untouched(self) -> bool:
        """Whether the controller certainly did not execute the command."""
        return False

    def _end(self, event: Event) -> None:
        self._step, self.deadline = None, None
        self._events.append(event)
