# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mirrored and turned operations: made, followed, nested, copied, undone, saved, opened, in CAM's own terms."""

import importlib

import FreeCAD as App
import numpy as np
import pytest
from another_freecad import printed_by
from cam_jobs import ARC, FIVE_AXIS, add_operation, moves, reopened
from Path.Base.Util import opProperty, toolControllerForOp

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.post_job import find_job
from pkm_post.freecad_app.symmetry import MirroredOperation, RotatedOperation, create_mirror, create_rotation

SIX_DECIMALS = 1e-6
XZ_PLANE, YZ_PLANE, HALF_TURN = (np.diag(signs) for signs in ((1, -1, 1), (-1, 1, 1), (-1, -1, 1)))


def poses(operation):
    """X Y Z and I J K of the straight moves."""
    words = [words for name, words in moves(operation) if name in ("G0", "G1")]
    return np.array([[each[letter] for letter in "XYZ"] for each in words]), np.array(
        [[each[letter] for letter in "IJK"] for each in words]
    )


def assert_copied(copy, base, matrix, shift=(0, 0, 0), atol=1e-12):
    for found, expected, offset in zip(poses(copy), poses(base), (shift, (0, 0, 0)), strict=True):
        np.testing.assert_allclose(found, expected @ matrix + offset, atol=atol)


@pytest.fixture
def base(job):
    return add_operation(job)


def recomputed(*objects):
    objects[0].Document.recompute()
    assert all(obj.isValid() for obj in objects)
    return objects[0] if len(objects) == 1 else objects


def test_mirror_in_a_plane(base):
    assert_copied(recomputed(create_mirror(base, (0, 1, 0))), base, XZ_PLANE)


def test_mirror_in_a_plane_away_from_the_origin(base):
    copy = recomputed(create_mirror(base, (2, 0, 0), point=(10, 99, -99)))
    assert_copied(copy, base, YZ_PLANE, shift=(20, 0, 0))


def test_turn_about_an_axis(base):
    copy = recomputed(create_rotation(base, (0, 0, 1), np.pi, point=(5, 0, 0), label="Quadrant 3"))
    assert copy.Label == "Quadrant 3"
    assert copy.Angle.Value == pytest.approx(180.0)
    assert_copied(copy, base, HALF_TURN, shift=(10, 0, 0))


def turned(base, degrees):
    return [[axis @ turn for axis in poses(base)] for turn in (rotation_matrix(angle) for angle in degrees)]


def rotation_matrix(degrees):
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]])


@pytest.mark.parametrize(
    ("copies", "angles", "found"),
    [(3, [], [72, 144, 216]), (1, [10, -35.5], [10, -35.5]), (1, [], [72])],
    ids=["by number", "by list", "one"],
)
def test_several_turns_stand_one_after_the_other(base, copies, angles, found):
    copy = create_rotation(base, (0, 0, 1), np.radians(72))
    copy.Copies, copy.Angles = copies, angles
    recomputed(copy)
    tips, axes = (np.concatenate(parts) for parts in zip(*turned(base, found), strict=True))
    np.testing.assert_allclose(poses(copy)[0], tips, atol=SIX_DECIMALS)
    np.testing.assert_allclose(poses(copy)[1], axes, atol=SIX_DECIMALS)


def test_turns_of_a_mirror_image(base):
    mirrored = recomputed(create_mirror(base, (0, 1, 0)))
    copy = create_rotation(mirrored, (0, 0, 1), np.radians(90))
    copy.Copies = 3
    recomputed(copy)
    tips = np.concatenate([tip for tip, _ in turned(mirrored, [90, 180, 270])])
    np.testing.assert_allclose(poses(copy)[0], tips, atol=SIX_DECIMALS)


def test_a_number_of_copies_below_one_is_reported_at_the_object(base):
    copy = create_rotation(base, (0, 0, 1), np.pi)
    copy.Copies = 0
    copy.Document.recompute()
    assert not copy.isValid()
    assert "Copies: expected 1 or more" in copy.getStatusString()
    assert not copy.Path.Commands
    copy.Angles = [90.0]  # instead of the number
    recomputed(copy)


def test_points_of_an_arc(job):
    base = add_operation(job, ARC)
    copy = recomputed(create_mirror(base, (1, 0, 0)))
    assert [name for name, _ in moves(base)] == ["G0", "G0", "G1", "G2", "G3", "G0"]
    assert [name for name, _ in moves(copy)] == ["G0", "G1", "G3", "G2", "G0"]
    assert moves(copy)[2][1] == {"X": -10, "Y": 0, "Z": 0, "I": -5, "J": 0, "K": 0, "F": 5}


def test_arc_turned_out_of_its_plane_becomes_chords(job):
    base = add_operation(job, ARC)
    copy = recomputed(create_rotation(base, (1, 0, 0), np.radians(20)))
    assert {name for name, _ in moves(copy)} == {"G0", "G1"}
    tips, axes = poses(copy)
    assert len(tips) > 100
    np.testing.assert_allclose(axes, [[0, -np.sin(np.radians(20)), np.cos(np.radians(20))]] * len(tips), atol=1e-9)


def test_copied_holes_are_as_exact_as_drilled_ones(job):
    base = add_operation(job, ["G0 Z10", "G0 X1 Y2", "G83 X3 Y2 Z-4 R2 Q2 F5", "G80", "G0 Z10", "G1 X9 F5"], "Holes")
    copy = create_mirror(base, normal=(0, 1, 0))
    job.Document.recompute()
    program, faults = read_job(job)
    assert faults == ()
    first, second = (program.exact_path[program.operation == number] for number in (0, 1))
    assert 0 < np.count_nonzero(first) == np.count_nonzero(second) < len(second)
    lines = [command.toGCode() for command in copy.Path.Commands]
    assert [line for line in lines if line.startswith("G6")] == ["G61", "G64"]


def test_copy_is_an_operation_of_the_job_beside_its_base(job, base):
    copy = create_mirror(base, (0, 1, 0))
    assert job.Operations.Group == [base, copy]
    assert recomputed(copy).Label == "Mirror of Cut"


def test_copy_follows_its_base(job, base):
    copy = recomputed(create_mirror(base, (0, 1, 0)))
    base.Gcode = [*FIVE_AXIS, "G0 X1 Y2 Z40 I0 J0 K1"]
    recomputed(copy, base)
    assert len(moves(copy)) == 5
    assert_copied(copy, base, XZ_PLANE)


def test_copy_follows_its_own_properties(base):
    copy = recomputed(create_mirror(base, (0, 1, 0)))
    copy.Normal = App.Vector(1, 0, 0)
    assert_copied(recomputed(copy), base, YZ_PLANE)


def test_copy_follows_the_placement_of_its_base(job, base):
    copy = recomputed(create_mirror(base, (1, 0, 0)))
    base.Placement.Base = App.Vector(100, 0, 0)
    recomputed(copy, base)
    program, faults = read_job(job)
    assert faults == ()
    np.testing.assert_allclose(program.position[4:], program.position[:4] @ YZ_PLANE)


def test_two_mirrors_are_a_half_turn(base):
    once = create_mirror(base, (0, 1, 0))
    twice = create_mirror(once, (1, 0, 0))
    turned = create_rotation(base, (0, 0, 1), np.pi)
    recomputed(twice, once, turned)
    assert_copied(twice, base, HALF_TURN)
    assert_copied(turned, base, HALF_TURN)


def test_tool_and_coolant_are_those_of_the_base_however_deep(job, base):
    base.CoolantMode = "Flood"
    deep = create_rotation(create_mirror(base, (0, 1, 0)), (0, 0, 1), 1.0)
    recomputed(deep)
    assert toolControllerForOp(deep) == base.ToolController
    assert opProperty(deep, "CoolantMode") == "Flood"
    program, faults = read_job(job)
    assert faults == ()
    assert [event.row for event in program.events] == [0, 0, 0, 12, 12]


def test_inactive_copy(job, base):
    copy = create_mirror(base, (0, 1, 0))
    copy.Active = False
    recomputed(copy)
    assert [command.Name for command in copy.Path.Commands] == ["(inactive operation)"]
    assert read_job(job)[0].operations == ("Cut",)


def test_copy_of_an_inactive_base_is_empty(job, base):
    copy = create_mirror(base, (0, 1, 0))
    base.Active = False
    recomputed(copy, base)
    assert moves(copy) == []
    assert [fault.code for fault in read_job(job)[1]] == ["J103"]


def test_copy_of_an_inactive_array_is_empty(job):
    """CAM leaves the path of an inactive Array without even a comment."""
    array = job.Document.addObject("Path::FeaturePython", "Array")
    importlib.import_module("Path.Op.Gui.Array").ObjectArray(array)
    array.Base = [add_operation(job, ARC, "Arc")]
    job.Proxy.addOperation(array)
    copy = create_mirror(array, (0, 1, 0))
    array.Active = False
    recomputed(array, copy)
    assert array.Path.Size == 0 and moves(copy) == []
    _, faults = read_job(job)
    assert faults == ()


def test_copy_of_an_operation_without_a_move_to_a_known_place_is_no_damaged_one(job, base):
    """As of a boundary around nothing, whose path is G0 alone; a path without even a comment was not computed."""
    add_operation(job, ["G0 Z50"], "Up")
    copy = recomputed(create_mirror(job.Operations.Group[-1], (0, 1, 0)))
    assert [command.Name for command in copy.Path.Commands] == ["(no moves)"]
    program, faults = read_job(job)
    assert [(fault.code, fault.place.operation) for fault in faults] == [("J141", copy.Label)]
    assert program.operations == ("Cut", "Up", copy.Label)


def test_deleted_base_leaves_an_empty_copy_that_is_refused(job, base):
    other = add_operation(job, label="Other")
    copy = recomputed(create_mirror(base, (0, 1, 0)))
    job.Document.removeObject(base.Name)
    recomputed(copy)
    assert copy.Base is None
    assert moves(copy) == []
    program, (fault,) = read_job(job)
    assert program is None
    assert (fault.code, fault.place.operation) == ("J116", copy.Label)
    copy.Base = other
    recomputed(copy)
    assert len(read_job(job)[0]) == 8


def test_fault_in_the_base_is_reported_at_both_and_leaves_no_old_path(job, base):
    copy = recomputed(create_mirror(base, (0, 1, 0)))
    base.Gcode = [*FIVE_AXIS, "G86 X1"]
    job.Document.recompute()
    assert not copy.isValid()
    assert moves(copy) == []
    program, faults = read_job(job)
    assert program is None
    assert [(fault.code, fault.place.operation) for fault in faults] == [("J104", "Cut"), ("J116", copy.Label)]
    assert "J104" in faults[1].found


def test_normal_without_direction_is_reported_at_the_copy(job, base):
    copy = create_mirror(base, (0, 0, 0))
    job.Document.recompute()
    assert "direction" in copy.getStatusString()
    assert [fault.code for fault in read_job(job)[1]] == ["J116"]


def test_document_can_be_copied(base):
    copy = recomputed(create_mirror(base, (0, 1, 0)))
    second = base.Document.copyObject(copy)
    second.Base = base
    second.Normal = App.Vector(1, 0, 0)
    assert isinstance(second.Proxy, MirroredOperation)
    assert_copied(recomputed(second), base, YZ_PLANE)
    assert_copied(copy, base, XZ_PLANE)


def test_one_undo_takes_it_back_and_redo_brings_it_again(job, base):
    document = job.Document
    document.UndoMode = 1
    document.openTransaction("Mirror")
    name = create_mirror(base, (0, 1, 0)).Name
    document.commitTransaction()
    document.recompute()
    document.undo()
    assert document.getObject(name) is None
    assert job.Operations.Group == [base]
    document.redo()
    document.recompute()
    assert_copied(recomputed(document.getObject(name)), base, XZ_PLANE)
    assert len(job.Operations.Group) == 2


def test_operation_of_no_job_is_the_callers_fault(document):
    alone = document.addObject("Path::FeaturePython", "Alone")
    with pytest.raises(ValueError, match="operation of a CAM job"):
        create_mirror(alone, (0, 1, 0))
    assert [obj.Name for obj in document.Objects] == ["Alone"]


@pytest.fixture
def saved(job, base, tmp_path):
    """A document with a mirror and a turned mirror, saved and opened again."""
    mirrored = create_mirror(base, (0, 1, 0), label="Mirror")
    create_rotation(mirrored, (0, 0, 1), np.pi, label="Turn")
    recomputed(mirrored)
    return reopened(job.Document, tmp_path / "saved part.FCStd")


def labelled(document, *labels):
    return [document.getObjectsByLabel(label)[0] for label in labels]


def test_saved_copies_live_on(saved):
    base, mirrored, turned = labelled(saved, "Cut", "Mirror", "Turn")
    assert (type(mirrored.Proxy), type(turned.Proxy)) == (MirroredOperation, RotatedOperation)
    assert_copied(mirrored, base, XZ_PLANE, atol=2 * SIX_DECIMALS)
    base.Gcode = ["G0 X1 Y2 Z30 I0 J0 K1", "G1 X3 Y4 Z5 I0 J0.6 K0.8 F20"]
    recomputed(turned, mirrored, base)
    assert_copied(turned, base, XZ_PLANE @ HALF_TURN)


def test_names_in_saved_documents_are_a_file_format(saved):
    proxies = [labelled(saved, label)[0].Proxy for label in ("Mirror", "Turn")]
    assert [f"{type(proxy).__module__}.{type(proxy).__name__}" for proxy in proxies] == [
        "pkm_post.freecad_app.symmetry.MirroredOperation",
        "pkm_post.freecad_app.symmetry.RotatedOperation",
    ]


def test_document_of_an_older_version_gets_the_missing_properties(job, base, tmp_path):
    copy = recomputed(create_mirror(base, (1, 0, 0)))
    for name in ("Point", "Active", "KeepClimb", "Plane", "MaterialSide", "CutOfBase", "ReversedPasses"):
        copy.removeProperty(name)
    document = reopened(job.Document, tmp_path / "old.FCStd")
    base, copy = labelled(document, "Cut", "Mirror of Cut")
    assert (copy.Active, copy.Point) == (True, App.Vector())
    assert (copy.KeepClimb, copy.Plane, copy.MaterialSide) == (False, None, "Not stated")
    copy.touch()
    assert_copied(recomputed(copy), base, YZ_PLANE)


_OPEN_AND_CHANGE = """
import sys, FreeCAD as App
document = App.openDocument(sys.argv[1])
base, copy = (document.getObjectsByLabel(label)[0] for label in ("Cut", "Turn"))
base.Gcode = ["G0 X1 Y2 Z30 I0 J0 K1", "G1 X3 Y4 Z5 I0 J0.6 K0.8 F20"]
document.recompute()
commands = [command for command in copy.Path.Commands if not command.Name.startswith("(")]
print("copy:", type(copy.Proxy).__name__, [round(commands[-1].Parameters[letter], 6) + 0.0 for letter in "XYZIJKF"])
"""


def test_saved_copies_live_on_in_a_fresh_freecad(saved, tmp_path):
    path, script = saved.FileName, tmp_path / "change.py"
    script.write_text(_OPEN_AND_CHANGE)
    App.closeDocument(saved.Name)
    # (3, 4, 5), mirrored in y, then turned by 180 degrees: (-3, 4, 5), the tool axis with it
    assert "copy: RotatedOperation [-3.0, 4.0, 5.0, 0.0, 0.6, 0.8, 20.0]" in printed_by(script, path)


def test_fault_is_not_forgotten_in_a_saved_document(job, base, tmp_path):
    create_mirror(base, (0, 0, 0))
    job.Document.recompute()
    document = reopened(job.Document, tmp_path / "faulty.FCStd")
    _, faults = read_job(find_job(document))
    assert [fault.code for fault in faults] == ["J116"]
