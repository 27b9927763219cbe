# SPDX-License-Identifier: LGPL-2.1-or-later
"""One study of a job for Reach, Simulation and posting: the same findings, computed once, again after a change."""

import dataclasses
import re

import FreeCAD as App
import numpy as np
import Part
import pytest
from cam_jobs import BELOW, add_operation, job_in_reach

from pkm_post.freecad_app import job_study
from pkm_post.freecad_app.job_setup import placed_job, study_job
from pkm_post.freecad_app.job_study import digest
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.reach_object import create_reach
from pkm_post.freecad_app.simulation_object import create_simulation
from pkm_post.freecad_app.tools import set_gauge_length
from pkm_post.machine import find_machine
from pkm_post.model import Refused, errors

THROUGH_THE_PART = ["G0 X0 Y0 Z60", "G0 Z-15", "G1 X2 Y1 Z-15 F25", "G0 Z60"]


@pytest.fixture
def job(document):
    made = job_in_reach(document, BELOW)
    add_operation(made)
    return made


@pytest.fixture
def checks(monkeypatch):
    """Counts how often the checks run."""
    run, calls = job_study.check_path_of, []
    monkeypatch.setattr(job_study, "check_path_of", lambda *given: calls.append(given) or run(*given))
    return calls


def test_a_collision_is_the_same_wherever_it_is_asked_for(document, job, tmp_path):
    operation = document.getObject("Custom")
    operation.Gcode = THROUGH_THE_PART
    reach, simulation = create_reach(job), create_simulation(job)
    document.recompute()
    with pytest.raises(Refused) as refused:
        post_job(job, out=tmp_path)
    codes = {each.code for each in errors(refused.value.diagnostics)}
    assert codes and min(reach.LeastMargins) > -1e3  # it is not for its struts alone
    assert not reach.Reachable and not simulation.Followable
    told = [line for line in reach.Violations if "error" in line]
    assert sorted(told) == sorted(str(each) for each in errors(refused.value.diagnostics))
    assert {(name, line) for name, line in zip(simulation.WorstOperations, simulation.WorstLines, strict=True)} >= {
        (each.place.operation, each.place.line) for each in errors(refused.value.diagnostics)
    }
    assert reach.ViolationOperations == ["Cut"] * len(reach.Violations)
    assert len(reach.ViolationPoints) == len(reach.ViolationLines) == len(reach.Violations)


def test_the_checks_run_once_for_all_who_show_them(document, job, checks):
    reach, simulation = create_reach(job), create_simulation(job)
    document.recompute()
    assert len(checks) == 1
    assert reach.Proxy.study is simulation.Proxy.plan.study is placed_job(job).study()
    reach.Label = "Another name"
    reach.touch()
    document.recompute()
    assert len(checks) == 1


CHANGES = ["path", "tool length", "tool diameter", "stock", "offset", "tolerance", "part", "machine"]


def _change(document, job, what, folder):
    """Change one thing that checks depend on."""
    controller = job.Tools.Group[0]
    if what == "path":
        operation = document.getObject("Custom")
        operation.Gcode = [*operation.Gcode, "G0 X11 Y4 Z30"]
    elif what == "tool length":
        set_gauge_length(controller, 121)
    elif what == "tool diameter":
        controller.Tool.Diameter = "7 mm"
    elif what == "stock":
        job.Stock.ExtZpos = "3 mm"
    elif what == "offset":
        job.PostProcessorArgs = job.PostProcessorArgs.replace("0,0,250", "0,0,251")
    elif what == "tolerance":
        job.PostProcessorArgs += " --tip-tolerance=0.003"
    elif what == "part":
        document.getObject("Stock").Shape = Part.makeBox(20, 20, 19, App.Vector(0, 0, BELOW - 20.0))
    else:
        text = find_machine("example_6tps").read_text(encoding="utf-8")
        other = folder / "other.toml"
        other.write_text(re.sub(r"(?m)^speed = .*", "speed = 450.0", text, count=1), encoding="utf-8")
        job.PostProcessorArgs = job.PostProcessorArgs.replace("example_6tps", str(other))
    document.recompute()


@pytest.mark.parametrize("change", CHANGES)
def test_whatever_matters_makes_another_study(document, job, checks, tmp_path, change):
    reach = create_reach(job)
    document.recompute()
    _change(document, job, change, tmp_path)
    assert len(checks) == 2
    assert reach.Proxy.study is placed_job(job).study()


@pytest.fixture
def searches(monkeypatch):
    """Counts the searches for collisions; none is known at first."""
    run, calls = job_study.find_collisions, []
    monkeypatch.setattr(job_study, "find_collisions", lambda *given: calls.append(given) or run(*given))
    job_study._COLLISIONS.clear()
    return calls


def posted(job, folder):
    """Files of a post by name, its report and its diagnostics; or the diagnostics alone of a refusal."""
    try:
        result = post_job(job, out=folder)
    except Refused as refused:
        assert list(folder.iterdir()) == []
        return None, None, [str(each) for each in refused.diagnostics]
    files = {path.name: path.read_bytes() for path in result.files}
    assert files
    return files, result.report, [str(each) for each in result.diagnostics]


@pytest.mark.parametrize("lines", [None, THROUGH_THE_PART], ids=["certified", "refused"])
def test_a_post_takes_collisions_of_the_study_and_gives_back_its_own(document, job, searches, tmp_path, lines):
    if lines is not None:
        document.getObject("Custom").Gcode = lines
        document.recompute()
    alone = posted(job, _folder(tmp_path, "alone"))
    assert len(searches) == 1
    reach = create_reach(job)
    document.recompute()
    assert len(searches) == 1 and reach.Reachable == (lines is None)  # those of the post
    assert posted(job, _folder(tmp_path, "again")) == alone
    assert len(searches) == 1
    job_study._COLLISIONS.clear()
    reach.touch()
    reach.Proxy.study = None
    document.recompute()
    assert len(searches) == 2
    assert posted(job, _folder(tmp_path, "after reach")) == alone
    assert len(searches) == 2


@pytest.mark.parametrize("change", CHANGES)
def test_a_post_of_a_changed_job_is_as_without_a_study(document, job, searches, tmp_path, change):
    reach = create_reach(job)
    document.recompute()
    reach.Active = False
    _change(document, job, change, tmp_path)
    assert len(searches) == 1
    after = posted(job, _folder(tmp_path, "after"))
    assert len(searches) == 2
    job_study._COLLISIONS.clear()
    assert posted(job, _folder(tmp_path, "alone")) == after


def test_a_job_without_a_part_and_a_stock_searches_for_nothing(document, job, searches, tmp_path):
    job.PostProcessorArgs += " --part none --stock none"
    posted(job, _folder(tmp_path, "alone"))
    assert not job_study._COLLISIONS


def _folder(parent, name):
    made = parent / name
    made.mkdir()
    return made


def test_the_findings_are_those_of_the_study_of_the_command_line(document, job):
    reach = create_reach(job)
    document.recompute()
    assert study_job(job).reach.as_dict() == reach.Proxy.study.reach.as_dict()


def test_colours_by_the_worst_check_are_red_where_any_check_is(document, job):
    reach = create_reach(job)
    document.recompute()
    assert reach.ColourBy == "worst check" and min(reach.Margins) > 0.0
    job.PostProcessorArgs = job.PostProcessorArgs.replace("0,0,250", "600,0,200,10")
    document.recompute()
    study = reach.Proxy.study
    out = np.min([each.margin for each in study.margins], axis=0) < 0.0
    assert out.any()
    np.testing.assert_array_equal(study.worst_margin() < 0.0, out)
    assert min(reach.Margins) < 0.0


def test_a_digest_sees_every_element():
    @dataclasses.dataclass
    class Thing:
        column: np.ndarray
        more: object

    column = np.arange(200_000.0)
    first = digest(Thing(column, {"a": (1, 2.5), "b": None}))
    assert first == digest(Thing(column.copy(), {"b": None, "a": (1, 2.5)}))
    for row in (0, 65535, 65536, 199_999):
        changed = column.copy()
        changed[row] = np.nextafter(changed[row], np.inf)
        assert digest(Thing(changed, {"a": (1, 2.5), "b": None})) != first
    assert digest(Thing(column, {"a": (1, 2.5), "b": 0})) != first
    assert digest(np.broadcast_to(3.0, 1000)) == digest(np.full(1000, 3.0)) != digest(np.full(999, 3.0))
