# SPDX-License-Identifier: LGPL-2.1-or-later
"""On-line commands: a line from a port, executed command by command.

Input: a line without its terminator, and its sender. Output: lines of data, or the error that refuses the line;
commands ahead of the faulty one were executed. While a buffer is open, everything that parses as a program statement
goes into it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from pkm_post.control.simulator import online_memory, online_motion
from pkm_post.control.simulator.errors import DATA, NOT_OPEN, RUNNING, CommandError
from pkm_post.control.simulator.expressions import Scanner
from pkm_post.control.simulator.machine_state import Handler, MachineState, PortSession
from pkm_post.control.simulator.moves import PvtMove
from pkm_post.control.simulator.programs import parse_statements
from pkm_post.control.simulator.variables import MOTORS, SIMULATED_MOTORS, SYSTEMS, hexadecimal


def motor_status(controller: MachineState, motor: int) -> str:
    """The answer to ``#n?``: two words."""
    if motor > SIMULATED_MOTORS:
        return hexadecimal(0, 0)
    motors, index = controller.motors, motor - 1
    high, low = motors.at_limits()
    jog = motors.jogs[index]
    system = controller.system_of(motor)
    first = {
        23: motors.activated[index],
        22: low[index] or motors.low_switch[index],
        21: high[index] or motors.high_switch[index],
        19: motors.enabled[index],
        18: not motors.closed[index],
        17: (jog and jog.profile.goal is not None) or (system and system.path.current()),
        13: motors.closed[index] and motors.speed[index] == 0,
        10: jog is not None and jog.homing,
        4: int(controller.variables.of_motor(motor, 6)) & 1,
    }
    second = {
        15: system is not None,
        11: motors.stopped_on_limit[index],
        10: motors.homed[index],
        3: motors.amplifier_fault[index],
        2: motors.fatal[index],
        1: motors.following_error_warnings()[index],
        0: motors.in_position()[index],
    }
    number = (system.number - 1) << 20 if system is not None else 0
    return hexadecimal(_word(first), _word(second) | number)


def system_status(controller: MachineState, number: int) -> str:
    """The answer to ``&n??``: three words."""
    system, motors = controller.systems[number - 1], controller.motors
    indices = system.axes.indices()
    is_executing = system.running and not system.interpreter.finished  # not while its last moves go on [TurboPMAC, ??]
    first = {0: is_executing, 2: system.running and not system.stepping, 4: system.running and not system.stepping}
    second = {
        22: system.runtime_error,
        20: motors.amplifier_fault[indices].any(),
        19: motors.fatal[indices].any(),
        18: motors.following_error_warnings()[indices].any(),
        17: bool(indices) and motors.in_position()[indices].all() and not system.running,
        16: controller.rotary_full(number),
        4: isinstance(system.path.current(), PvtMove),
    }
    third = {1: motors.stopped_on_limit[indices].any()}
    return hexadecimal(_word(first), _word(second), _word(third))


def global_status(controller: MachineState) -> str:
    """The answer to ``???``: two words. Their faults cannot occur in a simulation."""
    return hexadecimal(0, 0)


def _word(bits: Mapping[int, object]) -> int:
    return sum(1 << bit for bit, is_set in bits.items() if is_set)


def execute(session: PortSession, line: str) -> list[str]:
    """Execute a line.

    Raises:
        CommandError: one of its commands is refused.
    """
    scanner, answer = Scanner(line), []
    while not scanner.at_end():
        answer += _one(session, scanner)
    return answer


def _one(session: PortSession, scanner: Scanner) -> list[str]:
    memory = session.controller.memory
    if memory.is_open_by(session):
        for pattern, handler in online_memory.OF_OPEN_BUFFER:
            if match := scanner.take(pattern):
                return handler(session, match, scanner)
        if _went_into_buffer(session, scanner):
            return []
    for pattern, handler in COMMANDS:
        if match := scanner.take(pattern):
            return handler(session, match, scanner)
    raise CommandError(DATA if memory.is_open_by(session) or not _is_statement(scanner.rest()) else NOT_OPEN)


def _went_into_buffer(session: PortSession, scanner: Scanner) -> bool:
    try:
        session.controller.memory.add(scanner.text[scanner.position :], session.system)
    except CommandError as error:
        if error.number != DATA:
            raise
        return False  # not a statement, so it may be an on-line command
    scanner.rest()
    return True


def _is_statement(text: str) -> bool:
    try:
        return bool(parse_statements(text))
    except CommandError:
        return False


def _address_motor(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.motor = _within(match["number"], 1, MOTORS)
    return []


def _address_system(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.system = _within(match["number"], 1, SYSTEMS)
    return []


def _address_bank(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.bank = _within(match["number"], 0, MOTORS // 8 - 1)
    return []


def _within(text: str, least: int, most: int) -> int:
    if not least <= int(text) <= most:
        raise CommandError(DATA)
    return int(text)


def _axis(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``#n->`` reports an axis definition, ``#n->1000X`` sets one [TurboPMAC, axis definition]."""
    controller = session.controller
    motor = session.motor = _within(match["number"], 1, MOTORS)
    if scanner.at_end():
        there = controller.systems[session.system - 1].axes.definitions.get(motor)
        return [there.text() if there else "0"]
    return online_memory.define_axis(session, motor, scanner)


def _undefine(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    if session.controller.runs_program():
        raise CommandError(RUNNING)
    everywhere = match["all"] is not None
    for system in session.controller.systems:
        if everywhere or system.number == session.system:
            system.axes.definitions.clear()
    return []


def _status(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    if match["marks"] == "???":
        return [global_status(session.controller)]
    if match["marks"] == "??":
        return [system_status(session.controller, session.system)]
    return [motor_status(session.controller, session.motor)]


def _identity(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    settings = session.controller.settings
    word = match["word"].upper()
    return [{"TYPE": settings.card, "CID": settings.identity}.get(word, settings.firmware)]


def _whole_controller(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    controller = session.controller
    {"$$$***": controller.initialize, "$$$": controller.reset, "SAVE": controller.save}[match["word"].upper()]()
    return []


def _password(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.controller.unlocked = scanner.rest().strip() == session.controller.settings.password
    return []


def _plc(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """There are no PLC programs to enable or disable."""
    return []


COMMANDS: tuple[tuple[str, Handler], ...] = (
    online_memory.VARIABLE,  # first, as nearly all commands assign or report variables
    (r"#(?P<number>[0-9]{1,3})->", _axis),
    (r"##(?P<number>[0-9]{1,3})", _address_bank),
    (r"#(?P<number>[0-9]{1,3})", _address_motor),
    (r"&(?P<number>[0-9]{1,3})", _address_system),
    (r"(?P<marks>\?{1,3})", _status),
    (r"(?P<word>TYPE|VERSION|VER|CID)(?![A-Z0-9])", _identity),
    (r"(?P<word>\$\$\$\*\*\*|\$\$\$|SAVE(?![A-Z0-9]))", _whole_controller),
    (r"UNDEF(?:INE)? *(?P<all>ALL)?(?![A-Z0-9])", _undefine),
    (r"PASSWORD *= *", _password),
    (r"(?:ENABLE|ENA|DISABLE|DIS) *PLCC? *[0-9]+(?:(?:\.\.|,)[0-9]+)*", _plc),
    *online_memory.COMMANDS,
    *online_motion.COMMANDS,
)
"""Command patterns and their handlers; the first match wins."""
