# SPDX-License-Identifier: LGPL-2.1-or-later
"""Neither a process that is killed while it posts, nor two that post at once, leave a mixture that a reader accepts."""

import importlib
import json
import os
import subprocess
from pathlib import Path

import pytest
from interpreter import PYTHON
from killed_posts import MANIFEST, NAMES, post, whole, written
from series import cases

from pkm_post.system import staged
from pkm_post.system.lock import try_lock
from pkm_post.system.staged import BusyError
from pkm_post.writing import manifest

ROOT = Path(__file__).parents[2]
KILLS = cases(60)
POSTS = 40
RESULTS = sorted([*NAMES, MANIFEST])


def started(folder, *words):
    """A process with ``killed_posts.py``."""
    command = [PYTHON, str(Path(__file__).with_name("killed_posts.py")), str(folder), *map(str, words)]
    found = os.environ | {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(command, env=found, stdout=subprocess.PIPE, text=True)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="it kills copies of a process")
def test_no_kill_leaves_a_mixture(tmp_path):
    process = started(tmp_path, KILLS)
    reported, _ = process.communicate(timeout=300)
    assert process.returncode == 0
    found = json.loads(reported)
    assert {"earlier ones", "refused, earlier ones", "refused, none", "refused, new ones", "new ones"} == set(
        found["at every step"]
    )
    assert sum(found["at random"].values()) == KILLS
    assert {"refused, none", "refused, new ones", "new ones"} <= set(found["at random"])


@pytest.mark.slow
def test_two_that_post_at_once_end_one_after_the_other(tmp_path):
    ends = {tuple(manifest.fingerprint(name, written(text, name)) for name in NAMES): text for text in ("one", "two")}
    with started(tmp_path, "post", "one", POSTS) as one, started(tmp_path, "post", "two", POSTS) as two:
        while one.poll() is None or two.poll() is None:
            read, _ = manifest.check(tmp_path / NAMES[0])
            assert read is None or tuple(map(read.fingerprint_of, NAMES)) in ends
    assert (one.returncode, two.returncode) == (0, 0)
    assert whole(tmp_path) in ends.values()
    assert sorted(os.listdir(tmp_path)) == RESULTS


def test_a_process_that_does_not_end_moving_is_reported(tmp_path, monkeypatch):
    post(tmp_path, "earlier")
    monkeypatch.setattr(importlib.import_module("pkm_post.system.staged"), "_PATIENCE", 0.02)
    with try_lock(tmp_path / ".staged-lock"), pytest.raises(BusyError, match="another process has been moving files"):
        post(tmp_path, "new")
    assert whole(tmp_path) == "earlier"
    assert sorted(os.listdir(tmp_path)) == RESULTS


def test_what_the_dead_left_is_removed_and_what_the_living_write_stays(tmp_path):
    for name in (".staged-dead0000", ".staged-dead0001/new"):  # of an earlier version, and of one that was killed
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "part.pmc").write_text("half")
    (tmp_path / ".staged-dead0001" / "owner").write_text("")
    (tmp_path / ".staged-by-the-user").mkdir()
    with staged(tmp_path) as living:
        (living / "other.pmc").write_text("living")
        post(tmp_path, "new")
        assert living.is_dir()
    assert sorted(os.listdir(tmp_path)) == sorted([".staged-by-the-user", "other.pmc", *RESULTS])
