# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sessions with bad luck, drawn by a seed, and what has to hold of each: the machine rests, or moves as was certified.

A program runs, or is streamed. Something happens meanwhile: a stop whose own bytes are hit by noise, a signal, a client
that is killed, another client that does whatever it likes, a link that dies. At every moment all struts are in step, as
the program has them, unless an abort was carried out; at the end the machine rests, and the next client can work. Only
the simulator's clock passes.
"""

import copy
import functools
import logging
import random
import threading
from dataclasses import replace

import numpy as np
from rig import SETTINGS, Wire, carried, controller
from streams import MICRON, REACH, WORDS, swings

from pkm_post.cli.pmac_stop import held_at_the_end
from pkm_post.control.link import run as operate
from pkm_post.control.link import stopping
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, NotOwnerError, PmacError
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.session import OpenBufferPolicy
from pkm_post.control.link.status import read_status
from pkm_post.control.link.stream import stream

JOB = swings(interval=40)
LENGTH_S = JOB.motion.time_ms[-1] / 1000
TICK_MS, LOOK_MS = 20.0, 100.0
LONGEST_STOP_S = 25.0
"""All rungs, some of them twice, under noise that does not end."""
LONGEST_S = 120.0
STOPS = (b"&1H", b"&1A", b"\x01", b"\x0b")
"""Bytes of the rungs: hold, abort, abort of everything, power off."""


class Killed(BaseException):
    """The process of a client is gone: nothing of it is carried out any more, no cleaning up either."""


class Turns:
    """Clients in threads of which one runs at a time; when all wait, the clock passes until the first is due."""

    def __init__(self, advance):
        self.now, self._advance, self._over = 0.0, advance, threading.Semaphore(0)
        self._gates, self._due = {}, {}

    def sleep(self, seconds):
        me = threading.current_thread()
        if me not in self._gates:  # a thread without a gate
            self._pass(self.now + seconds)
            return
        self._due[me] = self.now + seconds
        if self._next() is not me:
            self._gates[me].acquire()

    def play(self, *clients):
        """Run all; what each has returned or raised."""
        ended = [None] * len(clients)

        def run(place):
            self._gates[threading.current_thread()].acquire()
            try:
                ended[place] = clients[place]()
            except BaseException as fault:
                ended[place] = fault
            self._next()

        threads = [threading.Thread(target=run, args=(place,)) for place in range(len(clients))]
        self._gates = {thread: threading.Semaphore(0) for thread in threads}
        self._due = dict.fromkeys(threads, self.now)
        for thread in threads:
            thread.start()
        self._next()
        self._over.acquire()
        self._gates = {}
        for thread in threads:
            thread.join()
        return ended

    def _next(self):
        """Let the client go on that is due first; which one."""
        if not self._due:
            self._over.release()
            return None
        first = min(self._due, key=self._due.get)
        self._pass(self._due.pop(first))
        if first is not threading.current_thread():
            self._gates[first].release()
        return first

    def _pass(self, until):
        self._advance(1000 * max(until - self.now, 0.0))
        self.now = max(until, self.now)


class Machine(Wire):
    """A wire to a machine whose every position is looked at, and that has more than one client.

    Attributes:
        due: when, in s, and what happens then to the client of this wire; None for nothing.
        aborted: whether an abort or a kill was carried out, so that the struts leave the path.
    """

    def __post_init__(self):
        super().__post_init__()
        self.due, self.aborted, self.off = None, False, 0.0
        self.turns = Turns(self._advance)
        for system in self.controller.systems[:1]:
            forget = system.forget

            def forgotten(forget=forget):
                self.aborted = True
                forget()

            system.forget = forgotten

    def _advance(self, ms):
        for _ in range(round(ms / LOOK_MS)):
            self._look(LOOK_MS)
        self._look(ms % LOOK_MS)

    def _look(self, ms):
        self.controller.advance(ms)
        if not self.aborted:
            course = (self.controller.motors.commanded / SETTINGS.counts_per_mm) / REACH
            self.off = max(self.off, float(np.ptp(course)))

    def sleep(self, seconds):
        self.turns.sleep(seconds)
        self.now = self.turns.now
        if self.due and self.due[0] <= self.now:
            act, self.due = self.due[1], None
            act()

    def beside(self):
        """A wire of another client to the same port."""
        return Beside(self)


class Beside(Wire):
    """The wire of another client."""

    def __init__(self, first):
        super().__init__(first.controller, first.kind, line=first.line)
        self._first = first

    def sleep(self, seconds):
        self._first.turns.sleep(seconds)
        self.now = self._first.turns.now


@functools.cache
def _loaded():
    """A controller with a rotary buffer, and the program in its memory."""
    made = controller()
    made.settings = replace(made.settings, tick_ms=TICK_MS)
    wire = Wire(made, "tcp")
    assert not wire.line.refusal(f"&1DEFINE ROT {WORDS}") and not wire.line.refusal("I5195=8220 I6=1 I3=2 I4=0 I9=3")
    with wire.session() as session:
        download(session, JOB.program)
    return made


def machine(kind):
    made = _loaded()
    return Machine(copy.deepcopy(made, {id(made._kept): made._kept}), kind, moves=True)


def begun(choice, session, until=LONGEST_S):
    """The program on its way, by the way that is drawn, to its end, or until it was waited for long enough."""
    if choice.random() < 0.5:
        stream(session, SETTINGS, JOB.program, JOB.first, WORDS, is_cancelled=lambda: session.now() > until)
        return
    with owned(session, "run"):
        operate.start_program(session, SETTINGS, JOB.program, JOB.first)
        while read_status(session, SETTINGS).running and session.now() < until:
            session.sleep(0.2)


def noisy(choice, wire, share):
    """Let noise hit the very bytes of stops, so often."""

    def fault(data, out):
        hit = next((stop for stop in STOPS if stop in data), None) if out else None
        if hit is None or choice.random() > share:
            return data
        place, kind = data.index(hit) + choice.randrange(len(hit)), choice.randrange(4)
        changed = bytes([data[place] ^ 1 << choice.randrange(7)])
        if changed[0] < 0x20:
            changed = b"\xff"  # a letter that becomes a control character stops the machine as well, in its own way
        return (
            data[:place]
            + (changed, b"", b"\x80" + data[place : place + 1], 2 * data[place : place + 1])[kind]
            + data[place + 1 :]
        )

    wire.fault = fault


def stopped(choice, session, wire):
    """Give a stop, and see that the machine rests when it says so."""
    stop = choice.choice((stopping.hold, stopping.abort, lambda *of: stopping.abort(*of, at_once=True)))
    began = wire.now
    status = stop(session, SETTINGS)
    assert status.standing and wire.now - began < LONGEST_STOP_S
    assert_at_rest(wire)


def assert_at_rest(wire, seconds=0.1):
    before = np.array(wire.controller.motors.commanded)
    wire.controller.advance(1000 * seconds)
    assert np.abs(wire.controller.motors.commanded - before).max() < MICRON, "it does not rest"


def _stop_under_noise(choice, wire):
    """From elsewhere, while the client goes on; over TCP nothing is changed on the way."""
    other = wire.beside()

    def stop():
        other.sleep(choice.uniform(0.1, LENGTH_S))
        if wire.kind == "serial":
            noisy(choice, other, choice.choice((0.3, 0.7, 0.95)))
        with other.session(open_buffer=OpenBufferPolicy.STOP) as session:
            stopped(choice, session, other)
            other.fault = carried
            stopping.abort(session, SETTINGS)  # a stream waits as long as it is held

    def work():
        with wire.session() as session:
            until = wire.now + 2 * LENGTH_S
            session.preempt_when(lambda: wire.now > until)
            begun(choice, session, until)

    ended = wire.turns.play(work, stop)
    _raise_unless(ended[0], PmacError)
    _raise_unless(ended[1])
    return "stopped"


def _raise_unless(ended, *expected):
    if isinstance(ended, BaseException) and not isinstance(ended, expected):
        raise ended


def _signal(choice, wire):
    """SIGINT, SIGTERM and SIGHUP are exceptions in the client, anywhere, while its stops are hit by noise."""

    def end():
        if wire.kind == "serial":
            noisy(choice, wire, choice.choice((0.0, 0.5, 0.9)))
        raise choice.choice((KeyboardInterrupt, SystemExit))

    with wire.session() as session:
        wire.due = wire.now + choice.uniform(0.05, LENGTH_S), end
        try:
            with held_at_the_end(session, SETTINGS):
                begun(choice, session)
                wire.due = None
        except (PmacError, SystemExit):
            assert_at_rest(wire)
            return "held"
    return "ended"


def _killed(choice, wire):
    """The process is gone between two bytes; what it let go runs to where it rests, and the next client works."""

    def kill():
        wire.fault = _dead
        raise Killed

    session = wire.session()
    session.open()
    wire.due = wire.now + choice.uniform(0.05, LENGTH_S), kill
    try:
        begun(choice, session)
    except Killed:
        return "killed"
    wire.due = None
    return "ended"


def _dead(data, out):
    raise Killed


def _second_client(choice, wire):
    """Whatever another client does: the program goes to its end, unless it is stopped; then it rests."""
    other, done, over = wire.beside(), [], []

    def act():
        for _ in range(3):
            other.sleep(choice.uniform(0.05, LENGTH_S / 2))
            done.append(choice.choice(tuple(_ACTS)))
            try:
                with other.session(
                    open_buffer=choice.choice((OpenBufferPolicy.LEAVE, OpenBufferPolicy.STOP))
                ) as session:
                    _ACTS[done[-1]](session)
            except PmacError:
                pass
            if over:
                return

    def work():
        with wire.session() as session:
            try:
                begun(choice, session)
            finally:
                over.append(True)

    ended = wire.turns.play(work, act)
    _raise_unless(ended[1])
    if isinstance(ended[0], NotOwnerError):
        return "came second"
    _raise_unless(ended[0], *([PmacError] if "abort" in done or "hold" in done else []))
    return "stopped by the other" if isinstance(ended[0], PmacError) else "to its end"


_ACTS = {
    "download": lambda session: download(session, JOB.program),
    "run": lambda session: operate.start_program(session, SETTINGS, JOB.program, JOB.first),
    "stream": lambda session: stream(session, SETTINGS, JOB.program, JOB.first, WORDS),
    "override": lambda session: operate.set_feed_override(session, SETTINGS, 50.0),
    "status": lambda session: read_status(session, SETTINGS),
    "hold": lambda session: _hold_for_a_while(session),
    "abort": lambda session: stopping.abort(session, SETTINGS),
}


def _dead_link(choice, wire):
    """Cut at any byte, for good or not; a stop is tried for a while, and the machine rests by itself."""
    wire.cut_at, wire.mends = wire.passed + choice.randrange(200, 9000), choice.random() < 0.5
    session = wire.session()
    try:
        session.open()
        begun(choice, session)
    except PmacError:
        pass
    until = wire.now + 2.0
    session.preempt_when(lambda: wire.now > until)
    try:
        stopping.hold(session, SETTINGS)
    except CancelledError:
        return "not reached"
    assert_at_rest(wire)
    return "held"


def _hold_for_a_while(session):
    stopping.hold(session, SETTINGS)
    session.sleep(0.3)
    try:
        operate.resume_program(session, SETTINGS)
    except PmacError:
        stopping.abort(session, SETTINGS)


_BAD_LUCK = {
    "noise on a stop": _stop_under_noise,
    "signal": _signal,
    "killed": _killed,
    "second client": _second_client,
    "dead link": _dead_link,
}


def by_chance(seed):
    """A session that the seed decides; what happened, and how it ended."""
    choice = random.Random(seed)
    wire = machine(choice.choice(("serial", "tcp")))
    luck = choice.choice(tuple(_BAD_LUCK))
    how = _BAD_LUCK[luck](choice, wire)
    assert wire.now < LONGEST_S, "it takes too long"
    _assert_all_is_well(wire)
    return luck, how


def _assert_all_is_well(wire):
    """On its path to the end; then at rest; and the next client stops what is held and can work."""
    wire.due = None
    assert wire.off < MICRON, f"the struts were out of step by {wire.off} mm"
    until = wire.now + 6 * LENGTH_S  # somebody may have set a slower override
    while wire.controller.runs_program() and wire.now < until:
        wire.sleep(LENGTH_S / 4)
    wire.sleep(0.5)
    assert wire.off < MICRON and wire.controller.systems[0].path.abrupt_stops == 0
    assert_at_rest(wire, 1.0)
    with wire.beside().session(open_buffer=OpenBufferPolicy.STOP) as session:
        stopping.abort(session, SETTINGS)
        assert not wire.controller.runs_program()
        if wire.controller.motors.closed.all():
            download(session, JOB.program)


def quiet():
    """Say nothing of what is expected to fail."""
    logging.disable(logging.CRITICAL)
