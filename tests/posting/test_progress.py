# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress: called within every step, and able to stop the run at any of its calls."""

import numpy as np
import pytest
from programs import cone

from pkm_post.machine import machine_named
from pkm_post.posting import run
from pkm_post.posting.post_file import post_file
from pkm_post.posting.steps import post, step_names

PROGRAM = "G21 G90 G17 T1 M6\nS9000 M3\nG43 H1\nG0 X0 Y0 Z40\nF600\nG1 Z30\nG2 X20 Y0 I10 J0\nG1 X0\nG0 Z40\nM5\nM2\n"


class StoppedError(Exception):
    """Raised by a callback."""


@pytest.fixture(autouse=True)
def at_every_checkpoint(monkeypatch):
    monkeypatch.setattr(run, "_PROGRESS_PERIOD", 0.0)


def posted(folder, progress):
    return post(cone(60), machine_named("example_6tps")[0], folder / "part.pmc", progress=progress)


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    made = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "_PROGRESS_PERIOD", 0.0)
        posted(tmp_path_factory.mktemp("calls"), lambda *call: made.append(call))
    return made


def test_every_long_step_calls_while_it_goes_on(calls):
    names = [name for name, _ in calls]
    for step in set(step_names()) - {"collisions", "report"}:  # nothing to check here, and nothing that grows
        assert names.count(step) > 1, step


def test_shares_increase_from_0_to_1(calls):
    shares = np.array([share for _, share in calls])
    assert shares[0] == 0.0 and calls[-1] == ("", 1.0)
    assert (np.diff(shares) >= 0).all()


def test_steps_come_in_their_order(calls):
    names = [name for name, _ in calls if name]
    assert list(dict.fromkeys(names)) == list(step_names())


@pytest.mark.slow
def test_a_callback_stops_the_run_at_any_call_and_nothing_is_left(calls, tmp_path):
    for call in np.random.default_rng(3).choice(len(calls), 12, replace=False).tolist():
        left = iter(range(call))

        def progress(step, share, left=left):
            if next(left, None) is None:
                raise StoppedError

        with pytest.raises(StoppedError):
            posted(tmp_path, progress)
        assert list(tmp_path.iterdir()) == []


def test_reading_a_file_calls_too(tmp_path):
    (tmp_path / "part.ngc").write_text(PROGRAM, encoding="ascii")
    names = []
    post_file(tmp_path / "part.ngc", out=tmp_path / "out", tool_lengths={1: 120.0},
              arguments="--part none --stock none", progress=lambda name, share: names.append(name))  # fmt: skip
    assert names.count("reading") > 2
