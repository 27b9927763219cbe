# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serial conversation: commands over a line that may lose, duplicate or corrupt bytes.

No line is executed before the controller has confirmed its checksum: the line is sent without CR, then ^N; the
controller returns one byte, the sum of what it holds. If it matches, CR follows; if not, ^X discards the line, and it
is resent. So resending is safe: a line not confirmed was not executed. After CR a line is resent in one case only: if
the controller refuses it with ERR004. That is noise, as lines contain printable characters only; a byte above 127 or a
framing error does not count in the checksum, but the controller does not execute a line that has one.
[TurboPMAC, <CTRL-N>, <CTRL-X>, I6]

Enters: commands, bytes and times. Leaves: bytes and events.
"""

from __future__ import annotations

from pkm_post.control.link.bytewise import BytewiseConversation
from pkm_post.control.link.exchange import Command, Kind, Lost, Refusal
from pkm_post.control.link.responses import ResponseReader, checksum

FORGET, SUM, END = b"\x18", b"\x0e", b"\r"
GUARD_ATTEMPTS = 4
LONGEST_LINE = 255
ILLEGAL_CHARACTER = 4
"""Number of the refusal that line noise causes."""


class SerialConversation(BytewiseConversation):
    """A conversation with checksums: I3=2, I4=1, I6=1.

    Attributes:
        deadline: when ``expire`` is due.
        handshake: the assignments it requires.
    """

    handshake = "I3=2 I4=1 I6=1 I9=3"

    def __init__(self, silence: float = 0.1) -> None:
        """Create a conversation; as ``BytewiseConversation``, allowing for the pauses of USB adapters."""
        super().__init__(silence)
        self._reader = ResponseReader(b"", True)
        self._attempts = 0

    def begin(self, command: Command, now: float) -> None:
        """As ``exchange.Conversation``."""
        if "\n" in command.text:
            raise ValueError(f"command: expected one line, got {command.text[:40]!r}")
        self._take_up(command, LONGEST_LINE)
        self._attempts = 0
        self._send_line(now)

    def reset(self, now: float, control: int | None = None) -> None:
        """As ``exchange.Conversation``; a control character acts at once, even inside a line."""
        self._forget()
        self._out += FORGET if control is None else bytes([control]) + FORGET
        self._wait_for_silence(now)

    def _send_line(self, now: float) -> None:
        self._attempts += 1
        self._out += self._command.text.encode("ascii") + SUM
        self._wait(self._guard, self._unguarded, now + self._command.patience)

    def _guard(self, byte: int, now: float) -> None:
        """Check the checksum of the line just sent."""
        line = self._command.text.encode("ascii")
        if byte != checksum(line):
            self._flush(f"the controller holds a line of checksum {byte:02X}, not {checksum(line):02X}", now)
            return
        self._out += END
        if self._command.kind is Kind.BLIND:
            self._wait_for_silence(now)
            return
        self._reader = ResponseReader(line, True)
        self._wait_patiently(self._answer, now)

    def _unguarded(self, now: float) -> None:
        self._flush("no checksum came back", now)

    def _flush(self, why: str, now: float) -> None:
        """Send ^X, wait for silence, then resend the line."""
        self._out += FORGET
        if self._attempts >= GUARD_ATTEMPTS:
            self._end(Lost(f"{why}, {self._attempts} times", untouched=True))
            return
        self._wait(self._pass_over, self._send_line, now + self._silence)

    def _pass_over(self, byte: int, now: float) -> None:
        self.deadline = now + self._silence

    def _is_untouched(self) -> bool:
        return self._step in (self._guard, self._pass_over)

    def _answer(self, byte: int, now: float) -> None:
        event = self._reader.take(byte)
        self._events += self._reader.taken_messages()
        if isinstance(event, Refusal) and event.number == ILLEGAL_CHARACTER:
            self._flush("the controller refused the line for an illegal character", now)
        elif event is not None:
            self._end(event)
        else:
            self._wait_patiently(self._answer, now)
