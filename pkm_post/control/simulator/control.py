# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control characters: their actions on all motors and coordinate systems at once [TurboPMAC, control characters]."""

from __future__ import annotations

from collections.abc import Callable

from pkm_post.control.simulator.errors import CommandError
from pkm_post.control.simulator.online import Session
from pkm_post.control.simulator.online_memory import open_rotary
from pkm_post.control.simulator.online_motion import position_text, run
from pkm_post.control.simulator.status import global_status, motor_status, system_status
from pkm_post.control.simulator.variables import SIMULATED_MOTORS, SYSTEMS

Control = Callable[[Session], list[str] | None]
"""The action of a control character; None if it has no answer."""


def _abort_all(session: Session) -> None:
    """End all programs; stop each motor on its own ramp, and close open loops."""
    for system in session.controller.systems:
        system.forget()
    for index in range(SIMULATED_MOTORS):
        session.controller.motors.abort(index)


def _kill_all(session: Session) -> None:
    session.controller.kill_all()


def _hold_all(session: Session) -> None:
    for system in session.controller.systems:
        system.hold()


def _quit_all(session: Session) -> None:
    for system in session.controller.systems:
        system.quit()


def _run_all(session: Session) -> None:
    _start_all(session, step=False)


def _step_all(session: Session) -> None:
    _start_all(session, step=True)


def _start_all(session: Session, step: bool) -> None:
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


def _open_rotary(session: Session) -> None:
    open_rotary(session)


def _close_rotary(session: Session) -> None:
    opened = session.controller.memory.opened
    if opened is not None and opened.program is None:
        session.controller.memory.close(session)


def _no_plc(session: Session) -> None:
    """There are no PLC programs to disable."""


def _bank(session: Session) -> range:
    """The eight motors of the bank addressed by ``##n``."""
    return range(8 * session.bank + 1, 8 * session.bank + 9)


def _of_motors(what: str) -> Control:
    return lambda session: [" ".join(position_text(session.controller, what, motor) for motor in _bank(session))]


def _motor_words(session: Session) -> list[str]:
    return [" ".join(motor_status(session.controller, motor) for motor in _bank(session))]


def _system_words(session: Session) -> list[str]:
    numbers = [number for number in _bank(session) if number <= SYSTEMS]
    return [" ".join(system_status(session.controller, number) for number in numbers)]


def _global_words(session: Session) -> list[str]:
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
