# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gpascii protocol: commands to a Power PMAC, in the shell of its ssh server.

The shell starts ``gpascii -2``, which reports ``STDIN Open for ASCII Input`` when it is ready; clients disagree whether
ACK follows, so the wait for it ends with the silence. ``echo 7`` reduces its answers to values. From then on each line
sent, terminated by one LF, returns as

    answer   = { CR | LF | ACK } command CR LF { data CR LF } ACK CR LF
    refusal  = the same with ``stdin:LINE:COLUMN: error #NUMBER: MEANING: text`` among the data

The terminal's echo of the command proves that the answer belongs to it. Remains of the previous answer, such as a late
CR LF, precede it and are skipped. Not every firmware is known to send ACK after a refusal: the wait for it ends with
the silence. [gpascii]

ssh neither loses nor corrupts data, so there are no checksums; invalid data ends with ``Lost``, and the caller
reconnects.

Input: commands, bytes and times. Output: bytes and events.
"""

from __future__ import annotations

import re

from pkm_post.control.link.protocol import Answer, ByteProtocol, CommandKind, ControllerCommand, Lost, Refusal

START, LISTENS, VALUES_ALONE = "gpascii -2", b"STDIN Open for ASCII Input", "echo 7"
START_S = 10.0
"""Seconds without a byte after which the shell is not that of a controller."""
LONGEST_LINE = 255
"""Characters of a command; longer ones are not documented to work."""
ERROR_TEXTS = {
    20: "illegal command",
    21: "wrong parameter",
    22: "the program is not in the buffer",
    23: "a number is out of range",
    31: "invalid data",
    33: "the buffer is in use",
    34: "the buffer is full",
    38: "a program runs",
    39: "not ready to run",
    42: "the coordinate system has no motors",
    43: "a motor is not in closed loop",
    45: "a motor is not active",
    46: "motors are not where the program was stopped",
}
"""Error numbers of a Power PMAC."""

_ACK, _LF = 0x06, 0x0A
_ERROR = re.compile(r"\w+:\d+:\d+: error #(\d+): *(.*)")


class GpasciiProtocol(ByteProtocol):
    """A protocol with gpascii, which needs no handshake: starting it is enough."""

    handshake = ""

    def __init__(self, silence: float = 0.5) -> None:
        super().__init__(silence)
        self._lines: list[str] = []
        self._refusal: Refusal | None = None

    def begin(self, command: ControllerCommand, now: float) -> None:
        """As ``CommandProtocol``."""
        if "\n" in command.text:
            raise ValueError(f"command: expected one line, got {command.text[:40]!r}")
        self._take_up(command, LONGEST_LINE)
        self._send(now)

    def reset(self, now: float, control: int | None = None) -> None:
        """Start gpascii in a new shell.

        Raises:
            ValueError: a control character was given; gpascii accepts none.
        """
        if control is not None:
            raise ValueError(f"control: expected none over gpascii, got {control}")
        self._begin_with(ControllerCommand(START, CommandKind.SET, START_S))
        self._out += f"{START}\n".encode("ascii")
        self._wait_for_answer(self._greeted, now)

    def _greeted(self, byte: int, now: float) -> None:
        """Ignore what the shell prints before gpascii is ready."""
        self._collected.append(byte)
        self.deadline = now + self._command.answer_timeout
        if self._collected.endswith(LISTENS):
            self._wait(self._listening, self._ready, now + self._silence)

    def _listening(self, byte: int, now: float) -> None:
        self.deadline = now + self._silence
        if byte == _ACK:
            self._ready(now)

    def _ready(self, now: float) -> None:
        self._begin_with(ControllerCommand(VALUES_ALONE, CommandKind.SET, START_S))
        self._send(now)

    def _send(self, now: float) -> None:
        self._lines, self._refusal = [], None
        self._collected.clear()
        self._out += f"{self._command.text}\n".encode("ascii")
        self._wait_for_answer(self._echoed, now)

    def _echoed(self, byte: int, now: float) -> None:
        self._wait_for_answer(self._echoed, now)
        line = self._line_with(byte)
        if line is None:
            return
        if line == self._command.text:
            self._wait_for_answer(self._answered, now)
        elif line:
            self._end(Lost(f"{line[:60]!r} in place of the echo of {self._command.text[:60]!r}"))

    def _answered(self, byte: int, now: float) -> None:
        if self._refusal is None:
            self._wait_for_answer(self._answered, now)
        else:
            self.deadline = now + self._silence
        if byte == _ACK:
            self._acknowledged(now)
            return
        line = self._line_with(byte)
        if line is None:
            return
        found = _ERROR.match(line)
        if found:
            number = int(found[1])
            self._refusal = Refusal(number, words=f"error #{number}, {ERROR_TEXTS.get(number, found[2])}: {line}")
            self._wait(self._answered, self._acknowledged, now + self._silence)
        elif line:
            self._lines.append(line)

    def _acknowledged(self, now: float) -> None:
        if self._collected.strip():
            self._end(Lost(f"ACK within a line: {self._collected[:60].decode('latin-1')!r}"))
            return
        self._end(self._refusal or Answer(tuple(self._lines)))

    def _line_with(self, byte: int) -> str | None:
        """The line that a byte completes, without remains of the previous answer in front of it."""
        if byte != _LF:
            self._collected.append(byte)
            return None
        line = self._collected.decode("latin-1").strip("\r\x06")
        self._collected.clear()
        return line
