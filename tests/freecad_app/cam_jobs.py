# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM jobs for the tests: a box, a job, and operations made from lines of G-code (F in mm/s, as inside FreeCAD)."""

import FreeCAD as App
import Part
import Path
import Path.Main.Job
import Path.Op.Custom

from pkm_post.freecad_app.tools import set_gauge_length

ARC = ["G0 Z10", "G0 X0 Y0", "G1 Z0 F5", "G2 X10 Y0 I5 J0", "G3 X10 Y0 Z-2 I-3 J0", "G0 Z10"]
FIVE_AXIS = [
    "G0 X0 Y0 Z30 I0 J0 K1",
    "G1 X0 Y0 Z5 I0 J0.28 K0.96 F20",
    "G1 X10 Y4 Z5 I0.28 J0 K0.96 F25",
    "G0 X10 Y4 Z30 I0 J0 K1",
]

ON_EXAMPLE = "--machine example_6tps --work-offset={}"
"""Arguments of a job, but for its work offset."""


BELOW = -5.0
"""The top of a part that the tool meets neither in ARC nor in FIVE_AXIS, in mm."""


def new_job(document, top=20.0):
    """A box that ends at a height, and a job with one tool controller that lacks nothing."""
    box = document.addObject("Part::Feature", "Stock")
    box.Shape = Part.makeBox(20, 20, 20, App.Vector(0, 0, top - 20.0))
    document.recompute()
    job = Path.Main.Job.Create("Job", [box], None)
    controller = job.Tools.Group[0]
    controller.SpindleSpeed, controller.SpindleDir = 9000, "Forward"
    set_gauge_length(controller, 120)
    return job


def job_in_reach(document, top=20.0):
    """A job that the example machine is to do, where it can reach it."""
    job = new_job(document, top)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", ON_EXAMPLE.format("0,0,250")
    return job


def add_operation(job, lines=FIVE_AXIS, label="Cut"):
    """An operation with these lines of G-code, computed."""
    operation = Path.Op.Custom.Create("Custom", parentJob=job)
    operation.Label = label
    operation.ToolController = job.Tools.Group[0]
    operation.Gcode = lines
    job.Document.recompute()
    return operation


def add_tool_controller(job, number):
    """One more tool controller, its gauge length known."""
    import Path.Tool.Controller

    controller = Path.Tool.Controller.Create(f"TC{number}", toolNumber=number)
    job.Proxy.addToolController(controller)
    controller.SpindleSpeed, controller.SpindleDir = 5000, "Forward"
    set_gauge_length(controller, 100 + number)
    return controller


def turn(controller, direction):
    """Set the direction of the spindle; FreeCAD 1.1 has it in the tool bit as well, and posts that of the bit."""
    controller.SpindleDir = direction
    if hasattr(controller.Tool, "SpindleDirection"):
        controller.Tool.SpindleDirection = direction


def moves(operation):
    """The commands of an operation without comments, as (name, words)."""
    commands = operation.Path.Commands
    return [(command.Name, command.Parameters) for command in commands if not command.Name.startswith("(")]


def reopened(document, path):
    """The document, saved and opened again."""
    document.saveAs(str(path))
    App.closeDocument(document.Name)
    return App.openDocument(str(path))
