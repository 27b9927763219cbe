# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gouges between the points of the grid: they are found, or are no deeper than what is said to be unseen."""

import math

import numpy as np
import Part
import pytest
from programs import program
from surface_finishes import plate_with_hole

from pkm_post.freecad_app import surface_check
from pkm_post.freecad_app.face_surface import is_untrimmed
from pkm_post.freecad_app.surface_check import check_faces
from pkm_post.toolpath import Cutter

TOLERANCE, SPACING = 0.01, 1.0
TOP = 10.0
BALL, BULL_NOSE, SHARP = (
    Cutter.apt(6.0, 3.0),
    Cutter.apt(6.0, 0.5),
    Cutter.apt(6.0, 0.0),
)


def is_top(face):
    return abs(face.BoundBox.ZMin - TOP) < 1e-6 and face.BoundBox.ZLength < 1e-6


def checked(shape, cutter, tips, axes=None):
    """A path held against the faces of a shape; those at the top are to be covered."""
    tips = np.asarray(tips, dtype=float)
    moves = program(tips, np.tile([0.0, 0.0, 1.0], (len(tips), 1)) if axes is None else axes)
    ours = [face for face in shape.Faces if is_top(face)]
    others = [face for face in shape.Faces if not is_top(face)]
    return check_faces(moves, cutter, ours, others, False, SPACING, TOLERANCE, 2.0, lambda share: None)


def stab(place, depth, lean=0.0):
    """Tips and axes that go down to one place and up again, as deep as that below the top."""
    axis = np.array([math.sin(lean), 0.0, math.cos(lean)])
    tip = np.array([*place, TOP - depth])
    return [tip + 20.0 * axis, tip, tip + 20.0 * axis], np.tile(axis, (3, 1))


def farthest_place(points):
    """The place of the middle of a face that is farthest from all points, and its distance from them."""
    x, y = (each.ravel() for each in np.meshgrid(np.linspace(3, 7, 201), np.linspace(3, 7, 201)))
    flat = points[np.abs(points[:, 2] - TOP) < 1e-6, :2]
    away = np.sqrt(((np.column_stack([x, y])[:, None] - flat) ** 2).sum(axis=2)).min(axis=1)
    return (float(x[away.argmax()]), float(y[away.argmax()])), float(away.max())


def test_a_gouge_between_two_points_of_the_grid_is_found():
    """The grid alone, all that was measured before, sees nothing of it: its points are outside the ball."""
    box = Part.makeBox(10, 10, 10)
    place, away = farthest_place(checked(box, BALL, *stab((5.0, 5.0), -5.0)).points)
    depth = 0.9 * (3.0 - math.sqrt(3.0**2 - away**2))
    assert depth > 4 * TOLERANCE
    found = checked(box, BALL, *stab(place, depth))
    assert found.depth.max() <= 0.0
    assert depth - found.unseen < found.gouge <= depth + 1e-6
    assert found.unseen < 1.2 * TOLERANCE
    assert found.gouge > 1.1 * TOLERANCE  # and so it is an error of the operation
    assert np.linalg.norm(found.gouge_point - [*place, TOP]) < away


@pytest.mark.slow
@pytest.mark.parametrize("cutter", [BALL, BULL_NOSE, SHARP], ids=["ball", "bull nose", "sharp"])
@pytest.mark.parametrize("few", [False, True], ids=["close points", "few"])
def test_no_gouge_is_deeper_than_what_was_found_and_what_is_unseen(monkeypatch, cutter, few):
    """Stabs at any place, upright or leaning; how deep a point of the face is comes from a fine grid of its own."""
    if few:
        monkeypatch.setattr(surface_check, "_MOST_CLOSE", 100)
    box, random = Part.makeBox(10, 10, 10), np.random.default_rng(20)
    for _ in range(8):
        (x, y), lean = random.uniform(3, 7, 2), random.uniform(0.0, 0.7)
        tips, axes = stab((x, y), random.uniform(0.0, 0.15), lean)
        found = checked(box, cutter, tips, axes)
        side = np.linspace(-4.0, 4.0, 401)
        u, v = (each.ravel() for each in np.meshgrid(side, side))
        fine = np.column_stack([x + u, y + v, np.full(len(u), TOP)])
        inside = (fine[:, :2] >= 0.0).all(axis=1) & (fine[:, :2] <= 10.0).all(axis=1)
        assert _depth(fine[inside], tips[1], axes[1], cutter) <= found.gouge + found.unseen


def _depth(points, tip, axis, cutter):
    """How deep the deepest of some points is in a cutter that stands still, mm, below 0 for outside.

    Its outline is that of a smaller cylinder, from its bottom as far away as its side, with a ball rolled round it.
    """
    r, e = cutter.corner_radius, cutter.radial_offset
    along = (points - tip) @ axis
    across = np.linalg.norm(points - tip - along[:, None] * axis, axis=1)
    out, below = across - e, r - along
    away = np.where((out > 0.0) & (below > 0.0), np.hypot(out, below), np.maximum(out, below)) - r
    return float(-away.min())


@pytest.mark.parametrize(
    "made", [lambda: plate_with_hole(TOP), lambda: Part.makeCylinder(8, 5), lambda: Part.makeCone(9, 4, 6)]
)
@pytest.mark.parametrize("parts", [1, 3])
def test_every_point_of_a_face_has_a_close_one(made, parts):
    random = np.random.default_rng(5)
    for face in made().Faces:
        grid = surface_check._Grid.of(face, False, SPACING)
        every = np.arange(grid.half_diagonals().size)
        reach = grid.half_diagonal() / parts
        close = np.vstack([grid.within(every, parts), grid.border(reach * surface_check._BORDER)])
        whole = reach * (1.0 if is_untrimmed(face) else 1.0 + surface_check._BORDER / 2.0)
        u, v = (random.uniform(span.first, span.last, 400) for span in (grid.surface.u, grid.surface.v))
        held = grid.surface.contains(u, v)
        for point in grid.surface.at(u[held], v[held]).point:
            assert np.linalg.norm(close - point, axis=1).min() <= whole


def test_curvature_is_that_of_convex_faces_alone():
    outside, inside = Part.makeCylinder(5, 10), Part.makeBox(20, 20, 10).cut(Part.makeCylinder(5, 30))
    for shape, expected in ((outside, 1 / 5), (inside, 0.0)):
        (face,) = [face for face in shape.Faces if face.Surface.TypeId == "Part::GeomCylinder"]
        grid = surface_check._Grid.of(face, False, 0.5)
        assert grid.curvature(np.arange(grid.half_diagonals().size)) == pytest.approx(expected, rel=0.01)
