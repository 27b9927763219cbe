# SPDX-License-Identifier: LGPL-2.1-or-later
"""On-line commands for variables and program buffers."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from pkm_post.control.simulator.errors import DATA, IN_USE, NO_PROGRAM, NOT_OPEN, PASSWORD, RUNNING, CommandError
from pkm_post.control.simulator.expressions import Scanner, expression, variable_number
from pkm_post.control.simulator.modal_state import parse_axis_definition
from pkm_post.control.simulator.programs import listed
from pkm_post.control.simulator.variables import HIGHEST, SystemScope, holds_address, printed

if TYPE_CHECKING:
    from pkm_post.control.simulator.machine_state import Handler, PortSession

PROTECTED_FROM = 1000
"""Programs from this number on can be password-protected [TurboPMAC, PASSWORD]."""


def _variable(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """``P1`` reports, ``P1=2`` sets; ``P1..3`` and ``P1..3=0`` do so for a range."""
    letter = match["letter"].upper()
    scope = SystemScope(session.controller.variables, session.system)
    first = int(variable_number(scanner).value(scope))
    last = int(scanner.expect(r"(?P<last>[0-9]{1,4})")["last"]) if scanner.take(r"\.\.") else first
    if not 0 <= first <= last <= HIGHEST:
        raise CommandError(DATA)
    if letter == "M" and scanner.take("->"):
        return _definition(session, first, scanner)
    if scanner.take("="):
        return assign(scope, letter, range(first, last + 1), scanner)
    in_hexadecimal = letter == "I" and session.controller.variables.setting(9) in (2, 3)
    return [
        (f"I{number}=" if letter == "I" and _is_long(session) else "")
        + (
            f"${int(scope.read(letter, number)):X}"
            if in_hexadecimal and holds_address(number)
            else printed(scope.read(letter, number))
        )
        for number in range(first, last + 1)
    ]


def assign(scope: SystemScope, letter: str, numbers: range, scanner: Scanner) -> list[str]:
    """Set variables to the value that follows; answer nothing."""
    value = expression(scanner).value(scope)
    for number in numbers:
        scope.write(letter, number, value)
    return []


def define_axis(session: PortSession, motor: int, scanner: Scanner) -> list[str]:
    """Set the axis definition of a motor of the addressed coordinate system, or remove it; answer nothing."""
    controller = session.controller
    definition = parse_axis_definition(scanner)
    if controller.runs_program():
        raise CommandError(RUNNING)
    system = controller.system_of(motor)
    if definition is not None and system is not None and system.number != session.system:
        raise CommandError(DATA)
    controller.systems[session.system - 1].axes.define(motor, definition)
    return []


def _definition(session: PortSession, number: int, scanner: Scanner) -> list[str]:
    """``M1->`` reports the address of an M-variable, ``M1->*`` sets it; the simulator has no data at addresses."""
    definitions = session.controller.variables.definitions
    if scanner.at_end():
        return [(f"M{number}->" if _is_long(session) else "") + definitions.get(number, "*")]
    definitions[number] = scanner.expect(r"(?P<address>\*|[A-Z]+:?\$?[0-9A-F]+(?:,[0-9A-Z]+)*)")["address"].upper()
    return []


def _unprotected(session: PortSession, match: re.Match[str]) -> int:
    """The number of a program, which the password does not protect."""
    controller, number = session.controller, int(match["number"])
    if controller.settings.password and not controller.unlocked and number >= PROTECTED_FROM:
        raise CommandError(PASSWORD)
    return number


def _open_program(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """OPEN PROG: requires that no program runs, and clears all program pointers [TurboPMAC, OPEN]."""
    controller, number = session.controller, _unprotected(session, match)
    if controller.memory.opened is not None:
        raise CommandError(IN_USE)
    if controller.runs_program():
        raise CommandError(RUNNING)
    controller.memory.open_program(number, session)
    controller.forget_pointers()
    return []


def open_rotary(session: PortSession, *_: object) -> list[str]:
    """OPEN ROT: a program may run, in particular the rotary one."""
    session.controller.memory.open_rotary(session)
    return []


def _close(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.controller.memory.close(session)
    return []


def _clear(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    session.controller.memory.clear(session, session.system)
    return []


def _not_open(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    raise CommandError(NOT_OPEN)


def _gather(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """DEFINE GATHER reserves the given number of words, or all; DELETE GATHER releases them."""
    memory = session.controller.memory
    if memory.opened is not None:
        raise CommandError(IN_USE)
    memory.gather = 0
    if match["verb"].upper().startswith("DEF"):
        size = scanner.take(r"(?P<words>[0-9]{1,6})")
        memory.gather = min(int(size["words"]), memory.free()) if size else memory.free()
    return []


def _rotary(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    memory, system = session.controller.memory, session.controller.systems[session.system - 1]
    if memory.opened is not None:
        raise CommandError(IN_USE)
    if system.running:
        raise CommandError(RUNNING)
    if match["verb"].upper().startswith("DEF"):
        memory.define_rotary(session.system, int(scanner.expect(r"(?P<words>[0-9]{1,6})")["words"]))
    else:
        memory.rotaries.pop(session.system, None)
    return []


def _lines_ahead(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    rotary = session.controller.memory.rotaries.get(session.system)
    return [str(len(rotary.lines) if rotary else 0)]


def _size(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """Number of free words; negative while a buffer is open [PMAC, SIZE]."""
    memory = session.controller.memory
    return [str(memory.free() if memory.opened is None else -memory.free())]


def _list_program(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    controller, number = session.controller, _unprotected(session, match)
    if number not in controller.memory.programs:
        raise CommandError(DATA)
    first, words = (int(match[name]) if match[name] else None for name in ("first", "words"))
    return controller.memory.programs[number].listing(_is_long(session), first or 0, words)


def _list_counter(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """LIST PC: the next statement to compute."""
    counter = session.controller.systems[session.system - 1].interpreter.counter
    counter.check()
    program, index = counter.place
    statements = session.controller.memory.programs[program].statements if program else []
    if index >= len(statements):
        raise CommandError(NO_PROGRAM)
    offset = sum(statement.words for statement in statements[:index])
    return [f"P{program}:{offset}:{listed([statements[index]], _is_long(session))}"]


def _is_long(session: PortSession) -> bool:
    """I9 = 1 or 3: keywords in full, I-variables and definitions of M-variables as statements [TurboPMAC, I9]."""
    return session.controller.variables.setting(9) in (1, 3)


_DEF, _DEL, _ROT = r"(?P<verb>DEFINE|DEF)", r"(?P<verb>DELETE|DEL)", r"(?:ROTARY|ROT)(?![A-Z])"
_GATHER = r"(?:GATHER|GAT)(?![A-Z])"
_PART = r"(?: *, *(?P<first>[0-9]{1,6})?(?: *, *(?P<words>[0-9]{1,6}))?)?"
_CLOSE, _CLEAR = r"(?:CLOSE|CLS)(?![A-Z])", r"(?:CLEAR|CLR)(?![A-Z])"

VARIABLE: tuple[str, Handler] = (r"(?P<letter>[IPQM])(?=[0-9(])", _variable)

COMMANDS: tuple[tuple[str, Handler], ...] = (
    (r"OPEN *(?:PROGRAM|PROG) *(?P<number>[0-9]{1,6})", _open_program),
    (rf"OPEN *{_ROT}", open_rotary),
    (_CLOSE, _close),
    (_CLEAR, _not_open),
    (rf"{_DEF} *{_GATHER}", _gather),
    (rf"{_DEL} *{_GATHER}", _gather),
    (rf"{_DEF} *{_ROT}", _rotary),
    (rf"{_DEL} *{_ROT}", _rotary),
    (r"PR(?![A-Z0-9])", _lines_ahead),
    (r"SIZE(?![A-Z0-9])", _size),
    (rf"(?:LIST|LIS) *(?:PROGRAM|PROG) *(?P<number>[0-9]{{1,5}}){_PART}", _list_program),
    (r"(?:LIST|LIS) *PC(?![A-Z0-9])", _list_counter),
)

OF_OPEN_BUFFER: tuple[tuple[str, Handler], ...] = ((_CLOSE, _close), (_CLEAR, _clear))
"""Commands that are never parsed as statements while a buffer is open."""
