# SPDX-License-Identifier: LGPL-2.1-or-later
"""On-line commands that move, stop and report positions."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from pkm_post.control.simulator.coordinate_system import CoordinateSystem
from pkm_post.control.simulator.errors import DATA, NOT_ACTIVATED, RUNNING, CommandError
from pkm_post.control.simulator.expressions import Scanner, argument, constant
from pkm_post.control.simulator.variables import SIMULATED_MOTORS, SystemScope, printed

if TYPE_CHECKING:
    from pkm_post.control.simulator.machine_state import Handler, MachineState, PortSession

DECIMALS = 1
"""Positions are reported to a tenth of a count."""


def position_text(controller: MachineState, what: str, motor: int) -> str:
    """The answer to ``#nP``, ``#nV`` and ``#nF``: counts, counts/ms, counts."""
    if motor > SIMULATED_MOTORS:
        return "0"
    motors = controller.motors
    column = {"P": motors.actual, "V": motors.speed, "F": motors.following_error}[what]
    return printed(float(np.round(column[motor - 1], DECIMALS)) + 0.0)


def report(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """P, V and F report position, speed and following error."""
    return [position_text(session.controller, match["what"].upper(), session.motor)]


def _system(session: PortSession) -> CoordinateSystem:
    return session.controller.systems[session.system - 1]


def _free_motor(session: PortSession) -> int:
    """The index of the addressed motor, if it may move on its own.

    Raises:
        CommandError: a program moves it, or it does not exist.
    """
    if session.motor > SIMULATED_MOTORS or not session.controller.motors.activated[session.motor - 1]:
        raise CommandError(NOT_ACTIVATED)
    system = session.controller.system_of(session.motor)
    if system is not None and system.running and not (system.holding and system.override == 0):
        raise CommandError(RUNNING)
    return session.motor - 1


def jog(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """J/ stops, J+ and J- jog, J= returns, J=n goes to a position, J:n and J^n move by a distance [TurboPMAC, J]."""
    motors, index, how = session.controller.motors, _free_motor(session), match["how"]
    if how == "/":
        motors.jog_stop(index)
    elif how in "+-":
        motors.jog_on(index, 1 if how == "+" else -1)
    elif how == "=" and not scanner.take(r"(?=[-+$.0-9(])"):
        motors.jog_to(index, float(motors.before_jog[index]))
    else:
        value = argument(scanner).value(SystemScope(session.controller.variables, session.system))
        origin = {"=": 0.0, ":": float(motors.commanded[index]), "^": float(motors.actual[index])}[how]
        motors.jog_to(index, origin + value)
    return []


def home(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """HM searches home, HMZ makes the current position home."""
    index = _free_motor(session)
    if match["here"]:
        session.controller.motors.home_here(index)
    else:
        session.controller.motors.home(index)
    return []


def kill(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """K is refused while a program moves the motor; A must come first [TurboPMAC, K]."""
    system = session.controller.system_of(session.motor)
    if system is not None and system.running:
        raise CommandError(RUNNING)
    if session.motor <= SIMULATED_MOTORS:
        session.controller.kill(session.motor - 1)
    return []


def open_loop(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """O0 opens the loop; the output level moves nothing here."""
    if abs(constant(match["percent"]).value(SystemScope(session.controller.variables, session.system))) > 100:
        raise CommandError(DATA)
    session.controller.motors.open_loop(_free_motor(session))
    return []


def enable(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """E closes the loops of all motors of the coordinate system."""
    system = _system(session)
    if system.running:
        raise CommandError(RUNNING)
    for index in system.axes.indices():
        session.controller.motors.jog_stop(index)
    return []


def run_or_step(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """R runs, S runs one move."""
    run(session.controller, session.system, step=match["letter"].upper() == "S")
    return []


def run(controller: MachineState, number: int, step: bool) -> None:
    """Execute R or S in a coordinate system.

    Raises:
        CommandError: motors or program are not ready.
    """
    system = controller.systems[number - 1]
    opened = controller.memory.opened
    if opened is not None and opened.program is not None:
        system.interpreter.point(None)  # no program may run while a fixed buffer is open
    system.run(step)


def hold(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """H, and the quick stop (backslash), which is equivalent outside look-ahead."""
    _system(session).hold()
    return []


def quit_program(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """Q ends after the moves already computed."""
    _system(session).quit()
    return []


def abort(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """A ends the program, each motor on its own ramp."""
    _system(session).abort()
    return []


def point(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """B10 selects a program, B10.5 its label N50000 [TurboPMAC, B]."""
    system = _system(session)
    if system.running:
        raise CommandError(RUNNING)
    fraction = match["fraction"] or ""
    system.interpreter.point(int(match["number"]), int(fraction[:5].ljust(5, "0")) if fraction else 0)
    return []


def override(session: PortSession, match: re.Match[str], scanner: Scanner) -> list[str]:
    """%n sets the override, % reports its current value."""
    system = _system(session)
    if match["percent"] is None:
        return [printed(round(100 * system.override, 3))]
    system.set_override(float(match["percent"]))
    return []


_ALONE = r"(?![-+A-Z0-9.$(:])"

COMMANDS: tuple[tuple[str, Handler], ...] = (
    (rf"(?P<what>[PVF]){_ALONE}", report),
    (r"J(?P<how>[-+/=:^])", jog),
    (r"(?:HOME|HM)(?P<here>Z)?(?![A-Z0-9])", home),
    (rf"K{_ALONE}", kill),
    (r"O(?P<percent>-?[0-9]{1,3}(?:\.[0-9]*)?)(?![A-Z])", open_loop),
    (rf"E{_ALONE}", enable),
    (rf"(?P<letter>[RS]){_ALONE}", run_or_step),
    (rf"(?:H{_ALONE}|\\)", hold),
    (rf"Q{_ALONE}", quit_program),
    (rf"A{_ALONE}", abort),
    (r"B *(?P<number>[0-9]{1,5})(?:\.(?P<fraction>[0-9]*))?", point),
    (r"%(?P<percent>[0-9]{1,3}(?:\.[0-9]*)?)?", override),
)
