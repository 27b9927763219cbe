# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which orders make sense in which state."""

from dataclasses import replace

import numpy as np
import pytest

from pkm_post.control.link.status import Status
from pkm_post.control.link.status_bits import MotorBits, SystemBits
from pkm_post.control.numerical_control.control_state import ControlState
from pkm_post.control.numerical_control.homing import Homing, HomingPhase
from pkm_post.control.numerical_control.interlocks import (
    INTERLOCKS_OF,
    Interlock,
    OperatorCommand,
    PanelState,
    active_interlocks,
    blocking_interlock,
    may_move,
)
from pkm_post.control.numerical_control.single_block import BlockDisplay

STANDING, HOMED, RUNNING = 1 << 37, 1 << 10, 1 << 48  # [EPICSpmac]
AT_HAND = PanelState(connected=True)
STOPS = {OperatorCommand.HOLD, OperatorCommand.ABORT}
BY_HAND = {OperatorCommand.HOME, OperatorCommand.JOG, OperatorCommand.LINE, OperatorCommand.OVERRIDE, *STOPS}
TAKEN = {OperatorCommand.LOAD, OperatorCommand.BLOCKS}
OPENED = PanelState(connected=True, has_job=True)
PLAYED = PanelState(connected=True, playing=True, waiting=True)
BEHIND_A_STOP = {OperatorCommand.PLAY_CONTINUE, OperatorCommand.RETRACT, OperatorCommand.PLAY_END}
LOADED = PanelState(connected=True, has_job=True, loaded=True)


def status(motor=STANDING | HOMED, system=0, override=100.0):
    zero = np.zeros(6)
    return Status((MotorBits(motor),) * 6, SystemBits(system), override, zero, zero)


def allowed(state, desk=AT_HAND):
    found = active_interlocks(state, desk)
    return {order for order in OperatorCommand if blocking_interlock(order, found) is None}


AT_REST, RUNS, IS_HELD = (
    ControlState(status(), None),
    ControlState(status(0, RUNNING), None),
    ControlState(status(system=RUNNING, override=0.0), None),
)


@pytest.mark.parametrize(
    ("state", "desk", "orders"),
    [
        (ControlState(None, None), PanelState(), set()),
        (ControlState(None, None), AT_HAND, STOPS),
        (AT_REST, AT_HAND, BY_HAND),
        (AT_REST, PanelState(connected=True, busy=True), STOPS),
        (AT_REST, OPENED, BY_HAND | TAKEN | {OperatorCommand.APPROACH}),
        (AT_REST, LOADED, BY_HAND | TAKEN | {OperatorCommand.APPROACH, OperatorCommand.START}),
        (
            ControlState(status(STANDING), None),
            LOADED,
            STOPS | TAKEN | {OperatorCommand.HOME, OperatorCommand.OVERRIDE},
        ),
        (ControlState(status(HOMED), None), AT_HAND, STOPS | {OperatorCommand.OVERRIDE}),
        (RUNS, LOADED, STOPS | {OperatorCommand.OVERRIDE}),
        (IS_HELD, LOADED, STOPS | {OperatorCommand.RESUME}),
        (AT_REST, PLAYED, STOPS | BEHIND_A_STOP),
        (AT_REST, replace(PLAYED, held_back=True), STOPS | BEHIND_A_STOP | {OperatorCommand.RESUME}),
        (ControlState(status(), None, lost="cut"), LOADED, STOPS),
    ],
)
def test_what_makes_sense(state, desk, orders):
    assert allowed(state, desk) == orders


@pytest.mark.parametrize(("watched", "phase", "moves"), [
    (True, HomingPhase.SEARCHING, True), (False, HomingPhase.SEARCHING, False), (True, HomingPhase.DONE, False),
])  # fmt: skip
def test_a_pause_of_a_homing_is_no_rest(watched, phase, moves):
    state = ControlState(status(), None, homing=Homing(phase, (), ()))
    assert (OperatorCommand.JOG not in allowed(state, PanelState(connected=True, homing=watched))) == moves


@pytest.mark.parametrize(
    ("block", "allows"),
    [(None, False), (BlockDisplay(1, 3), True), (BlockDisplay(3, 3), True), (BlockDisplay(4, 3), False)],
)
def test_a_step_needs_a_block_that_comes_next(block, allows):
    state, desk = ControlState(status(), None, block=block), PanelState(connected=True, has_job=True, stepping=True)
    assert (blocking_interlock(OperatorCommand.STEP, active_interlocks(state, desk)) is None) == allows
    assert (
        blocking_interlock(OperatorCommand.STEP, active_interlocks(state, OPENED)) is Interlock.NO_BLOCK
    )  # those are blocks of another program


def test_to_go_on_needs_a_stop():
    assert blocking_interlock(OperatorCommand.CONTINUE, active_interlocks(AT_REST, LOADED)) is Interlock.NO_STOP
    assert (
        blocking_interlock(
            OperatorCommand.CONTINUE,
            active_interlocks(AT_REST, PanelState(connected=True, has_job=True, has_stops=True)),
        )
        is None
    )


def test_the_reason_that_matters_most_comes_first():
    found = active_interlocks(ControlState(None, None), PanelState())
    assert {blocking_interlock(order, found) for order in OperatorCommand} == {Interlock.NOT_CONNECTED}
    assert (
        blocking_interlock(OperatorCommand.JOG, active_interlocks(ControlState(status(0, RUNNING), None), AT_HAND))
        is Interlock.RUNS
    )


def test_every_order_says_what_stands_against_it():
    assert set(INTERLOCKS_OF) == set(OperatorCommand)
    assert {why for against in INTERLOCKS_OF.values() for why in against} == set(Interlock)


@pytest.mark.parametrize(
    ("state", "moves"),
    [
        (ControlState(None, None), False),
        (AT_REST, False),
        (RUNS, True),
        (IS_HELD, False),
        (ControlState(status(0), None), True),
        (ControlState(status(), None, lost="cut", emergency=("press",)), True),
    ],
)
def test_what_nobody_should_walk_away_from(state, moves):
    assert may_move(state) == moves
