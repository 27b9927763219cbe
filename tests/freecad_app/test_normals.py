# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points and normals of Part faces against shapes whose formulas are known."""

import FreeCAD as App
import numpy as np
import Part
import pytest

from pkm_post.freecad_app.face_projection import project
from pkm_post.freecad_app.face_surface import surface_points

ROUNDING = 1e-9
NANOMETRE = 1e-6
RADIUS, HEIGHT = 20.0, 50.0


def cylinder_wall(shape):
    return next(face for face in shape.Faces if face.Surface.TypeId == "Part::GeomCylinder")


def grid_over(face, rows=9, columns=5):
    """Points and normals at every combination of u and v, (rows, columns, 3)."""
    first_u, last_u, first_v, last_v = face.ParameterRange
    u, v = np.meshgrid(np.linspace(first_u, last_u, rows), np.linspace(first_v, last_v, columns), indexing="ij")
    return [column.reshape(rows, columns, 3) for column in surface_points(face, u.ravel(), v.ravel())]


def radial(points):
    return points * [1.0, 1.0, 0.0] / np.hypot(points[..., 0], points[..., 1])[..., None]


def test_normals_of_a_cylinder_point_away_from_its_axis():
    points, normals = grid_over(cylinder_wall(Part.makeCylinder(RADIUS, HEIGHT)))
    assert points.shape == normals.shape == (9, 5, 3)
    assert np.hypot(points[..., 0], points[..., 1]) == pytest.approx(RADIUS, abs=ROUNDING)
    assert normals == pytest.approx(radial(points), abs=ROUNDING)


def test_normals_of_a_bore_point_towards_its_axis():
    plate = Part.makeBox(100, 100, HEIGHT, App.Vector(-50, -50, 0)).cut(Part.makeCylinder(RADIUS, HEIGHT))
    bore = cylinder_wall(plate)
    points, normals = grid_over(bore)
    assert normals == pytest.approx(-radial(points), abs=ROUNDING)
    _, _, distance, _ = project(bore, [[RADIUS - 1.0, 0.0, 10.0], [0.0, RADIUS + 2.0, 10.0]])
    assert distance == pytest.approx([1.0, -2.0], abs=ROUNDING)


def test_every_face_of_a_solid_faces_out_of_it():
    solid = Part.makeBox(20, 30, 40).cut(Part.makeCylinder(6, 50, App.Vector(10, 15, -5)))
    step = 1e-3
    middles = [(face, face.Surface.parameter(face.CenterOfMass)) for face in solid.Faces]
    inside = [(face, middle) for face, middle in middles if face.isPartOfDomain(*middle)]
    assert len(inside) == 5  # four sides and the bore; the middles of top and bottom are in the bore
    for face, (u, v) in inside:
        points, normals = surface_points(face, [u], [v])
        assert not solid.isInside(App.Vector(*(points + step * normals)[0]), 1e-7, True)
        assert solid.isInside(App.Vector(*(points - step * normals)[0]), 1e-7, True)


def test_points_are_at_the_pairs_of_parameters():
    face = cylinder_wall(Part.makeCylinder(RADIUS, HEIGHT))
    points, _ = surface_points(face, [0.0, np.pi / 2, np.pi / 2], [0.0, 10.0, 20.0])
    assert points == pytest.approx(np.array([[RADIUS, 0, 0], [0, RADIUS, 10], [0, RADIUS, 20]]), abs=ROUNDING)


def test_placement_of_the_shape_moves_points_and_turns_normals():
    shape = Part.makeCylinder(RADIUS, HEIGHT)
    still_points, still_normals = grid_over(cylinder_wall(shape))
    rotation = App.Rotation(App.Vector(1, 2, 3), 40)
    shape.Placement = App.Placement(App.Vector(5, -6, 7), rotation)
    points, normals = grid_over(cylinder_wall(shape))
    turn = np.array(rotation.toMatrix().A).reshape(4, 4)[:3, :3]
    assert points == pytest.approx(still_points @ turn.T + [5, -6, 7], abs=ROUNDING)
    assert normals == pytest.approx(still_normals @ turn.T, abs=ROUNDING)
    feet, _, distances, _ = project(cylinder_wall(shape), points.reshape(-1, 3) + 3.0 * normals.reshape(-1, 3))
    assert feet == pytest.approx(points.reshape(-1, 3), abs=NANOMETRE)
    assert distances == pytest.approx(3.0, abs=NANOMETRE)


def loft_wall():
    ellipse = Part.Ellipse(App.Vector(0, 0, 0), 60, 40).toShape()
    circle = Part.Circle(App.Vector(0, 0, 80), App.Vector(0, 0, 1), 25).toShape()
    loft = Part.makeLoft([Part.Wire(ellipse), Part.Wire(circle)], True, True)
    return next(face for face in loft.Faces if face.Surface.TypeId == "Part::GeomBSplineSurface")


def test_projection_on_a_free_form_face_finds_the_points_it_came_from():
    rng = np.random.default_rng(1)
    face = loft_wall()
    points, normals = surface_points(face, rng.uniform(0.1, 6.1, 100), rng.uniform(0.05, 0.95, 100))
    away = rng.uniform(-2.0, 2.0, 100)
    feet, found_normals, distances, _ = project(face, points + away[:, None] * normals)
    assert feet == pytest.approx(points, abs=NANOMETRE)
    assert found_normals == pytest.approx(normals, abs=1e-7)
    assert distances == pytest.approx(away, abs=NANOMETRE)


def test_no_points_give_empty_arrays():
    face = loft_wall()
    assert [array.shape for array in project(face, np.zeros((0, 3)))] == [(0, 3), (0, 3), (0,), (0,)]
    assert [array.shape for array in surface_points(face, [], [])] == [(0, 3), (0, 3)]


def test_wrong_shapes_are_the_callers_fault():
    face = loft_wall()
    with pytest.raises(ValueError, match="one shape"):
        surface_points(face, [0.0, 1.0], [0.5])
    with pytest.raises(ValueError, match=r"expected points \(N, 3\), got \(3,\)"):
        project(face, [0.0, 0.0, 0.0])
