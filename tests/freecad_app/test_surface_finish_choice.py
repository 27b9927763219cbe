# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a new Surface Finish chooses: with a flat or bull-nose mill its first computation succeeds without a gouge."""

import math

import FreeCAD as App
import Part
import pytest
from part_jobs import corner, job_on
from surface_finishes import face_names, finish, valid

from pkm_post.freecad_app.surface_finish import create_surface_finish

BITS = {
    "flat": ("endmill.fcstd", {"Diameter": 6}),
    "bull nose": ("bullnose.fcstd", {"Diameter": 8, **corner(8.0, 2.0)}),
}
RADIUS, SIDE = 30.0, 16.0


def trough():
    block = Part.makeBox(SIDE, SIDE, 12)
    return block.cut(
        Part.makeCylinder(RADIUS, 2 * SIDE, App.Vector(SIDE / 2, -SIDE / 2, 8 + RADIUS), App.Vector(0, 1, 0))
    )


SHAPES = {
    "plane": (lambda: Part.makeBox(SIDE, SIDE, 12), lambda face: face.BoundBox.ZMin > 11.9),
    "hollow": (trough, lambda face: face.Surface.TypeId == "Part::GeomCylinder"),
    "wall": (lambda: Part.makeCylinder(8, 8), lambda face: face.Surface.TypeId == "Part::GeomCylinder"),
}


@pytest.mark.parametrize("bit", BITS)
@pytest.mark.parametrize("shape", SHAPES)
def test_the_first_computation_succeeds(document, shape, bit):
    make, chosen = SHAPES[shape]
    name, sizes = BITS[bit]
    job = job_on(document, make(), name, **sizes)
    clone = job.Model.Group[0]
    operation = create_surface_finish(job, [(clone, face_names(clone.Shape, chosen))], fit=True)
    assert operation.CheckSpacing.Value == 1.0
    operation.Stepover, operation.CheckSpacing = 3.0, 2.0
    document.recompute()
    assert 0.0 <= valid(operation).MaximumGouge < 1.1 * operation.ChordTolerance.Value
    if shape == "plane":
        assert operation.Lead.Value == 0.0
    if shape == "hollow":
        flat = 3.0 if bit == "flat" else 2.0
        assert (
            math.degrees(math.asin(flat / RADIUS))
            < operation.Lead.Value
            <= math.degrees(math.asin(flat / RADIUS)) + 5.0
        )
    if shape == "wall":
        assert 10.0 < operation.ConeLimit.Value < 60.0


def test_a_hollow_is_gouged_without_the_lead_and_that_is_an_error(document):
    make, chosen = SHAPES["hollow"]
    operation = finish(job_on(document, make(), "endmill.fcstd", Diameter=6), chosen, Stepover=3.0, CheckSpacing=2.0)
    assert not operation.isValid()
    assert "N311" in operation.getStatusString() and operation.Path.Size == 0


def test_a_controller_whose_tool_fits_is_taken(document):
    from cam_jobs import add_tool_controller
    from test_tools import stock_bit

    job = job_on(document, Part.makeBox(SIDE, SIDE, 12), "drill.fcstd", Diameter=5)
    add_tool_controller(job, 2)
    job.Tools.Group[1].Tool = stock_bit(document, "ballend.fcstd", Diameter=6)
    assert create_surface_finish(job).ToolController == job.Tools.Group[1]
