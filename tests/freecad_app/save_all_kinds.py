# SPDX-License-Identifier: LGPL-2.1-or-later
"""Saves a document with every kind of document object of PKM Post, small, and with no path of this computer in it.

Run in FreeCAD 1.0, the oldest that is supported, with the folder that gets ``pkm_post-VERSION.FCStd``; beside it lies
the part program that the document names:

    PKM_FREECAD=1.0 tools/freecad -M "$PWD" tools/run_script.py -- tests/freecad_app/save_all_kinds.py tests/data/saved

What lies in tests/data/saved was written by the version in its name. Tests open it; it is never written again: a
new version gets a file of its own.
"""

import math
import os
import sys
from pathlib import Path

import FreeCAD

sys.path.insert(0, str(Path(__file__).parent))

from cam_jobs import FIVE_AXIS, add_operation, new_job

import pkm_post
from pkm_post.freecad_app.machine_object import create_machine
from pkm_post.freecad_app.normal_compensation import create_normal_compensation
from pkm_post.freecad_app.program_object import create_program
from pkm_post.freecad_app.reach_object import create_reach
from pkm_post.freecad_app.simulation_object import create_simulation
from pkm_post.freecad_app.surface_finish import create_surface_finish
from pkm_post.freecad_app.symmetry import create_mirror, create_rotation

PROGRAM = "part.ngc"
ON_TOP = ["G0 X5 Y5 Z40", "G1 Z20 F10", "G1 X15", "G0 Z40"]
QUARTER = ["G0 X60 Y0 Z90", "G0 Z40", "G1 Z30 F5", "G3 X0 Y60 I-60 J0 F20", "G0 Z40", "G0 Z90"]
ARGUMENTS = "--machine example_6tps --work-offset=0,0,250"


def all_kinds(program):
    """A document with every kind of object, computed; the part program is named without its folder."""
    document = FreeCAD.newDocument("all_kinds")
    job = new_job(document)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", ARGUMENTS
    controller = job.Tools.Group[0]
    controller.HorizFeed = controller.VertFeed = "1200 mm/min"
    add_operation(job, FIVE_AXIS, "Tilted")
    create_normal_compensation(add_operation(job, ON_TOP, "Contacts"))
    finish = create_surface_finish(job, [(job.Model.Group[0], ["Face6"])], controller=controller)
    finish.Stepover, finish.Lead, finish.Order, finish.LeadMove, finish.CheckSpacing = 5, 10, "One way", "Arc", 4
    document.recompute()
    create_mirror(finish, (0, 1, 0), (0, -10, 0))
    quarter = add_operation(job, QUARTER, "Quarter")
    mirrored = create_mirror(quarter, (1, 0, 0), (5, 0, 0), keep_climb=True)
    mirrored.MaterialSide = "Left"
    document.recompute()
    turned = create_rotation(mirrored, (0, 0, 1), math.pi / 2)
    turned.Copies = 3
    listed = create_rotation(job.Operations.Group[0], (0, 0, 1), 0.0, (10, 10, 0))
    listed.Angles = [30.0, 60.0]
    document.recompute()
    machine = create_machine(document, "example_6tps", job)
    machine.Tip, machine.ToolAxis, machine.Spin = FreeCAD.Vector(5, 5, 60), FreeCAD.Vector(0.28, 0, 0.96), 5
    create_reach(job, machine)
    create_simulation(job, machine)
    create_program(document, program).File = program.name
    document.recompute()
    return document


def main():
    """Save it in a folder; the working directory is the folder, since the part program is named from it."""
    folder = Path(sys.argv[1]).resolve()
    os.chdir(folder)
    document = all_kinds(folder / PROGRAM)
    document.saveAs(str(folder / f"pkm_post-{pkm_post.__version__}.FCStd"))
    FreeCAD.closeDocument(document.Name)


if __name__ == "__main__":
    main()
