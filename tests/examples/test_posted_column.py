# SPDX-License-Identifier: LGPL-2.1-or-later
"""The main job from end to end: the saved column posted as CAM's Post Process command does it."""

import importlib.util
import json
import sys
from pathlib import Path

import FreeCAD as App
import numpy as np
import pytest
from Path.Post.Processor import PostProcessorFactory

import pkm_post
from pkm_post.machine import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Kind
from pkm_post.writing import trajectory_file
from pkm_post.writing.controllers import pmac

EXAMPLE = Path(__file__).parents[2] / "examples" / "tapered_column"


def load(name):
    spec = importlib.util.spec_from_file_location(f"tapered_column_{name}", EXAMPLE / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def posted(tmp_path_factory):
    """The folder with what was posted, and the text that CAM would write."""
    folder = tmp_path_factory.mktemp("posted")
    document, _ = load("build").build(out=folder)
    App.closeDocument(document.Name)
    document = App.openDocument(str(folder / "tapered_column.FCStd"))
    document.recompute()
    job = document.getObject("Job")
    job.PostProcessorOutputFile = str(folder / "tapered_column.pmc")
    sections = PostProcessorFactory.get_post_processor(job, "hexapod_pmac").export()
    yield folder, sections, job
    App.closeDocument(document.Name)


def test_certificate_holds_a_micron_and_a_thousandth_of_a_degree(posted):
    report = json.loads((posted[0] / "tapered_column-report.json").read_text())
    assert report["tolerances"] == {"tip_mm": 0.001, "tip_of_program_mm": [], "axis_deg": 0.001}
    assert report["certificate"]["holds"]
    findings = {finding["what"]: finding for finding in report["certificate"]["findings"]}
    assert 0 < findings["deviation of the tool tip"]["value"] <= 0.001
    assert 0 < findings["deviation of the tool axis"]["value"] <= 0.001
    assert findings["strut speed"]["value"] <= 500
    assert findings["strut acceleration"]["value"] <= 5000


def test_text_for_cam_is_the_certified_program(posted):
    folder, sections, _ = posted
    assert [name for name, _ in sections] == ["allitems"]
    assert sections[0][1] == (folder / "tapered_column.pmc").read_text()


def test_four_formats_and_more_than_a_thousand_blocks_are_in_the_trajectory(posted):
    trajectory, faults = trajectory_file.read(posted[0] / "tapered_column.pkmt")
    assert not faults
    assert trajectory.operations == ("Quadrant 1", "Quadrant 4", "Quadrant 2", "Quadrant 3")
    cutting = trajectory.kind != Kind.RAPID
    assert cutting.sum() > 1000
    blocks = np.bincount(trajectory.operation[cutting])
    assert len(set(blocks)) == 1
    for operation, (x, y) in enumerate([(1, 1), (1, -1), (-1, 1), (-1, -1)]):
        tip = trajectory.tip[cutting & (trajectory.operation == operation)]
        assert (tip[:, 0] * x > -0.5).all() and (tip[:, 1] * y > -0.5).all()


def test_quadrants_in_mirror_have_the_same_struts_in_another_order(posted):
    # The machine is mirror-symmetric about x-z: what quadrants 1 and 4 need of the struts is the same.
    machine, _ = read_machine(find_machine("example_6tps"))
    text = (posted[0] / "tapered_column.pmc").read_text()
    struts, _ = pmac.read_program(text, pmac.PmacSettings.of(machine.controller), "tapered_column.pmc")
    quarter = np.array_split(np.sort(struts.length, axis=1), 4)
    longest = [part.max() for part in quarter]
    assert longest[0] == pytest.approx(longest[1], abs=0.1)
    assert longest[2] == pytest.approx(longest[3], abs=0.1)
    assert abs(longest[0] - longest[2]) > 1


def test_a_macro_gives_the_same_program(posted, tmp_path):
    folder, _, job = posted
    (result,) = pkm_post.post(job, "example_6tps", tmp_path)
    assert result.program == tmp_path / "tapered_column.pmc"
    assert result.program.read_bytes() == (folder / "tapered_column.pmc").read_bytes()
