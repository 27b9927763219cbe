# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation on shapes whose tips are known, and on the loft of the column."""

import math

import FreeCAD as App
import numpy as np
import Part
import pytest
from cam_jobs import moves
from normal_compensations import (
    ACROSS_THE_TOP,
    BALL_RADIUS,
    MICRON,
    SIX_DECIMALS,
    SPHERE_RADIUS,
    Z,
    bull_nose,
    dressed,
    lines,
    over_the_sphere,
    poses,
    refused,
    slope,
    valid,
)
from part_jobs import job_on, load_example

from pkm_post.freecad_app.normal_compensation import FROM_NORMAL


@pytest.fixture
def box_job(document):
    return job_on(document, Part.makeBox(20, 20, 20))


@pytest.mark.parametrize("cutter", [{}, {"bit": "endmill.fcstd"}, bull_nose(10, 2)], ids=["ball", "flat", "bull nose"])
def test_on_a_plane_across_the_tool_axis_tips_are_the_points(document, cutter):
    dressup = valid(dressed(job_on(document, Part.makeBox(20, 20, 20), **cutter), lines(ACROSS_THE_TOP)))
    assert poses(dressup)[0] == pytest.approx(np.array(ACROSS_THE_TOP), abs=SIX_DECIMALS)
    assert poses(dressup, "G0")[0] == pytest.approx(np.array([(5, 5, 60), (15, 12, 60)]), abs=SIX_DECIMALS)


@pytest.mark.parametrize(
    ("shape", "axis", "tip"),
    [
        (slope, Z, (8.8284, 0.0, -1.1716)),
        (slope, np.array([0.0, -np.sin(np.radians(20.0)), np.cos(np.radians(20.0))]), (8.5056, 3.1927, -0.2662)),
        (
            lambda: Part.makeBox(20, 20, 20, App.Vector(-10, -10, -20)),
            np.array([0.5, 0, 0.8660254]),
            (-7.1962, 0, 3.5359),
        ),
    ],
    ids=["upright on a slope", "leaning on a slope", "leaning on a plane"],
)
def test_bull_nose_on_a_plane_against_worked_numbers(document, shape, axis, tip):
    points = np.array([(0.0, 0.0, 0.0), (0.0, 5.0, 0.0)])
    dressup = valid(dressed(job_on(document, shape(), **bull_nose(20, 4)), lines(points, [axis, axis])))
    assert poses(dressup)[0] == pytest.approx(points + tip, abs=1e-4)


@pytest.mark.parametrize(
    "properties", [{}, {"ToolAxis": FROM_NORMAL, "Lead": 10, "Tilt": -20}], ids=["kept", "leaning"]
)
def test_centre_of_a_ball_is_its_radius_off_a_sphere(document, properties):
    sphere = Part.makeSphere(SPHERE_RADIUS)
    dressup = valid(dressed(job_on(document, sphere), lines(SPHERE_RADIUS * over_the_sphere()), **properties))
    tips, axes = poses(dressup)
    centres = tips + BALL_RADIUS * axes
    distances = [sphere.Faces[0].distToShape(Part.Vertex(App.Vector(*centre)))[0] for centre in centres]
    assert np.array(distances) == pytest.approx(BALL_RADIUS, abs=MICRON)
    assert centres / np.linalg.norm(centres, axis=1)[:, None] == pytest.approx(over_the_sphere(), abs=SIX_DECIMALS)


def test_faces_that_were_drawn_are_found_up_to_where_they_bulge_out_of_their_triangles(document):
    job = job_on(document, Part.makeSphere(SPHERE_RADIUS))
    shape = job.Model.Group[0].Shape
    shape.tessellate(2.0)  # as a window does
    job.Model.Group[0].Shape = shape
    angle = np.linspace(3.0, 3.3, 10)
    equator = SPHERE_RADIUS * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    assert job.Model.Group[0].Shape.Faces[0].BoundBox.XMin > equator[:, 0].min() + MICRON
    tips, _ = poses(valid(dressed(job, lines(equator))))
    assert tips + BALL_RADIUS * Z == pytest.approx(equator * (1 + BALL_RADIUS / SPHERE_RADIUS), abs=SIX_DECIMALS)


def test_cutter_touches_the_loft_of_the_tapered_column(document):
    example = load_example()
    column = example.Column(stepover=25.0, spacing=2.0)
    touched = example.contacts(column)
    axes = example.tool_axes(touched.normal, column.relief, touched.lead)
    job = job_on(document, example.solid(column), **bull_nose(column.tool.diameter, column.tool.corner_radius))
    links = np.linalg.norm(np.diff(touched.point, axis=0), axis=1) > 3.0  # from one level to the next
    assert links.any()
    last = np.append(np.flatnonzero(links), len(axes) - 1)
    first = np.append(0, last[:-1] + 1)
    passes = [lines(touched.point[a : b + 1], axes[a : b + 1]) for a, b in zip(first, last, strict=True)]
    high = [line.replace("Z60", "Z100") for cut in passes for line in cut]
    tips, found_axes = poses(valid(dressed(job, high, Faces=[(job.Model.Group[0], "Face1")])))
    wall = example.wall(example.solid(column))
    e = column.tool.diameter / 2 - column.tool.corner_radius
    for tip, axis in zip(tips[::7], found_axes[::7], strict=True):
        centre, direction = App.Vector(*(tip + column.tool.corner_radius * axis)), App.Vector(*axis)
        corner_circle = Part.Circle(centre, direction, e).toShape()
        assert wall.distToShape(corner_circle)[0] == pytest.approx(column.tool.corner_radius, abs=MICRON)


def test_arcs_become_chords_before_they_are_compensated(document):
    """On a cylinder of radius 10 a ball of radius 5 runs round on a circle, its tip at half its height."""
    job = job_on(document, Part.makeCylinder(10, 20))
    dressup = valid(dressed(job, ["G0 X10 Y0 Z60", "G1 Z10 F10", "G3 X-10 Y0 I-10 J0", "G0 Z60"]))
    tips, _ = poses(dressup)
    assert {name for name, _ in moves(dressup)} == {"G0", "G1"}
    assert len(tips) > 50
    assert np.hypot(tips[:, 0], tips[:, 1]) == pytest.approx(15.0, abs=SIX_DECIMALS)
    assert tips[:, 2] == pytest.approx(5.0, abs=SIX_DECIMALS)


def test_stock_is_left_along_the_normal(document):
    job = job_on(document, slope())
    points = np.array([(0.0, 0.0, 0.0), (0.0, 5.0, 0.0)])
    bare, stocked = (
        poses(valid(dressed(job, lines(points))))[0],
        poses(valid(dressed(job, lines(points), StockToLeave=0.3)))[0],
    )
    assert stocked - bare == pytest.approx(
        np.tile([0.3 / math.sqrt(2), 0, 0.3 / math.sqrt(2)], (2, 1)), abs=SIX_DECIMALS
    )


def test_lead_leans_forward_and_tilt_to_the_left(box_job):
    forward = dressed(box_job, lines(ACROSS_THE_TOP[:2]), ToolAxis=FROM_NORMAL, Lead=30)
    left = dressed(box_job, lines(ACROSS_THE_TOP[:2]), ToolAxis=FROM_NORMAL, Tilt=30)
    half, tall = 0.5, math.sqrt(0.75)
    assert poses(valid(forward))[1] == pytest.approx(np.tile([half, 0, tall], (2, 1)), abs=SIX_DECIMALS)
    assert poses(valid(left))[1] == pytest.approx(np.tile([0, half, tall], (2, 1)), abs=SIX_DECIMALS)
    assert poses(left, "G0")[1] == pytest.approx(np.tile([0, half, tall], (2, 1)), abs=SIX_DECIMALS)


def test_lead_leans_forward_of_the_way_in_where_the_path_turns_back(box_job):
    there, back = ACROSS_THE_TOP[:2]
    leaning = {"ToolAxis": FROM_NORMAL, "Lead": 30, "ChordTolerance": 1}
    _, axes = poses(valid(dressed(box_job, lines([there, back, there]), **leaning)))
    assert axes[:, 0] == pytest.approx([0.5, 0.5, -0.5], abs=SIX_DECIMALS)


def test_each_cut_leans_its_own_way(box_job):
    code = [*lines(ACROSS_THE_TOP[:2]), *lines(ACROSS_THE_TOP[1:])]
    _, axes = poses(valid(dressed(box_job, code, ToolAxis=FROM_NORMAL, Lead=30)))
    assert axes[:, :2] == pytest.approx(np.array([(0.5, 0), (0.5, 0), (0, 0.5), (0, 0.5)]), abs=SIX_DECIMALS)


def test_cut_across_a_plane_keeps_to_itself(document):
    """A bull nose D10 r2: on the top its tip is at the point, at the wall its corner is, whatever was before."""
    job = job_on(document, Part.makeBox(20, 20, 20), **bull_nose(10, 2))
    wall = [(20.0, 5.0, 10.0), (20.0, 15.0, 10.0)]
    tips, _ = poses(valid(dressed(job, [*lines(wall), *lines(ACROSS_THE_TOP), *lines(wall)])))
    beside = np.array(wall) + (5, 0, -2)
    assert tips == pytest.approx(np.vstack([beside, ACROSS_THE_TOP, beside]), abs=SIX_DECIMALS)


def test_rapid_moves_follow_sideways_and_never_go_lower(document):
    """On the slope the ball D10 has its tip 5 sin 45 to the side, and 5 (cos 45 - 1) below the point."""
    job = job_on(document, slope())
    dressup = valid(dressed(job, lines([(0, 0, 0), (0, 5, 0)])))
    sideways, down = 5 / math.sqrt(2), 5 / math.sqrt(2) - 5
    assert poses(dressup)[0] == pytest.approx(np.array([(sideways, 0, down), (sideways, 5, down)]), abs=SIX_DECIMALS)
    assert poses(dressup, "G0")[0] == pytest.approx(np.array([(sideways, 0, 60), (sideways, 5, 60)]), abs=SIX_DECIMALS)


def test_rapid_moves_are_lifted_when_the_tip_is(document):
    axis = (math.sqrt(0.5), 0, math.sqrt(0.5))
    job = job_on(document, Part.makeBox(20, 20, 20))
    code = lines(ACROSS_THE_TOP[:2], [axis, axis])
    dressup = valid(dressed(job, [line.replace("Z60", "Z20.5") for line in code]))
    lift = 5 * (1 - math.sqrt(0.5))
    assert poses(dressup)[0][:, 2] == pytest.approx(20 + lift, abs=SIX_DECIMALS)
    assert poses(dressup, "G0")[0][:, 2] == pytest.approx(20.5 + lift, abs=SIX_DECIMALS)


def test_leads_keep_their_shape(document):
    job = job_on(document, slope())
    cut = ["G0 X0 Y-5 Z60", "G0 X0 Y-2 Z3", "G1 X0 Y-1 Z1 F5", "G1 X0 Y0 Z0", "G1 Y5", "G1 Y6 Z2", "G0 Z60"]
    assert "N111" in refused(dressed(job, cut))
    job.Document.removeObject(job.Operations.Group[0].Name)
    job.Document.removeObject(job.Operations.Group[0].Name)
    tips, _ = poses(valid(dressed(job, cut, LeadLength=3)))
    programmed = np.array([(0, -1, 1), (0, 0, 0), (0, 5, 0), (0, 6, 2)])
    assert tips - programmed == pytest.approx(np.tile(tips[1], (4, 1)), abs=SIX_DECIMALS)
