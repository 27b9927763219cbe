# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs with 2D compensation for the tests, and distances measured another way than the product does."""

from dataclasses import replace

import numpy as np
from programs import program

from pkm_post.model import Kind

AXES = {2: (0, 1, 2), 1: (2, 0, 1), 0: (1, 2, 0)}
"""By the coordinate that a plane is normal to: its two coordinates in right-handed order, and that one."""


def contour(start, pieces, offset, plane=2, axis=None, cancel=True):
    """A program with one contour in a plane.

    pieces are points (x, y[, z]) for lines, or (x, y[, z], cx, cy, turn) for arcs with turn 1 to the left and -1 to the
    right. The first one is the start-up block, the last one the cancel block.
    """
    points, kinds, centres, turns, height = [list(start) + [0.0] * (3 - len(start))], [Kind.RAPID], [None], [0], 0.0
    for piece in pieces:
        arc = len(piece) > 3
        height = piece[2] if len(piece) in (3, 6) else height
        points.append([piece[0], piece[1], height])
        kinds.append(Kind.ARC if arc else Kind.LINE)
        centres.append([*piece[-3:-1], height] if arc else None)
        turns.append(piece[-1] if arc else 0)
    order = np.argsort(AXES[plane])
    blank = np.full(3, np.nan)
    normal = np.eye(3)[plane]
    count = len(points)
    side = np.full(count, float(offset))
    side[0] = 0.0
    side[-1] = 0.0 if cancel else side[-1]
    made = program(
        np.array(points)[:, order],
        axis=np.tile(normal if axis is None else axis, (count, 1)),
        kind=np.array(kinds),
        centre=np.array([blank if centre is None else np.array(centre)[order] for centre in centres]),
        turn=np.array([normal * turn if turn else blank for turn in turns]),
    )
    return replace(made, side_offset=side, plane=np.full(count, plane))


def in_plane(points, plane=2):
    """The two coordinates in a plane of (n, 3) points."""
    return np.asarray(points)[:, list(AXES[plane][:2])]


def samples(moved, row, count=33):
    """Points along a row of a program, (count, 3)."""
    share = np.linspace(0.0, 1.0, count)[:, None]
    start, end = moved.position[row - 1], moved.position[row]
    if moved.kind[row] != Kind.ARC:
        return start + share * (end - start)
    axis, centre = moved.arc_axis[row], moved.arc_centre[row]
    rise = (end - start) @ axis
    spoke = start - centre - ((start - centre) @ axis) * axis
    last = end - centre - ((end - centre) @ axis) * axis
    angle = np.arctan2(np.cross(spoke, last) @ axis, spoke @ last) % (2 * np.pi)
    angle = 2 * np.pi if angle < 1e-9 else angle
    turned = np.cos(share * angle) * spoke + np.sin(share * angle) * np.cross(axis, spoke)
    size = 1 + share * (np.linalg.norm(last) / np.linalg.norm(spoke) - 1) if np.linalg.norm(spoke) > 0 else 1.0
    return start - spoke + size * turned + share * rise * axis


def distance(points, given, row, plane=2):
    """Distances in the plane of (n, 3) points from a row of a program, by the closed form for lines and for arcs."""
    start, end = in_plane(given.position[[row - 1, row]], plane)
    q = in_plane(points, plane)
    ends = np.minimum(np.hypot(*(q - start).T), np.hypot(*(q - end).T))
    if given.kind[row] != Kind.ARC:
        way = end - start
        length = np.hypot(*way)
        if length == 0:
            return ends
        share = (q - start) @ way / length**2
        across = np.abs((q - start) @ [-way[1], way[0]]) / length
        return np.where((share >= 0) & (share <= 1), across, ends)
    centre = in_plane(given.arc_centre[[row]], plane)[0]
    turn = given.arc_axis[row][plane]
    angle = [np.arctan2(*(point - centre).T[::-1]) for point in (start, end, q)]
    sweep = (turn * (angle[1] - angle[0])) % (2 * np.pi) or 2 * np.pi
    sweep = 2 * np.pi if sweep < 1e-9 else sweep
    on_arc = (turn * (angle[2] - angle[0])) % (2 * np.pi) <= sweep
    return np.where(on_arc, np.abs(np.hypot(*(q - centre).T) - np.hypot(*(start - centre))), ends)


def beside(points, given, row, plane=2):
    """Which of (n, 3) points are beside a row of a program, not before or behind it; of an arc all are."""
    if given.kind[row] == Kind.ARC:
        return np.ones(len(points), dtype=bool)
    start, end = in_plane(given.position[[row - 1, row]], plane)
    share = (in_plane(points, plane) - start) @ (end - start) / np.sum((end - start) ** 2)
    return (share >= 0) & (share <= 1)


def clearance(points, given, rows, plane=2):
    """The least distance in the plane of points from rows of a program, (n,)."""
    return np.min([distance(points, given, row, plane) for row in rows], axis=0)


def cutting_rows(given):
    """Rows of a program with one contour that are neither its start-up nor its cancel block."""
    return np.flatnonzero(given.side_offset)[1:]


def random_contour(rng, offset, plane=2, height=0.0):
    """A contour that wanders on, of lines and arcs; its leads are straight on."""
    heading = rng.uniform(-np.pi, np.pi)
    point = rng.uniform(-20, 20, 2)
    go = np.array([np.cos(heading), np.sin(heading)])
    start = (*(point - 25 * go), height)
    pieces = [(*point, height)]
    count = int(rng.integers(2, 7))
    for index in range(count):
        length = rng.uniform(12, 40)
        height = height + rng.choice([0.0, 0.0, -1.0])
        if rng.random() < 0.4:
            turn = int(rng.choice([-1, 1]))
            radius = rng.uniform(abs(offset) + 1.0, 30.0)
            angle = min(length / radius, 2.5)
            left = np.array([-np.sin(heading), np.cos(heading)])
            centre = point + turn * radius * left
            heading = heading + turn * angle
            point = centre - turn * radius * np.array([-np.sin(heading), np.cos(heading)])
            pieces.append((*point, height, *centre, turn))
        else:
            point = point + length * np.array([np.cos(heading), np.sin(heading)])
            pieces.append((*point, height))
        if index < count - 1:
            heading += rng.choice([0.0, 1.0, 1.0, 1.0]) * rng.uniform(-2.6, 2.6)
    point = point + 25 * np.array([np.cos(heading), np.sin(heading)])
    return contour(start, [*pieces, (*point, height)], offset, plane)
