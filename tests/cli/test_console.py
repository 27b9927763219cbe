# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ctrl-C in a console of Windows, simulated: which processes it reaches, and how the others are interrupted."""

import os
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from interpreter import PYTHON

from pkm_post.cli import parallel, terminal

NO_WINDOW, NEW_GROUP, CTRL_BREAK = 0x08000000, 0x200, 1


@pytest.fixture
def windows(monkeypatch):
    """The flags of Windows, and processes without groups and signals of POSIX."""
    monkeypatch.setattr(terminal, "_NO_WINDOW", NO_WINDOW)
    monkeypatch.setattr(terminal, "_NEW_GROUP", NEW_GROUP)
    monkeypatch.setattr(terminal, "BREAK", CTRL_BREAK)
    monkeypatch.setattr(parallel, "_HAS_GROUPS", False)


class Running(SimpleNamespace):
    """A process that runs, and keeps what is done to it."""

    def __init__(self):
        super().__init__(done=[])

    def poll(self):
        return None

    def send_signal(self, number):
        self.done.append(number)

    def terminate(self):
        self.done.append("terminated")


@pytest.mark.parametrize(("has", "with_us", "by_us"), [(True, 0, NEW_GROUP), (False, NO_WINDOW, NO_WINDOW)])
def test_no_window_opens_and_ctrl_c_reaches_what_it_should(windows, monkeypatch, has, with_us, by_us):
    monkeypatch.setattr(terminal, "has_console", lambda: has)
    assert (terminal.flags_with_us(), terminal.flags_by_us()) == (with_us, by_us)


@pytest.mark.parametrize(("has", "done"), [(True, CTRL_BREAK), (False, "terminated")])
def test_parallel_processes_get_a_break_in_place_of_ctrl_c(windows, monkeypatch, has, done):
    monkeypatch.setattr(terminal, "has_console", lambda: has)
    child = parallel.Child(["post"], {}, Running())
    child.interrupt()
    assert child.process.done == [done]
    assert not child.is_wanted


def test_a_break_is_a_keyboard_interrupt(monkeypatch):
    if not hasattr(signal, "SIGBREAK"):
        monkeypatch.setattr(signal, "SIGBREAK", signal.SIGUSR1, raising=False)
    monkeypatch.setattr(terminal, "_ENDS", ("SIGBREAK",))
    before = signal.getsignal(signal.SIGBREAK)
    try:
        terminal.interrupt_on_end()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGBREAK)
    finally:
        signal.signal(signal.SIGBREAK, before)


@pytest.mark.skipif(os.name != "posix", reason="raises the signal as a terminal of POSIX does")
def test_a_command_in_freecad_may_tidy_up_after_ctrl_c(tmp_path):
    """Both processes get the signal, and the inner one needs longer than Python would wait by itself."""
    inner = f"""
import pathlib, time
try:
    pathlib.Path({str(tmp_path / "begun")!r}).touch()
    time.sleep(60)
except KeyboardInterrupt:
    time.sleep(1)
    pathlib.Path({str(tmp_path / "tidied up")!r}).touch()
"""
    outer = f"""
import sys
from pkm_post.cli import processes
try:
    processes._run_with_us([{PYTHON!r}, "-c", {inner!r}])
except KeyboardInterrupt:
    sys.exit(130)
"""
    process = subprocess.Popen(
        [PYTHON, "-c", outer], env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}, start_new_session=True
    )
    end = time.monotonic() + 300
    while not (tmp_path / "begun").exists() and time.monotonic() < end:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(60) == 130
    assert (tmp_path / "tidied up").exists()
