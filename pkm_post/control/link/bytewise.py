# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bytewise: the common base of all conversations with a controller.

One command is outstanding at a time. Each received byte goes to the current step; if no byte arrives before the
deadline, the timeout step runs. A subclass adds the bytes to send and the sequence of steps.

Enters: commands, bytes and times. Leaves: bytes and events.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pkm_post.control.link.exchange import Answer, Command, Event, Kind, Lost

Step = Callable[[int, float], None]
"""Called with a byte and the time."""
Late = Callable[[float], None]
"""Called with the time when the deadline has passed."""


class BytewiseConversation:
    """A conversation without a protocol.

    Attributes:
        deadline: when ``expire`` is due.
    """

    def __init__(self, silence: float) -> None:
        """Create a conversation.

        Args:
            silence: seconds without a byte that end an answer; longer than the longest pause within one.
        """
        self.deadline: float | None = None
        self._silence = silence
        self._command = Command("?")
        self._step: Step | None = None
        self._late: Late = self._unanswered
        self._out = bytearray()
        self._events: list[Event] = []
        self._collected = bytearray()
        self._taken = 0

    def receive(self, data: bytes, now: float) -> None:
        """As ``exchange.Conversation``."""
        for byte in data:
            if self._step is None:
                continue  # nothing is outstanding: a stray byte
            self._taken += 1
            self._step(byte, now)
            if self._taken > self._command.most and self._step is not None:
                self._end(Lost(f"more than {self._command.most} bytes", self._is_untouched()))

    def expire(self, now: float) -> None:
        """As ``exchange.Conversation``."""
        if self._step is not None:
            self._late(now)

    def outgoing(self) -> bytes:
        """As ``exchange.Conversation``."""
        data, self._out = bytes(self._out), bytearray()
        return data

    def events(self) -> list[Event]:
        """As ``exchange.Conversation``."""
        events, self._events = self._events, []
        return events

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """One line at a time: each is confirmed separately."""
        return min(len(lines), 1)

    def _take_up(self, command: Command, most: int) -> None:
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
        self._begin_with(Command("forget", Kind.BLIND, self._silence))

    def _begin_with(self, command: Command) -> None:
        self._command, self._taken = command, 0
        self._collected.clear()

    def _wait(self, step: Step, late: Late, deadline: float) -> None:
        self._step, self._late, self.deadline = step, late, deadline

    def _wait_patiently(self, step: Step, now: float) -> None:
        self._wait(step, self._unanswered, now + self._command.patience)

    def _wait_for_silence(self, now: float) -> None:
        # A controller thinks before it answers: the first byte may take longer than those after it.
        self._collected.clear()
        self._wait(self._collect, self._silent, now + self._command.patience)

    def _collect(self, byte: int, now: float) -> None:
        self._collected.append(byte)
        self.deadline = now + self._silence

    def _silent(self, now: float) -> None:
        self._end(Answer(tuple(self._collected.decode("latin-1").split("\r"))))

    def _unanswered(self, now: float) -> None:
        self._end(Lost(f"no answer for {self._command.patience:g} s"))

    def _is_untouched(self) -> bool:
        """Whether the controller certainly did not execute the command."""
        return False

    def _end(self, event: Event) -> None:
        self._step, self.deadline = None, None
        self._events.append(event)
