# SPDX-License-Identifier: LGPL-2.1-or-later
"""A lock belongs to one process, says whose it is, and goes with it."""

import stat
import subprocess

from interpreter import PYTHON

from pkm_post.system.lock import lock_owner, try_lock

_CHILD = """
import sys, time
from pathlib import Path
from pkm_post.system.lock import try_lock
lock = try_lock(Path(sys.argv[1]))
lock.describe({"what": "child"})
print("locked", flush=True)
sys.stdin.read()
"""


def test_a_lock_is_had_once_and_says_whose_it_is(tmp_path):
    path = tmp_path / "a.lock"
    with try_lock(path) as lock:
        lock.describe({"what": "a long word that is followed by a short one"})
        lock.describe({"what": "jog"})
        assert try_lock(path) is None
        assert lock_owner(path) == {"what": "jog"}
    assert not list(tmp_path.iterdir())
    try_lock(path).release()


def test_a_process_that_is_killed_leaves_no_lock(tmp_path):
    path = tmp_path / "a.lock"
    child = subprocess.Popen([PYTHON, "-c", _CHILD, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        assert child.stdout.readline().split() == [b"locked"]
        assert try_lock(path) is None and lock_owner(path) == {"what": "child"}
    finally:
        child.kill()
        child.communicate(timeout=120)
    assert path.exists()
    try_lock(path).release()


def test_other_users_of_the_computer_can_take_it_too(tmp_path):
    path = tmp_path / "a.lock"
    with try_lock(path):
        assert stat.S_IMODE(path.stat().st_mode) == 0o666


def test_words_that_are_none(tmp_path):
    path = tmp_path / "a.lock"
    assert lock_owner(path) == {}
    for said in (b"", b"{", b"[1]", b"\xff\xfe"):
        path.write_bytes(said)
        assert lock_owner(path) == {}
