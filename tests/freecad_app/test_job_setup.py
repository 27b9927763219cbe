# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs are checked against their models, their stock and the shanks of their tools, by posting as by reach."""

import FreeCAD as App
import numpy as np
import Part
import Path.Main.Job
import pytest
from cam_jobs import ON_EXAMPLE, add_operation, add_tool_controller, new_job
from part_jobs import job_on

from pkm_post.freecad_app.job_setup import setup_of, study_job
from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_app.tools import set_gauge_length
from pkm_post.geometry.polygons import is_closed, volume
from pkm_post.model import Refused

CLEARANCE, HOLDER = 2.0, 25.0
"""mm: of the example machine; its holder begins 70 mm above the tip of a tool of 120 mm."""
PASS = ["G0 Z60", "G0 X-30 Y10", "G0 Z12", "G1 Z10 F10", "G1 X30", "G0 Z60"]


def job_beside_a_wall(document, gap, stock_height=0.0):
    """A plate with a wall that the holder passes at a distance; its stock is the plate and the wall, or a box."""
    plate = Part.makeBox(80, 80, 10, App.Vector(-40, -40, 0))
    wall = Part.makeBox(80, 20, 105, App.Vector(-40, 10 + HOLDER + gap, 10))
    part, stock = (document.addObject("Part::Feature", name) for name in ("Part", "Blank"))
    part.Shape = plate.fuse(wall)
    stock.Shape = Part.makeBox(80, 80, stock_height, App.Vector(-40, -40, 0)) if stock_height else part.Shape
    job = Path.Main.Job.Create("Job", [part], None)
    job.Stock = stock
    controller = job.Tools.Group[0]
    controller.SpindleSpeed, controller.SpindleDir = 9000, "Forward"
    set_gauge_length(controller, 120)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--machine example_6tps --work-offset=0,0,150"
    return job


def test_the_setup_is_what_the_job_has(document):
    job = new_job(document)
    setup = setup_of(job)
    assert volume(setup.part.triangles) == pytest.approx(20.0**3)
    assert volume(setup.stock.triangles) > volume(setup.part.triangles)
    assert is_closed(setup.part.triangles) and is_closed(setup.stock.triangles)
    bit, (shank,) = job.Tools.Group[0].Tool, setup.shanks.values()
    assert (shank.start, shank.diameter) == (bit.CuttingEdgeHeight.Value, bit.ShankDiameter.Value)
    assert not setup.fixtures and np.all(setup.part.triangles >= -1e-9)


@pytest.mark.parametrize("gap", [CLEARANCE + 0.1, CLEARANCE - 0.1, -15.0])
def test_a_holder_that_goes_into_the_part_is_refused_and_one_that_clears_is_posted(document, tmp_path, gap):
    job = job_beside_a_wall(document, gap)
    add_operation(job, PASS)
    reported = {fault.code for fault in study_job(job).reach.faults()}
    if gap > CLEARANCE:
        posted = post_job(job, out=tmp_path)
        assert posted.files and reported == set() and posted.diagnostics == ()
        rows = {row["what"]: row["extent"] for row in posted.report["certificate"]["coverage"]}
        assert rows["spindle and holder against the part"] == rows["shanks against the part"] == "proven"
    else:
        with pytest.raises(Refused) as refused:
            post_job(job, out=tmp_path)
        assert (
            {fault.code for fault in refused.value.diagnostics} - {"K134"} == {"K117"} == reported
        )  # the wall is stock too
        assert "tool holder" in str(refused.value) and f"by {CLEARANCE - gap:.2f}" in str(refused.value)
        assert list(tmp_path.iterdir()) == []


def test_a_rapid_move_into_the_stock_is_refused_unless_the_stock_is_said_to_be_another(document, tmp_path):
    job = job_beside_a_wall(document, CLEARANCE + 5.0, stock_height=16.0)
    add_operation(job, PASS)
    with pytest.raises(Refused) as refused:
        post_job(job, out=tmp_path)
    assert {fault.code for fault in refused.value.diagnostics} == {"K136"}
    job.PostProcessorArgs += " --stock none"
    assert post_job(job, out=tmp_path).files


def test_a_shank_thicker_than_the_cutter_is_refused_where_it_goes_into_the_part(document, tmp_path):
    job = job_beside_a_wall(document, CLEARANCE + 5.0)
    bit = job.Tools.Group[0].Tool
    bit.CuttingEdgeHeight, bit.ShankDiameter = 5.0, 80.0
    add_operation(job, PASS)
    with pytest.raises(Refused) as refused:
        post_job(job, out=tmp_path)
    assert "K130" in {fault.code for fault in refused.value.diagnostics}
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("thin", [3.0, 0.0])
def test_the_shank_is_that_of_the_tool_in_use(document, thin):
    """Another controller may have its number; 0 for a tool bit that does not state a shank."""
    job = new_job(document)
    operation = add_operation(job, PASS)
    used, other = job.Tools.Group[0], add_tool_controller(job, 1)
    bits = [document.copyObject(used.Tool) for _ in range(2)]
    for bit, diameter in zip(bits, (80.0, thin), strict=True):
        bit.ShankDiameter = diameter
    used.Tool, other.Tool = bits
    assert setup_of(job).shanks[1].diameter == 80.0
    operation.ToolController = other
    assert [shank.diameter for shank in setup_of(job).shanks.values()] == [thin] * bool(thin)


@pytest.mark.parametrize("tip", [0.0, 1.0])
def test_a_v_bit_cuts_as_deep_as_its_cone(document, tmp_path, tip):
    """Its CuttingEdgeHeight, 1 mm, is above the cone: the groove of 3 mm, and the way out of it, are no collisions."""
    sizes = {"TipDiameter": tip, "CuttingEdgeHeight": 1, "ShankDiameter": 5}
    job = job_on(document, Part.makeBox(60, 20, 10), "v-bit.fcstd", **sizes)
    stock = document.addObject("Part::Feature", "Blank")
    stock.Shape = Part.makeBox(60, 20, 10)
    job.Stock, job.PostProcessor = stock, "hexapod_pmac"
    job.PostProcessorArgs = ON_EXAMPLE.format("0,0,250") + " --part none"
    add_operation(job, ["G0 X-8 Y10 Z20", "G1 Z7 F10", "G1 X68", "G0 X60", "G0 X10", "G0 Z20"])
    posted = post_job(job, out=tmp_path)
    assert posted.files
    assert [str(each) for each in posted.diagnostics if each.code.startswith("K13")] == []
