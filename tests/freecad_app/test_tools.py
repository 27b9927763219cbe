# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool bits of FreeCAD 1.0 and newer: both name the same cutter in their own way."""

import math

import FreeCAD as App
import pytest
from cam_jobs import add_operation

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.tools import read_tools, set_gauge_length


def stock_bit(document, shape, **sizes):
    """A tool bit of a stock shape with some sizes in mm, as this FreeCAD makes them."""
    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        from Path.Tool.Bit import Factory

        parameters = {name: f"{size} mm" for name, size in sizes.items()}
        declared = {"name": shape, "shape": shape, "parameter": parameters, "attribute": {}}
        return Factory.CreateFromAttrs(declared, shape)
    bit = ToolBit.from_shape_id(shape, label=shape).attach_to_doc(doc=document)
    for name, size in sizes.items():
        setattr(bit, name, size)
    document.recompute()
    return bit


def tool_of(job, bit):
    controller = job.Tools.Group[0]
    controller.Tool = bit
    tools, faults = read_tools([controller], {}, "part.FCStd")
    assert faults == ()
    return tools[1]


def assert_shape(bit, diameter, corner_radius):
    """The solid of the bit ends where a cutter of these sizes does, looked at in the middle of the corner."""
    assert bit.Shape.Volume > 0
    z = max(0.3 * corner_radius, 0.5)
    below_middle = max(corner_radius - z, 0)
    end = diameter / 2 - corner_radius + math.sqrt(corner_radius**2 - below_middle**2)
    inside = [bit.Shape.isInside(App.Vector(radius, 0.01, z), 1e-7, False) for radius in (end - 0.01, end + 0.01)]
    assert inside == [True, False]


@pytest.mark.parametrize(("shape", "corner_radius"), [("endmill.fcstd", 0), ("ballend.fcstd", 6), ("drill.fcstd", 0)])
def test_corner_radius_by_shape(job, shape, corner_radius):
    bit = stock_bit(job.Document, shape, Diameter=12)
    tool = tool_of(job, bit)
    assert (tool.diameter, tool.corner_radius) == (12, corner_radius)
    if shape != "drill.fcstd":  # the point of a drill is a cone
        assert_shape(bit, tool.diameter, tool.corner_radius)


def test_bull_nose_says_its_flat_or_its_corner(job):
    size = {"FlatRadius": 5} if int(App.Version()[1]) == 0 else {"CornerRadius": 3}
    bit = stock_bit(job.Document, "bullnose.fcstd", Diameter=16, **size)
    tool = tool_of(job, bit)
    assert (tool.diameter, tool.corner_radius) == (16, 3)
    assert_shape(bit, 16, 3)


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
