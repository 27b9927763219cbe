# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which orders make sense in which state."""

import numpy as np
import pytest

from pkm_post.control.link.status import MotorBits, Status, SystemBits
from pkm_post.control.numerical_control.control import State
from pkm_post.control.numerical_control.homing import Homing, Phase
from pkm_post.control.numerical_control.permissions import AGAINST, Desk, Order, Why, facts, may_move, refusal
from pkm_post.control.numerical_control.single_block import Shown

STANDING, HOMED, RUNNING = 1 << 37, 1 << 10, 1 << 48  # [EPICSpmac]
HELD = RUNNING | 1 << 47
AT_HAND = Desk(connected=True)
STOPS = {Order.HOLD, Order.ABORT}
BY_HAND = {Order.HOME, Order.JOG, Order.LINE, Order.OVERRIDE, *STOPS}
TAKEN = {Order.LOAD, Order.BLOCKS}
OPENED = Desk(connected=True, has_job=True)
LOADED = Desk(connected=True, has_job=True, loaded=True)


def status(motor=STANDING | HOMED, system=0):
    zero = np.zeros(6)
    return Status((MotorBits(motor),) * 6, SystemBits(system), 100.0, zero, zero)


def allowed(state, desk=AT_HAND):
    found = facts(state, desk)
    return {order for order in Order if refusal(order, found) is None}


AT_REST, RUNS, IS_HELD = State(status(), None), State(status(0, RUNNING), None), State(status(system=HELD), None)


@pytest.mark.parametrize(
    ("state", "desk", "orders"),
    [
        (State(None, None), Desk(), set()),
        (State(None, None), AT_HAND, STOPS),
        (AT_REST, AT_HAND, BY_HAND),
        (AT_REST, Desk(connected=True, busy=True), STOPS),
        (AT_REST, Desk(connected=True, watch_only=True), STOPS),
        (AT_REST, OPENED, BY_HAND | TAKEN | {Order.APPROACH}),
        (AT_REST, LOADED, BY_HAND | TAKEN | {Order.APPROACH, Order.START}),
        (State(status(STANDING), None), LOADED, STOPS | TAKEN | {Order.HOME, Order.OVERRIDE}),
        (State(status(HOMED), None), AT_HAND, STOPS | {Order.OVERRIDE}),
        (RUNS, LOADED, STOPS | {Order.OVERRIDE}),
        (IS_HELD, LOADED, STOPS | {Order.RESUME}),
        (State(status(), None, lost="cut"), LOADED, STOPS),
    ],
)
def test_what_makes_sense(state, desk, orders):
    assert allowed(state, desk) == orders


@pytest.mark.parametrize(("watched", "phase", "moves"), [
    (True, Phase.SEARCHING, True), (False, Phase.SEARCHING, False), (True, Phase.DONE, False),
])  # fmt: skip
def test_a_pause_of_a_homing_is_no_rest(watched, phase, moves):
    state = State(status(), None, homing=Homing(phase, (), ()))
    assert (Order.JOG not in allowed(state, Desk(connected=True, homing=watched))) == moves


@pytest.mark.parametrize(
    ("block", "allows"), [(None, False), (Shown(1, 3), True), (Shown(3, 3), True), (Shown(4, 3), False)]
)
def test_a_step_needs_a_block_that_comes_next(block, allows):
    state, desk = State(status(), None, block=block), Desk(connected=True, has_job=True, stepping=True)
    assert (refusal(Order.STEP, facts(state, desk)) is None) == allows
    assert refusal(Order.STEP, facts(state, OPENED)) is Why.NO_BLOCK  # those are blocks of another program


def test_to_go_on_needs_a_stop():
    assert refusal(Order.GO_ON, facts(AT_REST, LOADED)) is Why.NO_STOP
    assert refusal(Order.GO_ON, facts(AT_REST, Desk(connected=True, has_job=True, has_stops=True))) is None


def test_the_reason_that_matters_most_comes_first():
    found = facts(State(None, None), Desk())
    assert {refusal(order, found) for order in Order} == {Why.NOT_CONNECTED}
    assert refusal(Order.JOG, facts(State(status(0, RUNNING), None), AT_HAND)) is Why.RUNS


def test_every_order_says_what_stands_against_it():
    assert set(AGAINST) == set(Order)
    assert {why for against in AGAINST.values() for why in against} == set(Why)


@pytest.mark.parametrize(
    ("state", "moves"),
    [
        (State(None, None), False),
        (AT_REST, False),
        (RUNS, True),
        (IS_HELD, False),
        (State(status(0), None), True),
        (State(status(), None, lost="cut", emergency=("press",)), True),
    ],
)
def test_what_nobody_should_walk_away_from(state, moves):
    assert may_move(state) == moves
