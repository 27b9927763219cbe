# SPDX-License-Identifier: LGPL-2.1-or-later
"""Climb milling kept behind a mirror, and the report of copies, on a quarter of a ring about z."""

import FreeCAD as App
import numpy as np
import pytest
from cam_jobs import add_operation, moves, reopened

from pkm_post.freecad_app.document_object import program_of
from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.symmetry import create_mirror, create_rotation
from pkm_post.freecad_app.symmetry_report import family_of
from pkm_post.toolpath import Copies, with_copies

QUARTER = ["G0 X60 Y0 Z90", "G0 Z40", "G1 Z30 F5", "G3 X0 Y60 I-60 J0 F20", "G0 Z40", "G0 Z90"]
EXACT, SIX_DECIMALS = 1e-9, 1e-6


@pytest.fixture
def quarter(job):
    return add_operation(job, QUARTER)


def recomputed(obj):
    obj.Document.recompute()
    assert obj.isValid(), obj.getStatusString()
    return obj


def climbing(copy):
    copy.MaterialSide = "Right"
    return recomputed(copy)


def test_passes_of_a_mirror_are_run_the_other_way(quarter):
    copy = recomputed(create_mirror(quarter, (0, 1, 0), keep_climb=True))
    assert [name for name, _ in moves(copy)] == ["G0", "G0", "G1", "G3", "G0", "G0"]
    ends = [[words[letter] for letter in "XYZ"] for _, words in moves(copy)]
    np.testing.assert_allclose(ends[:3], [[0, -60, 90], [0, -60, 40], [0, -60, 30]], atol=EXACT)
    np.testing.assert_allclose(ends[3:], [[60, 0, 30], [60, 0, 40], [60, 0, 90]], atol=EXACT)
    assert [words.get("F") for _, words in moves(copy)] == [None, None, 5, 20, None, None]
    assert copy.ReversedPasses == 1


@pytest.mark.parametrize("keep", [False, True])
def test_copies_of_a_program_are_those_of_the_tree(job, quarter, keep):
    """One law for ``--copies`` and for the operations: two ways to the same rows."""
    original, _ = read_job(job)
    expected, _ = with_copies(original, Copies(("xz", "yz", np.pi), keep))
    for normal in ((0, 1, 0), (1, 0, 0)):
        recomputed(create_mirror(quarter, normal, keep_climb=keep))
    recomputed(create_rotation(quarter, (0, 0, 1), np.pi))
    found, _ = read_job(job)
    for name in ("position", "tool_axis", "arc_centre", "arc_axis", "feed"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), atol=SIX_DECIMALS, err_msg=name)
    np.testing.assert_array_equal(found.kind, expected.kind)


@pytest.mark.parametrize(("keep", "swapped"), [(False, 1), (True, 0)])
def test_arcs_that_turn_the_other_way_are_counted(quarter, keep, swapped):
    copy = recomputed(create_mirror(quarter, (0, 1, 0), keep_climb=keep))
    assert [name for name, _ in moves(copy)][3] == ("G2" if swapped else "G3")
    assert copy.SwappedArcs == swapped


@pytest.mark.parametrize(("keep", "found"), [(False, "Conventional"), (True, "Climb")])
def test_climb_milling_is_kept_where_it_is_asked_for(quarter, keep, found):
    copy = climbing(create_mirror(quarter, (0, 1, 0), keep_climb=keep))
    assert (copy.CutOfBase, copy.CutOfCopies) == ("Climb", found)


def test_without_a_word_on_the_material_nothing_is_said(quarter):
    copy = recomputed(create_mirror(quarter, (0, 1, 0)))
    assert (copy.CutOfBase, copy.CutOfCopies) == ("Unknown", "Unknown")


@pytest.mark.parametrize(("sense", "found"), [("Forward", "Climb"), ("Reverse", "Conventional"), ("None", "Unknown")])
def test_the_sense_is_that_of_the_tool_controller(quarter, sense, found):
    quarter.ToolController.SpindleDir = sense
    assert climbing(create_rotation(quarter, (0, 0, 1), np.pi)).CutOfCopies == found


def test_sides_change_with_each_mirror_however_deep(quarter):
    once = climbing(create_mirror(quarter, (0, 1, 0)))
    twice = recomputed(create_mirror(once, (1, 0, 0)))
    turned = recomputed(create_rotation(once, (0, 0, 1), np.pi))
    kept = recomputed(create_mirror(once, (1, 0, 0), keep_climb=True))
    assert (twice.CutOfBase, twice.CutOfCopies) == ("Conventional", "Climb")
    assert (turned.CutOfBase, turned.CutOfCopies) == ("Conventional", "Conventional")
    assert (kept.CutOfBase, kept.CutOfCopies) == ("Conventional", "Conventional")


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ({"Side": "Outside", "Direction": "CW"}, "Climb"),
        ({"Side": "Inside", "Direction": "CW"}, "Conventional"),
        ({"CutMode": "Conventional"}, "Conventional"),
        ({"CutMode": "Climb", "Order": "One way"}, "Climb"),
        ({"CutMode": "Climb", "Order": "Zigzag"}, "Unknown"),
        ({"CutMode": "As it comes", "Order": "One way"}, "Unknown"),
    ],
)
def test_what_operations_say_of_themselves(quarter, words, found):
    for name, value in words.items():
        quarter.addProperty("App::PropertyString", name)
        setattr(quarter, name, value)
    assert recomputed(create_rotation(quarter, (0, 0, 1), np.pi)).CutOfBase == found


def test_a_pass_that_cannot_be_reversed_is_reported_at_the_object_with_no_path_left(quarter):
    copy = create_mirror(quarter, (0, 1, 0), keep_climb=True)
    quarter.Gcode = ["G0 X0 Y0 Z5", "G1 X20 F5", "G0 X30", "G1 X40"]
    quarter.Document.recompute()
    assert not copy.isValid()
    assert "K122" in copy.getStatusString()
    assert moves(copy) == []


def test_four_quarters_go_round_and_meet(quarter):
    copy = create_rotation(quarter, (0, 0, 1), np.radians(90))
    copy.Copies = 3
    recomputed(copy)
    assert (copy.Covered.Value, copy.Overlap.Value) == pytest.approx((360, 0), abs=SIX_DECIMALS)
    assert (copy.Tiles, copy.Joints) == (True, 4)
    assert (copy.JointDistance.Value, copy.JointTurn.Value) == pytest.approx((0, 0), abs=SIX_DECIMALS)


def test_the_turn_by_90_degrees_that_the_paper_prints_lies_on_a_mirror(quarter):
    create_mirror(quarter, (0, 1, 0))
    create_mirror(quarter, (1, 0, 0))
    turn = create_rotation(quarter, (0, 0, 1), np.radians(90))
    recomputed(turn)
    wrong = family_of(turn)
    assert (wrong.label, wrong.members) == ("Cut", 4)
    assert np.degrees([wrong.coverage.overlap, wrong.coverage.gap]) == pytest.approx([90, 90], abs=SIX_DECIMALS)
    turn.Angle = 180
    right = family_of(recomputed(turn))
    assert right.coverage.tiles
    assert len(right.joints) == 4


def test_two_mirrors_have_an_axis_where_they_cross_and_one_has_none(quarter):
    one = recomputed(create_mirror(quarter, (0, 1, 0), point=(0, 0, 7)))
    assert family_of(one).coverage is None
    across = recomputed(create_mirror(one, (1, 0, 0)))
    assert np.degrees(family_of(across).coverage.covered) == pytest.approx(270, abs=SIX_DECIMALS)
    across.Active = False
    assert family_of(recomputed(one)).members == 2


def test_copies_that_failed_or_are_switched_off_are_not_counted(quarter):
    good = recomputed(create_mirror(quarter, (0, 1, 0)))
    broken, off = create_mirror(quarter, (0, 0, 0)), create_mirror(quarter, (1, 0, 0))
    create_rotation(broken, (0, 0, 1), np.pi)
    create_rotation(off, (0, 0, 1), np.pi)
    off.Active = False
    quarter.Document.recompute()
    assert family_of(good).members == 2


def test_a_copy_whose_original_was_deleted_has_no_family(quarter):
    once = create_mirror(quarter, (0, 1, 0))
    twice = recomputed(create_mirror(once, (1, 0, 0)))
    twice.Document.removeObject(quarter.Name)
    recomputed(twice)
    found = family_of(twice)
    assert (found.members, found.coverage, found.joints) == (0, None, ())
    assert (twice.CutOfCopies, twice.Joints) == ("Unknown", 0)


@pytest.mark.parametrize(("offset", "gap", "overlap"), [(0, 0, 0), (-5, 10, 0), (5, 0, 10)])
def test_a_mirror_beside_its_base(quarter, offset, gap, overlap):
    copy = recomputed(create_mirror(quarter, (1, 0, 0), point=(offset, 0, 0)))
    assert (copy.GapToBase.Value, copy.OverlapWithBase.Value) == pytest.approx((gap, overlap), abs=SIX_DECIMALS)
    assert copy.JointDistance.Value == pytest.approx(2 * abs(offset), abs=SIX_DECIMALS)


@pytest.fixture
def block(job):
    """A block 10 x 20 x 30 in a part that stands 100 mm up."""
    document = job.Document
    part, box = document.addObject("App::Part", "Part"), document.addObject("Part::Box", "Block")
    part.Placement.Base = App.Vector(0, 0, 100)
    box.Length, box.Width, box.Height = 10, 20, 30
    part.addObject(box)
    document.recompute()
    return box


def test_plane_of_a_face_where_it_stands_in_the_document(quarter, block):
    copy = create_mirror(quarter, (0, 1, 0))
    copy.Plane = (block, ["Face6"])
    recomputed(copy)
    assert (copy.Point.z, abs(copy.Normal.z)) == pytest.approx((130, 1))
    block.Height = 40
    assert recomputed(copy).Point.z == pytest.approx(140)
    assert moves(copy)[0][1]["Z"] == pytest.approx(190)  # 90 mirrored at 140


def test_plane_named_by_its_way_through_a_part(quarter, block):
    copy = create_mirror(quarter, (0, 1, 0))
    copy.Plane = (block.getParentGeoFeatureGroup(), ["Block.Face6"])
    assert recomputed(copy).Point.z == pytest.approx(130)


@pytest.mark.parametrize(("kind", "link"), [("PartDesign::Line", "Line"), ("PartDesign::Plane", "Plane")])
def test_datum_planes_and_lines(quarter, kind, link):
    body = quarter.Document.addObject("PartDesign::Body", "Body")
    datum = body.newObject(kind, "Datum")
    datum.Placement = App.Placement(App.Vector(1, 2, 3), App.Rotation(App.Vector(1, 0, 0), -90))
    copy = create_mirror(quarter, (1, 0, 0)) if link == "Plane" else create_rotation(quarter, (0, 0, 1), np.pi)
    setattr(copy, link, (datum, [""]))
    recomputed(copy)
    direction, off = copy.Normal if link == "Plane" else copy.Axis, App.Vector(1, 2, 3) - copy.Point
    np.testing.assert_allclose(np.abs(direction), [0, 1, 0], atol=EXACT)
    away = off.dot(direction) if link == "Plane" else off.cross(direction).Length
    assert away == pytest.approx(0, abs=EXACT)


def test_axes_and_planes_of_an_origin(quarter):
    body = quarter.Document.addObject("PartDesign::Body", "Body")
    quarter.Document.recompute()
    by_role = {item.Role: item for item in body.Origin.OriginFeatures}
    turn = create_rotation(quarter, (0, 0, 1), np.pi)
    copy = create_mirror(quarter, (0, 0, 1))
    for number, (axis, plane) in enumerate((("X_Axis", "YZ_Plane"), ("Y_Axis", "XZ_Plane"), ("Z_Axis", "XY_Plane"))):
        turn.Line, copy.Plane = (by_role[axis], [""]), (by_role[plane], [""])
        recomputed(turn)
        expected = np.eye(3)[number]
        np.testing.assert_allclose(np.abs(turn.Axis), expected, atol=EXACT)
        np.testing.assert_allclose(np.abs(copy.Normal), expected, atol=EXACT)


def test_axis_of_a_round_face_and_of_a_round_edge(quarter):
    post = quarter.Document.addObject("Part::Cylinder", "Post")
    post.Placement.Base = App.Vector(7, 8, 0)
    quarter.Document.recompute()
    turn = create_rotation(quarter, (1, 0, 0), np.pi)
    for name in ("Face1", "Edge3"):
        turn.Line = (post, [name])
        recomputed(turn)
        assert (turn.Point.x, turn.Point.y, abs(turn.Axis.z)) == pytest.approx((7, 8, 1))


@pytest.mark.parametrize(("name", "reported"), [("Face1", "round"), ("Edge1", "edge"), ("", "whole")])
def test_what_is_no_plane_is_reported_at_the_object(quarter, name, reported):
    post = quarter.Document.addObject("Part::Cylinder", "Post")
    quarter.Document.recompute()
    copy = create_mirror(quarter, (0, 1, 0))
    copy.Plane = (post, [name])
    quarter.Document.recompute()
    assert not copy.isValid(), reported
    assert f"got Post {name}".strip() in copy.getStatusString()


def test_results_are_for_reading_and_are_saved(job, quarter, tmp_path):
    create_mirror(quarter, (0, 1, 0), label="Kept", keep_climb=True).MaterialSide = "Right"
    job.Document.recompute()
    document = reopened(job.Document, tmp_path / "kept.FCStd")
    (copy,) = document.getObjectsByLabel("Kept")
    assert (copy.KeepClimb, copy.CutOfCopies, copy.ReversedPasses) == (True, "Climb", 1)
    assert copy.getEditorMode("CutOfCopies") == ["ReadOnly"]
    assert len(program_of(copy)) == 6
