# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which side the material is on, against the ways that CAM's own operations go round a box of 20 mm."""

import numpy as np
import Path.Op.PocketShape
import Path.Op.Profile
import pytest
from cam_jobs import turn
from surface_finishes import coarse, valid

from pkm_post.freecad_app.document_object import program_of
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.freecad_app.symmetry_report import material_side_of
from pkm_post.toolpath.symmetry.passes import cut_chords

MIDDLE = [10, 10, 0]
COUNTERCLOCKWISE, CLOCKWISE = 1, -1


def made(job, module, name, **properties):
    operation = module.Create(name, parentJob=job)
    controller = operation.ToolController = job.Tools.Group[0]
    controller.HorizFeed = controller.VertFeed = "600 mm/min"
    for key, value in properties.items():
        setattr(operation, key, value)
    job.Document.recompute()
    assert operation.isValid()
    return operation


def winding(operation, middle=MIDDLE):
    """+1 for a way that goes round the middle counterclockwise, by twice the area that it goes round."""
    start, end = (points - middle for points in cut_chords(program_of(operation)))
    return np.sign((start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]).sum())


@pytest.mark.parametrize(("direction", "found"), [("CW", CLOCKWISE), ("CCW", COUNTERCLOCKWISE)])
def test_a_profile_round_the_outside_has_the_part_within_its_way(job, direction, found):
    operation = made(job, Path.Op.Profile, "Profile", Side="Outside", Direction=direction)
    assert winding(operation) == found
    assert material_side_of(operation) == -found  # clockwise: the middle is to the right


@pytest.mark.parametrize(("mode", "found"), [("Climb", COUNTERCLOCKWISE), ("Conventional", CLOCKWISE)])
def test_a_pocket_has_its_wall_round_its_way(job, mode, found):
    pattern = {"Base": [(job.Model.Group[0], ["Face6"])], "CutMode": mode}
    operation = made(job, Path.Op.PocketShape, "Pocket", **pattern)
    name = "ClearingPattern" if hasattr(operation, "ClearingPattern") else "OffsetPattern"
    setattr(operation, name, "Offset")
    job.Document.recompute()
    assert winding(operation) == found
    assert material_side_of(operation) == found  # counterclockwise: what is outside is to the right
    setattr(operation, name, "ZigZag")
    assert material_side_of(operation) == 0


@pytest.mark.parametrize("keep", [False, True])
def test_a_mirrored_profile_goes_round_as_it_has_to(job, keep):
    operation = made(job, Path.Op.Profile, "Profile", Side="Outside", Direction="CW")
    copy = create_mirror(operation, (1, 0, 0), keep_climb=keep)
    job.Document.recompute()
    assert copy.isValid(), copy.getStatusString()
    assert (copy.CutOfBase, copy.CutOfCopies) == ("Climb", "Climb" if keep else "Conventional")
    assert winding(copy, middle=[-10, 10, 0]) == (CLOCKWISE if keep else COUNTERCLOCKWISE)


@pytest.mark.parametrize("direction", ["Forward", "Reverse"])
@pytest.mark.parametrize("mode", ["Climb", "Conventional"])
def test_surface_finish_has_the_material_where_its_own_spindle_cuts_so(job, mode, direction):
    controller = job.Tools.Group[0]
    controller.HorizFeed = controller.VertFeed = "600 mm/min"
    turn(controller, direction)
    operation = valid(coarse(job, lambda face: face.BoundBox.ZMin > 19.9, Order="One way", CutMode=mode))
    copy = create_mirror(operation, (1, 0, 0))
    job.Document.recompute()
    assert copy.CutOfBase == mode
    assert copy.CutOfCopies == {"Climb": "Conventional", "Conventional": "Climb"}[mode]
    start, end = cut_chords(program_of(operation))
    assert material_side_of(operation) == material_to_the_right(start, end)


def material_to_the_right(start, end):
    """+1 where the passes still to come are to the right of the first pass, -1 to the left."""
    along, to_the_last = end[0] - start[0], end[-1] - start[0]
    return np.sign(along[1] * to_the_last[0] - along[0] * to_the_last[1])
