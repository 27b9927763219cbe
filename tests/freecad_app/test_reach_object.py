# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach in the document: findings by property, the way with its margins, what follows and what is kept."""

import numpy as np
import pytest
from cam_jobs import BELOW, ON_EXAMPLE, add_operation, job_in_reach, reopened

from pkm_post.freecad_app.job_setup import study_job
from pkm_post.freecad_app.machine_object import create_machine
from pkm_post.freecad_app.reach_object import create_reach, machine_for, thinned
from pkm_post.freecad_gui.verdict_icons import verdict_of

NANOMETRE = 1e-6


@pytest.fixture
def job(document):
    job = job_in_reach(document, BELOW)
    add_operation(job)
    return job


@pytest.fixture
def found(job):
    made = create_reach(job)
    job.Document.recompute()
    return made


def test_findings_are_those_of_the_study(job, found):
    assert found.Reachable
    assert found.Violations and all("warning K128" in line for line in found.Violations)  # slower rapid moves, no more
    checks = study_job(job).reach.as_dict()["checks"]
    assert list(found.Checks) == [check["name"] for check in checks]
    assert list(found.LeastMargins) == pytest.approx([check["margin"] for check in checks], abs=NANOMETRE)
    assert list(found.WorstLines) == [check["worst"]["line"] for check in checks]
    assert set(found.WorstOperations) == {"Cut"}


def test_reach_that_is_switched_off_says_nothing_about_a_changed_job(job, found):
    assert [verdict_of(item) for item in (found, job, job.Operations.Group[0])] == [True] * 3
    found.Active = False
    job.Operations.Group[0].Gcode = ["G0 X0 Y0 Z30", "G1 X900 F5"]
    job.Document.recompute()
    assert found.Reachable  # of the job before
    assert [verdict_of(item) for item in (found, job, job.Operations.Group[0])] == [None] * 3


def test_the_way_ends_where_the_operation_ends_and_worst_points_lie_on_it(found):
    # FIVE_AXIS of cam_jobs ends at (10, 4, 30)
    assert tuple(found.Points[-1]) == pytest.approx((10, 4, 30), abs=NANOMETRE)
    points = np.array(found.Points)
    for point in found.WorstPoints:
        assert np.linalg.norm(points - np.array(point), axis=1).min() < NANOMETRE
    assert len(found.Margins) == len(points)


def test_another_check_colours_without_checking_anew(job, found):
    before = found.Points
    found.ColourBy = "base joints"
    assert min(found.Margins) == pytest.approx(found.LeastMargins[list(found.Checks).index("base joints")])
    assert found.Points == before
    job.Document.recompute()
    assert found.ColourBy == "base joints"


def test_it_follows_the_job_and_tells_what_is_out_of_limits(job, found):
    job.PostProcessorArgs = ON_EXAMPLE.format("600,0,200,10")
    job.Document.recompute()
    assert not found.Reachable
    assert min(found.LeastMargins) < 0
    assert any("K10" in line for line in found.Violations)
    found.Active = False
    job.PostProcessorArgs = ON_EXAMPLE.format("0,0,250")
    job.Document.recompute()
    assert not found.Reachable
    found.Active = True
    job.Document.recompute()
    assert found.Reachable


def test_a_machine_object_says_what_the_job_runs_on(job, found):
    machine = create_machine(job.Document, "linuxcnc_genhexkins", job)
    assert machine_for(job) == machine
    found.Machine = machine
    job.Document.recompute()
    # genhexkins states no bodies: nothing but struts, joints, singular poses and speeds can be checked
    assert not any("platform and" in name or "strut and" in name for name in found.Checks)
    machine.Job, machine.WorkOffset.Base.z = None, 400
    job.Document.recompute()
    lower = list(found.LeastMargins)
    machine.WorkOffset.Base.z = 500
    job.Document.recompute()
    assert list(found.LeastMargins) != lower


def test_a_job_that_cannot_be_read_leaves_no_old_result(job, found):
    job.PostProcessorArgs = "--machine no_such_machine"
    job.Document.recompute()
    assert not found.isValid()
    assert not found.Reachable
    assert (list(found.Checks), list(found.Points)) == ([], [])


def test_without_a_job_nothing_is_left(job, found):
    found.Job = None
    job.Document.recompute()
    assert found.isValid()
    assert (list(found.Checks), found.Reachable) == ([], False)


def test_it_survives_saving(job, found, tmp_path):
    margins, worst = list(found.Margins), list(found.WorstPoints)
    again = reopened(job.Document, tmp_path / "reach.FCStd").getObject("Reach")
    assert type(again.Proxy).__module__ == "pkm_post.freecad_app.reach_object"
    assert (list(again.Margins), list(again.WorstPoints)) == (margins, worst)
    again.ColourBy = "base joints"
    again.Document.recompute()
    assert min(again.Margins) == pytest.approx(again.LeastMargins[list(again.Checks).index("base joints")])


def test_one_undo_takes_it_back(job):
    document = job.Document
    document.UndoMode = 1
    document.openTransaction("Reach")
    create_reach(job)
    document.commitTransaction()
    document.recompute()
    document.undo()
    assert document.getObject("Reach") is None


def test_undo_leaves_no_findings_of_the_undone_state(job, found):
    document, operation = job.Document, job.Operations.Group[0]
    document.UndoMode = 1
    assert found.Proxy.study is not None
    before = list(found.Violations), list(found.Points), list(found.Margins), str(found.ColourBy)
    document.openTransaction("Edit")
    operation.Gcode = [*operation.Gcode, "G1 X900 Y4 Z30 I0 J0 K1 F20"]
    found.ColourBy = found.Checks[0]
    document.recompute()
    document.commitTransaction()
    assert len(found.Violations) == len(found.Proxy.study.findings) > len(before[0])
    document.undo()
    assert (list(found.Violations), list(found.Points), list(found.Margins), str(found.ColourBy)) == before
    assert found.Proxy.study is None
    document.recompute()
    assert found.Proxy.study is not None and list(found.Violations) == before[0]


def test_thinning_keeps_the_worst_and_both_ends():
    margin = np.random.default_rng(7).normal(size=5000)
    rows = thinned(margin, 100)
    assert len(rows) <= 100
    assert np.all(np.diff(rows) > 0)
    assert {0, int(np.argmin(margin)), 4999} <= set(rows.tolist())
    np.testing.assert_array_equal(thinned(margin, 5000), np.arange(5000))
