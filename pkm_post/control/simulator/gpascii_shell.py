# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gpascii shell: the shell of a Power PMAC's computer, in which ``gpascii -2`` may be started.

It reports that it listens, without ACK. A line sent returns as the terminal's echo, followed by the data and ACK CR LF.
An error is the first line of data, ``stdin:LINE:COLUMN: error #20: ILLEGAL CMD: text`` [gpascii].

Input and output: bytes. Only LF ends a line.
"""

from __future__ import annotations

from collections.abc import Sequence

from pkm_post.control.simulator import errors
from pkm_post.control.simulator.controller import Controller
from pkm_post.control.simulator.errors import CommandError
from pkm_post.control.simulator.power_online import GpasciiThread, PowerPmac
from pkm_post.control.simulator.serial_port import SerialPort

PROMPT = b"root@ppmac:/opt/ppmac# "
LISTENS = b"STDIN Open for ASCII Input\r\n"
DONE = b"\x06\r\n"
LONGEST_LINE = 1024

POWER_ERRORS = {
    errors.RUNNING: (38, "PROGRAM RUNNING"),
    errors.DATA: (20, "ILLEGAL CMD"),
    errors.CHARACTER: (20, "ILLEGAL CMD"),
    errors.NOT_OPEN: (20, "ILLEGAL CMD"),
    errors.NO_ROOM: (34, "BUFFER FULL"),
    errors.IN_USE: (33, "BUFFER IN USE"),
    errors.STRUCTURE: (31, "COMPILE ERR"),
    errors.BOTH_LIMITS: (39, "NOT READY TO RUN"),
    errors.MOVING: (39, "NOT READY TO RUN"),
    errors.OPEN_LOOP: (43, "MOTOR NOT CLOSED LOOP"),
    errors.NOT_ACTIVATED: (45, "MOTOR NOT ACTIVE"),
    errors.NO_MOTORS: (42, "NO MOTORS DEFINED"),
    errors.NO_PROGRAM: (22, "PROGRAM NOT IN BUFFER"),
    errors.BAD_PROGRAM: (39, "NOT READY TO RUN"),
    errors.DISPLACED: (46, "COORD JOGGED OUT OF POSITION"),
}
"""Number and text of a Power PMAC for each error of the simulator [PowerPMAC, Error Codes]."""
_COMPILE_ERROR = (31, "invalid data")


class GpasciiShell:
    """One log-in."""

    def __init__(self, machine: PowerPmac) -> None:
        self._thread = GpasciiThread(machine)
        self._line, self._lines = bytearray(), 0
        self._in_gpascii = False

    def greeting(self) -> bytes:
        """The output of the log-in."""
        return b"Power PMAC\r\n" + PROMPT

    def receive(self, data: bytes) -> bytes:
        """Take received bytes; return the echo and the answers of the lines that they complete."""
        said = b""
        for code in data:
            if code == 0x0A:
                line, self._line = bytes(self._line), bytearray()
                said += line + b"\r\n" + self._answer(line.decode("ascii", "replace").strip("\r"))
            elif len(self._line) < LONGEST_LINE:
                self._line.append(code)
        return said

    def end(self) -> None:
        """The log-in ends."""
        self._thread.end()

    def _answer(self, line: str) -> bytes:
        if not self._in_gpascii:
            self._in_gpascii = line.split() == ["gpascii", "-2"]
            return LISTENS if self._in_gpascii else b"sh: not found\r\n" + PROMPT
        self._lines += 1
        try:
            lines = self._thread.execute(line)
        except CommandError as error:
            lines = [self._error(error.number, line), *self._thread.answered]
        return "".join(f"{text}\r\n" for text in lines).encode("ascii") + DONE

    def _error(self, number: int, line: str) -> str:
        in_buffer = self._thread.has_open_buffer and number == errors.DATA
        number, words = _COMPILE_ERROR if in_buffer else POWER_ERRORS[number]
        return f"stdin:{self._lines}:1: error #{number}: {words}: {line}"


def refused_line(machine: Controller | PowerPmac, lines: Sequence[str]) -> tuple[int, str] | None:
    """Execute lines until one is refused; return its index and the reason, or None.

    Args:
        machine: a Turbo PMAC or a Power PMAC.
        lines: of a set-up file.
    """
    execute = GpasciiThread(machine).execute if isinstance(machine, PowerPmac) else SerialPort(machine).carry_out
    for place, line in enumerate(lines):
        try:
            execute(line)
        except CommandError as error:
            if not isinstance(machine, PowerPmac):
                return place, f"ERR{error.number:03d}, {errors.ERROR_TEXTS[error.number]}"
            number, words = POWER_ERRORS[error.number]
            return place, f"error #{number}, {words}"
    return None
