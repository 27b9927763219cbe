# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ethernet protocol: commands in packets of the Turbo PMAC's Ethernet card.

Every packet has a header of eight bytes: request type, request, and value, index and length as big-endian words.

| request | type | asks for | returns |
|---|---|---|---|
| GETRESPONSE BF | 40 | text of one command, without CR | up to 1400 bytes of the answer |
| GETBUFFER C5 | C0 | the rest of the answer | up to 1400 bytes |
| WRITEBUFFER C6 | 40 | up to 1024 bytes of lines for an open buffer, each terminated by 00 | 4 bytes |
| FLUSH B3 | 40 | everything outstanding to be dropped | 1 byte |
| CTRL_RESPONSE C4 | C0 | a control character, in the value | its answer |

TCP neither loses nor corrupts data, so there are no checksums (I4=0), and on invalid bytes the connection is
unusable: the protocol ends with ``Lost``, and its caller reconnects.
[UMACEthernet, Ethernet Protocol]

Input: commands, bytes and times. Output: bytes and events.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

from pkm_post.control.link.protocol import Answer, ByteProtocol, CommandKind, ControllerCommand, Lost, Refusal
from pkm_post.control.link.serial_protocol import ResponseParser

DOWNLOAD, UPLOAD = 0x40, 0xC0
GETRESPONSE, GETBUFFER, WRITEBUFFER, FLUSH, CTRL_RESPONSE = 0xBF, 0xC5, 0xC6, 0xB3, 0xC4
MOST_ANSWER = 1400
"""Bytes of an answer in one packet."""
MOST_LINES = 1024
"""Bytes of lines in one WRITEBUFFER."""
LONGEST_COMMAND = 255
"""Characters of one command; longer ones are not documented to work."""

_LINE_FAULT = 0x80


def packet(request: int, data: bytes = b"", value: int = 0, length: int | None = None) -> bytes:
    """Build a request packet.

    Args:
        request: its number, which implies its type.
        length: header field; the length of the data by default.
    """
    kind = UPLOAD if request in (GETBUFFER, CTRL_RESPONSE) else DOWNLOAD
    return struct.pack(">BBHHH", kind, request, value, 0, len(data) if length is None else length) + data


class EthernetProtocol(ByteProtocol):
    """A protocol in packets: I3=2, I4=0, I6=1."""

    handshake = "I3=2 I4=0 I6=1 I9=3"

    def __init__(self, silence: float = 0.1) -> None:
        super().__init__(silence)
        self._reader = ResponseParser(b"", False)
        self._in_packet = 0

    def begin(self, command: ControllerCommand, now: float) -> None:
        """As ``CommandProtocol``."""
        # Each line of a buffer takes a terminator byte.
        self._take_up(command, MOST_LINES - 1 if command.kind is CommandKind.BUFFER else LONGEST_COMMAND)
        text = command.text.encode("ascii")
        if command.kind is CommandKind.BUFFER:
            self._out += packet(WRITEBUFFER, text.replace(b"\n", b"\0") + b"\0")
            self._wait_for_answer(self._lines_taken, now)
            return
        self._out += packet(GETRESPONSE, text)
        if command.kind is CommandKind.BLIND:
            self._wait_for_silence(now)
            return
        self._reader, self._in_packet = ResponseParser(text, False), 0
        self._wait_for_answer(self._answer, now)

    def reset(self, now: float, control: int | None = None) -> None:
        """As ``CommandProtocol``."""
        self._forget()
        if control is not None:
            self._out += packet(CTRL_RESPONSE, value=control, length=MOST_ANSWER)
        self._out += packet(FLUSH)
        self._wait_for_silence(now)

    def lines_at_once(self, lines: Sequence[str]) -> int:
        """As many lines as fit into one WRITEBUFFER."""
        room, count = MOST_LINES, 0
        for line in lines:
            room -= len(line) + 1
            if room < 0:
                break
            count += 1
        return count

    def _answer(self, byte: int, now: float) -> None:
        self._in_packet += 1
        event = self._reader.take(byte)
        self._events += self._reader.taken_messages()
        if event is not None:
            self._end(event)
            return
        if self._in_packet == MOST_ANSWER:
            self._in_packet = 0
            self._out += packet(GETBUFFER, length=MOST_ANSWER)
        self._wait_for_answer(self._answer, now)

    def _take_text(self, data: bytes, now: float) -> int:
        """As in ``ByteProtocol``; not the last byte of a full packet, after which more is asked for."""
        room = MOST_ANSWER - self._in_packet - 1
        taken = self._reader.take_text(data[:room]) if self._step == self._answer else 0
        if taken:
            self._in_packet += taken
            self._wait_for_answer(self._answer, now)
        return taken

    def _lines_taken(self, byte: int, now: float) -> None:
        """Four bytes: line number, low byte first; error number; 80 if there is an error."""
        self._collected.append(byte)
        if len(self._collected) < 4:
            return
        line, error, fault = struct.unpack("<HBB", self._collected)
        count = self._command.text.count("\n") + 1
        if fault == 0 and error == 0:
            self._end(Answer())
        elif fault == _LINE_FAULT:
            # The available manuals do not state whether the first line is 0 or 1; 1 is assumed.
            self._end(Refusal(error, min(max(line - 1, 0), count - 1)))
        else:
            self._end(Lost(f"{self._collected.hex(' ')} in answer to lines of a program"))
