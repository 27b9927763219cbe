# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ethernet conversation: commands in the packets of the Turbo PMAC's Ethernet card.

Every packet has a head of eight bytes: request type, request, and value, index and length as big-endian words.

| request | type | asks for | returns |
|---|---|---|---|
| GETRESPONSE BF | 40 | text of one command, without CR | up to 1400 bytes of the answer |
| GETBUFFER C5 | C0 | the rest of the answer | up to 1400 bytes |
| WRITEBUFFER C6 | 40 | up to 1024 bytes of lines for an open buffer, each with a 00 behind it | 4 bytes |
| FLUSH B3 | 40 | that everything outstanding is forgotten | 1 byte |
| CTRL_RESPONSE C4 | C0 | a control character, in the value | its answer |

TCP loses and changes nothing, so there are no checksums (I4=0), and bytes that make no sense mean that the connection
is of no use any more: it ends with ``Lost``, and whoever runs the conversation connects anew.
[UMACEthernet, Ethernet Protocol]

Enters: commands, bytes and times. Leaves: bytes and events.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from enum import Enum, auto

from pkm_post.pmac_link.exchange import Answer, Command, Event, Kind, Lost, Refusal
from pkm_post.pmac_link.responses import ResponseReader

DOWNLOAD, UPLOAD = 0x40, 0xC0
GETRESPONSE, GETBUFFER, WRITEBUFFER, FLUSH, CTRL_RESPONSE = 0xBF, 0xC5, 0xC6, 0xB3, 0xC4
MOST_ANSWER = 1400
"""Bytes of an answer in one packet."""
MOST_LINES = 1024
"""Bytes of lines in one WRITEBUFFER."""
LONGEST_COMMAND = 255
"""Characters of one command; longer ones are not known to be taken."""

_LINE_FAULT = 0x80


def packet(request: int, data: bytes = b"", value: int = 0, length: int | None = None) -> bytes:
    """A request.

    Args:
        request: its number; its type follows.
        data: what is sent with it.
        value: of the head.
        length: of the head; the length of the data unless given.
    """
    kind = UPLOAD if request in (GETBUFFER, CTRL_RESPONSE) else DOWNLOAD
    return struct.pack(">BBHHH", kind, request, value, 0, len(data) if length is None else length) + data


class _State(Enum):
    IDLE = auto()
    ANSWER = auto()
    LINES = auto()
    SILENCE = auto()


class EthernetConversation:
    """A conversation in packets: I3=2, I4=0, I6=1.

    Attributes:
        deadline: when ``expire`` is due.
        handshake: the assignments that it needs.
    """

    handshake = "I3=2 I4=0 I6=1 I9=3"

    def __init__(self, silence: float = 0.1) -> None:
        """Make a conversation.

        Args:
            silence: seconds without a byte after which the controller has nothing more to say.
        """
        self.deadline: float | None = None
        self._silence = silence
        self._state = _State.IDLE
        self._command = Command("?")
        self._reader = ResponseReader(b"", False)
        self._out = bytearray()
        self._events: list[Event] = []
        self._collected = bytearray()
        self._in_packet = self._taken = 0

    def begin(self, command: Command, now: float) -> None:
        """As ``exchange.Conversation``."""
        if self._state is not _State.IDLE:
            raise ValueError(f"command: expected none outstanding, got {self._command.text!r} before {command.text!r}")
        most = MOST_LINES if command.kind is Kind.BUFFER else LONGEST_COMMAND
        if len(command.text) >= most:
            raise ValueError(f"command: expected less than {most} characters, got {len(command.text)}")
        self._command, self._taken, self._in_packet = command, 0, 0
        text = command.text.encode("ascii")
        self._collected.clear()
        if command.kind is Kind.BUFFER:
            self._ask(packet(WRITEBUFFER, text.replace(b"\n", b"\0") + b"\0"), _State.LINES, now)
            return
        self._reader = ResponseReader(text, False)
        self._ask(packet(GETRESPONSE, text), _State.SILENCE if command.kind is Kind.BLIND else _State.ANSWER, now)

    def reset(self, now: float) -> None:
        """As ``exchange.Conversation``."""
        self._command, self._taken = Command("forget", Kind.BLIND, self._silence), 0
        self._collected.clear()
        self._ask(packet(FLUSH), _State.SILENCE, now)

    def receive(self, data: bytes, now: float) -> None:
        """As ``exchange.Conversation``."""
        for byte in data:
            self._taken += 1
            if self._state is _State.ANSWER:
                self._answer(byte, now)
            elif self._state is _State.LINES:
                self._collected.append(byte)
                self._lines_taken()
            elif self._state is _State.SILENCE:
                self._collected.append(byte)
                self.deadline = now + self._silence
            if self._taken > self._command.most and self._state is not _State.IDLE:
                self._end(Lost(f"more than {self._command.most} bytes"))

    def expire(self, now: float) -> None:
        """As ``exchange.Conversation``."""
        if self._state is _State.SILENCE:
            self._end(Answer(tuple(self._collected.decode("latin-1").split("\r"))))
        elif self._state is not _State.IDLE:
            self._end(Lost(f"no answer for {self._command.patience:g} s"))

    def outgoing(self) -> bytes:
        """As ``exchange.Conversation``."""
        data, self._out = bytes(self._out), bytearray()
        return data

    def events(self) -> list[Event]:
        """As ``exchange.Conversation``."""
        events, self._events = self._events, []
        return events

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """As many lines as one WRITEBUFFER holds."""
        room, count = MOST_LINES, 0
        for line in lines:
            room -= len(line) + 1
            if room < 0:
                break
            count += 1
        return count

    def _answer(self, byte: int, now: float) -> None:
        self._in_packet += 1
        self.deadline = now + self._command.patience
        event = self._reader.take(byte)
        self._events += self._reader.messages
        self._reader.messages.clear()
        if event is not None:
            self._end(event)
        elif self._in_packet == MOST_ANSWER:
            self._in_packet = 0
            self._ask(packet(GETBUFFER, length=MOST_ANSWER), _State.ANSWER, now)

    def _lines_taken(self) -> None:
        """Four bytes: number of a line, low byte first; number of the error; 80 when there is one."""
        if len(self._collected) < 4:
            return
        line, error, fault = struct.unpack("<HBB", self._collected[:4])
        count = self._command.text.count("\n") + 1
        if fault == 0 and error == 0:
            self._end(Answer())
        elif fault == _LINE_FAULT:
            # Whether the first line is 0 or 1 is not in the manuals at hand; 1 is taken.
            self._end(Refusal(error, min(max(line - 1, 0), count - 1)))
        else:
            self._end(Lost(f"{self._collected[:4].hex(' ')} in answer to lines of a program"))

    def _ask(self, data: bytes, state: _State, now: float) -> None:
        self._out += data
        self._state, self.deadline = state, now + self._command.patience

    def _end(self, event: Event) -> None:
        self._state, self.deadline = _State.IDLE, None
        self._events.append(event)
