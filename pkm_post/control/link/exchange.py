# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exchange: the commands and events of a conversation with the controller.

A command enters; bytes go out and come in; one event ends it. A conversation does no I/O and has no clock: its caller
passes the bytes and the time in seconds, from any monotonic clock.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol


class Kind(Enum):
    """The effect of a command, which decides whether it may be resent."""

    QUERY = "query"
    """Reads only; may be repeated."""
    SET = "set"
    """Changes something; never resent unless it certainly was not executed."""
    BUFFER = "buffer"
    """Lines for an open program buffer; the rule for a set applies."""
    BLIND = "blind"
    """Its answer cannot be parsed, as the handshake is unknown: it ends when the controller falls silent."""


@dataclass(frozen=True)
class Command:
    r"""One command; only one is outstanding at a time.

    Attributes:
        text: without its terminator. Printable ASCII; the lines of a ``Kind.BUFFER`` are separated by ``\n``.
        kind: its effect.
        patience: seconds without a byte before the answer is given up.
        most: maximum bytes of an answer; a longer one is invalid.

    Raises:
        ValueError: the text contains other characters.
    """

    text: str
    kind: Kind = Kind.QUERY
    patience: float = 2.0
    most: int = 1 << 16

    def __post_init__(self) -> None:
        plain = self.text.replace("\n", "") if self.kind is Kind.BUFFER else self.text
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
        words: number and meaning, if the controller states them itself.
    """

    number: int | None
    line: int = 0
    words: str = ""


@dataclass(frozen=True)
class Lost:
    """The answer made no sense, or did not arrive.

    Attributes:
        why: in plain text.
        untouched: whether the controller certainly did not execute the command.
    """

    why: str
    untouched: bool = False


@dataclass(frozen=True)
class Message:
    """An unsolicited line from a program in the controller."""

    text: str


Event = Answer | Refusal | Lost | Message


class Conversation(Protocol):
    """A protocol without I/O: bytes in, bytes out.

    Attributes:
        deadline: when ``expire`` is due unless bytes arrive first; None while nothing is outstanding.
        handshake: the assignments that make the controller answer in the expected form; empty if ``reset`` is enough.
    """

    deadline: float | None
    handshake: str

    def begin(self, command: Command, now: float) -> None:
        """Start a command.

        Raises:
            ValueError: another one is outstanding, or it exceeds the link's limit.
        """

    def reset(self, now: float, control: int | None = None) -> None:
        """Drop what is outstanding, here and in the controller; ends with an ``Answer``, or with ``Lost``.

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
        """How many of these lines one ``Kind.BUFFER`` command may hold."""
