# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finishes over chosen faces of a part: made, computed, and what came of them."""

import FreeCAD as App
import numpy as np
import Part
from cam_jobs import moves

from pkm_post.freecad_app.surface_finish import create_surface_finish
from pkm_post.options.choices import Options

MICRON = 1e-3
SIX_DECIMALS = 1e-6
AT_G54 = Options(work_offset="G54")
CHORD = 0.005


def plate_with_hole(height=20):
    return Part.makeBox(40, 30, height).cut(Part.makeCylinder(5, 50, App.Vector(20, 15, -5)))


def face_names(shape, chosen):
    return [f"Face{number}" for number, face in enumerate(shape.Faces, start=1) if chosen(face)]


def is_top(face):
    return face.BoundBox.ZMin > 19.9


def finish(job, chosen=is_top, **properties):
    """The operation over some faces of the model, computed."""
    clone = job.Model.Group[0]
    operation = create_surface_finish(job, [(clone, face_names(clone.Shape, chosen))])
    for name, value in properties.items():
        setattr(operation, name, value)
    job.Document.recompute()
    return operation


def coarse(job, chosen=is_top, **properties):
    """The same with few passes, and without a search for gouges unless one is asked for."""
    return finish(job, chosen, **({"Stepover": 5.0, "CheckSpacing": 0.0} | properties))


def valid(operation):
    assert operation.isValid(), operation.getStatusString()
    return operation


def poses(operation, codes=("G0", "G1")):
    """Tips and tool axes of the moves that name all of both."""
    words = [words for name, words in moves(operation) if name in codes and {*"XYZIJK"} <= set(words)]
    table = np.array([[each[letter] for letter in "XYZIJK"] for each in words])
    return table[:, :3], table[:, 3:] / np.linalg.norm(table[:, 3:], axis=1, keepdims=True)


LEAD_ROWS = 20
"""More than a quarter circle of 2 mm has chords."""


def cutting(operation):
    """Tips and axes at the ends and in the middle of the moves with the cutter on the wall: one run without lifts."""
    words = [words for name, words in moves(operation) if name == "G1"][LEAD_ROWS:-LEAD_ROWS]
    table = np.array([[each[letter] for letter in "XYZIJKF"] for each in words])
    tip, axis = table[:, :3], table[:, 3:6]
    return np.vstack([tip, (tip[1:] + tip[:-1]) / 2]), np.vstack([axis, (axis[1:] + axis[:-1]) / 2])


def gap_to(wall, tip, axis):
    """How far the corner is from the wall: a tube of 4 mm about the corner circle, negative where it cuts in."""
    along = App.Vector(*axis).normalize()
    circle = Part.Circle(App.Vector(*tip) + along * 4.0, along, 4.0).toShape()
    found = circle.distToShape(wall)[0] - 4.0
    if found < CHORD:
        return found
    # OpenCASCADE may miss the nearest places of two curved shapes, but not the foot of a point.
    return min(wall.distToShape(Part.Vertex(point))[0] for point in circle.discretize(Number=721)) - 4.0
