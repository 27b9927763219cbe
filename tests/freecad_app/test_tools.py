# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool bits of FreeCAD 1.0 and newer: both name the same cutter in their own way."""

import json
import math

import FreeCAD as App
import numpy as np
import Part
import pytest
from cam_jobs import add_operation

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.job_setup import setup_of
from pkm_post.freecad_app.tools import read_tools, set_gauge_length
from pkm_post.machine.collisions.moving_bodies import cutter_profile
from pkm_post.machine.collisions.tools_in_use import sizes_between
from pkm_post.model import Setup
from pkm_post.reading.tool_table import read_tool_table
from pkm_post.toolpath.compensation.cutter import Cutter, CutterProfile


def stock_bit(document, shape, **sizes):
    """A tool bit of a stock shape with some sizes in mm and degrees, as this FreeCAD makes them."""
    try:
        from Path.Tool.toolbit import ToolBit
    except ImportError:
        from Path.Tool.Bit import Factory

        units = {name: "deg" if name.endswith("Angle") else "mm" for name in sizes}
        parameters = {name: f"{size} {units[name]}" for name, size in sizes.items()}
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


def assert_profile(bit, tool, levels):
    """The solid of the bit ends where the profile of the tool's cutter does, at some levels above the tip."""
    outline = CutterProfile.of(Cutter.of(tool), 100.0)
    for z in levels:
        low, high = 0.0, 50.0
        for _ in range(40):
            middle = (low + high) / 2
            inside = outline.distance(np.array([middle]), np.array([z]))[0] < 0
            low, high = (middle, high) if inside else (low, middle)
        assert low > 0.02
        hits = [bit.Shape.isInside(App.Vector(radius, 1e-4, z), 1e-7, False) for radius in (low - 0.01, low + 0.01)]
        assert hits == [True, False], f"at level {z}"


@pytest.mark.parametrize(("shape", "corner_radius"), [("endmill.fcstd", 0), ("ballend.fcstd", 6)])
def test_corner_radius_by_shape(job, shape, corner_radius):
    bit = stock_bit(job.Document, shape, Diameter=12)
    tool = tool_of(job, bit)
    assert (tool.diameter, tool.corner_radius, tool.bottom_angle, tool.side_angle) == (12, corner_radius, 0, 0)
    assert_shape(bit, tool.diameter, tool.corner_radius)


CONICAL = {
    "drill": ("drill.fcstd", {"Diameter": 6}, {"TipAngle": 130}, (6, 0, 25, 0), (0.5, 1.0, 5.0)),
    "v-bit with a flat": (
        "v-bit.fcstd", {"Diameter": 10, "TipDiameter": 1}, {"CuttingEdgeAngle": 70}, (1, 0, 0, 35), (0.3, 0.9),
    ),
    "pointed v-bit": (
        "v-bit.fcstd", {"Diameter": 10, "TipDiameter": 0}, {"CuttingEdgeAngle": 70}, (10, 0, 55, 0), (0.3, 0.9),
    ),
    "chamfer": ("chamfer.fcstd", {"TipDiameter": 5}, {"CuttingEdgeAngle": 80}, (5, 0, 0, 40), (0.3, 2.0)),
    "dovetail": ("dovetail.fcstd", {}, {"CuttingEdgeAngle": 50}, None, (0.3, 4.0)),
}  # fmt: skip


@pytest.mark.parametrize(("shape", "lengths", "angles", "sizes", "levels"), CONICAL.values(), ids=CONICAL.keys())
def test_cones_at_bottom_and_side(job, shape, lengths, angles, sizes, levels):
    bit = stock_bit(job.Document, shape, **lengths, **angles)
    tool = tool_of(job, bit)
    if sizes is not None:
        degrees = math.degrees(tool.bottom_angle), math.degrees(tool.side_angle)
        assert (tool.diameter, tool.corner_radius, *degrees) == pytest.approx(sizes)
    assert_profile(bit, tool, levels)


def tapered_ball_of_newer_freecad(document):
    """What FreeCAD 1.0 sees of such a bit in a document of a newer one, with the solid that its sizes stand for."""
    bit = document.addObject("Part::FeaturePython", "TaperedBall")
    bit.addProperty("App::PropertyString", "ShapeType")
    bit.addProperty("App::PropertyLength", "Diameter")
    bit.addProperty("App::PropertyAngle", "TaperAngle")
    bit.ShapeType, bit.Diameter, bit.TaperAngle = "TaperedBallNose", 1.5875, 11
    radius, taper, top = 1.5875 / 2, math.radians(5.5), 20.0
    level = radius * (1 - math.sin(taper))
    below = radius * math.cos(taper)
    above = below + (top - level) * math.tan(taper)
    ball = Part.makeSphere(radius, App.Vector(0, 0, radius))
    bit.Shape = ball.fuse(Part.makeCone(below, above, top - level, App.Vector(0, 0, level)))
    return bit


def test_tapered_ball(job):
    if int(App.Version()[1]) == 0:
        bit = tapered_ball_of_newer_freecad(job.Document)
    else:
        bit = stock_bit(job.Document, "taperedballnose.fcstd")
    tool = tool_of(job, bit)
    assert (tool.corner_radius, math.degrees(tool.side_angle)) == pytest.approx((1.5875 / 2, 5.5))
    assert Cutter.of(tool).radial_offset == pytest.approx(0.0, abs=1e-12)
    assert_profile(bit, tool, (0.1, 0.6, 1.0, 10.0))


def test_a_bit_of_another_shape_has_a_corner_that_is_not_known(job):
    """It counted as flat, and stock at its corner as removed."""
    bit = job.Document.addObject("Part::FeaturePython", "Own")
    bit.addProperty("App::PropertyString", "ShapeType")
    bit.addProperty("App::PropertyLength", "Diameter")
    bit.ShapeType, bit.Diameter = "Custom", 8
    tool = tool_of(job, bit)
    smallest, largest = sizes_between(tool, setup_of(job))
    assert (tool.diameter, smallest.corner_radius, largest.corner_radius) == (8, 4, 0)


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


V_BITS = [(90, 1.0, 1.0), (60, 0.2, 3.0), (90, 0.0, 1.0), (30, 0.0, 4.0)]
"""Cutting edge angles, tip diameters and heights of the cylinder above the cone."""


@pytest.mark.parametrize(("angle", "tip", "height"), V_BITS)
def test_the_shank_of_a_v_bit_is_above_its_cone(job, angle, tip, height):
    sizes = {"Diameter": 10, "TipDiameter": tip, "CuttingEdgeAngle": angle, "CuttingEdgeHeight": height}
    bit = stock_bit(job.Document, "v-bit.fcstd", **sizes, Length=60, ShankDiameter=5)
    tool, (shank,) = tool_of(job, bit), setup_of(job).shanks.values()
    cone = (10 - tip) / 2 / math.tan(math.radians(angle) / 2)
    assert (shank.start, shank.diameter) == pytest.approx((cone, 10) if tip else (cone + height, 5))
    edges = cutter_profile(tool, shank.start)
    for z in np.linspace(0.1, cone + height + 5, 40):
        solid = _radius_of(bit, z)
        if z < shank.start:
            assert np.interp(z, edges.height, edges.radius) == pytest.approx(solid, abs=2e-3)
        else:
            assert solid <= shank.diameter / 2 + 2e-3


@pytest.mark.parametrize(("shape", "edges"), [("slittingsaw", "BladeThickness"), ("tap", "CuttingEdgeLength")])
def test_the_edges_of_a_saw_and_a_tap_end_where_their_solids_get_thin(job, shape, edges):
    if shape == "tap" and int(App.Version()[1]) == 0:
        pytest.skip("FreeCAD 1.0 has no taps")
    bit = stock_bit(job.Document, f"{shape}.fcstd")
    tool, (shank,) = tool_of(job, bit), setup_of(job).shanks.values()
    cone = tool.diameter / 2 * math.tan(tool.bottom_angle)
    assert shank.start == pytest.approx(cone + getattr(bit, edges).Value)
    assert _radius_of(bit, shank.start - 0.1) == pytest.approx(tool.diameter / 2, abs=2e-3)
    for z in np.linspace(shank.start + 0.1, bit.Length.Value - 0.1, 20):
        assert _radius_of(bit, z) <= shank.diameter / 2 + 2e-3 < tool.diameter / 2


TAPERS = [(3, 10, 5, 20, 8), (3, 10, 5, 12, 8), (3, 20, 5, 9, 8), (1, 6, 4, 20, 6), (2, 40, 8, 12, 10)]
"""Diameters, whole angles, diameters at the top of the taper, heights of the edges, and shanks."""


@pytest.mark.parametrize("sizes", TAPERS)
def test_the_shank_of_a_tapered_ball_begins_where_its_solid_gets_wide(job, sizes):
    """It began at CuttingEdgeHeight, which its solid does not follow: 7 mm of shank were thinner than they are."""
    if int(App.Version()[1]) == 0:
        pytest.skip("FreeCAD 1.0 has no tapered ball")
    names = ("Diameter", "TaperAngle", "TaperDiameter", "CuttingEdgeHeight", "ShankDiameter")
    bit = stock_bit(job.Document, "taperedballnose.fcstd", Length=70, **dict(zip(names, sizes, strict=True)))
    tool, (shank,) = tool_of(job, bit), setup_of(job).shanks.values()
    edges = cutter_profile(tool, shank.start)
    for z in np.linspace(0.1, shank.start - 0.03, 20):
        # Some angles of its sketch are off by a thousandth
        assert np.interp(z, edges.height, edges.radius) == pytest.approx(_radius_of(bit, z), abs=5e-3)
    for z in np.linspace(shank.start + 0.03, 60, 10):
        assert shank.diameter / 2 == pytest.approx(_radius_of(bit, z), abs=2e-3)


def test_a_thread_mill_has_a_core_up_to_its_shank(job):
    sizes = {"Diameter": 5, "NeckDiameter": 3, "NeckLength": 20, "ShankDiameter": 6, "Crest": 0.1, "Length": 50}
    bit = stock_bit(job.Document, "thread-mill.fcstd", **sizes)
    tool, setup = tool_of(job, bit), setup_of(job)
    (shank,), core = setup.shanks.values(), setup.core_of(tool)
    assert (tool.diameter, core.diameter, core.corner_radius, shank.diameter) == (5, 3, 0, 6)
    for z in np.linspace(0.02, shank.start - 0.05, 40):
        assert core.diameter / 2 - 2e-3 <= _radius_of(bit, z) <= tool.diameter / 2
    assert _radius_of(bit, shank.start + 0.1) == pytest.approx(shank.diameter / 2, abs=2e-3)


def test_a_radius_mill_has_a_core_as_thick_as_its_tip(job):
    if int(App.Version()[1]) == 0:
        pytest.skip("FreeCAD 1.0 has no radius mill")
    sizes = {"Diameter": 15, "TipDiameter": 5, "CuttingRadius": 3, "CuttingEdgeHeight": 14, "ShankDiameter": 8}
    bit = stock_bit(job.Document, "radius.fcstd", **sizes)
    tool, setup = tool_of(job, bit), setup_of(job)
    (shank,), core = setup.shanks.values(), setup.core_of(tool)
    assert (tool.diameter, core.diameter, shank.start, shank.diameter) == (15, 5, 14, 8)
    for z in np.linspace(0.1, shank.start - 0.05, 40):
        assert core.diameter / 2 - 2e-3 <= _radius_of(bit, z) <= tool.diameter / 2 + 2e-3
    assert _radius_of(bit, 0.5) < 3  # hollow: a cylinder of its diameter would cut what it leaves


def _radius_of(bit, z):
    """The radius of the solid of a bit at a height, by halving."""
    low, high = 0.0, 80.0
    for _ in range(30):
        middle = (low + high) / 2
        inside = bit.Shape.isInside(App.Vector(middle, 1e-4, z), 1e-7, False)
        low, high = (middle, high) if inside else (low, middle)
    return low


def written_by_freecad(bit):
    """The content of the file of a bit, as this FreeCAD writes it."""
    try:
        from Path.Tool.toolbit.serializers.fctb import FCTBSerializer
    except ImportError:
        return json.dumps(bit.Proxy.templateAttrs(bit))
    return FCTBSerializer.serialize(bit.Proxy).decode()


@pytest.mark.parametrize("system", range(len(App.Units.listSchemas())))
def test_a_library_that_freecad_writes_in_any_unit_system_has_the_sizes_of_a_job(job, tmp_path, system):
    bit = stock_bit(job.Document, "endmill.fcstd", Diameter=25.4, ShankDiameter=12.7, CuttingEdgeHeight=50.8)
    App.Units.setSchema(system)
    try:
        (tmp_path / "end.fctb").write_text(written_by_freecad(bit), encoding="utf-8")
    finally:
        App.Units.setSchema(0)
    (tmp_path / "shop.fctl").write_text(json.dumps({"tools": [{"nr": 1, "path": "end.fctb"}]}), encoding="utf-8")
    table, faults = read_tool_table(str(tmp_path / "shop.fctl"))
    assert not faults
    cutter = tool_of(job, bit)
    (shank,) = setup_of(job).shanks.values()
    inches, centimetres, feet, metres = 3, 4, 7, 9
    rounding = {inches: 0.13, centimetres: 0.051, feet: 1.6, metres: 5.1}  # mm, half of 0.01
    off = pytest.approx([cutter.diameter, shank.start, shank.diameter], abs=rounding.get(system, 0.0051))
    found = table.shanks[1]
    assert [table.tools[1].diameter, found.start, found.diameter] == off
    drill = stock_bit(job.Document, "drill.fcstd", Diameter=25.4, TipAngle=118.123)
    App.Units.setSchema(system)
    try:
        (tmp_path / "end.fctb").write_text(written_by_freecad(drill), encoding="utf-8")
    finally:
        App.Units.setSchema(0)
    bottom = read_tool_table(str(tmp_path / "shop.fctl"))[0].tools[1].bottom_angle
    assert math.degrees(bottom) == pytest.approx(90 - 118.123 / 2, abs=0.0026)  # half of 0.01, halved


LIBRARY_SHAPES = {
    "drill": {"Diameter": 5, "TipAngle": 118},
    "tap": {"Diameter": 8, "TipAngle": 90, "CuttingEdgeLength": 20, "ShankDiameter": 4},
    "v-bit": {"Diameter": 10, "CuttingEdgeAngle": 60, "TipDiameter": 1, "CuttingEdgeHeight": 2, "ShankDiameter": 4},
    "thread-mill": {"Diameter": 5, "NeckDiameter": 3, "NeckLength": 20, "ShankDiameter": 4},
    "radius": {"Diameter": 15, "TipDiameter": 5, "CuttingRadius": 3, "CuttingEdgeHeight": 14, "ShankDiameter": 4},
    "slittingsaw": {"Diameter": 60, "BladeThickness": 3, "ShankDiameter": 10},
    "dovetail": {"ShankDiameter": 10},
    "chamfer": {"Diameter": 12, "CuttingEdgeAngle": 60, "TipDiameter": 5, "ShankDiameter": 6},
    "taperedballnose": {"Diameter": 3, "TaperAngle": 10, "TaperDiameter": 5, "CuttingEdgeHeight": 20},
}


@pytest.mark.parametrize("name", LIBRARY_SHAPES)
def test_a_library_has_the_tools_of_a_job_and_cutters_that_their_solids_contain(job, tmp_path, name):
    """Many were balls of their diameter without a shank; chamfer mills and tapered balls had upright sides."""
    if int(App.Version()[1]) == 0 and name in ("tap", "radius", "taperedballnose"):
        pytest.skip("FreeCAD 1.0 has no such bits")
    bit = stock_bit(job.Document, f"{name}.fcstd", **LIBRARY_SHAPES[name])
    (tmp_path / "end.fctb").write_text(written_by_freecad(bit), encoding="utf-8")
    (tmp_path / "shop.fctl").write_text(json.dumps({"tools": [{"nr": 1, "path": "end.fctb"}]}), encoding="utf-8")
    table, faults = read_tool_table(str(tmp_path / "shop.fctl"))
    assert not faults
    tool, setup, found = tool_of(job, bit), setup_of(job), table.tools[1]
    assert {number: (each.start, each.diameter) for number, each in table.shanks.items()} == {
        number: pytest.approx((each.start, each.diameter)) for number, each in setup.shanks.items()
    }
    assert table.cores == setup.cores
    top = setup.shanks[1].start if setup.shanks else 20.0
    of_table = Setup(cores=table.cores, unknown_corners=frozenset() if found.corner_known else {1})
    edges = cutter_profile(sizes_between(found, of_table)[0], top)
    for z in np.linspace(0.05, top - 0.05, 30):
        assert np.interp(z, edges.height, edges.radius) <= _radius_of(bit, z) + 2e-3
    sizes = [[each.diameter, each.corner_radius, each.bottom_angle, each.side_angle] for each in (found, tool)]
    assert sizes[0] == pytest.approx(sizes[1]) and found.corner_known == tool.corner_known
