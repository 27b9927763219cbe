# SPDX-License-Identifier: LGPL-2.1-or-later
"""2D compensation of closed contours, against the offset of wires by OpenCASCADE (Part.Wire.makeOffset2D)."""

import FreeCAD
import numpy as np
import Part
import pytest

from pkm_post.model import Kind, Program, Tool
from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

MICRON = 1e-3
ARC_CORNERS, MITRED_CORNERS = 0, 2


def polygon(rng, count, bulges):
    """Corners of a closed contour that turns to the left, and for each of its sides the centre of an arc or None."""
    angle = np.cumsum(rng.uniform(0.7, 1.3, count))
    angle *= 2 * np.pi / angle[-1]
    points = rng.uniform(35, 60, (count, 1)) * np.column_stack([np.cos(angle), np.sin(angle)])
    turns = np.where(rng.random(count) < 0.4, rng.choice([-1, 1], count), 0) if bulges else np.zeros(count, dtype=int)
    # The first side is where the path begins and ends.
    turns[0] = 0
    return points, turns


def centre_of(start, end, turn):
    """Centre of a flat arc between two points."""
    way = end - start
    return (start + end) / 2 + turn * 0.9 * np.array([-way[1], way[0]])


def contour(points, turns, offset):
    """A program that leads from the tool's side to the middle of the first side, goes round, and leads away."""
    middle = (points[0] + points[1]) / 2
    way = points[1] - points[0]
    left = np.array([-way[1], way[0]]) / np.hypot(*way)
    away = middle + 2 * offset * left
    stops = [away, middle, *np.roll(points, -1, axis=0), middle, away]
    turn = np.array([0, 0, 0, *turns[1:], 0, 0])
    blank = np.full((len(stops), 3), np.nan)
    centre, axis = blank.copy(), blank.copy()
    for row in np.flatnonzero(turn):
        centre[row] = [*centre_of(stops[row - 1], stops[row], turn[row]), 0]
        axis[row] = [0, 0, turn[row]]
    side = np.full(len(stops), float(offset))
    side[[0, -1]] = 0.0
    count = len(stops)
    return Program(
        kind=np.where(turn != 0, Kind.ARC, np.where(np.arange(count) > 0, Kind.LINE, Kind.RAPID)),
        position=np.column_stack([stops, np.zeros(count)]),
        tool_axis=np.tile([0.0, 0.0, 1.0], (count, 1)),
        feed=np.full(count, 10.0),
        arc_centre=centre,
        arc_axis=axis,
        operation=np.zeros(count),
        line=np.arange(1, count + 1),
        events=(),
        operations=("",),
        tools={1: Tool(1, "", 2 * abs(offset), 0.0, 100.0)},
        source="contour",
        side_offset=side,
    )


def edge(program, row):
    """A row of a program as an edge of OpenCASCADE."""
    start, end = (FreeCAD.Vector(*program.position[i]) for i in (row - 1, row))
    if program.kind[row] != Kind.ARC:
        return Part.LineSegment(start, end).toShape()
    centre = program.arc_centre[row]
    spokes = [program.position[row - 1] - centre, program.position[row] - centre]
    bisector = spokes[0] + spokes[1]
    bisector *= np.linalg.norm(spokes[0]) / np.linalg.norm(bisector)
    sense = np.sign(np.cross(spokes[0], spokes[1]) @ program.arc_axis[row])
    return Part.Arc(start, FreeCAD.Vector(*(centre + sense * bisector)), end).toShape()


def farthest(points, shape):
    return max(Part.Vertex(*point).distToShape(shape)[0] for point in points)


def sharpest(points):
    """Cosine of the largest turn of a polygon."""
    way = np.roll(points, -1, axis=0) - points
    way /= np.hypot(*way.T)[:, None]
    return np.min(np.sum(way * np.roll(way, -1, axis=0), axis=1))


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["inside", "outside"])
@pytest.mark.parametrize(
    ("bulges", "corners", "join"),
    [(False, "arc", ARC_CORNERS), (True, "arc", ARC_CORNERS), (False, "chord", MITRED_CORNERS)],
    ids=["lines, arcs at corners", "lines and arcs, arcs at corners", "lines, mitred corners"],
)
def test_closed_contours_are_offset_as_by_opencascade(side, bulges, corners, join):
    rng = np.random.default_rng(7)
    compared = 0
    for _ in range(40):
        points, turns = polygon(rng, int(rng.integers(4, 9)), bulges)
        given = contour(points, turns, side * rng.uniform(1.0, 4.0))
        moved, _ = offset_contours(given, OffsetOptions(corners=corners))
        # Beyond a right angle the paper cuts off what OpenCASCADE extends.
        if moved is None or (corners == "chord" and sharpest(points) < 0):
            continue
        wire = Part.Wire([edge(given, row) for row in range(2, len(given) - 1)])
        offset = wire.makeOffset2D(-float(given.side_offset[1]), join)
        path = [edge(moved, row) for row in range(2, len(moved) - 1)]
        assert sum(piece.Length for piece in path) == pytest.approx(offset.Length, abs=MICRON)
        for piece in path:
            assert farthest(piece.discretize(5), offset) < MICRON
        compared += 1
    assert compared > 15
