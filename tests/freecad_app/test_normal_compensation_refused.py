# SPDX-License-Identifier: LGPL-2.1-or-later
"""What Normal Compensation refuses, and where it says it is."""

import types

import FreeCAD as App
import numpy as np
import Part
import pytest
from cam_jobs import moves
from normal_compensations import (
    ACROSS_THE_TOP,
    COMMENTS,
    SIX_DECIMALS,
    SPHERE_RADIUS,
    Z,
    dressed,
    lines,
    poses,
    refused,
    valid,
)
from part_jobs import job_on

from pkm_post.freecad_app import progress
from pkm_post.freecad_app.normal_compensation import FROM_NORMAL


@pytest.fixture
def box_job(document):
    return job_on(document, Part.makeBox(20, 20, 20))


def test_point_off_the_faces_is_reported_with_its_place_and_distance(box_job):
    text = refused(dressed(box_job, lines([(5, 5, 20), (15, 5, 20.5), (15, 8, 20)])))
    assert "N111" in text
    assert f"part: Cut: line {COMMENTS + 3}" in text
    assert "X 15 mm, Y 5 mm, Z 20.5 mm is 0.5 mm from" in text
    assert ".Face6, Tolerance 10 µm" in text


def test_wider_tolerance_takes_the_point(box_job):
    dressup = dressed(box_job, lines([(5, 5, 20), (15, 5, 20.5)]), Tolerance=0.6)
    assert poses(valid(dressup))[0][:, 2] == pytest.approx([20, 20.5], abs=SIX_DECIMALS)


def test_point_beyond_the_edge_of_a_face_is_off_it(box_job):
    text = refused(dressed(box_job, lines([(5, 5, 20), (25, 5, 20)])))
    assert "N111" in text
    assert "X 25 mm, Y 5 mm, Z 20 mm is 5 mm from" in text


def test_point_over_a_hole_in_a_face_is_off_it(document):
    plate = Part.makeBox(20, 20, 20).cut(Part.makeCylinder(5, 30, App.Vector(10, 10, 0)))
    text = refused(dressed(job_on(document, plate), lines([(2, 2, 20), (10, 10, 20)])))
    assert "X 10 mm, Y 10 mm, Z 20 mm is 5 mm from" in text


def test_point_beyond_the_edge_within_the_tolerance_is_on_the_face(document):
    """The surface of the face goes on there; over a hole the box about the face does not leave such points out."""
    plate = Part.makeBox(20, 20, 20).cut(Part.makeCylinder(5, 30, App.Vector(10, 10, 0)))
    job = job_on(document, plate)
    top = next(number for number, face in enumerate(plate.Faces, start=1) if face.CenterOfMass.z > 19.99)
    dressup = dressed(job, lines([(10, 4, 20), (10, 5.008, 20)]), Faces=[(job.Model.Group[0], f"Face{top}")])
    assert poses(valid(dressup))[0][1] == pytest.approx([10, 5.008, 20], abs=SIX_DECIMALS)
    dressup.Base.Gcode = lines([(10, 4, 20), (10, 5.012, 20)])
    document.recompute()
    assert "is 12 µm from" in refused(dressup)


def test_nearer_one_of_two_faces_is_reported_first(box_job):
    name = box_job.Model.Group[0].Label
    text = refused(dressed(box_job, lines([(5, 5, 20), (19.995, 5, 20)])))
    assert f"is on {name}.Face6 and on {name}.Face2" in text


def test_point_at_an_edge_is_reported_unless_its_face_is_chosen(box_job):
    dressup = dressed(box_job, lines([(5, 5, 20), (20, 5, 20)]))
    text = refused(dressup)
    assert "N112" in text
    assert f"part: Cut: line {COMMENTS + 3}" in text
    assert ".Face2" in text
    assert ".Face6" in text
    dressup.Faces = [(box_job.Model.Group[0], ("Face6",))]
    box_job.Document.recompute()
    assert poses(valid(dressup))[0] == pytest.approx(np.array([(5, 5, 20), (20, 5, 20)]), abs=SIX_DECIMALS)


def test_smooth_edge_is_no_edge(document):
    """Two cylinders of one radius on each other have two faces and one normal."""
    shape = Part.makeCylinder(10, 10).fuse(Part.makeCylinder(10, 10, App.Vector(0, 0, 10)))
    assert len(shape.Faces) == 4
    dressup = valid(dressed(job_on(document, shape), lines([(10, 0, 15), (10, 0, 10), (10, 0, 5)])))
    assert poses(dressup)[0] == pytest.approx(np.array([(15, 0, 10), (15, 0, 5), (15, 0, 0)]), abs=SIX_DECIMALS)


def test_cut_round_an_edge_without_a_point_on_it_is_reported(box_job):
    """The centre of the ball would cut the corner by 5 (1 - cos 45) = 1.46 mm."""
    text = refused(dressed(box_job, lines([(19.9, 5, 20), (20, 5, 19.9)])))
    assert "N113" in text
    assert "the normal by 90, the axis by 0 degrees; halfway the tool would be 1.46 mm off" in text
    assert f"part: Cut: line {COMMENTS + 3}" in text


def test_stock_makes_the_corner_that_is_cut_larger(box_job):
    text = refused(dressed(box_job, lines([(19.9, 5, 20), (20, 5, 19.9)]), StockToLeave=1))
    assert "the tool would be 1.76 mm off" in text  # (5 + 1) (1 - cos 45)


def test_flat_end_mill_would_jump_over_a_summit(document):
    """From one side of the pole to the other it is its other edge that touches: half way its tip is 5 mm off either."""
    angle = np.array([-0.3, -0.1, 0.1])
    points = SPHERE_RADIUS * np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
    text = refused(dressed(job_on(document, Part.makeSphere(SPHERE_RADIUS), "endmill.fcstd"), lines(points)))
    assert f"part: Cut: line {COMMENTS + 4}: error N113" in text
    assert "the normal by 11.5, the axis by 0 degrees; halfway the tool would be 5 mm off" in text


def test_rapid_move_onto_a_face_may_come_from_another_one(box_job):
    code = ["G0 X5 Y5 Z60", "G0 Z20", "G1 X15 F10", "G0 X20 Z10", "G1 Y15", "G0 Z60"]
    dressup = valid(dressed(box_job, code))
    expected = [(5, 5, 60), (5, 5, 20), (25, 5, 5), (25, 15, 60)]
    assert poses(dressup, "G0")[0] == pytest.approx(np.array(expected), abs=SIX_DECIMALS)


def test_plane_that_looks_down_is_undercut(box_job):
    assert "N102" in refused(dressed(box_job, lines([(5, 5, 0), (15, 5, 0)])))


def test_axis_that_turns_lifts_the_tool(box_job):
    """The tip goes straight while the centre of the ball goes round it: 5 (1 - cos 10) = 0.076 mm in the middle."""
    axes = [(np.sin(angle), 0, np.cos(angle)) for angle in np.radians([10, -10])]
    dressup = dressed(box_job, lines(ACROSS_THE_TOP[:2], axes))
    assert "the normal by 0, the axis by 20 degrees; halfway the tool would be 0.076 mm off" in refused(dressup)
    dressup.ChordTolerance = 0.08
    box_job.Document.recompute()
    valid(dressup)


def test_axis_that_turns_with_the_normal_keeps_a_ball_on_the_surface(document):
    """Both turn by 0.2 rad: the normal alone would take the ball 5 (1 - cos 0.1) = 0.025 mm off."""
    angle = np.arange(-1.0, 1.0, 0.2)
    points = SPHERE_RADIUS * np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
    job = job_on(document, Part.makeSphere(SPHERE_RADIUS))
    valid(dressed(job, lines(points), ToolAxis=FROM_NORMAL, ChordTolerance=0.001))
    assert "0.025 mm off" in refused(dressed(job, lines(points), ChordTolerance=0.001))


def test_operation_of_rapid_moves_stays_as_it_is(box_job):
    dressup = valid(dressed(box_job, ["G0 X5 Y5 Z60", "G0 X15"]))
    assert poses(dressup, "G0")[0] == pytest.approx(np.array([(5, 5, 60), (15, 5, 60)]))


def test_undercut_is_reported_at_its_command(document):
    """Below its equator a sphere looks away from an upright tool."""
    angle = np.arange(1.0, 2.0, 0.05)
    points = SPHERE_RADIUS * np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
    text = refused(dressed(job_on(document, Part.makeSphere(SPHERE_RADIUS)), lines(points)))
    assert "N102" in text
    assert f"part: Cut: line {COMMENTS + 14}" in text  # 1.0 + 12 * 0.05 is the first angle beyond pi / 2


def test_lone_point_has_no_direction_to_lean(box_job):
    code = ["G0 X5 Y5 Z60", "G1 Z20 F5", "G0 Z60"]
    assert "N114" in refused(dressed(box_job, code, ToolAxis=FROM_NORMAL, Lead=5))
    assert poses(valid(dressed(box_job, code, ToolAxis=FROM_NORMAL)))[1] == pytest.approx(Z[None])


def test_face_that_is_gone_is_reported(box_job):
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    dressup.Faces = [(box_job.Model.Group[0], ("Face6",))]
    box_job.Proxy.baseObject(box_job, box_job.Model.Group[0]).Shape = Part.makeSphere(10)
    box_job.Document.recompute()
    text = refused(dressup)
    assert "N115" in text
    assert "Face6" in text


def test_drill_is_refused(document):
    job = job_on(document, Part.makeBox(20, 20, 20), "drill.fcstd")
    assert "N116" in refused(dressed(job, lines(ACROSS_THE_TOP)))


def test_stopped_computation_leaves_nothing(box_job, monkeypatch):
    """There is no Escape key without a window; FreeCAD's bar raises this when it is pressed."""

    class Bar:
        def start(self, text, steps):
            assert steps > 0

        def next(self, may_stop):
            raise RuntimeError("abort progress indicator")

        def stop(self):
            pass

    monkeypatch.setattr(progress, "Base", types.SimpleNamespace(ProgressIndicator=Bar))
    dressup = dressed(box_job, lines(ACROSS_THE_TOP))
    assert "Normal Compensation of Cut: stopped at 100 %" in refused(dressup)
    monkeypatch.undo()
    dressup.touch()
    box_job.Document.recompute()
    assert len(moves(valid(dressup))) == 5
