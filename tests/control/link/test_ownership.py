# SPDX-License-Identifier: LGPL-2.1-or-later
"""One client at a time moves a machine or loads into it; others watch and stop. Owners that died are passed over."""

import getpass
import os
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager

import numpy as np
import pytest
from interpreter import PYTHON
from link_faults import FIRST, small_program
from rig import SETTINGS, Wire, controller, served
from test_stopping import SLOW

from pkm_post.control.link import ownership, stopping
from pkm_post.control.link import run as operate
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import DiagnosedError, LinkLostError, NotOwnerError, NotReadyError, RefusedError
from pkm_post.control.link.owner_record import read_record
from pkm_post.control.link.ownership import SILENCE_S, claim, lock_path, owned
from pkm_post.control.link.ports import port_named
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import read_status, settled_status
from pkm_post.control.link.tool_pose import state_text
from pkm_post.model.rules import RULES
from pkm_post.system.lock import lock_owner, try_lock

KINDS = pytest.mark.parametrize("kind", ["serial", "tcp"])
PROGRAM = small_program()


class Shared(Wire):
    """A wire on which something else happens while a client looks whether another one is alive."""

    meanwhile = None

    def sleep(self, seconds):
        super().sleep(seconds)
        act, self.meanwhile = self.meanwhile, None
        if act is not None and seconds == ownership.POLL_S:
            act()
        self.meanwhile = act


def beside(wire):
    """Another client of the same port, with the same clock."""
    other = Wire(wire.controller, wire.kind, line=wire.line)
    other.clock, other.sleep, other.sent = wire.clock, wire.sleep, wire.sent
    return other


@contextmanager
def two(kind, moves=False):
    wire = Shared(controller(), kind, moves=moves)
    with wire.session() as one, beside(wire).session() as other:
        yield wire, one, other


ORDERS = {
    "download": lambda session: download(session, PROGRAM),
    "run": lambda session: operate.start_program(session, SETTINGS, PROGRAM, FIRST),
    "resume": lambda session: operate.resume_program(session, SETTINGS),
    "override": lambda session: operate.set_feed_override(session, SETTINGS, 50.0),
}


@KINDS
@pytest.mark.parametrize("name", ORDERS)
def test_what_moves_or_loads_needs_the_right_and_gives_it_back(kind, name):
    with two(kind) as (wire, one, other):
        with owned(one, "jog"), pytest.raises(NotOwnerError) as refused:
            wire.meanwhile = lambda: one.query("I3")
            sent = len(wire.sent)
            ORDERS[name](other)
        wire.meanwhile = None
        assert refused.value.diagnostic.code == "C210"
        assert "jog, since 20" in str(refused.value) and RULES["C210"].cure in str(refused.value)
        left = wire.sent[sent:].replace(b"P8187=P8187", b"").replace(b"P8188=P8188+1", b"")
        assert b"=" not in left, "nothing was set, but that the owner counts and gives back"
        download(other, PROGRAM)
        assert read_record(other).owner == 0


@KINDS
def test_others_watch_and_stop(kind):
    with two(kind, moves=True) as (wire, one, other):
        download(one, SLOW)
        with owned(one, "run"):
            operate.start_program(one, SETTINGS, SLOW, FIRST)
            wire.sleep(0.3)
            assert read_status(other, SETTINGS).running
            assert stopping.hold(other, SETTINGS).held
            assert stopping.abort(other, SETTINGS).standing
        assert not wire.controller.runs_program()


@KINDS
def test_a_download_that_is_refused_gives_the_right_back(kind):
    """No program can be opened while one runs [TSRM, OPEN PROG]: nothing was left open, and the next client goes on."""
    with two(kind, moves=True) as (wire, one, other):
        download(one, SLOW)
        operate.start_program(one, SETTINGS, SLOW, FIRST)
        wire.sleep(0.3)
        with pytest.raises(RefusedError, match="ERR001"):
            download(other, PROGRAM)
        assert read_record(one).owner == 0 and not other.has_open_buffer
        stopping.abort(one, SETTINGS)
        began = wire.now
        assert download(one, PROGRAM).lines == len(PROGRAM.lines) and wire.now - began < SILENCE_S


@KINDS
def test_an_owner_that_died_is_passed_over_when_nothing_is_seen_of_it(kind, caplog):
    with two(kind) as (wire, one, other):
        claim(one, "download")
        one.command("OPEN PROG 10")
        one.command("CLEAR")
        one.command("ABS")
        one.keeper = None  # it is gone, and its buffer is open
        began = wire.now
        assert download(other, PROGRAM).lines == len(PROGRAM.lines)
        assert SILENCE_S <= wire.now - began < 3 * SILENCE_S
        assert "its ownership is overridden" in caplog.text and "it was cleared" in caplog.text


@pytest.mark.slow
@KINDS
def test_an_owner_that_counts_or_loads_or_moves_is_not_passed_over(kind):
    with two(kind, moves=True) as (wire, one, other):
        download(one, SLOW)
        claim(one, "run")
        wire.meanwhile = lambda: one.query("I3")
        with pytest.raises(NotOwnerError, match="C210"):
            download(other, PROGRAM)
        wire.meanwhile = lambda: one.load(["A1:0"])
        for line in ("CLOSE", "OPEN PROG 11"):
            one.command(line)
        with pytest.raises(NotOwnerError, match="C210"):
            download(other, PROGRAM)
        wire.meanwhile = None
        one.command("CLOSE")
        operate.start_program(one, SETTINGS, SLOW, FIRST)
        wire.sleep(SILENCE_S)
        with pytest.raises(NotOwnerError, match="C210.*run"):
            download(other, PROGRAM)
        stopping.hold(other, SETTINGS)
        with pytest.raises(NotOwnerError, match="C210.*run"):  # a program that is held is somebody's, however silent
            download(other, PROGRAM)
        wire.meanwhile = lambda: one.query("I3")
        with pytest.raises(NotOwnerError, match="C210.*run"):
            operate.resume_program(other, SETTINGS)
        wire.meanwhile = None
        assert operate.resume_program(other, SETTINGS).running  # of an owner that is silent it may go on


@KINDS
def test_an_owner_that_was_silent_looks_before_it_sends(kind):
    with two(kind) as (wire, one, other):
        claim(one, "download")
        wire.sleep(SILENCE_S)
        with owned(other, "jog"):
            sent = len(wire.sent)
            with pytest.raises(NotOwnerError, match="C211.*jog"):
                one.command("P5=1")
            assert b"P5=1" not in wire.sent[sent:]
        assert read_record(other).owner == 0


@KINDS
def test_of_two_that_take_it_at_once_one_gets_it(kind):
    """Between the look of one and its assignment the other takes it."""
    with two(kind) as (_, one, other):
        asked, taken = one.query, []

        def ask(text, most=1 << 16):
            if "INT(1/" in text and not taken:
                taken.append(claim(other, "run"))
            return asked(text, most)

        one.query = ask
        with pytest.raises(NotOwnerError, match="C210.*run"):
            claim(one, "jog")
        assert taken and other.keeper is taken[0] and one.keeper is None
        other.keeper.check()


def test_a_controller_that_was_reset_has_forgotten_its_owner():
    with two("tcp") as (wire, one, _):
        claim(one, "jog")
        wire.controller.reset()
        wire.line.receive(b"I3=2\rI6=1\r")
        wire.sleep(SILENCE_S)
        one.command("P5=1")
        assert read_record(one).owner and one.query("P5") == ("1",)


@pytest.mark.parametrize("value", ["0.5", "-3"])
def test_variables_of_somebody_else_are_named(value):
    with two("tcp") as (wire, one, _):
        assert not wire.line.refusal(f"P8187={value}")
        with pytest.raises(DiagnosedError, match="C213.*P8187..8191"):
            claim(one, "jog")


def test_an_answer_without_sense_is_a_link_that_is_lost():
    with two("tcp") as (_, one, __):
        for reported in ((), ("1",), ("a", "b", "c", "d", "e"), ("nan",) * 5):
            one.query = lambda text, most=0, reported=reported: reported
            with pytest.raises((LinkLostError, DiagnosedError)):
                read_record(one)


def test_the_lock_of_this_computer_says_who_has_it(monkeypatch):
    for name in ("LOGNAME", "USER", "LNAME", "USERNAME"):  # as in cron: the system has the name
        monkeypatch.delenv(name, raising=False)
    with served(controller()) as name, Session(port_named(name)) as one, Session(port_named(name)) as other:
        with owned(one, "stream"), pytest.raises(NotOwnerError) as refused:
            claim(other, "jog")
        owner = f"process {os.getpid()} of {getpass.getuser()}, stream, since 20"
        assert owner in str(refused.value)
        assert not lock_path(name).exists()
        claim(other, "jog").release()


_CLIENT = """
import sys
sys.path[:0] = {paths!r}
from pkm_post.control.link.ports import port_named
from pkm_post.control.link.session import Session
from pkm_post.control.link.ownership import claim
session = Session(port_named(sys.argv[1]))
session.open()
claim(session, "download")
for line in ("OPEN PROG 10", "CLEAR", "ABS"):
    session.command(line)
print("taken", flush=True)
sys.stdin.read()
"""


@pytest.mark.slow
def test_a_client_that_was_killed_locks_nobody_out():
    with served(controller(), speed=10.0) as name:
        script = _CLIENT.format(paths=[path for path in sys.path if path])
        child = subprocess.Popen([PYTHON, "-c", script, name], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        try:
            assert child.stdout.readline() == b"taken\n"
            with Session(port_named(name)) as session, pytest.raises(NotOwnerError, match="download"):
                download(session, PROGRAM)
            assert lock_owner(lock_path(name))["process"] == child.pid
        finally:
            child.send_signal(signal.SIGKILL)
            child.communicate(timeout=120)
        with Session(port_named(name)) as session:
            assert download(session, PROGRAM).lines == len(PROGRAM.lines)
        with try_lock(lock_path(name)) as lock:
            assert lock is not None


def test_a_lock_that_cannot_be_kept_is_named(monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "missing"))
    with served(controller()) as name, Session(port_named(name)) as session:
        with pytest.raises(DiagnosedError, match="C212"):
            claim(session, "jog")
        assert session.keeper is None


def test_serial_lines_have_one_lock_by_all_their_names(tmp_path):
    device, link = tmp_path / "ttyUSB0", tmp_path / "by-id"
    device.touch()
    link.symlink_to(device)
    assert lock_path(f"serial:{device}") == lock_path(f"serial:{link}") != lock_path("serial:/dev/ttyUSB1")
    assert lock_path("tcp:Host:1025") == lock_path("tcp:host:1025") != lock_path("tcp:host:1026")


@KINDS
def test_a_machine_that_moves_without_a_program_is_seen_to_move(kind):
    wire = Wire(controller(), kind, moves=True)
    with wire.session() as session:
        download(session, PROGRAM)
        assert not wire.line.refusal("#3J+")
        wire.sleep(0.3)
        status = settled_status(session, SETTINGS)
        assert not status.running and not status.standing
        assert "no program runs, BUT THE MACHINE MOVES" in state_text(status)
        with pytest.raises(NotReadyError, match="strut 3: moves"):
            operate.start_program(session, SETTINGS, PROGRAM, FIRST, start_tolerance=1000.0)


def test_struts_that_turn_round_or_sink_are_seen_to_move():
    """The controller wants them to stand, at that moment or for good."""
    wire = Wire(controller(), "tcp", moves=True)
    with wire.session() as session:
        assert settled_status(session, SETTINGS).standing
        motors, advance = wire.controller.motors, wire.controller.advance

        def sinking(ms):
            advance(ms)
            motors.actual[4] -= 0.002 * SETTINGS.counts_per_mm * ms
            motors.commanded[4] = motors.actual[4]

        wire.controller.advance = sinking
        assert read_status(session, SETTINGS).standing
        status = settled_status(session, SETTINGS)
        assert not status.standing and [bits.has("standing") for bits in status.motors].index(False) == 4
        assert np.isfinite(status.length).all()


def test_threads_of_one_process_are_clients_as_well():
    with served(controller()) as name:
        got, start = [], threading.Barrier(4, timeout=120)

        def client():
            with Session(port_named(name)) as session:
                start.wait()
                try:
                    claim(session, "jog")
                except NotOwnerError:
                    got.append("refused")
                else:
                    got.append("taken")
                start.wait()

        threads = [threading.Thread(target=client) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(30)
        assert sorted(got) == ["refused"] * 3 + ["taken"]
