# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serial conversation: commands over a line that may lose, double or change bytes.

No line is carried out before the controller has told its checksum: the line goes out without CR, then ^N; the
controller returns one byte, the sum of what it holds. If it is right, CR goes out; if not, ^X makes the controller
forget the line, and it is sent again. So sending again is safe: what was not confirmed was not carried out.
After CR nothing is sent twice here.  [TurboPMAC, <CTRL-N>, <CTRL-X>]

Enters: commands, bytes and times. Leaves: bytes and events.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum, auto

from pkm_post.pmac_link.exchange import Answer, Command, Event, Kind, Lost
from pkm_post.pmac_link.responses import ResponseReader, checksum

FORGET, SUM, END = b"\x18", b"\x0e", b"\r"
GUARD_ATTEMPTS = 4
LONGEST_LINE = 255


class _State(Enum):
    IDLE = auto()
    GUARD = auto()
    """The line is out, its checksum is due."""
    FLUSH = auto()
    """^X is out; silence is due, then the line goes out again."""
    ANSWER = auto()
    SILENCE = auto()
    """Whatever comes is thrown away or, after a blind command, collected, until nothing comes any more."""


class SerialConversation:
    """A conversation with checksums: I3=2, I4=1, I6=1.

    Attributes:
        deadline: when ``expire`` is due.
        handshake: the assignments that it needs.
    """

    handshake = "I3=2 I4=1 I6=1 I9=3"

    def __init__(self, silence: float = 0.1) -> None:
        """Make a conversation.

        Args:
            silence: seconds without a byte after which the controller has nothing more to say; more than the longest
                pause within an answer, adapters for USB included.
        """
        self.deadline: float | None = None
        self._silence = silence
        self._state = _State.IDLE
        self._command = Command("?")
        self._reader = ResponseReader(b"", True)
        self._out = bytearray()
        self._events: list[Event] = []
        self._collected = bytearray()
        self._attempts = self._taken = 0

    def begin(self, command: Command, now: float) -> None:
        """As ``exchange.Conversation``."""
        if self._state is not _State.IDLE:
            raise ValueError(f"command: expected none outstanding, got {self._command.text!r} before {command.text!r}")
        if len(command.text) > LONGEST_LINE or "\n" in command.text:
            raise ValueError(f"command: expected one line up to {LONGEST_LINE} characters, got {command.text[:40]!r}")
        self._command, self._attempts, self._taken = command, 0, 0
        self._send_line(now)

    def reset(self, now: float) -> None:
        """As ``exchange.Conversation``."""
        self._out += FORGET
        self._taken = 0
        self._command = Command("forget", Kind.BLIND, self._silence)
        self._be_silent(now)

    def receive(self, data: bytes, now: float) -> None:
        """As ``exchange.Conversation``."""
        for byte in data:
            self._taken += 1
            if self._state is _State.GUARD:
                self._guard(byte, now)
            elif self._state is _State.ANSWER:
                self._answer(byte, now)
            elif self._state is _State.SILENCE:
                self._collected.append(byte)
            if self._taken > self._command.most and self._state is not _State.IDLE:
                self._end(Lost(f"more than {self._command.most} bytes", self._state in (_State.GUARD, _State.FLUSH)))
        if data and self._state in (_State.SILENCE, _State.FLUSH):
            self.deadline = now + self._silence

    def expire(self, now: float) -> None:
        """As ``exchange.Conversation``."""
        if self._state is _State.GUARD:
            self._flush("no checksum came back", now)
        elif self._state is _State.FLUSH:
            self._send_line(now)
        elif self._state is _State.ANSWER:
            self._end(Lost(f"no answer for {self._command.patience:g} s"))
        elif self._state is _State.SILENCE:
            self._end(Answer(tuple(self._collected.decode("latin-1").split("\r"))))

    def outgoing(self) -> bytes:
        """As ``exchange.Conversation``."""
        data, self._out = bytes(self._out), bytearray()
        return data

    def events(self) -> list[Event]:
        """As ``exchange.Conversation``."""
        events, self._events = self._events, []
        return events

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """One line at a time: each is confirmed by itself."""
        return min(len(lines), 1)

    def _send_line(self, now: float) -> None:
        self._attempts += 1
        self._out += self._command.text.encode("ascii") + SUM
        self._wait(_State.GUARD, now)

    def _guard(self, byte: int, now: float) -> None:
        line = self._command.text.encode("ascii")
        if byte != checksum(line):
            self._flush(f"the controller holds a line of checksum {byte:02X}, not {checksum(line):02X}", now)
            return
        self._out += END
        if self._command.kind is Kind.BLIND:
            self._be_silent(now)
            return
        self._reader = ResponseReader(line, True)
        self._wait(_State.ANSWER, now)

    def _flush(self, why: str, now: float) -> None:
        self._out += FORGET
        if self._attempts >= GUARD_ATTEMPTS:
            self._end(Lost(f"{why}, {self._attempts} times", untouched=True))
            return
        self._state, self.deadline = _State.FLUSH, now + self._silence

    def _answer(self, byte: int, now: float) -> None:
        event = self._reader.take(byte)
        self._events += self._reader.messages
        self._reader.messages.clear()
        self.deadline = now + self._command.patience
        if event is not None:
            self._end(event)

    def _be_silent(self, now: float) -> None:
        self._collected.clear()
        # A controller thinks before it answers: the first byte may take longer than the next.
        self._wait(_State.SILENCE, now)

    def _wait(self, state: _State, now: float) -> None:
        self._state, self.deadline = state, now + self._command.patience

    def _end(self, event: Event) -> None:
        self._state, self.deadline = _State.IDLE, None
        self._events.append(event)
