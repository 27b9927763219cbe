# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complete a lap around the part from the first operation of the active document's job, which cuts x > 0, y > 0.

The copies follow each other around the lap. The mirrored ones run in reverse, so that all of them climb mill or none
does, and each begins where the previous one ended. The Report view shows the angle that they cover together.
"""

import math

import FreeCAD

import pkm_post as pkm

document = FreeCAD.ActiveDocument
quadrant = pkm.jobs(document)[0].Operations.Group[0]
pkm.mirror(quadrant, normal=(1, 0, 0), label="Quadrant 2", keep_climb=True)
pkm.rotate(quadrant, axis=(0, 0, 1), angle=math.pi, label="Quadrant 3")
pkm.mirror(quadrant, normal=(0, 1, 0), label="Quadrant 4", keep_climb=True)
document.recompute()

family = pkm.symmetry(quadrant)
if family.coverage is None:
    FreeCAD.Console.PrintError(f"{quadrant.Label} does not go around the z axis\n")
else:
    covered, overlap = (math.degrees(angle) for angle in (family.coverage.covered, family.coverage.overlap))
    apart = max((joint.distance for joint in family.joints), default=math.inf)
    FreeCAD.Console.PrintMessage(
        f"{family.members} quadrants: {covered:.3f} degrees covered, {overlap:.3f} of them twice, "
        f"{len(family.joints)} joints, tips {apart:.3f} mm apart at most\n"
    )
