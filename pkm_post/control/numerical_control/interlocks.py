# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interlocks: the commands of the operator, and the reasons that block each in the current state.

Input: the state of a machine and of a panel. Output: for each command the active interlocks, the most important first.
This only spares the operator refused commands; only the checks of the control and the controller decide what may move
the machine.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

from pkm_post.control.numerical_control.control_state import ControlState
from pkm_post.control.numerical_control.homing import HomingPhase


class OperatorCommand(enum.Enum):
    """Commands of the operator."""

    HOME = "home"
    JOG = "jog"
    LINE = "line"
    LOAD = "load"
    BLOCKS = "blocks"
    APPROACH = "approach"
    START = "start"
    STEP = "step"
    CONTINUE = "continue"
    HOLD = "hold"
    RESUME = "resume"
    ABORT = "abort"
    OVERRIDE = "override"
    PLAY = "play"
    PLAY_CONTINUE = "continue the play"
    RETRACT = "retract"
    PLAY_END = "end the play"


class Interlock(enum.Enum):
    """Reason why a command is blocked."""

    NOT_CONNECTED = "there is no connection"
    NO_ANSWER = "the controller does not answer"
    BUSY = "another command is being executed"
    NO_JOB = "no program was opened"
    NOT_LOADED = "the program is not loaded"
    NO_TRAJECTORY = "no trajectory was opened"
    PLAYS = "a trajectory is played"
    NOT_PLAYING = "no trajectory is played"
    NOT_WAITING = "the play is not waiting"
    NO_BLOCK = "no block comes next"
    NO_STOP = "the program has no stop with moves after it"
    RUNS = "a program runs"
    HELD = "a program is held"
    NOT_HELD = "no program is held"
    MOVES = "the machine moves"
    NOT_HOMED = "not all struts are homed"


_AT_REST = (Interlock.BUSY, Interlock.PLAYS, Interlock.RUNS, Interlock.HELD, Interlock.MOVES)
_READY = (*_AT_REST, Interlock.NOT_HOMED)
_ORDERS = (Interlock.NOT_CONNECTED, Interlock.NO_ANSWER)

INTERLOCKS_OF: dict[OperatorCommand, tuple[Interlock, ...]] = {
    OperatorCommand.HOME: (*_ORDERS, *_AT_REST),
    OperatorCommand.JOG: (*_ORDERS, *_READY),
    OperatorCommand.LINE: (*_ORDERS, *_READY),
    OperatorCommand.LOAD: (*_ORDERS, Interlock.NO_JOB, *_AT_REST),
    OperatorCommand.BLOCKS: (*_ORDERS, Interlock.NO_JOB, *_AT_REST),
    OperatorCommand.APPROACH: (*_ORDERS, Interlock.NO_JOB, *_READY),
    OperatorCommand.START: (*_ORDERS, Interlock.NO_JOB, Interlock.NOT_LOADED, *_READY),
    OperatorCommand.STEP: (*_ORDERS, Interlock.NO_JOB, Interlock.NO_BLOCK, *_READY),
    OperatorCommand.CONTINUE: (*_ORDERS, Interlock.NO_JOB, Interlock.NO_STOP, *_READY),
    OperatorCommand.HOLD: (Interlock.NOT_CONNECTED,),
    OperatorCommand.RESUME: (*_ORDERS, Interlock.BUSY, Interlock.NOT_HELD),
    OperatorCommand.ABORT: (Interlock.NOT_CONNECTED,),
    OperatorCommand.OVERRIDE: (*_ORDERS, Interlock.BUSY, Interlock.PLAYS, Interlock.HELD),
    OperatorCommand.PLAY: (*_ORDERS, Interlock.NO_TRAJECTORY, *_READY),
    OperatorCommand.PLAY_CONTINUE: (Interlock.NOT_CONNECTED, Interlock.NOT_PLAYING, Interlock.NOT_WAITING),
    OperatorCommand.RETRACT: (Interlock.NOT_CONNECTED, Interlock.NOT_PLAYING, Interlock.NOT_WAITING),
    OperatorCommand.PLAY_END: (Interlock.NOT_CONNECTED, Interlock.NOT_PLAYING),
}
"""A stop is never blocked by the last reading, which may be stale."""


@dataclass(frozen=True)
class PanelState:
    """State of a panel besides that of the machine.

    Attributes:
        has_job: whether a program is open.
        loaded: whether it is known to be in the controller.
        has_stops: whether it has stops (M0, M1) to continue after.
        has_trajectory: whether a trajectory is open for playing.
        waiting: whether the play waits for the operator.
        held_back: whether the play is at rest between two pieces until it is resumed.
        stepping: whether its blocks are open in single block mode.
        homing: whether a homing started here is being monitored.
    """

    connected: bool = False
    busy: bool = False
    has_job: bool = False
    loaded: bool = False
    has_stops: bool = False
    has_trajectory: bool = False
    playing: bool = False
    waiting: bool = False
    held_back: bool = False
    stepping: bool = False
    homing: bool = False


def active_interlocks(state: ControlState, panel: PanelState) -> frozenset[Interlock]:
    """All interlocks that are active in this state."""
    status = state.status
    answers = status is not None and not state.lost
    held = status is not None and status.held
    searches = panel.homing and state.homing is not None and state.homing.phase is HomingPhase.SEARCHING
    holds = {
        Interlock.NOT_CONNECTED: not panel.connected,
        Interlock.NO_ANSWER: not answers,
        Interlock.BUSY: panel.busy,
        Interlock.NO_JOB: not panel.has_job,
        Interlock.NOT_LOADED: not panel.loaded,
        Interlock.NO_TRAJECTORY: not panel.has_trajectory,
        Interlock.PLAYS: panel.playing,
        Interlock.NOT_PLAYING: not panel.playing,
        Interlock.NOT_WAITING: not panel.waiting,
        Interlock.NO_BLOCK: not panel.stepping or state.block is None or state.block.is_over,
        Interlock.NO_STOP: not panel.has_stops,
        Interlock.RUNS: status is not None and status.running and not held,
        Interlock.HELD: held,
        Interlock.NOT_HELD: not (held or panel.held_back),
        Interlock.MOVES: searches or (status is not None and not status.standing),
        Interlock.NOT_HOMED: status is None or not all(status.homed),
    }
    return frozenset(why for why, is_so in holds.items() if is_so)


def blocking_interlock(command: OperatorCommand, active: frozenset[Interlock]) -> Interlock | None:
    """The first active interlock of a command; None if it is allowed."""
    return next((why for why in INTERLOCKS_OF[command] if why in active), None)


def may_move(state: ControlState) -> bool:
    """Whether the machine moves or may move, and must be attended."""
    if state.emergency:
        return True
    status = state.status
    if status is None:
        return False
    return not status.standing or (status.running and not status.held)
