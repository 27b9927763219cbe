# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exchange: what goes into a conversation with the controller, and what comes out of it.

A command enters; bytes go out and come in; one event leaves that ends it. A conversation does no input or output and
knows no clock: whoever runs it passes bytes and the time in seconds, of any clock that only grows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Protocol


class Kind(Enum):
    """What a command does, which decides whether it may be sent again."""

    QUERY = "query"
    """Asks; may be asked again."""
    SET = "set"
    """Changes something; never sent again unless it surely was not carried out."""
    BUFFER = "buffer"
    """Lines for an open program buffer; as a set."""
    BLIND = "blind"
    """Its answer cannot be told apart, for the handshake is not known yet: ends when the controller is silent."""


@dataclass(frozen=True)
class Command:
    r"""One command; only one is outstanding at a time.

    Attributes:
        text: without its end. Printable ASCII; the lines of a ``Kind.BUFFER`` are parted by ``\n``.
        kind: what it does.
        patience: seconds without a byte until the answer is given up.
        most: bytes of an answer that are taken; more is no answer.

    Raises:
        ValueError: the text has other characters.
    """

    text: str
    kind: Kind = Kind.QUERY
    patience: float = 2.0
    most: int = 1 << 16

    def __post_init__(self) -> None:
        plain = self.text.replace("\n", "") if self.kind is Kind.BUFFER else self.text
        # The controller obeys control characters even inside a line: ^K takes the power off the motors.
        if not plain or not all(" " <= character <= "~" for character in plain):
            raise ValueError(f"text: expected printable ASCII, got {self.text!r}")


@dataclass(frozen=True)
class Answer:
    """The command was carried out; the lines that the controller said."""

    lines: tuple[str, ...] = ()


@dataclass(frozen=True)
class Refusal:
    """The controller refused the command.

    Attributes:
        number: of the error, None when it gave none.
        line: index of the line that was refused, for lines of a buffer.
        words: number and meaning, where the controller says them itself.
    """

    number: int | None
    line: int = 0
    words: str = ""


@dataclass(frozen=True)
class Lost:
    """No sense came back.

    Attributes:
        why: in words.
        untouched: whether the controller surely did not carry the command out.
    """

    why: str
    untouched: bool = False


@dataclass(frozen=True)
class Message:
    """A line that a program in the controller sent of its own accord."""

    text: str


Event = Answer | Refusal | Lost | Message


class Conversation(Protocol):
    """Bytes in, bytes out.

    Attributes:
        deadline: when ``expire`` is due unless bytes come before; None while nothing is outstanding.
        handshake: the assignments that make the controller answer as this conversation expects; empty when ``reset``
            is enough.
    """

    deadline: float | None
    handshake: str

    def begin(self, command: Command, now: float) -> None:
        """Start a command.

        Raises:
            ValueError: another one is outstanding, or it is longer than the link takes.
        """

    def reset(self, now: float, control: int | None = None) -> None:
        """Forget what is outstanding and make the controller forget it; ends with an ``Answer``, or with ``Lost``.

        Args:
            now: the time.
            control: code of a control character that is sent first; the controller obeys it whatever it is doing.
        """

    def receive(self, data: bytes, now: float) -> None:
        """Take bytes of the controller."""

    def expire(self, now: float) -> None:
        """The deadline has passed."""

    def outgoing(self) -> bytes:
        """Bytes to be sent; each call gives them once."""

    def events(self) -> list[Event]:
        """What has happened; each call gives it once."""

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """How many of these lines one ``Kind.BUFFER`` command may hold."""
