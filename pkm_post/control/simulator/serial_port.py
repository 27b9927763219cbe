# SPDX-License-Identifier: LGPL-2.1-or-later
"""Serial port: bytes to commands and control characters, and answers to bytes.

Input and output: bytes, in pieces of any size. I3 selects the framing of answers, I4 enables checksums, I6 selects the
error format [TurboPMAC, I3, I4, I6]. Control characters act at once, even inside a line.
"""

from __future__ import annotations

from collections.abc import Callable

from pkm_post.control.simulator.controller import Controller
from pkm_post.control.simulator.errors import CHARACTER, DATA, CommandError
from pkm_post.control.simulator.machine_state import PortSession
from pkm_post.control.simulator.online import execute, global_status, motor_status, system_status
from pkm_post.control.simulator.online_memory import open_rotary
from pkm_post.control.simulator.online_motion import position_text, run
from pkm_post.control.simulator.variables import SIMULATED_MOTORS, SYSTEMS

Control = Callable[[PortSession], list[str] | None]
"""The action of a control character; None if it has no answer."""


def _abort_all(session: PortSession) -> None:
    """End all programs; stop each motor on its own ramp, and close open loops."""
    for system in session.controller.systems:
        system.forget()
    for index in range(SIMULATED_MOTORS):
        session.controller.motors.abort(index)


def _kill_all(session: PortSession) -> None:
    session.controller.kill_all()


def _hold_all(session: PortSession) -> None:
    for system in session.controller.systems:
        system.hold()


def _quit_all(session: PortSession) -> None:
    for system in session.controller.systems:
        system.quit()


def _run_all(session: PortSession) -> None:
    _start_all(session, step=False)


def _step_all(session: PortSession) -> None:
    _start_all(session, step=True)


def _start_all(session: PortSession, step: bool) -> None:
    """Start every coordinate system that has a program; the first refusal is raised at the end."""
    refusals = []
    for system in session.controller.systems:
        if system.axes.definitions and system.interpreter.counter.pointer is not None:
            try:
                run(session.controller, system.number, step)
            except CommandError as error:
                refusals.append(error)
    if refusals:
        raise refusals[0]


def _open_rotary(session: PortSession) -> None:
    open_rotary(session)


def _close_rotary(session: PortSession) -> None:
    opened = session.controller.memory.opened
    if opened is not None and opened.program is None:
        session.controller.memory.close(session)


def _no_plc(session: PortSession) -> None:
    """There are no PLC programs to disable."""


def _bank(session: PortSession) -> range:
    return range(8 * session.bank + 1, 8 * session.bank + 9)


def _of_motors(what: str) -> Control:
    return lambda session: [" ".join(position_text(session.controller, what, motor) for motor in _bank(session))]


def _motor_words(session: PortSession) -> list[str]:
    return [" ".join(motor_status(session.controller, motor) for motor in _bank(session))]


def _system_words(session: PortSession) -> list[str]:
    numbers = [number for number in _bank(session) if number <= SYSTEMS]
    return [" ".join(system_status(session.controller, number) for number in numbers)]


def _global_words(session: PortSession) -> list[str]:
    return [global_status(session.controller)]


def _code(letter: str) -> int:
    return ord(letter) - ord("A") + 1


CONTROLS: dict[int, Control] = {
    _code(letter): act
    for letter, act in {
        "A": _abort_all,
        "B": _motor_words,
        "C": _system_words,
        "D": _no_plc,
        "F": _of_motors("F"),
        "G": _global_words,
        "K": _kill_all,
        "L": _close_rotary,
        "O": _hold_all,
        "P": _of_motors("P"),
        "Q": _quit_all,
        "R": _run_all,
        "S": _step_all,
        "U": _open_rotary,
        "V": _of_motors("V"),
    }.items()
}
"""Actions by character code. The line handles ^H, ^M, ^N and ^X; others do nothing."""


ACK, BEL, CR, LF, MARK = b"\x06", b"\x07", b"\r", b"\n", b"\x02"
BACKSPACE, CHECK, CANCEL = 0x08, 0x0E, 0x18
LAST_CHARACTER = 127


class SerialPort:
    """One port: the line received so far, and the addresses for its commands.

    A controller's port does not detect a disconnect: a buffer stays open, a motor addressed.
    """

    def __init__(self, controller: Controller) -> None:
        self.controller = controller
        self.session = PortSession(controller)
        self._text = bytearray()
        self._error = 0
        self._unsolicited = bytearray()

    def attend(self) -> None:
        """Also receive the output of programs (SEND), for ``receive`` to return."""
        self.controller.listeners.append(self._listen)

    def receive(self, data: bytes) -> bytes:
        """Take received bytes; return the output of programs since the last call, then the answers."""
        answer = self.output()
        for code in data:
            answer += self._take(code)
        return answer + self.output()

    def output(self) -> bytes:
        """The output of programs since the last call."""
        output, self._unsolicited = bytes(self._unsolicited), bytearray()
        return output

    def command(self, text: str) -> bytes:
        """Execute a line and frame its answer."""
        try:
            return self._framed(self.carry_out(text), text)
        except CommandError as error:
            return self.refused(error.number)

    def refusal(self, text: str) -> int:
        """Execute a line without its answer; return the number of its error, or 0."""
        try:
            self.carry_out(text)
        except CommandError as error:
            return error.number
        return 0

    def refused(self, number: int) -> bytes:
        """The framed report of an error."""
        return self._error_text(number, BEL)

    def control(self, code: int) -> bytes:
        """Execute a control character; queries are answered like a line."""
        act = CONTROLS.get(code)
        if act is None:
            return b""
        try:
            lines = act(self.session)
        except CommandError as error:
            return self.refused(error.number)
        return b"" if lines is None else self._framed(lines, "")

    def carry_out(self, text: str) -> list[str]:
        """Execute a line and return the lines of its answer.

        Raises:
            CommandError: it is refused.
        """
        if len(text) > self.controller.settings.line_limit:
            raise CommandError(DATA)
        return execute(self.session, text)

    def _take(self, code: int) -> bytes:
        if code == CR[0]:
            return self._end_of_line()
        if code == BACKSPACE:
            del self._text[-1:]
        elif code == CHECK:
            return bytes([sum(self._text) & 0xFF])
        elif code == CANCEL:
            return self._cancel()
        elif code < 0x20:
            return self.control(code)  # LF has no action
        elif code > LAST_CHARACTER:
            self._error = CHARACTER
        elif len(self._text) >= self.controller.settings.line_limit:
            self._error = self._error or DATA
        else:
            self._text.append(code)
        return b""

    def _end_of_line(self) -> bytes:
        """Execute a line, unless it has a faulty character, whenever I4 reports the error."""
        text, error = self._text.decode("ascii"), self._error
        self._text, self._error = bytearray(), 0
        return self.refused(error) if error else self.command(text)

    def _cancel(self) -> bytes:
        self._text, self._error = bytearray(), 0
        return bytes([CANCEL]) if self.controller.variables.setting(63) else b""

    def _framed(self, lines: list[str], command: str) -> bytes:
        handshake, sums = self.controller.variables.setting(3), self.controller.variables.setting(4)
        answer = bytearray()
        for text in lines:
            data = (LF if handshake in (1, 3) else b"") + text.encode("ascii") + CR
            answer += data + (_sum(data) if sums else b"")
        mark = (b"", LF, ACK, ACK)[handshake]
        return bytes(answer + mark + (_sum(command.encode("ascii")) if sums and mark else b""))

    def _error_text(self, number: int, bell: bytes) -> bytes:
        handshake, form = self.controller.variables.setting(3), self.controller.variables.setting(6)
        if form in (0, 2):
            return bell
        feed = LF if handshake in (1, 3) else b""
        return bell + (CR if form == 3 else b"") + feed + f"ERR{number:03d}".encode("ascii") + CR

    def _listen(self, output: str | CommandError) -> None:
        """Queue unsolicited output: I64 marks it; I6 = 2 suppresses errors of programs."""
        variables = self.controller.variables
        if isinstance(output, CommandError):
            if variables.setting(6) != 2:
                self._unsolicited += self._error_text(output.number, MARK if variables.setting(64) else BEL)
            return
        feed = LF if variables.setting(3) in (1, 3) else b""
        self._unsolicited += (MARK if variables.setting(64) else b"") + feed + output.encode("ascii", "replace") + CR


def _sum(data: bytes) -> bytes:
    return bytes([sum(data) & 0xFF])
