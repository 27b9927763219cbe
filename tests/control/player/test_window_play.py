# SPDX-License-Identifier: LGPL-2.1-or-later
"""A trajectory played by a worker: stops come first, the play goes on behind a hold, the end of the worker ends it."""

import time
from concurrent.futures import CancelledError

import pytest
from playing import RECTANGLE, TOLERANCES, trajectory_of

from pkm_post.control.link.errors import CancelledError as StoppedError
from pkm_post.control.link.errors import LinkLostError, PmacError
from pkm_post.control.link.status import read_status
from pkm_post.control.link.stopping import EMERGENCY_STEPS
from pkm_post.control.numerical_control.connection import SIMULATED_HOMING, connect, connection_target
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.window_play import WindowPlay
from pkm_post.model import Event, EventKind

TOOL = 120.0
LONGEST_S = 240.0
TO_THE_END = [Order("override", 1.5), Order("start")]


def until(holds):
    end = time.monotonic() + LONGEST_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.005)


@pytest.fixture
def connection():
    """A simulated machine at home, homed."""
    target, faults = connection_target(None, "example_6tps")
    assert not faults
    made = connect(target, TOOL)
    made.worker.submit(lambda control: control.home(SIMULATED_HOMING)).result(LONGEST_S)
    until(lambda: made.worker.state.status is not None and all(made.worker.state.status.homed))
    until(lambda: made.worker.state.status.standing and not made.worker.state.status.running)
    yield made
    made.close()


def playing(connection, trajectory=None, override=0.1, **choices):
    """A play of 100 mm, so slow that it has not ended when something comes first."""
    options = PlayOptions(override=override, **choices)
    return WindowPlay(connection, trajectory or trajectory_of(RECTANGLE), TOLERANCES, options)


def phase(play):
    return "" if play.state is None else play.state.phase


def moves(connection):
    """Where the state of the worker has the tip, after it has read again."""
    before = connection.worker.state
    until(lambda: connection.worker.state is not before)
    return connection.worker.state.pose.tip


@pytest.mark.slow
def test_a_hold_of_the_worker_comes_first_and_the_play_goes_on_behind_it(connection):
    trajectory = trajectory_of(RECTANGLE)
    play = playing(connection, trajectory)
    until(lambda: phase(play) == "runs")
    status = connection.worker.submit(lambda control: control.hold(), urgent=True).result(LONGEST_S)
    assert status.standing and not play.done.done()
    # a computer so busy that the list has run out is at rest by itself; the hold keeps it there
    until(lambda: (phase(play) == "held" and connection.worker.state.status.held) or play.waits_for == "hold")
    assert (moves(connection) == moves(connection)).all()
    play.order(Order("resume"))
    until(lambda: phase(play) == "runs")
    for order in TO_THE_END:
        play.order(order)
    done = play.done.result(LONGEST_S)
    assert done.finished and done.log.holds
    until(lambda: abs(connection.worker.state.pose.tip - trajectory.tip[-1]).max() < 1e-3)


@pytest.mark.slow
def test_a_hold_before_anything_runs_keeps_it_from_starting(connection):
    stopped = trajectory_of(RECTANGLE, events=(Event(1, EventKind.STOP, 0.0),))
    play = playing(connection, stopped, override=1.5)  # nothing comes first here: it rests, and it plays to its end
    until(lambda: play.waits_for == "M0")
    connection.worker.submit(lambda control: control.hold(), urgent=True).result(LONGEST_S)
    play.order(Order("resume"))
    play.order(Order("hold"))
    play.order(Order("start"))
    assert play.done.result(LONGEST_S).finished  # a start is a start

    play = playing(connection, stopped, approach=True)
    until(lambda: play.waits_for.startswith("T"))
    connection.worker.submit(lambda control: control.abort(), urgent=True).result(LONGEST_S)
    play.order(Order("end"))
    assert not play.done.result(LONGEST_S).finished


@pytest.mark.slow
def test_an_abort_ends_it_and_the_worker_goes_on(connection):
    play = playing(connection)
    until(lambda: phase(play) == "runs")
    connection.worker.submit(lambda control: control.abort(), urgent=True).result(LONGEST_S)
    play.order(Order("end"))
    try:
        assert not play.done.result(LONGEST_S).finished  # the list had run out just before
    except PmacError as fault:
        assert "ended from elsewhere" in str(fault)
    moves(connection)
    assert not connection.worker.state.status.running and connection.worker.state.status.standing


@pytest.mark.slow
def test_a_link_that_is_lost_while_it_plays_is_a_state_of_the_worker(connection, monkeypatch):
    """The last position is not shown as the present one, and the operator is told what to do."""
    is_cut = []

    def read(*order):
        if is_cut:
            raise LinkLostError("the cable is out")
        return read_status(*order)

    monkeypatch.setattr("pkm_post.control.player.play.read_status", read)
    play = playing(connection)
    until(lambda: phase(play) == "runs")
    is_cut.append(True)
    until(lambda: connection.worker.state.lost)
    assert (connection.worker.state.lost, connection.worker.state.emergency) == ("the cable is out", EMERGENCY_STEPS)
    is_cut.clear()
    until(lambda: not connection.worker.state.lost)
    assert not connection.worker.state.emergency
    for order in TO_THE_END:
        play.order(order)
    assert play.done.result(LONGEST_S).finished


@pytest.mark.slow
def test_what_waits_behind_it_is_cancelled_by_a_stop_and_the_end_of_the_worker_ends_it(connection):
    play = playing(connection)
    behind = connection.worker.submit(lambda control: control.poll())
    until(lambda: phase(play) == "runs")
    connection.worker.submit(lambda control: control.hold(), urgent=True).result(LONGEST_S)
    with pytest.raises(CancelledError):
        behind.result(LONGEST_S)
    connection.worker.close()
    with pytest.raises(StoppedError, match="the play was ended"):
        play.done.result(LONGEST_S)
