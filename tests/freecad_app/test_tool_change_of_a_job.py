# SPDX-License-Identifier: LGPL-2.1-or-later
"""A CAM job with two tools on a machine with a tool-change pose: what is posted, and what the simulation shows."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from cam_jobs import FIVE_AXIS, add_operation, add_tool_controller, job_in_reach  # noqa: E402
from machines import tool_change_file  # noqa: E402

from pkm_post.freecad_app.post_job import post_job  # noqa: E402
from pkm_post.freecad_app.simulation import simulate_job  # noqa: E402
from pkm_post.model import EventKind  # noqa: E402
from pkm_post.options.choices import Options  # noqa: E402

MICRON = 1e-3
ON_TABLE = Options(work_offset=np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 200], [0, 0, 0, 1]]))


@pytest.fixture
def job(document, tmp_path):
    """Two tools of other lengths; the first one is tilted where it leaves."""
    job = job_in_reach(document)
    job.PostProcessorArgs = f"--machine {tool_change_file(tmp_path)} --work-offset=0,0,200"
    add_operation(job, FIVE_AXIS[:-1], "Tilted")
    second = add_tool_controller(job, 2)
    add_operation(job, FIVE_AXIS, "Again").ToolController = second
    document.recompute()
    return job


def test_it_is_posted_with_its_tool_changes(job, tmp_path):
    report = post_job(job, tool_change_file(tmp_path), tmp_path / "out", ON_TABLE).report
    assert report["certificate"]["holds"]
    assert report["program"]["operations"] == ["Tilted", "Again", "tool change T1", "tool change T2"]
    times = {operation["name"]: operation for operation in report["machining_time"]["operations"]}
    assert all(times[f"tool change T{number}"]["rapid_s"] > 0.1 for number in (1, 2))
    # The spindle starts with 9000 and with 5000 of 24000 rpm, in 2 s to the highest, and stops in 3 s from there.
    assert times["tool change T2"]["dwell_s"] == pytest.approx(2 * 5 / 24 + 3 * 9 / 24, abs=3e-3)


def test_the_simulation_stands_at_the_pose_at_each_change(job):
    simulation = simulate_job(job)
    pose = simulation.machine.tool_change
    changes = [event.row for event in simulation.motion.events if event.kind is EventKind.TOOL_CHANGE]
    assert len(changes) == 2
    tip, axis, spin, length = simulation.pose_at(simulation.motion.time_ms[changes] / 1000.0)
    np.testing.assert_allclose(tip + length[:, None] * axis, np.tile(pose.nose, (2, 1)), atol=MICRON)
    np.testing.assert_allclose(spin, pose.spin, atol=1e-6)
