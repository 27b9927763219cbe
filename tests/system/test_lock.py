# SPDX-License-Identifier: LGPL-2.1-or-later
"""A lock belongs to one process, says whose it is, and goes with it."""

import signal
import stat
import subprocess

from interpreter import PYTHON

from pkm_post.system.lock import locked, words_of

_CHILD = """
import sys, time
from pathlib import Path
from pkm_post.system.lock import locked
lock = locked(Path(sys.argv[1]))
lock.say({"what": "child"})
print("locked", flush=True)
sys.stdin.read()
"""


def test_a_lock_is_had_once_and_says_whose_it_is(tmp_path):
    path = tmp_path / "a.lock"
    with locked(path) as lock:
        lock.say({"what": "a long word that is followed by a short one"})
        lock.say({"what": "jog"})
        assert locked(path) is None
        assert words_of(path) == {"what": "jog"}
    assert not list(tmp_path.iterdir())
    locked(path).release()


def test_a_process_that_is_killed_leaves_no_lock(tmp_path):
    path = tmp_path / "a.lock"
    child = subprocess.Popen([PYTHON, "-c", _CHILD, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        assert child.stdout.readline() == b"locked\n"
        assert locked(path) is None and words_of(path) == {"what": "child"}
    finally:
        child.send_signal(signal.SIGKILL)
        child.communicate(timeout=20)
    assert path.exists()
    locked(path).release()


def test_other_users_of_the_computer_can_take_it_too(tmp_path):
    path = tmp_path / "a.lock"
    with locked(path):
        assert stat.S_IMODE(path.stat().st_mode) == 0o666


def test_words_that_are_none(tmp_path):
    path = tmp_path / "a.lock"
    assert words_of(path) == {}
    for said in (b"", b"{", b"[1]", b"\xff\xfe"):
        path.write_bytes(said)
        assert words_of(path) == {}
