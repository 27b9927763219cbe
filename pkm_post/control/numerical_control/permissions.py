# SPDX-License-Identifier: LGPL-2.1-or-later
"""Permissions: which orders make sense in which state, and why the others do not.

Enters: the state of a machine and what a panel knows in addition. Leaves: for each order the obstacles, the most
important first. This only saves the operator orders that would be refused; the checks of the control and the controller
alone decide what may move the machine.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass

from pkm_post.control.numerical_control.control import State
from pkm_post.control.numerical_control.homing import Phase


class Order(enum.Enum):
    """Orders an operator can give."""

    HOME = "home"
    JOG = "jog"
    LINE = "line"
    LOAD = "load"
    BLOCKS = "blocks"
    APPROACH = "approach"
    START = "start"
    STEP = "step"
    GO_ON = "go on"
    HOLD = "hold"
    RESUME = "resume"
    ABORT = "abort"
    OVERRIDE = "override"


class Why(enum.Enum):
    """Obstacles to an order."""

    NOT_CONNECTED = "there is no connection"
    WATCH_ONLY = "a Power PMAC can be watched, held and aborted alone"
    NO_ANSWER = "the controller does not answer"
    BUSY = "another order is being carried out"
    NO_JOB = "no program was opened"
    NOT_LOADED = "the program is not loaded"
    NO_BLOCK = "no block comes next"
    NO_STOP = "the program has no stop with moves after it"
    RUNS = "a program runs"
    HELD = "a program is held"
    NOT_HELD = "no program is held"
    MOVES = "the machine moves"
    NOT_HOMED = "not all struts are homed"


_AT_REST = (Why.BUSY, Why.RUNS, Why.HELD, Why.MOVES)
_READY = (*_AT_REST, Why.NOT_HOMED)
_LINK, _ORDERS = (Why.NOT_CONNECTED, Why.NO_ANSWER), (Why.NOT_CONNECTED, Why.WATCH_ONLY, Why.NO_ANSWER)

AGAINST: dict[Order, tuple[Why, ...]] = {
    Order.HOME: (*_ORDERS, *_AT_REST),
    Order.JOG: (*_ORDERS, *_READY),
    Order.LINE: (*_ORDERS, *_READY),
    Order.LOAD: (*_ORDERS, Why.NO_JOB, *_AT_REST),
    Order.BLOCKS: (*_ORDERS, Why.NO_JOB, *_AT_REST),
    Order.APPROACH: (*_ORDERS, Why.NO_JOB, *_READY),
    Order.START: (*_ORDERS, Why.NO_JOB, Why.NOT_LOADED, *_READY),
    Order.STEP: (*_ORDERS, Why.NO_JOB, Why.NO_BLOCK, *_READY),
    Order.GO_ON: (*_ORDERS, Why.NO_JOB, Why.NO_STOP, *_READY),
    Order.HOLD: (Why.NOT_CONNECTED,),
    Order.RESUME: (*_ORDERS, Why.BUSY, Why.NOT_HELD),
    Order.ABORT: (Why.NOT_CONNECTED,),
    Order.OVERRIDE: (*_ORDERS, Why.BUSY, Why.HELD),
}
"""The last reading never blocks a stop: it may be stale."""


@dataclass(frozen=True)
class Desk:
    """What a panel knows besides the machine state.

    Attributes:
        connected: whether a connection is open.
        watch_only: whether the controller accepts stops only.
        busy: whether an order is in progress.
        has_job: whether a program is open.
        loaded: whether it is in the controller, as far as known here.
        has_stops: whether it has stops (M0, M1) to continue after.
        stepping: whether its blocks are open in single block mode.
        homing: whether a homing started here is being monitored.
    """

    connected: bool = False
    watch_only: bool = False
    busy: bool = False
    has_job: bool = False
    loaded: bool = False
    has_stops: bool = False
    stepping: bool = False
    homing: bool = False


def facts(state: State, desk: Desk) -> frozenset[Why]:
    """All obstacles in this state."""
    status = state.status
    answers = status is not None and not state.lost
    held = status is not None and status.held
    searches = desk.homing and state.homing is not None and state.homing.phase is Phase.SEARCHING
    holds = {
        Why.NOT_CONNECTED: not desk.connected,
        Why.WATCH_ONLY: desk.watch_only,
        Why.NO_ANSWER: not answers,
        Why.BUSY: desk.busy,
        Why.NO_JOB: not desk.has_job,
        Why.NOT_LOADED: not desk.loaded,
        Why.NO_BLOCK: not desk.stepping or state.block is None or state.block.is_over,
        Why.NO_STOP: not desk.has_stops,
        Why.RUNS: status is not None and status.running and not held,
        Why.HELD: held,
        Why.NOT_HELD: not held,
        Why.MOVES: searches or (status is not None and not status.standing),
        Why.NOT_HOMED: status is None or not all(status.homed),
    }
    return frozenset(why for why, is_so in holds.items() if is_so)


def refusal(order: Order, found: frozenset[Why]) -> Why | None:
    """The first obstacle to an order; None if it is allowed."""
    return next((why for why in AGAINST[order] if why in found), None)


def may_move(state: State) -> bool:
    """Whether the machine moves, or may move as far as known: it must not be left unattended then."""
    if state.emergency:
        return True
    status = state.status
    if status is None:
        return False
    return not status.standing or (status.running and not status.held)
