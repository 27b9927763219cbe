# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serial protocol: commands over a line that may lose, duplicate or corrupt bytes.

A line is executed only after the controller has confirmed its checksum: the line is sent without CR, then ^N; the
controller returns one byte, the sum of the line as received. If it matches, CR follows; if not, ^X discards the line,
and it is resent. So resending is safe: an unconfirmed line was not executed. After CR a line is resent only if the
controller refuses it with ERR004. That is noise, as lines have printable characters only; the checksum ignores a byte
above 127 or a framing error, but the controller does not execute a line with one.
[TurboPMAC, <CTRL-N>, <CTRL-X>, I6]

Input: commands, bytes and times. Output: bytes and events.
"""

from __future__ import annotations

import re
from enum import Enum, auto

from pkm_post.control.link.protocol import (
    Answer,
    ByteProtocol,
    CommandKind,
    ControllerCommand,
    Event,
    Lost,
    Message,
    Refusal,
)

ACK, BEL, STX, CR = 0x06, 0x07, 0x02, 0x0D
_ERROR = re.compile(r"\s*ERR(\d{3})")
_PRINTABLE = re.compile(rb"[ -~]*")


def checksum(data: bytes | bytearray) -> int:
    """The checksum of I4=1 and ^N."""
    return sum(data) & 0xFF


class _State(Enum):
    START = auto()
    DATA = auto()
    DATA_SUM = auto()
    ERROR = auto()
    MESSAGE = auto()
    COMMAND_SUM = auto()


class ResponseParser:
    """Parses one answer, byte by byte.

    Attributes:
        messages: lines sent by programs in between.
    """

    def __init__(self, command: bytes, summed: bool) -> None:
        """Create a reader for the answer to a command.

        Args:
            command: its characters without CR.
            summed: whether I4 is 1.
        """
        self.messages: list[Message] = []
        self._command, self._summed = command, summed
        self._state = _State.START
        self._line = bytearray()
        self._lines: list[str] = []
        self._steps = {
            _State.START: self._start,
            _State.DATA: self._data,
            _State.DATA_SUM: self._data_sum,
            _State.ERROR: self._error,
            _State.MESSAGE: self._message,
            _State.COMMAND_SUM: self._command_sum,
        }

    def take(self, byte: int) -> Event | None:
        """Take one byte; return the event if it completes the answer, or makes it invalid."""
        return self._steps[self._state](byte)

    def take_text(self, data: bytes) -> int:
        """Take the leading printable bytes inside a line of the answer; return their number."""
        if self._state is not _State.DATA:
            return 0
        text = _PRINTABLE.match(data)
        assert text is not None
        self._line += text[0]
        return len(text[0])

    def taken_messages(self) -> list[Message]:
        """Lines sent by programs in between; each call returns new ones only."""
        messages, self.messages = self.messages, []
        return messages

    def _start(self, byte: int) -> Event | None:
        self._line = bytearray()
        if byte == ACK:
            if not self._summed:
                return self._answer()
            self._state = _State.COMMAND_SUM
        elif byte == BEL:
            self._state = _State.ERROR
        elif byte == STX:
            self._state = _State.MESSAGE
        else:
            self._state = _State.DATA
            return self._data(byte)
        return None

    def _data(self, byte: int) -> Event | None:
        if byte != CR and not 0x20 <= byte <= 0x7E:
            return Lost(f"byte {byte:02X} in the middle of an answer")
        self._line.append(byte)
        if byte == CR and self._summed:
            self._state = _State.DATA_SUM
        elif byte == CR:
            self._keep()
        return None

    def _data_sum(self, byte: int) -> Event | None:
        if byte != checksum(self._line):
            return Lost(f"checksum {byte:02X} of an answer that sums to {checksum(self._line):02X}")
        self._keep()
        return None

    def _keep(self) -> None:
        self._lines.append(self._line[:-1].decode("ascii"))
        self._state = _State.START

    def _error(self, byte: int) -> Event | None:
        self._line.append(byte)
        text = self._line.decode("latin-1")
        # I6=3 also sends a CR before ERRnnn
        if byte != CR or not text.strip():
            return None if len(text) < 16 else Lost("an error that does not end")
        found = _ERROR.fullmatch(text.rstrip())
        return Refusal(int(found[1])) if found else Lost(f"an error that reads {text.strip()!r}")

    def _message(self, byte: int) -> Event | None:
        if byte != CR:
            self._line.append(byte)
            return None
        self.messages.append(Message(self._line.decode("latin-1")))
        self._state = _State.START
        return None

    def _command_sum(self, byte: int) -> Event | None:
        if byte != checksum(self._command):
            return Lost(f"checksum {byte:02X} for a command that sums to {checksum(self._command):02X}")
        return self._answer()

    def _answer(self) -> Answer:
        return Answer(tuple(self._lines))


FORGET, SUM, END = b"\x18", b"\x0e", b"\r"
GUARD_ATTEMPTS = 4
LONGEST_LINE = 255
ILLEGAL_CHARACTER = 4
"""Number of the refusal that line noise causes."""


class SerialProtocol(ByteProtocol):
    """A protocol with checksums: I3=2, I4=1, I6=1."""

    handshake = "I3=2 I4=1 I6=1 I9=3"

    def __init__(self, silence: float = 0.1) -> None:
        """Create a protocol; as ``ByteProtocol``, allowing for the pauses of USB adapters."""
        super().__init__(silence)
        self._reader = ResponseParser(b"", True)
        self._attempts = 0

    def begin(self, command: ControllerCommand, now: float) -> None:
        """As ``CommandProtocol``."""
        if "\n" in command.text:
            raise ValueError(f"command: expected one line, got {command.text[:40]!r}")
        self._take_up(command, LONGEST_LINE)
        self._attempts = 0
        self._send_line(now)

    def reset(self, now: float, control: int | None = None) -> None:
        """As ``CommandProtocol``; a control character acts at once, even inside a line."""
        self._forget()
        self._out += FORGET if control is None else bytes([control]) + FORGET
        self._wait_for_silence(now)

    def _send_line(self, now: float) -> None:
        self._attempts += 1
        self._out += self._command.text.encode("ascii") + SUM
        self._wait(self._guard, self._unguarded, now + self._command.answer_timeout)

    def _guard(self, byte: int, now: float) -> None:
        """Check the checksum of the line just sent."""
        line = self._command.text.encode("ascii")
        if byte != checksum(line):
            self._flush(f"the controller holds a line of checksum {byte:02X}, not {checksum(line):02X}", now)
            return
        self._out += END
        if self._command.kind is CommandKind.BLIND:
            self._wait_for_silence(now)
            return
        self._reader = ResponseParser(line, True)
        self._wait_for_answer(self._answer, now)

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

    def _take_text(self, data: bytes, now: float) -> int:
        taken = self._reader.take_text(data) if self._step == self._answer else 0
        if taken:
            self._wait_for_answer(self._answer, now)
        return taken

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
            self._wait_for_answer(self._answer, now)
