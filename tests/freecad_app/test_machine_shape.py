# SPDX-License-Identifier: LGPL-2.1-or-later
import FreeCAD
import numpy as np
import Part
import pytest
from machines import direction, example

from pkm_post.freecad_app.machine_shape import machine_bodies
from pkm_post.kinematics import strut_lengths
from pkm_post.model import Tool

TIP, AXIS = np.array([30.0, -40.0, 250.0]), direction(20, 35)
TOOLS = [Tool(1, "ball", 12, 6, 120), Tool(2, "bull nose", 16, 4, 120), Tool(3, "flat", 10, 0, 120)]


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.name)
def test_bodies_stand_where_kinematics_puts_them(tool):
    bodies = {body.name: body.shape for body in machine_bodies(example(), tool, TIP, AXIS)}
    assert set(bodies) == {"Base", "Struts", "Platform", "Spindle", "Tool"}
    assert all(shape.isValid() and shape.Placement.isIdentity() for shape in bodies.values())
    # The bottom of the tool touches the tip; its volume is that of the profile turned about the axis.
    assert bodies["Tool"].distToShape(Part.Vertex(FreeCAD.Vector(*TIP)))[0] < 1e-6
    radius, corner = tool.diameter / 2, tool.corner_radius
    flat = radius - corner
    quarter = np.pi * corner**2 / 4
    turned = 2 * np.pi * (flat + 4 * corner / (3 * np.pi)) * quarter + np.pi * flat**2 * corner
    assert bodies["Tool"].Volume == pytest.approx(turned + np.pi * radius**2 * (tool.length - corner), rel=1e-6)


def test_rods_and_tubes_together_are_the_strut_lengths():
    struts = machine_bodies(example(), TOOLS[0], TIP, AXIS)[1].shape
    lengths = strut_lengths(example(), TIP[None], AXIS[None], np.zeros(1), np.array([120.0]))[0]
    cylinders = [solid for solid in struts.Solids if any("Cylinder" in str(face.Surface) for face in solid.Faces)]
    found = []
    for tube, rod in zip(cylinders[::2], cylinders[1::2], strict=True):
        heights = [max(edge.Length for edge in solid.Edges if edge.Curve.TypeId == "Part::GeomLine")
                   for solid in (tube, rod)]  # fmt: skip
        found.append(sum(heights))
    np.testing.assert_allclose(found, lengths, atol=1e-6)
