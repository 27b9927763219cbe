# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpreter: executes the statements of a coordinate system's program up to the next move.

Input: a program, variables, the end position of the moves so far. Output: the next move. Codes G, M, T and D call
programs 1000 to 1003 at the label of their number [TurboPMAC, motion programs]; S writes its value to Q127.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from pkm_post.control.simulator.errors import CommandError
from pkm_post.control.simulator.expressions import Expression
from pkm_post.control.simulator.memory import Memory, ProgramCounter, ProgramError
from pkm_post.control.simulator.modal_state import Axes, ModalState
from pkm_post.control.simulator.moves import Dwell, Move, Pending
from pkm_post.control.simulator.programs import Statement
from pkm_post.control.simulator.variables import SystemScope

STATEMENTS_AT_ONCE = 1000
"""Most statements without a move before the rest of the controller gets its turn."""
CODE_PROGRAMS = {"G": 1000, "M": 1001, "T": 1002, "D": 1003}
SPEED_OF_S_CODE = 127

PortOutput = Callable[[str, str], None]


class Interpreter:
    """The program state of a coordinate system.

    Attributes:
        modes: the modal state of its moves.
        finished: whether the program has reached its end.
        halted: whether it has reached a STOP.
    """

    def __init__(self, number: int, memory: Memory, scope: SystemScope, axes: Axes, outside: PortOutput) -> None:
        self._scope, self._outside = scope, outside
        self.modes = ModalState(scope, axes)
        self.counter = ProgramCounter(number, memory)
        self._pending: list[Pending] = []
        self.finished = self.halted = self.in_block = False

    def point(self, program: int | None, label: int = 0) -> None:
        """Point to a label of a program; label 0 is its beginning."""
        self.counter.point(program, label)
        self.finished = self.halted = self.in_block = False
        self._pending = []

    def ended(self) -> bool:
        """Whether nothing follows: the program is at its end or at a STOP."""
        return self.finished or self.halted

    def taken_pending(self) -> list[Pending]:
        """The synchronous assignments ahead of the last computed move."""
        pending, self._pending = self._pending, []
        return pending

    def next(self, after: Move | None, now: float) -> Move | None:
        """Execute statements up to the next move.

        Args:
            after: the previous move, which may still run.
            now: program time, ms.

        Returns:
            The move; None at the end, at a STOP, when a rotary buffer is empty, or after too many statements without a
            move.

        Raises:
            ProgramError: the program cannot continue.
        """
        try:
            for _ in range(STATEMENTS_AT_ONCE):
                statement = self.counter.fetch()
                if statement is None:
                    return None
                move = self._carry_out(statement, after, now)
                if move is not None or self.ended():
                    return move
        except CommandError as error:
            raise ProgramError from error
        return None

    def _carry_out(self, statement: Statement, after: Move | None, now: float) -> Move | None:
        kind, arguments = statement.kind, statement.arguments
        if kind == "move":
            return self.modes.move(arguments[0], after, now)
        if kind in ("DWELL", "DELAY"):
            return self._rest(self._value(arguments[0]), after, now, kind == "DWELL")
        if kind in CODE_PROGRAMS:
            self._code(kind, self._value(arguments[0]))
        elif kind in _FLOW:
            _FLOW[kind](self, arguments)
        else:
            self.modes.change(kind, arguments)
        return None

    def _rest(self, duration: float, after: Move | None, now: float, fixed: bool) -> Dwell:
        start = max(after.end, now) if after else now
        self.modes.rest()
        return Dwell(start, start + max(duration, 0.0), self.modes.target, fixed)

    def _value(self, expression: Expression) -> float:
        return expression.value(self._scope)

    def _code(self, letter: str, value: float) -> None:
        # M123.4 is label 23400 of program 1011: the hundreds select the program.
        hundreds = int(value // 100)
        self.counter.call(CODE_PROGRAMS[letter] + 10 * hundreds, round((value - 100 * hundreds) * 1000))

    def _goto(self, arguments: tuple[Any, ...]) -> None:
        self.counter.go_to(round(self._value(arguments[0])))

    def _gosub(self, arguments: tuple[Any, ...]) -> None:
        self.counter.call(self.counter.place[0], round(self._value(arguments[0])))

    def _call_program(self, arguments: tuple[Any, ...]) -> None:
        fraction, number = math.modf(self._value(arguments[0]))
        self.counter.call(int(number), round(fraction * 100_000))

    def _return(self, arguments: tuple[Any, ...]) -> None:
        if not self.counter.return_from_call():
            self.point(self.counter.pointer)
            self.finished = True

    def _stop(self, arguments: tuple[Any, ...]) -> None:
        self.halted = True

    def _branch(self, arguments: tuple[Any, ...]) -> None:
        if not self._value(arguments[0]):
            self.counter.jump()

    def _jump(self, arguments: tuple[Any, ...]) -> None:
        self.counter.jump()

    def _assign(self, arguments: tuple[Any, ...]) -> None:
        letter, number, _, value = arguments
        self._scope.write(letter, int(self._value(number)), self._value(value))

    def _synchronous(self, arguments: tuple[Any, ...]) -> None:
        """Compute the value now and write it when the next move begins."""
        letter, number, sign, expression = arguments
        index, value = int(self._value(number)), self._value(expression)
        self._scope.read(letter, index)
        operation = _BITWISE.get(sign)

        def write() -> None:
            old = self._scope.read(letter, index)
            self._scope.write(letter, index, operation(int(old), int(value)) if operation else value)

        self._pending.append(write)

    def _speed(self, arguments: tuple[Any, ...]) -> None:
        self._scope.write("Q", SPEED_OF_S_CODE, self._value(arguments[0]))

    def _send(self, arguments: tuple[Any, ...]) -> None:
        self._outside("SEND", arguments[0])

    def _command(self, arguments: tuple[Any, ...]) -> None:
        self._outside("COMMAND", arguments[0])

    def _block(self, inside: bool) -> None:
        self.in_block = inside


_BITWISE: dict[str, Callable[[int, int], float]] = {
    "&=": lambda old, new: float(np.bitwise_and(old, new)),
    "|=": lambda old, new: float(np.bitwise_or(old, new)),
    "^=": lambda old, new: float(np.bitwise_xor(old, new)),
}

_FLOW: dict[str, Callable[[Interpreter, tuple[Any, ...]], None]] = {
    "N": lambda interpreter, arguments: None,
    "ENDIF": lambda interpreter, arguments: None,
    "GOTO": Interpreter._goto,
    "GOSUB": Interpreter._gosub,
    "CALL": Interpreter._call_program,
    "RETURN": Interpreter._return,
    "STOP": Interpreter._stop,
    "IF": Interpreter._branch,
    "WHILE": Interpreter._branch,
    "ELSE": Interpreter._jump,
    "ENDWHILE": Interpreter._jump,
    "assign": Interpreter._assign,
    "synchronous": Interpreter._synchronous,
    "S": Interpreter._speed,
    "SEND": Interpreter._send,
    "COMMAND": Interpreter._command,
    "BLOCKSTART": lambda interpreter, arguments: interpreter._block(True),
    "BLOCKSTOP": lambda interpreter, arguments: interpreter._block(False),
}
