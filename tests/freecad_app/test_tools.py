# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool bits of FreeCAD 1.0 and newer: both name the same cutter in their own way."""

import pytest
from cam_jobs import add_operation

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.tools import read_tools, set_gauge_length

MICRON = 1e-3


def stock_bit(document, shape):
    """A tool bit of a stock shape, as this FreeCAD makes them."""
    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        from Path.Tool.Bit import Factory

        return Factory.CreateFromAttrs({"name": shape, "shape": shape, "parameter": {}, "attribute": {}}, shape)
    return ToolBit.from_shape_id(shape, label=shape).attach_to_doc(doc=document)


def tool_of(job, bit):
    controller = job.Tools.Group[0]
    controller.Tool = bit
    tools, faults = read_tools([controller], {}, "part.FCStd")
    assert faults == ()
    return tools[1]


def radius_of_flat_bottom(bit):
    """From the solid itself: the largest radius of an edge in the plane of the tip."""
    job_edges = [edge for edge in bit.Shape.Edges if edge.BoundBox.ZMax - bit.Shape.BoundBox.ZMin < MICRON]
    return max((edge.Curve.Radius for edge in job_edges if hasattr(edge.Curve, "Radius")), default=0.0)


@pytest.mark.parametrize("shape", ["endmill.fcstd", "ballend.fcstd", "bullnose.fcstd"])
def test_corner_radius_is_that_of_the_solid(job, shape):
    bit = stock_bit(job.Document, shape)
    bit.Diameter = 12
    job.Document.recompute()
    tool = tool_of(job, bit)
    assert tool.diameter == pytest.approx(12)
    assert tool.corner_radius == pytest.approx(6 - radius_of_flat_bottom(bit), abs=MICRON)


def test_corner_radius_follows_the_bit(job):
    bit = stock_bit(job.Document, "bullnose.fcstd")
    bit.Diameter = 16
    if hasattr(bit, "FlatRadius"):
        bit.FlatRadius = 5
    else:
        bit.CornerRadius = 3
    job.Document.recompute()
    assert tool_of(job, bit).corner_radius == pytest.approx(3)
    assert radius_of_flat_bottom(bit) == pytest.approx(5, abs=MICRON)


def test_drill_has_no_corner_radius(job):
    assert tool_of(job, stock_bit(job.Document, "drill.fcstd")).corner_radius == 0


def test_tool_has_the_name_of_the_bit_and_the_length_of_the_controller(job):
    add_operation(job)
    controller = job.Tools.Group[0]
    controller.Tool.Label = "Cutter"
    set_gauge_length(controller, 133.5)
    program, _ = read_job(job)
    assert (program.tools[1].name, program.tools[1].length) == ("Cutter", 133.5)


def test_gauge_length_is_one_property_that_is_saved(job):
    controller = job.Tools.Group[0]
    set_gauge_length(controller, 80)
    set_gauge_length(controller, 90)
    assert controller.GaugeLength.UserString.startswith("90")
    assert controller.getGroupOfProperty("GaugeLength") == "PKM Post"
    assert controller.getTypeIdOfProperty("GaugeLength") == "App::PropertyLength"
