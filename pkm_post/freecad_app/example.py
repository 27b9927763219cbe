# SPDX-License-Identifier: LGPL-2.1-or-later
"""Example: a document with a blade, and the CAM job that finishes its upper face on the example machine.

It is the blade of docs/tutorial-blade.md. Lengths in mm, angles in degrees, as in FreeCAD's properties.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import Path.Main.Job
import Path.Post.Processor  # noqa: F401  the post-processors of a new job

from pkm_post.freecad_app.surface_finish import create_surface_finish
from pkm_post.freecad_app.tools import set_gauge_length

NAME = "Blade"
_EDGES = ((60, (0, -30, 0), 0), (80, (-10, 30, -22), 8))
"""Radius, position and pitch of the two edges of the face."""
_ARC = 70, 110
_HEIGHT = 40


def create_example() -> FreeCAD.Document:
    """Create the document: the blade, a job for a hexapod with one tool, and Surface Finish on its upper face."""
    document = FreeCAD.newDocument(NAME)
    blade = _blade(document)
    job = _job(blade)
    faces = blade.Shape.Faces
    upper = f"Face{1 + max(range(len(faces)), key=lambda row: faces[row].CenterOfMass.z)}"
    finish = create_surface_finish(job, [(job.Model.Group[0], [upper])], NAME, fit=True)
    finish.Order, finish.Stepover, finish.ChordTolerance, finish.AxisTolerance = "Zigzag", 2, 0.05, 1
    document.recompute()
    return document


def _blade(document: FreeCAD.Document) -> Any:
    edges = []
    for radius, position, pitch in _EDGES:
        edge = document.addObject("Part::Circle", "Circle")
        edge.Radius, (edge.Angle1, edge.Angle2) = radius, _ARC
        edge.Placement = FreeCAD.Placement(FreeCAD.Vector(*position), FreeCAD.Rotation(0, pitch, 90))
        edges.append(edge)
    loft = document.addObject("Part::Loft", "Loft")
    loft.Sections, loft.Solid, loft.Ruled = edges, False, True
    blade = document.addObject("Part::Extrusion", NAME)
    blade.Base, blade.DirMode, blade.Dir, blade.LengthFwd, blade.Solid = loft, "Custom", (0, 0, -1), _HEIGHT, True
    document.recompute()
    return blade


def _job(blade: Any) -> Any:
    if FreeCAD.GuiUp:
        from Path.Main.Gui.Job import Create

        Create([blade.Name], None, openTaskPanel=False)
        job = blade.Document.getObject("Job")
    else:
        job = Path.Main.Job.Create("Job", [blade], None)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--machine example_6tps --work-offset G54"
    controller = job.Tools.Group[0]
    controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = "1800 mm/min", "600 mm/min", 12000
    controller.Tool.Diameter = controller.Tool.ShankDiameter = 10
    set_gauge_length(controller, 120)
    blade.Document.recompute()
    return job
