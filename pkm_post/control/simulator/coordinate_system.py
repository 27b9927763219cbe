# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coordinate system: a running program, with a time base that an override slows down or stops.

Input: R, S, H, Q, A, an override in per cent, and elapsed time in ms. Output: commanded motor positions in counts. One
move is computed ahead: statements between two moves are executed when the first of them begins, except that a DWELL is
waited for.
"""

from __future__ import annotations

import numpy as np

from pkm_post.control.simulator import errors
from pkm_post.control.simulator.errors import CommandError
from pkm_post.control.simulator.interpreter import Interpreter, PortOutput
from pkm_post.control.simulator.memory import Memory, ProgramError
from pkm_post.control.simulator.modal_state import Axes
from pkm_post.control.simulator.motors import NO_COMMAND, Motors
from pkm_post.control.simulator.moves import MoveQueue
from pkm_post.control.simulator.variables import Array, SystemScope, Variables

UNITS_PER_MS = 2.0**23
"""Isx94 and Isx95 count 2^-23 ms per servo cycle, and a cycle of I10 units is 100 % [TurboPMAC, I10, Isx94]."""
MOVES_AT_ONCE = 1000
SAME_PLACE = 0.5
"""counts: largest distance of a motor from its position when the program stopped."""


class CoordinateSystem:
    """One coordinate system.

    Attributes:
        number: from 1.
        running: whether a program runs; true also while it is held or waits for lines.
        stepping: whether it stops after the next move.
        holding: whether a feed hold is active.
        override: of the current time base; 1 is 100 %.
        override_wanted: target override when not held; 1 is 100 %.
        path: the moves of the program.
        runtime_error: whether the last program ended with an error.
    """

    def __init__(self, number: int, memory: Memory, variables: Variables, motors: Motors, outside: PortOutput) -> None:
        self.number, self._motors, self._variables = number, motors, variables
        self.axes = Axes()
        self.interpreter = Interpreter(number, memory, SystemScope(variables, number), self.axes, outside)
        self.running = self.stepping = self.holding = self.runtime_error = False
        self.override = self.override_wanted = 1.0
        self.path = MoveQueue()
        self._stopped_at: Array | None = None
        self._no_more = self._resuming = False

    def run(self, step: bool = False) -> None:
        """R or S: start, or continue after H, Q, S or STOP.

        Raises:
            CommandError: the motors or the program are not ready.
        """
        self._check_motors()
        self.interpreter.counter.check()
        if self.running and not self.holding:
            self.stepping, self._no_more = step, False
            return
        self._check_place()
        self._resuming = self.holding
        self.holding, self.stepping, self.runtime_error = False, step, False
        if not self.running:
            self._begin()

    def hold(self) -> None:
        """H: slow the time base down to zero; the motors stay on their path."""
        self.holding = self.running

    def quit(self) -> None:
        """Q: end after the moves already computed."""
        self._no_more = True

    def abort(self) -> None:
        """A: end the program and stop each motor on its own ramp."""
        for index in self.axes.indices():
            self._motors.abort(index)
        self.forget()

    def forget(self) -> None:
        """End the program at once, without commanding the motors."""
        self.running = self.holding = self.stepping = False
        self._stopped_at = None
        self.path.clear()

    def set_override(self, percent: float) -> None:
        """Set the override, at most the servo rate in kHz times 100 % [TurboPMAC, %]."""
        self.override_wanted = min(percent / 100, UNITS_PER_MS / max(self._variables.setting(10), 1))

    def advance(self, ms: float) -> None:
        """Advance time."""
        if not self.running:
            self.path.clear()  # the last move is kept for one tick, so that the motors reach its end exactly
        self._slew(ms)
        for _ in range(MOVES_AT_ONCE):
            if self.running:
                self._compute_ahead()
            ms = self.path.go_on(ms, self.override)
            if not ms:
                return

    @property
    def resumes(self) -> bool:
        """Whether a program speeds up after a hold."""
        return self.running and self._resuming

    def rests(self) -> bool:
        """Whether ticks change only the program time until the next command."""
        return not self.running and self.path.last() is None and self.override == self.override_wanted

    def commanded(self) -> Array:
        """Commanded motor positions, counts, (6,); NaN where no program commands them."""
        position = None if self.holding and self.override == 0 else self.path.position()
        return NO_COMMAND if position is None else self.axes.counts(position)

    def _begin(self) -> None:
        place = self.axes.position(self._motors.commanded)
        if self.interpreter.counter.at_beginning():
            self.interpreter.modes.reset(place)
        else:
            self.interpreter.modes.resume(place)
        self.interpreter.finished = self.interpreter.halted = False
        self.path.clear()
        self._stopped_at, self._no_more, self.running = None, False, True

    def _check_motors(self) -> None:
        indices, motors = self.axes.indices(), self._motors
        if not indices or self.number - 1 > self._variables.setting(68):
            raise CommandError(errors.NO_MOTORS)
        if not motors.activated[indices].all():
            raise CommandError(errors.NOT_ACTIVATED)
        if (motors.low_switch & motors.high_switch)[indices].any():
            raise CommandError(errors.BOTH_LIMITS)
        if not motors.closed[indices].all():
            raise CommandError(errors.OPEN_LOOP)
        if any(motors.jogs[index] is not None for index in indices):
            raise CommandError(errors.MOVING)

    def _check_place(self) -> None:
        """Refuse an unsound program, and motors away from the place where it stopped."""
        program = self.interpreter.counter.program()
        if program is not None and not program.sound:
            raise CommandError(errors.BAD_PROGRAM)
        stopped = self._standing() if self.holding else self._stopped_at
        if stopped is not None and (np.abs(stopped - self._motors.commanded) > SAME_PLACE).any():
            raise CommandError(errors.DISPLACED)

    def _slew(self, ms: float) -> None:
        """Slew the override: Isx95 for a hold and the resume after it, Isx94 otherwise [TurboPMAC, Isx95]."""
        wanted = 0.0 if self.holding else self.override_wanted
        if self.override != wanted:
            which = 95 if self.holding or self._resuming else 94
            cycle = max(self._variables.setting(10), 1)
            change = abs(self._variables.of_system(self.number, which)) / cycle * ms * UNITS_PER_MS / cycle
            self.override += min(max(wanted - self.override, -change), change)
        self._resuming = self._resuming and self.override != wanted

    def _standing(self) -> Array:
        """Positions to which the program commands the motors, or last did, counts, (6,)."""
        position = self.path.position()
        return self._motors.commanded.copy() if position is None else self.axes.counts(position)

    def _compute_ahead(self) -> None:
        for _ in range(MOVES_AT_ONCE):
            if self._no_more or self.interpreter.ended() or self.path.has_enough():
                break
            try:
                move = self.interpreter.next(self.path.last(), self.path.time)
            except ProgramError:
                self.runtime_error = True
                self.abort()
                return
            if move is None:
                break
            self.path.add(move, self.interpreter.taken_pending())
            self._no_more = self.stepping and not self.interpreter.in_block
        if (self._no_more or self.interpreter.ended()) and self.path.done():
            self._stopped_at = None if self.interpreter.finished else self._standing()
            self.running = self.stepping = self.holding = False
