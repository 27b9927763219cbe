# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ethernet: packets of the Turbo PMAC's Ethernet protocol to commands, and answers to bytes.

Input and output: bytes of a TCP stream, in pieces of any size. A packet has a header of eight bytes (type, request,
value, index, length; words in big-endian order), followed, on the way to the controller, by as many bytes of data as
the header states [UMACEthernet]. Unknown or invalid requests are ignored.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

from pkm_post.control.simulator.errors import CHARACTER
from pkm_post.control.simulator.serial_port import ACK, CR, LF, SerialPort

DOWNLOAD, UPLOAD = 0x40, 0xC0
HEAD = struct.Struct(">BBHHH")
LONGEST_DATA = 1492
LONGEST_ANSWER = 1400
DONE, NOTHING = b"\x40", b"\x00"
FAILED = 0x80


class EthernetPort:
    """One connection to the Ethernet port; all connections share the port behind it."""

    def __init__(self, line: SerialPort) -> None:
        self.line = line
        self._received = bytearray()
        self._waiting = bytearray()

    def receive(self, data: bytes) -> bytes:
        """Take received bytes; return the answers to the packets that they complete."""
        self._received += data
        answer = b""
        while (packet := self._packet()) is not None:
            answer += packet
        return answer

    def _packet(self) -> bytes | None:
        """Answer the first packet; None if it is incomplete."""
        if len(self._received) < HEAD.size:
            return None
        kind, request, value, _, length = HEAD.unpack_from(self._received)
        if kind not in (DOWNLOAD, UPLOAD) or (kind == DOWNLOAD and length > LONGEST_DATA):
            self._received.clear()  # not a packet: the start of the next one is unknown
            return None
        size = HEAD.size + (length if kind == DOWNLOAD else 0)
        if len(self._received) < size:
            return None
        data = bytes(self._received[HEAD.size : size])
        del self._received[:size]
        answer = _REQUESTS.get((kind, request))
        return answer(self, data, value, length) if answer else b""

    def _get_response(self, data: bytes, value: int, length: int) -> bytes:
        self._waiting = bytearray(self._response(data))
        return self._taken(LONGEST_ANSWER)

    def _get_buffer(self, data: bytes, value: int, length: int) -> bytes:
        return self._taken(min(length, LONGEST_ANSWER)) or NOTHING

    def _send_line(self, data: bytes, value: int, length: int) -> bytes:
        self._waiting += self._response(data)
        return DONE

    def _get_line(self, data: bytes, value: int, length: int) -> bytes:
        """Up to and including the first line terminator."""
        ends = [self._waiting.find(end) for end in (CR, ACK, LF)]
        found = [end for end in ends if end >= 0]
        return self._taken(min(length, min(found) + 1) if found else length) or NOTHING

    def _flush(self, data: bytes, value: int, length: int) -> bytes:
        self._waiting.clear()
        return DONE

    def _ready(self, data: bytes, value: int, length: int) -> bytes:
        return bytes([bool(self._waiting), 0])

    def _control(self, data: bytes, value: int, length: int) -> bytes:
        return self.line.control(value & 0xFF)[:LONGEST_ANSWER]

    def _write_buffer(self, data: bytes, value: int, length: int) -> bytes:
        """Lines separated by zero bytes; the answer gives the position of the first refused one, counted from one."""
        for place, text in enumerate(data.rstrip(b"\0").split(b"\0"), start=1):
            number = self.line.refusal(_decoded(text))
            if number:
                return struct.pack("<HBB", place, number, FAILED)
        return bytes(4)

    def _response(self, data: bytes) -> bytes:
        """The answer to a line of text; a carriage return at its end is optional."""
        if not data.isascii():
            return self.line.refused(CHARACTER)
        return self.line.command(_decoded(data.rstrip(b"\r\n\0")))

    def _taken(self, length: int) -> bytes:
        answer = bytes(self._waiting[:length])
        del self._waiting[:length]
        return answer


def _decoded(data: bytes) -> str:
    text = data.decode("latin-1")
    if text.isascii() and text.isprintable():
        return text
    return "".join(chr(code) if 0x20 <= code < 0x7F else "\x7f" for code in data)


Answer = Callable[[EthernetPort, bytes, int, int], bytes]

_REQUESTS: dict[tuple[int, int], Answer] = {
    (DOWNLOAD, 0xB0): EthernetPort._send_line,
    (UPLOAD, 0xB1): EthernetPort._get_line,
    (DOWNLOAD, 0xB3): EthernetPort._flush,
    (DOWNLOAD, 0xBF): EthernetPort._get_response,
    (UPLOAD, 0xC2): EthernetPort._ready,
    (UPLOAD, 0xC4): EthernetPort._control,
    (UPLOAD, 0xC5): EthernetPort._get_buffer,
    (DOWNLOAD, 0xC6): EthernetPort._write_buffer,
}
