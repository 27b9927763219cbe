# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power on-line commands: a line for a Power PMAC, executed command by command.

Input: a line without its terminator, and its thread. Output: lines of data, or the error that refuses the line;
commands ahead of the faulty one were executed. While a thread has a buffer open, everything except ``close`` goes
into it, or is refused. Answers come as ``name=value`` and, after ``echo 7``, as values [gpascii].
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.control.simulator import online_memory, online_motion
from pkm_post.control.simulator.controller import Controller, SimulatorSettings
from pkm_post.control.simulator.errors import DATA, NO_PROGRAM, RUNNING, CommandError
from pkm_post.control.simulator.expressions import Scanner, expression, variable_number
from pkm_post.control.simulator.machine_state import PortSession
from pkm_post.control.simulator.power_elements import PowerElements
from pkm_post.control.simulator.power_program import BlockReader, listed_line, without_comment
from pkm_post.control.simulator.programs import FixedProgram
from pkm_post.control.simulator.variables import DOUBLES, ELEMENT, MOTORS, SIMULATED_MOTORS, SYSTEMS, SystemScope

HIGHEST_VARIABLE = 8191
"""The P-variables of a Power PMAC go to 65535; this simulator has fewer."""
DEFAULT_WORDS = 1 << 21
"""ProgramBufSize=16777216 of published projects, in words of 8 bytes."""
VALUES_ALONE = 4
"""Bit of ``echo`` that suppresses the names: set in 7, not in 3."""


class PowerPmac:
    """A Power PMAC with six motors.

    Attributes:
        controller: its motors, coordinate systems and buffers.
    """

    def __init__(
        self,
        memory_words: int | None = None,
        form: type[Controller] = Controller,
        motors: SimulatorSettings | None = None,
    ) -> None:
        """Create one, as after a reset.

        Args:
            memory_words: program memory in words of 8 bytes; 16 MiB by default, as in projects.
            form: class of the controller, for instance one that records.
            motors: settings of its motors and of the period; other settings are ignored.
        """
        words = DEFAULT_WORDS if memory_words is None else memory_words
        settings = replace(
            motors or SimulatorSettings(), numbers=DOUBLES, memory_words=words, identity="604020", firmware="2.8.3.0"
        )
        self.controller = form(settings)
        self.elements = PowerElements(self.controller)
        self.controller.inputs.element = self.elements.read


@dataclass(eq=False)
class GpasciiThread:
    """The sender of commands: one gpascii.

    Attributes:
        machine: the controller.
        session: the motor and coordinate system that it addresses.
        echo: format of its answers.
        reader: reader of its open program.
        answered: lines of data of the last line, also of the commands ahead of one that is refused.
    """

    machine: PowerPmac
    echo: int = 0
    reader: BlockReader = field(default_factory=BlockReader)
    answered: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.session = PortSession(self.machine.controller)

    @property
    def has_open_buffer(self) -> bool:
        """Whether its lines go into a program."""
        return self.machine.controller.memory.is_open_by(self.session)

    def execute(self, line: str) -> list[str]:
        """Execute a line.

        Raises:
            CommandError: one of its commands is refused.
        """
        text, self.answered = without_comment(line), []
        if self.has_open_buffer and not re.fullmatch(r"close(?: *all)?;?", text, re.IGNORECASE):
            self._add(text)
            return []
        scanner = Scanner(text, DOUBLES)
        while not scanner.at_end():
            self.answered += self._one(scanner)
        return self.answered

    def end(self) -> None:
        """End the thread and close its open buffer."""
        try:
            self._close()
        except CommandError:
            return  # a program with unmatched braces is kept but does not run

    def _one(self, scanner: Scanner) -> list[str]:
        for pattern, act in COMMANDS:
            if match := scanner.take(pattern):
                return act(self, match, scanner)
        raise CommandError(DATA)

    def _add(self, text: str) -> None:
        memory = self.machine.controller.memory
        memory.append(self.reader.statements(text), self.session.system)
        assert memory.opened is not None and memory.opened.program is not None
        if text:
            memory.programs[memory.opened.program].source.append(listed_line(text))

    def _close(self) -> None:
        reader, self.reader = self.reader, BlockReader()
        if self.has_open_buffer:
            self.machine.controller.memory.close(self.session)
            reader.finish()

    def named(self, name: str, value: str) -> list[str]:
        """An answer in the format of ``echo``."""
        return [value if self.echo & VALUES_ALONE else f"{name}={value}"]


Act = Callable[[GpasciiThread, re.Match[str], Scanner], list[str]]


def _echo(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    thread.echo = int(match["number"])
    return []


def _address(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    number = int(match["number"])
    if not 1 <= number <= (MOTORS if match["sign"] == "#" else SYSTEMS):
        raise CommandError(DATA)
    setattr(thread.session, "motor" if match["sign"] == "#" else "system", number)
    return []


def _axis(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``#n->`` reports an axis definition in small letters, the coordinate system in front; ``#n->10000X`` sets one."""
    controller, session, motor = thread.machine.controller, thread.session, int(match["number"])
    if not 1 <= motor <= MOTORS:
        raise CommandError(DATA)
    if not scanner.at_end():
        return online_memory.define_axis(session, motor, scanner)
    if (system := controller.system_of(motor)) is None:
        return [f"#{motor}->0"]
    return [f"&{system.number}#{motor}->{system.axes.definitions[motor].text(DOUBLES).lower()}"]


def _element(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    name, elements = match["element"], thread.machine.elements
    if scanner.take(r"=(?!=)"):
        scope = SystemScope(thread.machine.controller.variables, thread.session.system)
        elements.write(name, expression(scanner).value(scope))
        return []
    return thread.named(name, DOUBLES.printed(elements.read(name)))


def _time_base(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    """The source of the time base has the name of its element [PowerPMACProjects]; the address is made up."""
    number, sources = int(match["number"]), thread.machine.elements.time_bases
    if not 1 <= number <= SYSTEMS:
        raise CommandError(DATA)
    if match["own"]:
        return thread.named(match[0], f"${0x10000 + 0x1000 * number:x}")
    if found := scanner.take(r"= *(?P<source>[\w.\[\]]+)"):
        sources[number] = found["source"]
        return []
    return thread.named(match[0], sources.get(number, f"Coord[{number}].DesTimeBase.a"))


def _variable(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``P1`` reports, ``P1=2`` sets; ``P1..3`` and ``P1..3=0`` do so for a range."""
    letter = match["letter"].upper()
    scope = SystemScope(thread.machine.controller.variables, thread.session.system)
    first = int(variable_number(scanner).value(scope))
    last = int(scanner.expect(r"(?P<last>[0-9]{1,5})")["last"]) if scanner.take(r"\.\.") else first
    if not 0 <= first <= last <= HIGHEST_VARIABLE:
        raise CommandError(DATA)
    if scanner.take(r"=(?!=)"):
        return online_memory.assign(scope, letter, range(first, last + 1), scanner)
    values = [(number, DOUBLES.printed(scope.read(letter, number))) for number in range(first, last + 1)]
    return [line for number, value in values for line in thread.named(f"{letter}{number}", value)]


def _open(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``open prog`` erases; a program that runs or is suspended cannot be opened [PowerPMAC, Program Buffers]."""
    controller, number = thread.machine.controller, int(match["number"])
    if any(system.running and system.interpreter.counter.pointer == number for system in controller.systems):
        raise CommandError(RUNNING)
    controller.memory.open_program(number, thread.session)
    controller.memory.programs[number] = FixedProgram()
    thread.reader = BlockReader()
    return []


def _close(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    thread._close()
    return []


def _list(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    program = thread.machine.controller.memory.programs.get(int(match["number"]))
    if program is None:
        raise CommandError(NO_PROGRAM)
    return list(program.source)


def _buffer(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``buffer`` names each program with its place and size [dls_powerpmacanalyse]."""
    lines, place = [], 0
    for number, program in thread.machine.controller.memory.programs.items():
        size = 8 * program.words
        lines.append(f"Prog{number}. Offset {place}, Size {size}")
        place += size
    return lines


def _identity(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    settings = thread.machine.controller.settings
    return [settings.identity if match["word"].lower() == "cid" else settings.firmware]


def _report(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    motors, motor = thread.machine.controller.motors, thread.session.motor
    if motor > SIMULATED_MOTORS:
        raise CommandError(DATA)
    column = {"P": motors.actual, "V": motors.speed, "F": motors.following_error}[match["what"].upper()]
    return [DOUBLES.printed(float(np.round(column[motor - 1], 6)) + 0.0)]


def _motor_bits(thread: GpasciiThread) -> dict[int, object]:
    motors, index = thread.machine.controller.motors, thread.session.motor - 1
    if index >= SIMULATED_MOTORS:
        raise CommandError(DATA)
    high, low = motors.at_limits()
    jog = motors.jogs[index]
    return {
        62: jog is not None and jog.homing, 61: motors.low_switch[index], 60: motors.high_switch[index],
        59: motors.following_error_warnings()[index], 58: motors.fatal[index], 57: motors.stopped_on_limit[index],
        56: motors.amplifier_fault[index], 55: low[index], 54: high[index], 47: motors.homed[index],
        46: motors.speed[index] == 0, 45: motors.closed[index], 44: motors.enabled[index],
        43: motors.in_position()[index],
    }  # fmt: skip


def _system_bits(thread: GpasciiThread) -> dict[int, object]:
    controller = thread.machine.controller
    motors, indices = controller.motors, controller.systems[thread.session.system - 1].axes.indices()
    return {
        61: motors.low_switch[indices].any(), 60: motors.high_switch[indices].any(),
        59: motors.following_error_warnings()[indices].any(), 58: motors.fatal[indices].any(),
        56: motors.amplifier_fault[indices].any(),
    }  # fmt: skip


def _hexadecimal(bits: Mapping[int, object]) -> str:
    """64 bits as 16 digits; positions as in the EPICS driver [EPICSpmac, pmacHardwarePower]."""
    return f"${sum(1 << bit for bit, is_set in bits.items() if is_set):016X}"


def _status(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    _address(thread, match, scanner)
    return [_hexadecimal((_motor_bits if match["sign"] == "#" else _system_bits)(thread))]


def _whole(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    thread.machine.controller.save()
    return []


def _kill_all(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    thread.machine.controller.kill_all()
    return []


def _begin_and_run(thread: GpasciiThread, match: re.Match[str], scanner: Scanner) -> list[str]:
    online_motion.point(thread.session, match, scanner)
    online_motion.run(thread.machine.controller, thread.session.system, step=False)
    return []


def _as_turbo(act: Callable[[PortSession, re.Match[str], Scanner], list[str]]) -> Act:
    return lambda thread, match, scanner: act(thread.session, match, scanner)


_ALONE = r"(?![-+A-Z0-9.$(:\[])"
_PROGRAM = r":? *(?P<number>[0-9]{1,5})(?:\.(?P<fraction>[0-9]*))?"

COMMANDS: tuple[tuple[str, Act], ...] = (
    (r"(?P<letter>[PQM])(?=[0-9(])", _variable),  # first, as nearly all commands assign or report variables
    (r"echo *(?P<number>[0-9])", _echo),
    (r"#(?P<number>[0-9]{1,3}) *->", _axis),
    (rf"#\* *(?:kill|k){_ALONE}", _kill_all),
    (r"(?P<sign>[#&])(?P<number>[0-9]{1,3})\?", _status),
    (r"(?P<sign>[#&])(?P<number>[0-9]{1,3})", _address),
    (r"Coord\[(?P<number>[0-9]{1,3})\]\.(?:pDesTimeBase|(?P<own>DesTimeBase\.a))", _time_base),
    (ELEMENT, _element),
    (r"open *prog *(?P<number>[0-9]{1,5})", _open),
    (rf"close{_ALONE}", _close),
    (r"list *prog *(?P<number>[0-9]{1,5})", _list),
    (rf"buffer{_ALONE}", _buffer),
    (rf"(?P<word>cid|vers){_ALONE}", _identity),
    (rf"save{_ALONE}", _whole),
    (rf"(?:begin|b){_PROGRAM}", _as_turbo(online_motion.point)),
    (rf"start{_PROGRAM}", _begin_and_run),
    (rf"(?P<letter>r)(?:un)?{_ALONE}", _as_turbo(online_motion.run_or_step)),
    (rf"(?P<letter>s)(?:tep)?{_ALONE}", _as_turbo(online_motion.run_or_step)),
    (rf"(?:hold|h){_ALONE}", _as_turbo(online_motion.hold)),
    (rf"(?:pause|q){_ALONE}", _as_turbo(online_motion.quit_program)),
    (rf"(?:abort|a){_ALONE}", _as_turbo(online_motion.abort)),
    (rf"enable{_ALONE}", _as_turbo(online_motion.enable)),
    (r"%(?P<percent>[0-9]{1,3}(?:\.[0-9]*)?)?", _as_turbo(online_motion.override)),
    (r"(?:jog|j)(?P<how>[-+/=:^])", _as_turbo(online_motion.jog)),
    (rf"(?:home|hm)(?P<here>z)?{_ALONE}", _as_turbo(online_motion.home)),
    (rf"(?:kill|k){_ALONE}", _as_turbo(online_motion.kill)),
    (rf"(?P<what>[pvf]){_ALONE}", _report),
)
"""Command patterns and their handlers; the first match wins [PowerPMAC, Command Syntax Summary]."""
