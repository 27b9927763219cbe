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


def plane_inside(*borders):
    return Part.Face([Part.Wire(border) for border in borders])


def closed_spline():
    curve = Part.BSplineCurve()
    curve.interpolate([App.Vector(*at) for at in ((0, 0), (10, 5), (20, -5), (25, 10), (8, 18))], PeriodicFlag=True)
    return curve.toShape()


def drilled(pipe):
    return pipe.cut(Part.makeCylinder(4, 60, App.Vector(0, -30, 20), App.Vector(0, 1, 0)))


UP = App.Vector(0, 0, 1)
TRIMMED = {
    "plate with a hole": plate_with_hole,
    "pipe with a hole": lambda: drilled(Part.makeCylinder(10, 40)),
    "half of it": lambda: drilled(Part.makeCylinder(10, 40, App.Vector(), UP, 180)),
    "ball with a corner": lambda: Part.makeSphere(15).cut(Part.makeBox(20, 20, 20, App.Vector(3, 3, 3))),
    "cut cone": lambda: Part.makeCone(10, 3, 20).cut(Part.makeBox(30, 30, 30, App.Vector(2, -15, 5))),
    "notched": lambda: plane_inside(
        Part.makePolygon([App.Vector(*at) for at in ((0, 0), (30, 0), (30, 20), (15, 5), (0, 20), (0, 0))])
    ),
    "spline": lambda: plane_inside(closed_spline()),
    "hole that runs the wrong way round": lambda: plane_inside(
        Part.Ellipse(App.Vector(), 30, 10).toShape(), Part.makeCircle(4, App.Vector(5, 0, 0))
    ),
}
"""Lines, arcs, splines, holes, a seam and a pole in the borders, and a face that is not valid."""


@pytest.mark.parametrize("made", TRIMMED.values(), ids=TRIMMED)
def test_trimmed_faces_hold_what_opencascade_says(made):
    chance = np.random.default_rng(1)
    trimmed = [face for face in made().Faces if not is_untrimmed(face)]
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
        for turned, pair in ((surface, (u, v)), (face_surface(face, True), (u, v)), (surface.swapped(), (v, u))):
            point, normal = turned.oriented_at(*pair)
            assert (point == turned.at(*pair).point).all()
            assert (normal == turned.at(*pair).normal).all() and (normal == turned.normals_at(*pair)).all()


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
