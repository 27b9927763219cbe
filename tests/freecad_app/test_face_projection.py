# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feet found in bulk are those that OpenCASCADE finds one by one."""

import functools

import FreeCAD as App
import numpy as np
import Part
import pytest

from pkm_post.freecad_app.face_projection import nurbs_of, project
from pkm_post.freecad_app.face_surface import surface_points

NANOMETRE = 1e-6
ANGLE = 1e-6
Z = App.Vector(0, 0, 1)


def by_kind(shape, kind):
    return next(face for face in shape.Faces if face.Surface.TypeId == f"Part::Geom{kind}")


def bezier(*poles):
    curve = Part.BezierCurve()
    curve.setPoles([App.Vector(*pole) for pole in poles])
    return curve.toShape()


def smooth_loft():
    """A wall over an ellipse, a circle and a circle: closed along u, with a seam."""
    return by_kind(smooth_solid(), "BSplineSurface")


def smooth_solid():
    wires = [
        Part.Ellipse(App.Vector(), 60, 40),
        *(Part.Circle(App.Vector(0, 0, z), Z, r) for z, r in ((40, 40), (80, 25))),
    ]
    return Part.makeLoft([Part.Wire(wire.toShape()) for wire in wires], True, False)


def wavy(reversed_face=False):
    """A bicubic sheet through a grid of points."""
    rows = [[App.Vector(x, y, 4 * np.sin(x / 9) * np.cos(y / 11)) for y in range(0, 61, 6)] for x in range(0, 81, 8)]
    surface = Part.BSplineSurface()
    surface.interpolate(rows)
    face = surface.toShape().Faces[0]
    return face.reversed() if reversed_face else face


def periodic():
    """A ring of periodic splines, its surface periodic along one parameter."""
    curves = []
    for z, radius in ((0, 30), (20, 24), (40, 28)):
        turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
        points = [App.Vector((radius + 2 * np.sin(3 * t)) * np.cos(t), radius * np.sin(t), z) for t in turn]
        curve = Part.BSplineCurve()
        curve.interpolate(Points=points, PeriodicFlag=True)
        curves.append(Part.Wire(curve.toShape()))
    return Part.makeLoft(curves, False, False).Faces[0]


def bore():
    plate = Part.makeBox(100, 100, 50, App.Vector(-50, -50, 0)).cut(Part.makeCylinder(20, 50))
    return by_kind(plate, "Cylinder")


def perforated():
    """A plate with 16 holes."""
    plate = Part.makeBox(80, 80, 5)
    for x in range(4):
        for y in range(4):
            plate = plate.cut(Part.makeCylinder(6, 20, App.Vector(10 + 20 * x, 10 + 20 * y, -5)))
    return max(plate.Faces, key=lambda face: face.Area)


def cross_hole():
    """A cylinder that another one goes through, over its seam and on the other side."""
    hole = Part.makeCylinder(8, 100, App.Vector(-50, 0, 25), App.Vector(1, 0, 0))
    faces = Part.makeCylinder(20, 50).cut(hole).Faces
    return next(face for face in faces if face.Surface.TypeId == "Part::GeomCylinder" and face.Surface.Radius > 19)


def over_the_seam():
    """A round piece of a B-spline cylinder, half on this and half on that side of the seam."""
    wall = by_kind(Part.makeCylinder(20, 50).toNurbs(), "BSplineSurface")
    return wall.common(Part.makeCylinder(8, 30, App.Vector(5, 0, 25), App.Vector(1, 0, 0))).Faces[0]


def leaning(face):
    face = face.copy()
    face.Placement = App.Placement(App.Vector(5, -6, 7), App.Rotation(App.Vector(1, 2, 3), 40))
    return face


VASE = bezier((10, 0, 0), (16, 0, 5), (8, 0, 9), (12, 0, 20))
FACES = {
    "plane": lambda: Part.makeBox(40, 50, 60).Faces[2],
    "bore": bore,
    "cone that narrows": lambda: by_kind(Part.makeCone(15, 5, 30), "Cone"),
    "cone that widens": lambda: by_kind(Part.makeCone(5, 15, 30), "Cone"),
    "sphere": lambda: Part.makeSphere(20).Faces[0],
    "torus": lambda: Part.makeTorus(30, 8).Faces[0],
    "loft": smooth_loft,
    "wavy": wavy,
    "wavy, reversed": lambda: wavy(True),
    "periodic": periodic,
    "revolution": lambda: VASE.revolve(App.Vector(), Z, 200).Faces[0],
    "extrusion": lambda: VASE.extrude(App.Vector(2, 30, 1)).Faces[0],
    "extrusion, reversed": lambda: VASE.extrude(App.Vector(2, 30, 1)).Faces[0].reversed(),
    "loft, mirrored": lambda: smooth_loft().mirror(App.Vector(), App.Vector(1, 0.3, 0)).Faces[0],
    "hollow": lambda: by_kind(
        Part.makeBox(140, 140, 70, App.Vector(-70, -70, 5)).cut(smooth_solid()), "BSplineSurface"
    ),
    "leaning cone": lambda: leaning(by_kind(Part.makeCone(15, 5, 30), "Cone")),
    "leaning loft": lambda: leaning(smooth_loft()),
    "perforated": perforated,
    "cylinder with a cross hole": cross_hole,
    "patch over the seam": lambda: leaning(over_the_seam()),
    "rational": lambda: by_kind(Part.makeCylinder(20, 50).toNurbs(), "BSplineSurface"),
}
EVERY_FACE = pytest.mark.parametrize("face", FACES, indirect=True)


@functools.cache
def made(name):
    return FACES[name]()


@pytest.fixture
def face(request):
    """A face by its name, made by the test that is the first to use it: OpenCASCADE starts threads for some."""
    return made(request.param)


def around(face, count, seed, reach=2.0):
    """Points over the whole face, up to the reach off it, and the points on the face they stand over."""
    rng = np.random.default_rng(seed)
    first_u, last_u, first_v, last_v = face.ParameterRange
    u, v = rng.uniform(first_u, last_u, count), rng.uniform(first_v, last_v, count)
    points, normals = surface_points(face, u, v)
    away = rng.uniform(-reach, reach, count)
    return points + away[:, None] * normals, points, normals, away


def one_by_one(face, points):
    parameters = np.array([face.Surface.parameter(App.Vector(*point)) for point in points.tolist()])
    return surface_points(face, *parameters.T)


@EVERY_FACE
def test_feet_are_those_of_opencascade(face):
    points, _, _, _ = around(face, 150, seed=1)
    feet, normals, distances, _ = project(face, points)
    expected_feet, expected_normals = one_by_one(face, points)
    assert np.max(np.linalg.norm(feet - expected_feet, axis=1)) < 10 * NANOMETRE
    assert np.max(np.linalg.norm(normals - expected_normals, axis=1)) < 10 * ANGLE
    assert np.abs(distances) == pytest.approx(np.linalg.norm(points - expected_feet, axis=1), abs=10 * NANOMETRE)


@EVERY_FACE
def test_points_find_back_where_they_came_from(face):
    points, start, normals, away = around(face, 3000, seed=2, reach=1.0)
    feet, found, distances, _ = project(face, points)
    assert np.max(np.linalg.norm(feet - start, axis=1)) < NANOMETRE
    assert np.max(np.linalg.norm(found - normals, axis=1)) < ANGLE
    assert distances == pytest.approx(away, abs=NANOMETRE)


@EVERY_FACE
def test_feet_inside_the_edges_are_on_the_face_and_others_are_not(face):
    points, start, _, _ = around(face, 150, seed=3, reach=0.5)
    *_, on = project(face, points)
    edges = Part.makeCompound([edge for edge in face.Edges if not edge.Degenerated])
    expected = [face.distToShape(Part.Vertex(*point))[0] < 1e-3 for point in start.tolist()]
    far_from_edge = [edges.distToShape(Part.Vertex(*point))[0] > 0.01 for point in start.tolist()]
    assert np.array_equal(on[far_from_edge], np.array(expected)[far_from_edge])
    assert sum(far_from_edge) > 100
    assert sum(on) > 20


def test_window_in_a_plane_is_not_on_the_face():
    plate = Part.makeBox(40, 40, 10).cut(Part.makeCylinder(10, 20, App.Vector(20, 20, -5)))
    top = next(face for face in plate.Faces if face.CenterOfMass.z > 9.9)
    points = [
        [20, 20, 10.5],
        [29.9, 20, 10.5],
        [30.0005, 20, 9],
        [29.9995, 20, 9],
        [30.1, 20, 9],
        [41, 20, 10],
        [40, 40, 10],
    ]
    feet, _, distances, on = project(top, points)
    assert on.tolist() == [False, False, True, True, True, False, True]
    assert distances == pytest.approx([0.5, 0.5, -1, -1, -1, 0, 0], abs=NANOMETRE)
    assert feet[:, 2] == pytest.approx(10.0, abs=NANOMETRE)


def test_surface_goes_on_beyond_the_edges():
    arc = VASE.revolve(App.Vector(), Z, 200).Faces[0]
    whole = VASE.revolve(App.Vector(), Z, 360).Faces[0]
    points, start, normals, away = around(whole, 200, seed=4, reach=0.5)
    feet, found, distances, on = project(arc, points)
    assert feet == pytest.approx(start, abs=NANOMETRE)
    assert found == pytest.approx(normals, abs=ANGLE)
    assert distances == pytest.approx(away, abs=NANOMETRE)
    turn = np.degrees(np.arctan2(start[:, 1], start[:, 0])) % 360
    assert np.array_equal(on, turn <= 200)


def test_tip_of_a_cone_has_one_of_the_normals_about_it():
    face = by_kind(Part.makeCone(10, 0, 20), "Cone")
    feet, normals, distances, _ = project(face, [[0, 0, 20]])
    assert feet == pytest.approx(np.array([[0, 0, 20]]), abs=NANOMETRE)
    assert normals[0, 2] == pytest.approx(1 / np.sqrt(5), abs=ANGLE)
    assert np.abs(distances) == pytest.approx([0], abs=NANOMETRE)


def test_surface_without_area_has_no_normal():
    surface = Part.BSplineSurface()
    line = [[App.Vector(x + y, 0, 0) for y in (0, 1)] for x in (0, 5)]
    surface.buildFromPolesMultsKnots(line, [2, 2], [2, 2], [0, 1], [0, 1], False, False, 1, 1)
    face = surface.toShape().Faces[0]
    feet, normals, _, _ = project(face, [[3, 1, 0]])
    assert feet == pytest.approx(np.array([[3, 0, 0]]), abs=NANOMETRE)
    assert np.isnan(normals).all()


def test_point_on_the_axis_gets_the_foot_of_opencascade():
    face = bore()
    feet, normals, distances, _ = project(face, [[0, 0, 10]])
    assert np.hypot(*feet[0, :2]) == pytest.approx(20, abs=NANOMETRE)
    assert distances == pytest.approx([20], abs=NANOMETRE)
    assert normals[0] == pytest.approx(-feet[0] / 20 * [1, 1, 0], abs=ANGLE)


def test_numbers_of_a_face_give_its_points():
    for face in (smooth_loft(), wavy(), periodic(), by_kind(Part.makeSphere(9).toNurbs(), "BSplineSurface")):
        surface, _ = nurbs_of(face)
        rng = np.random.default_rng(6)
        (low_u, high_u), (low_v, high_v) = surface.bounds
        u, v = rng.uniform(low_u, high_u, 200), rng.uniform(low_v, high_v, 200)
        points, along_u, along_v = surface.derivatives(u, v, order=1)
        expected, _ = surface_points(face, u, v)
        assert points == pytest.approx(expected, abs=1e-9)
        slopes = np.array([[[*vector] for vector in face.derivative1At(*at)] for at in zip(u, v, strict=True)])
        assert np.stack([along_u, along_v], axis=1) == pytest.approx(slopes, abs=1e-6)


def test_points_that_are_no_numbers_are_the_callers_fault():
    with pytest.raises(ValueError, match="expected finite points, got 1 other"):
        project(bore(), [[0, 0, np.nan]])
