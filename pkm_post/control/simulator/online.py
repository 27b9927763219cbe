# SPDX-License-Identifier: LGPL-2.1-or-later
"""On-line commands: a line from a port, executed command by command.

Enters: a line without its terminator, and its sender. Leaves: lines of data, or the error that refuses the line;
commands ahead of the faulty one were executed. While a buffer is open, everything that parses as a program statement
goes into it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pkm_post.control.simulator import online_memory, online_motion
from pkm_post.control.simulator.axes import definition_of
from pkm_post.control.simulator.errors import DATA, NOT_OPEN, RUNNING, CommandError
from pkm_post.control.simulator.scanner import Scanner
from pkm_post.control.simulator.statements import statements_of
from pkm_post.control.simulator.status import global_status, motor_status, system_status
from pkm_post.control.simulator.variables import MOTORS, SYSTEMS

if TYPE_CHECKING:
    from pkm_post.control.simulator.controller import Controller

Handler = Callable[["Session", re.Match[str], Scanner], list[str]]


@dataclass(eq=False)
class Session:
    """The sender of commands, and the motor and coordinate system it addresses.

    Attributes:
        controller: that executes them.
        motor: addressed by ``#n``.
        system: addressed by ``&n``.
        bank: eight motors, addressed by ``##n``.
    """

    controller: Controller
    motor: int = 1
    system: int = 1
    bank: int = 0


def execute(session: Session, line: str) -> list[str]:
    """Execute a line.

    Raises:
        CommandError: one of its commands is refused.
    """
    scanner, told = Scanner(line), []
    while not scanner.at_end():
        told += _one(session, scanner)
    return told


def _one(session: Session, scanner: Scanner) -> list[str]:
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


def _went_into_buffer(session: Session, scanner: Scanner) -> bool:
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
        return bool(statements_of(text))
    except CommandError:
        return False


def _address_motor(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.motor = _within(match["number"], 1, MOTORS)
    return []


def _address_system(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.system = _within(match["number"], 1, SYSTEMS)
    return []


def _address_bank(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.bank = _within(match["number"], 0, MOTORS // 8 - 1)
    return []


def _within(text: str, least: int, most: int) -> int:
    if not least <= int(text) <= most:
        raise CommandError(DATA)
    return int(text)


def _axis(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``#n->`` reports an axis definition, ``#n->1000X`` sets one [TurboPMAC, axis definition]."""
    controller = session.controller
    motor = session.motor = _within(match["number"], 1, MOTORS)
    axes = controller.systems[session.system - 1].axes
    if scanner.at_end():
        there = axes.definitions.get(motor)
        return [there.text() if there else "0"]
    definition = definition_of(scanner)
    if controller.runs_program():
        raise CommandError(RUNNING)
    system = controller.system_of(motor)
    if definition is not None and system is not None and system.number != session.system:
        raise CommandError(DATA)
    axes.define(motor, definition)
    return []


def _undefine(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    if session.controller.runs_program():
        raise CommandError(RUNNING)
    everywhere = match["all"] is not None
    for system in session.controller.systems:
        if everywhere or system.number == session.system:
            system.axes.definitions.clear()
    return []


def _status(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    if match["marks"] == "???":
        return [global_status(session.controller)]
    if match["marks"] == "??":
        return [system_status(session.controller, session.system)]
    return [motor_status(session.controller, session.motor)]


def _identity(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    settings = session.controller.settings
    word = match["word"].upper()
    return [{"TYPE": settings.card, "CID": settings.identity}.get(word, settings.firmware)]


def _whole_controller(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    controller = session.controller
    {"$$$***": controller.initialize, "$$$": controller.reset, "SAVE": controller.save}[match["word"].upper()]()
    return []


def _password(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.controller.unlocked = scanner.rest().strip() == session.controller.settings.password
    return []


def _plc(session: Session, match: re.Match[str], scanner: Scanner) -> list[str]:
    """There are no PLC programs to enable or disable."""
    return []


COMMANDS: tuple[tuple[str, Handler], ...] = (
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
