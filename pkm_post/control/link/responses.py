# SPDX-License-Identifier: LGPL-2.1-or-later
"""Responses: parse the bytes of one answer of the controller, framed by I3=2, I6=1 and either I4.

    answer   = { data CR [sum] } ACK [sum of the command]     or     { data CR [sum] } BEL ERRnnn CR
    message  = STX text CR                                    (I64=1: unsolicited, from a program)

Each [sum] is one byte, present with I4=1 only: the sum of the bytes of the data line with its CR, or of the command
without its CR, modulo 256. A sum may be any byte, including 06, 07 and 0D, so only its position identifies it. The
manuals do not state whether a refusal has a sum; none is expected, and one that arrives is a stray byte.
[TurboPMAC, I3, I4, I6, I64]
"""

from __future__ import annotations

import re
from enum import Enum, auto

from pkm_post.control.link.exchange import Answer, Event, Lost, Message, Refusal

ACK, BEL, STX, CR = 0x06, 0x07, 0x02, 0x0D
_ERROR = re.compile(r"\s*ERR(\d{3})")


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


class ResponseReader:
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
