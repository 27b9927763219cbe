# SPDX-License-Identifier: LGPL-2.1-or-later
"""The thread that talks to the controller: nothing waits for it, stops come first, faults are reported."""

import threading
import time
from concurrent.futures import CancelledError

import pytest

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.stopping import NOT_AT_REST
from pkm_post.control.numerical_control.control_state import ControlState
from pkm_post.control.numerical_control.manual_moves import CartesianJog
from pkm_post.control.numerical_control.worker import Worker

LONGEST_S = 120.0


class Stub:
    """A control that counts its readings."""

    def __init__(self):
        self.polls = 0
        self.done = []
        self.is_preempted = None

    def preempt_when(self, stop_pending):
        self.is_preempted = stop_pending

    def attended_while(self, is_attended):
        self.is_attended = is_attended

    def poll(self):
        self.polls += 1
        if self.polls == -1:
            raise ZeroDivisionError
        return ControlState(None, None, lost=str(self.polls))


def until(holds):
    """Wait for what another thread does."""
    end = time.monotonic() + LONGEST_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.002)


@pytest.fixture
def stub():
    return Stub()


@pytest.fixture
def worker(stub):
    made = Worker(stub, period=0.005)
    yield made
    if made.failure is None:
        made.close()


def test_the_state_is_read_again_and_again(worker, stub):
    until(lambda: stub.polls > 5 and worker.state.lost)
    assert int(worker.state.lost) > 0


def test_somebody_who_looked_on_once_counts_for_a_while(stub):
    worker = Worker(stub, period=0.005, attended=0.05)
    assert not stub.is_attended()
    until(lambda: worker.attend() or stub.is_attended())
    until(lambda: not stub.is_attended())
    worker.close()


def test_orders_are_carried_out_in_their_order_and_give_results(worker, stub):
    results = [worker.submit(lambda control, n=n: control.done.append(n) or n) for n in range(20)]
    assert [result.result(LONGEST_S) for result in results] == list(range(20)) == stub.done


def test_a_stop_comes_first_and_cancels_what_waits(worker, stub):
    begun, go_on = threading.Event(), threading.Event()

    def long(control):
        begun.set()
        assert go_on.wait(LONGEST_S)

    first = worker.submit(long)
    assert begun.wait(LONGEST_S)
    waiting = [worker.submit(lambda control: control.done.append("jog")) for _ in range(3)]
    hold = worker.submit(lambda control: control.done.append("hold"), urgent=True)
    abort = worker.submit(lambda control: control.done.append("abort"), urgent=True)
    go_on.set()
    first.result(LONGEST_S)
    hold.result(LONGEST_S)
    abort.result(LONGEST_S)
    assert stub.done == ["hold", "abort"]
    for order in waiting:
        with pytest.raises(CancelledError):
            order.result(LONGEST_S)


def test_what_is_being_done_is_informed_that_a_stop_waits(worker, stub):
    begun = threading.Event()

    def long(control):
        before = stub.is_preempted()
        begun.set()
        until(stub.is_preempted)
        return before

    first = worker.submit(long)
    assert begun.wait(LONGEST_S)
    hold = worker.submit(lambda control: stub.is_preempted(), urgent=True)
    assert first.result(LONGEST_S) is False
    assert hold.result(LONGEST_S) is False, "a stop does not wait for itself"


def test_what_is_being_done_gives_way_to_the_end(stub):
    worker = Worker(stub, period=0.005)
    begun = threading.Event()
    first = worker.submit(lambda control: begun.set() or until(stub.is_preempted) or "given way")
    assert begun.wait(LONGEST_S)
    worker.close()
    assert first.result(0) == "given way"


def test_a_stop_that_is_being_done_does_not_give_way_to_the_end(stub):
    worker = Worker(stub, period=0.005)
    begun, ends = threading.Event(), threading.Event()

    def stop(control):
        begun.set()
        until(lambda: worker._ended)
        return stub.is_preempted()

    aborted = worker.submit(stop, urgent=True)
    assert begun.wait(LONGEST_S)
    threading.Timer(0.0, lambda: (worker.close(), ends.set())).start()
    assert aborted.result(LONGEST_S) is False
    assert ends.wait(LONGEST_S)


def test_an_order_that_ends_the_thread_is_reported_as_well(stub):
    worker = Worker(stub, period=0.005)

    def ends(control):
        raise SystemExit(3)

    with pytest.raises(SystemExit):
        worker.submit(ends).result(LONGEST_S)
    with pytest.raises(RuntimeError, match="ended by a fault"):
        worker.close()


def test_the_exception_of_an_order_is_that_of_its_result(worker):
    def fails(control):
        raise NotReadyError(["no"])

    with pytest.raises(NotReadyError):
        worker.submit(fails).result(LONGEST_S)
    assert worker.submit(lambda control: 7).result(LONGEST_S) == 7


def test_it_ends(stub):
    worker = Worker(stub, period=0.005)
    begun, go_on = threading.Event(), threading.Event()
    first = worker.submit(lambda control: begun.set() or go_on.wait(LONGEST_S))
    assert begun.wait(LONGEST_S)
    waiting = worker.submit(lambda control: 1)
    threading.Timer(0.05, go_on.set).start()
    worker.close()
    assert first.result(0) and waiting.cancelled()
    with pytest.raises(RuntimeError, match="the worker has ended"):
        worker.submit(lambda control: 1)


def test_a_fault_of_ours_is_not_hidden(worker, stub):
    stub.polls = -2
    until(lambda: worker.failure is not None)
    with pytest.raises(RuntimeError) as reported:
        worker.submit(lambda control: 1)
    assert isinstance(reported.value.__cause__, ZeroDivisionError)
    with pytest.raises(RuntimeError, match="ended by a fault"):
        worker.close()


def test_a_machine_is_operated(station):
    worker = Worker(station.control, period=0.01)
    try:
        plan, reported = worker.submit(lambda control: control.plan_jog(CartesianJog((2, 0, 0)), 10.0)).result(
            LONGEST_S
        )
        assert not reported
        worker.submit(lambda control: control.execute(plan)).result(LONGEST_S)
        worker.submit(lambda control: station.to_rest()).result(LONGEST_S)
        until(lambda: worker.state.pose is not None and worker.state.pose.tip[0] == pytest.approx(2.0, abs=1e-3))
    finally:
        worker.close()


def test_a_stop_that_does_not_show_is_an_emergency_until_it_does(worker, stub):
    go_on = threading.Event()
    stop = worker.submit(lambda control: go_on.wait(LONGEST_S), urgent=True)
    until(lambda: worker.state.emergency)
    assert worker.state.emergency == NOT_AT_REST
    go_on.set()
    assert stop.result(LONGEST_S)
    assert worker.state.emergency == ()


def test_the_end_waits_for_a_stop_but_not_for_ever(worker, stub):
    begun = threading.Event()

    def stop(control):
        begun.set()
        while not control.is_preempted():
            time.sleep(0.005)
        raise NotReadyError(["given up"])

    trying = worker.submit(stop, urgent=True)
    assert begun.wait(LONGEST_S)
    worker.close()
    with pytest.raises(NotReadyError, match="given up"):
        trying.result(0)
