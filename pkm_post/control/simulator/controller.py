# SPDX-License-Identifier: LGPL-2.1-or-later
"""Controller: a Turbo PMAC with six motors, whose time is advanced by its owner.

Input: commands through ports, and milliseconds. Output: motor positions in counts, and the output of ports. It reads
no clock: the same commands at the same times give the same positions.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from pkm_post.control.simulator.coordinate_system import CoordinateSystem
from pkm_post.control.simulator.errors import CommandError
from pkm_post.control.simulator.machine_state import PortSession
from pkm_post.control.simulator.memory import Memory
from pkm_post.control.simulator.motors import NO_COMMAND, Motors
from pkm_post.control.simulator.online import execute
from pkm_post.control.simulator.variables import SIMULATED_MOTORS, SYSTEMS, WORDS, Array, FloatFormat, Inputs, Variables

_M_CODE_STATEMENTS = {
    0: "STOP", 1: "STOP", 3: "P7001=1", 4: "P7001=-1", 5: "P7001=0", 7: "P7002=2", 8: "P7002=1", 9: "P7002=0",
}  # fmt: skip
_M_CODES = (*range(10), 30)
_TOOLS = 100

MACHINE_CODES: tuple[str, ...] = (
    "CLOSE",
    "OPEN PROG 1001 CLEAR",
    *(f"N{1000 * code} {_M_CODE_STATEMENTS.get(code, '')} RETURN" for code in _M_CODES),
    "CLOSE",
    "OPEN PROG 1002 CLEAR",
    *(f"N{1000 * tool}" for tool in range(_TOOLS)),
    "CLOSE",
)
"""Programs for M and T codes, for a machine without hardware: M3, M4 and M5 write 1, -1 and 0 to P7001, M8, M7 and
M9 write 1, 2 and 0 to P7002; M0 and M1 stop until R; T accepts any tool from 0 to 99, and M6 changes it instantly."""


def function_programs(numbers: Iterable[int]) -> list[str]:
    """Lines that add programs for M codes of a machine, such as 21: they write their number to P7004.

    Args:
        numbers: of codes without a program.
    """
    lines = []
    for number in sorted(set(numbers)):
        hundreds, rest = divmod(number, 100)
        label = f"N{1000 * rest} P7004={number} RETURN"
        lines += ["CLOSE", f"OPEN PROG {1001 + 10 * hundreds}", label, "CLOSE"]
    return lines


LEAST_MEMORY = 1000
"""words: room for the machine codes."""


@dataclass(frozen=True, kw_only=True)
class SimulatorSettings:
    """A controller and its motors.

    Attributes:
        memory_words: program memory, in 48-bit words.
        line_limit: longest line, in characters.
        tick_ms: period of the position update.
        lag_ms: time constant of the servo loops: at constant speed the following error is the speed times this.
        home_flag: position of the home flags after a reset, counts from the motors' positions.
        firmware: answer to VER.
        card: answer to TYPE.
        identity: answer to CID.
        password: protects programs from 1000 on; empty for none.
        machine_codes: lines loaded at a reset: the programs for G, M, T and D codes.
    """

    memory_words: int = 237_568
    line_limit: int = 255
    tick_ms: float = 1.0
    lag_ms: float = 0.5
    home_flag: float = 5000.0
    firmware: str = "1.947"
    card: str = "TURBO2, X4"
    identity: str = "602413"
    password: str = ""
    machine_codes: tuple[str, ...] = MACHINE_CODES
    numbers: FloatFormat = WORDS

    def __post_init__(self) -> None:
        if self.memory_words < LEAST_MEMORY:
            raise ValueError(f"memory_words: expected {LEAST_MEMORY} or more, got {self.memory_words}")
        if not (self.tick_ms > 0 and self.lag_ms > 0):
            raise ValueError(f"expected times above zero, got tick_ms {self.tick_ms}, lag_ms {self.lag_ms}")


Listener = Callable[[str | CommandError], None]


class Controller:
    """The state of a controller.

    Attributes:
        time: ms since creation.
        variables: I, P, Q and M.
        motors: the six simulated motors.
        systems: coordinate systems, from 1.
        unlocked: whether the password was entered.
        listeners: ports that receive the output of programs.
        inputs: of the machine, by number of their M-variable.
    """

    def __init__(self, settings: SimulatorSettings | None = None) -> None:
        self.settings = settings or SimulatorSettings()
        self.time, self._owed_ms = 0.0, 0.0
        self.listeners: list[Listener] = []
        self.inputs = Inputs()
        self.initialize()

    def initialize(self) -> None:
        """Reset to factory defaults: ``$$$***``."""
        self._start(Variables(self.settings.numbers), Memory(self.settings.memory_words))
        self.unlocked = True
        self.load(self.settings.machine_codes)
        self.unlocked = False
        self.save()

    def save(self) -> None:
        """Save variables, programs and axis definitions for the next reset: ``SAVE``."""
        definitions = [dict(system.axes.definitions) for system in self.systems]
        self._kept = copy.deepcopy((self.variables, self.memory.programs, definitions))

    def reset(self) -> None:
        """Reset to the saved state: ``$$$``. Motors lose their positions, and rotary buffers are deleted."""
        variables, programs, definitions = copy.deepcopy(self._kept)
        memory = Memory(self.settings.memory_words)
        memory.programs = programs
        self._start(variables, memory)
        for system, kept in zip(self.systems, definitions, strict=True):
            system.axes.definitions = kept

    def load(self, lines: list[str] | tuple[str, ...]) -> None:
        """Execute lines as if received by a port.

        Raises:
            CommandError: a line is refused; those before it were executed.
        """
        session = PortSession(self)
        for line in lines:
            execute(session, line)

    def advance(self, ms: float) -> None:
        """Advance time in whole ticks; the remainder is kept for the next call."""
        tick = self.settings.tick_ms
        self._owed_ms += ms
        count = math.floor(self._owed_ms / tick + 1e-9)
        self._owed_ms -= count * tick
        while count > 0:
            before = self.motors.commanded, self.motors.actual
            self._tick(tick)
            count -= 1
            if count and self._rests(*before):
                self._stand(tick, count)
                return

    def system_of(self, motor: int) -> CoordinateSystem | None:
        """The coordinate system of a motor."""
        return next((system for system in self.systems if motor in system.axes.definitions), None)

    def runs_program(self) -> bool:
        """Whether a program runs in any coordinate system."""
        return any(system.running for system in self.systems)

    def rotary_full(self, system: int) -> bool:
        """Whether a rotary buffer requests no more lines: from I17 lines ahead until fewer than I16 are left."""
        self._watch_rotaries()
        return self._full[system - 1]

    def forget_pointers(self) -> None:
        """Clear all program pointers, as on opening a fixed buffer."""
        for system in self.systems:
            system.interpreter.point(None)

    def kill(self, index: int) -> None:
        """Kill a motor and the program of its coordinate system."""
        system = self.system_of(index + 1)
        if system is not None:
            system.forget()
        self.motors.kill(index)

    def kill_all(self) -> None:
        """^K."""
        for index in range(SIMULATED_MOTORS):
            self.kill(index)

    def _start(self, variables: Variables, memory: Memory) -> None:
        self.variables, self.memory, self.unlocked = variables, memory, False
        variables.inputs = self.inputs
        self.motors = Motors(variables, self.settings.lag_ms, self.settings.home_flag)
        self.systems = [
            CoordinateSystem(number, memory, variables, self.motors, self._output_of(number))
            for number in range(1, SYSTEMS + 1)
        ]
        self._full = [False] * SYSTEMS

    def _output_of(self, number: int) -> Callable[[str, str], None]:
        """A callback for text that a program of this coordinate system sends to ports, or executes as a command."""
        return partial(
            self._send_output, PortSession(self, system=number)
        )  # no closure: it is copied along with the controller

    def _send_output(self, session: PortSession, kind: str, text: str) -> None:
        try:
            output: list[str | CommandError] = [text] if kind == "SEND" else [*execute(session, text)]
        except CommandError as error:
            output = [error]
        for item in output:
            for listen in self.listeners:
                listen(item)

    def _tick(self, ms: float) -> None:
        commanded = NO_COMMAND
        for system in self.systems:
            if system.axes.definitions:
                system.advance(ms)
                own = system.commanded()
                commanded = own if commanded is NO_COMMAND else np.where(np.isnan(commanded), own, commanded)
        self.motors.advance(ms, commanded)
        self._guard()
        self._watch_rotaries()
        self.time += ms

    def _rests(self, commanded: Array, actual: Array) -> bool:
        """Whether ticks up to the next command change only the time, given the previous motor positions."""
        moves_none = all(system.rests() for system in self.systems if system.axes.definitions)
        return moves_none and self.motors.rest(commanded, actual)

    def _stand(self, ms: float, count: int) -> None:
        """Advance by ticks in which nothing happens; times are summed tick by tick, for the same bits."""
        for system in self.systems:
            if system.axes.definitions:
                for _ in range(count):
                    system.path.go_on(ms, system.override)
        for _ in range(count):
            self.time += ms

    def _guard(self) -> None:
        """Stop failed motors, and all motors that move with them."""
        if self.motors.are_sound():
            return
        self.motors.fatal |= self.motors.fatal_following_errors()
        tripped = self.motors.closed & (self.motors.fatal | self.motors.amplifier_fault)
        for index in np.flatnonzero(tripped).tolist():
            system = self.system_of(index + 1)
            for other in system.axes.indices() if system is not None else [index]:
                self.kill(other)
        for index in np.flatnonzero(self.motors.beyond_limits() & ~self.motors.stopped_on_limit).tolist():
            system = self.system_of(index + 1)
            if system is not None and system.running:
                system.abort()
            else:
                self.motors.abort(index)
            self.motors.stopped_on_limit[index] = True

    def _watch_rotaries(self) -> None:
        if not self.memory.rotaries:
            return
        fewest, most = self.variables.setting(16), self.variables.setting(17)
        for number, rotary in self.memory.rotaries.items():
            ahead = len(rotary.lines)
            self._full[number - 1] = ahead >= most or (self._full[number - 1] and ahead >= fewest)
