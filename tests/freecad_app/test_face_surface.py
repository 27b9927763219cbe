# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces of FreeCAD as parametric surfaces: closed, trimmed, flipped, and against OpenCASCADE."""

import FreeCAD as App
import numpy as np
import Part
import pytest
from part_jobs import load_example
from surface_finishes import is_top, plate_with_hole

from pkm_post.freecad_app.face_surface import face_surface, is_untrimmed


def test_closed_and_trimmed_faces_are_known_as_such():
    ball, cone = Part.makeSphere(10).Faces[0], Part.makeCone(10, 5, 20).Faces[0]
    for face in (ball, cone):
        surface = face_surface(face)
        assert (surface.u.closed, surface.v.closed) == (True, False)
    ring = face_surface(Part.makeTorus(30, 5).Faces[0])
    assert (ring.u.closed, ring.v.closed) == (True, True)
    half = face_surface(Part.makeSphere(10, App.Vector(), App.Vector(0, 0, 1), -90, 90, 180).Faces[0])
    assert not half.u.closed
    top = face_surface(plate_with_hole().Faces[[is_top(face) for face in plate_with_hole().Faces].index(True)])
    u, v = (np.linspace(span.first, span.last, 41) for span in (top.u, top.v))
    held = top.contains(*(each.ravel() for each in np.meshgrid(u, v)))
    assert 0.9 < held.mean() < 0.97


def trimmed_shapes():
    """Lines, arcs, splines, holes, a seam and a pole in the borders, and a face whose hole runs the wrong way round."""
    at, z = App.Vector, App.Vector(0, 0, 1)
    hole = Part.makeCylinder(4, 60, at(0, -30, 20), at(0, 1, 0))
    corners = [at(0, 0), at(30, 0), at(30, 20), at(15, 5), at(0, 20), at(0, 0)]
    spline = Part.BSplineCurve()
    spline.interpolate([at(0, 0), at(10, 5), at(20, -5), at(25, 10), at(8, 18)], PeriodicFlag=True)
    yield "plate", plate_with_hole()
    yield "pipe with a hole", Part.makeCylinder(10, 40).cut(hole)
    yield "half of it", Part.makeCylinder(10, 40, at(), z, 180).cut(hole)
    yield "ball with a corner", Part.makeSphere(15).cut(Part.makeBox(20, 20, 20, at(3, 3, 3)))
    yield "cut cone", Part.makeCone(10, 3, 20).cut(Part.makeBox(30, 30, 30, at(2, -15, 5)))
    yield "notched", Part.Face(Part.makePolygon(corners))
    yield "spline", Part.Face(Part.Wire(spline.toShape()))
    ellipse, circle = Part.Ellipse(at(), 30, 10).toShape(), Part.makeCircle(4, at(5, 0, 0))
    yield "not valid", Part.Face([Part.Wire(ellipse), Part.Wire(circle)])


@pytest.mark.parametrize("shape", [pytest.param(shape, id=name) for name, shape in trimmed_shapes()])
def test_trimmed_faces_hold_what_opencascade_says(shape):
    chance = np.random.default_rng(1)
    trimmed = [face for face in shape.Faces if not is_untrimmed(face)]
    assert trimmed
    for face in trimmed:
        surface = face_surface(face)
        u, v = (np.linspace(span.first, span.last, 29) for span in (surface.u, surface.v))
        u, v = (each.ravel() for each in np.meshgrid(u, v))
        u = np.append(u, chance.uniform(surface.u.first, surface.u.last, 500))
        v = np.append(v, chance.uniform(surface.v.first, surface.v.last, 500))
        expected = [face.isPartOfDomain(*pair) for pair in zip(u.tolist(), v.tolist(), strict=True)]
        assert 0 < sum(expected) < len(expected)
        assert np.array_equal(surface.inside(u, v), expected)
        assert surface.points_at(u, v) == pytest.approx(surface.at(u, v).point, abs=1e-12)


def bspline_faces():
    """A loft, a ball as B-splines with its poles, a placed piece of a loft, and one that is a hole."""
    example = load_example()
    loft = example.solid(example.Column())
    moved = loft.common(Part.makeBox(100, 100, 50, App.Vector(0, -50, 10)))
    moved.Placement = App.Placement(App.Vector(5, -6, 7), App.Rotation(App.Vector(1, 2, 3), 40))
    hole = Part.makeBox(200, 200, 60, App.Vector(-100, -100, 10)).cut(loft)
    for shape in (loft, Part.makeSphere(10).toNurbs(), moved, hole):
        yield next(face for face in shape.Faces if face.Surface.TypeId == "Part::GeomBSplineSurface")


@pytest.mark.parametrize("number", range(4), ids=["loft", "ball", "moved", "hole"])
def test_poles_give_what_opencascade_gives(number):
    face = list(bspline_faces())[number]
    surface = face_surface(face)
    u, v = (np.linspace(span.first, span.last, 9) for span in (surface.u, surface.v))
    u, v = (each.ravel() for each in np.meshgrid(u, v))
    samples = surface.at(u, v)
    pairs = [(surface.u.normalise(a[None])[0], surface.v.normalise(b[None])[0]) for a, b in zip(u, v, strict=True)]
    vectors = [[face.valueAt(*pair), face.normalAt(*pair), *face.derivative1At(*pair)] for pair in pairs]
    expected = np.array([[tuple(vector) for vector in row] for row in vectors])
    for column, found in enumerate((samples.point, samples.normal, samples.along_u, samples.along_v)):
        assert found == pytest.approx(expected[:, column], abs=1e-9)


def test_flipped_normals_point_the_other_way():
    face = Part.makeSphere(10).Faces[0]
    u, v = np.array([1.0]), np.array([0.5])
    out, in_ = (face_surface(face, flipped).at(u, v) for flipped in (False, True))
    assert out.normal == pytest.approx(-in_.normal)
    assert out.normal == pytest.approx(out.point / 10.0)
