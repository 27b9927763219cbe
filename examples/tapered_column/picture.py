# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of path, part and machine in FreeCAD's 3D view; run by FreeCAD with its window, on a display or under Xvfb.

The environment says what to draw, since FreeCAD would open the files that its command line names: PKM_DOCUMENT,
PKM_MACHINE, PKM_PATH_PICTURE for the path of the tool tip over the part, each operation in a colour of its own, and
PKM_PICTURE for the machine. It stands where the middle of the first operation has it, around the part as the work
offset places it.
"""

import os
import sys
import traceback

import FreeCAD
import FreeCADGui
import numpy as np
from PySide import QtCore

import pkm_post as pkm

SIZE = 1200, 1000
FROM_ABOVE = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 20) * FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 45)
"""Orientation of the camera on the path."""
STANDING_UP = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 20) * FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 70)
"""Orientation of the camera on the machine: from the front, a little from the right and from above."""


COLOURS = (0.46, 0.31, 0.48), (0.20, 0.40, 0.64), (0.31, 0.60, 0.02), (0.77, 0.63, 0.00)
"""Of the operations, in their order; rapid moves are red."""


def show_path(document):
    """Hide what would hide the path, and give each operation its colour."""
    job = pkm.job(document)
    for item in (job.Stock, *(controller.Tool for controller in job.Tools.Group)):
        item.ViewObject.Visibility = False
    for operation, colour in zip(job.Operations.Group, COLOURS, strict=True):
        operation.ViewObject.NormalColor = colour
        operation.ViewObject.LineWidth = 1


def show_machine(document, machine):
    """Add the machine to the document, at the middle of the job's first operation."""
    job = pkm.job(document)
    program = pkm.read(job)
    rows = np.flatnonzero(program.operation == 0)
    row = int(rows[len(rows) // 2])
    number = next(event.value for event in program.events if event.kind == pkm.EventKind.TOOL_CHANGE)
    tool = program.tools[int(number)]
    shown = pkm.add_machine(document, machine, job)
    shown.Tip = FreeCAD.Vector(*program.position[row])
    shown.ToolAxis = FreeCAD.Vector(*program.tool_axis[row])
    shown.ToolLength, shown.ToolDiameter, shown.ToolCornerRadius = tool.length, tool.diameter, tool.corner_radius


def draw(document_path, machine_name, path_picture, picture_path):
    """Open, show, and save the pictures."""
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/View").SetBool("ShowNaviCube", False)
    document = FreeCAD.openDocument(document_path)
    document.recompute()
    view = FreeCADGui.getDocument(document.Name).ActiveView
    view.setAnimationEnabled(False)
    view.setCameraType("Perspective")
    for show, target, orientation, fit in (
        (show_path, path_picture, FROM_ABOVE, 0.9),
        (lambda opened: show_machine(opened, machine_name), picture_path, STANDING_UP, 1.0),
    ):
        show(document)
        document.recompute()
        view.setCameraOrientation(orientation)
        view.fitAll(fit)
        view.saveImage(target, *SIZE, "White")


def main():
    """Draw, and end FreeCAD with an exit code that says how it went."""
    code = 0
    try:
        draw(*(os.environ[name] for name in ("PKM_DOCUMENT", "PKM_MACHINE", "PKM_PATH_PICTURE", "PKM_PICTURE")))
    except Exception:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


QtCore.QTimer.singleShot(1000, main)
