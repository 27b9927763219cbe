# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surfaces whose points, normals and curvatures are known: a plate, a cylinder, a sphere, a torus."""

import numpy as np

from pkm_post.model import Place
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.surface.options import SurfaceOptions
from pkm_post.toolpath.surface.passes import surface_poses
from pkm_post.toolpath.surface.surface import ParameterRange, Surface

PLACE = Place("part.FCStd", "Finish")
MICRON = 1e-3
BALL, BULL, FLAT = Cutter(3.0, 0.0, 3.0), Cutter(2.0, 3.0, 2.0), Cutter(0.0, 5.0, 0.0)


def everywhere(u, v):
    return np.ones(len(u), dtype=bool)


def columns(*parts):
    return np.column_stack(np.broadcast_arrays(*parts))


def plate(width=40.0, depth=20.0, inside=everywhere):
    """The plane z = 0, u along x and v along y, material below."""

    def evaluate(u, v):
        one, nil = np.ones_like(u), np.zeros_like(u)
        return columns(u, v, nil), columns(nil, nil, one), columns(one, nil, nil), columns(nil, one, nil)

    return Surface(evaluate, inside, ParameterRange(0.0, width), ParameterRange(0.0, depth))


def cylinder(radius=20.0, height=30.0):
    """A round column about z, u the angle and v the height."""

    def evaluate(u, v):
        cos, sin, nil = np.cos(u), np.sin(u), np.zeros_like(u)
        normal = columns(cos, sin, nil)
        return (
            radius * normal + columns(nil, nil, v),
            normal,
            radius * columns(-sin, cos, nil),
            columns(nil, nil, np.ones_like(u)),
        )

    return Surface(evaluate, everywhere, ParameterRange(0.0, 2 * np.pi, closed=True), ParameterRange(0.0, height))


def sphere(radius=25.0, lowest=0.3, highest=np.pi / 2, hollow=False):
    """The part of a ball, or of a bowl, between two latitudes; u is the longitude."""

    def evaluate(u, v):
        out = columns(np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v))
        along_u = radius * columns(-np.cos(v) * np.sin(u), np.cos(v) * np.cos(u), np.zeros_like(u))
        along_v = radius * columns(-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v))
        return radius * out, -out if hollow else out, along_u, along_v

    return Surface(evaluate, everywhere, ParameterRange(0.0, 2 * np.pi, closed=True), ParameterRange(lowest, highest))


def torus(ring=40.0, tube=10.0, lowest=0.2, highest=np.pi - 0.2):
    """The upper part of a ring: u goes round the ring, v over the tube from outside to inside."""

    def evaluate(u, v):
        out = columns(np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v))
        middle = ring * columns(np.cos(u), np.sin(u), np.zeros_like(u))
        along = columns(-np.sin(u), np.cos(u), np.zeros_like(u))
        along_u = (ring + tube * np.cos(v))[:, None] * along
        along_v = tube * columns(-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v))
        return middle + tube * out, out, along_u, along_v

    return Surface(evaluate, everywhere, ParameterRange(0.0, 2 * np.pi, closed=True), ParameterRange(lowest, highest))


def distance_to_torus(points, ring=40.0, tube=10.0):
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - ring, points[:, 2]) - tube


def distance_to_cutter(points, tip, axis, cutter):
    """Of points from the corner and the bottom of a bull nose, in closed form; negative inside."""
    way = points - tip
    height = np.einsum("nj,nj->n", way, axis) - cutter.axial_offset
    away = np.linalg.norm(way - (height + cutter.axial_offset)[:, None] * axis, axis=1)
    off_corner = np.hypot(np.maximum(away - cutter.radial_offset, 0.0), height)
    return off_corner - cutter.corner_radius


def settings(**chosen):
    return SurfaceOptions(
        **({"safe_height": 60.0, "clearance_height": 80.0, "feed": 20.0, "plunge_feed": 5.0} | chosen)
    )


def covered(surface, cutter=BALL, **chosen):
    poses, faults = surface_poses(surface, cutter, settings(**chosen), PLACE)
    assert poses is not None, [str(fault) for fault in faults]
    return poses


def passes(poses):
    """The rows of each pass, without links, in the order of travel."""
    path = poses.path
    rows = np.flatnonzero(np.isnan(path.link))
    changes = np.flatnonzero((np.diff(path.number[rows]) != 0) | (np.diff(path.run[rows]) != 0)) + 1
    return np.split(rows, changes)


def played(poses, instants=11):
    """Tips and axes at many instants of every move of the runs, as the machine plays them."""
    moving = np.flatnonzero(poses.path.run[:-1] == poses.path.run[1:])
    share = np.linspace(0.0, 1.0, instants)[:, None, None]
    tip = poses.tip[moving] + share * (poses.tip[moving + 1] - poses.tip[moving])
    first, second = poses.axis[moving], poses.axis[moving + 1]
    angle = np.arccos(np.clip(np.einsum("nj,nj->n", first, second), -1.0, 1.0))[:, None]
    safe = np.where(angle > 1e-7, np.sin(angle), 1.0)
    axis = np.where(angle > 1e-7, (np.sin((1 - share) * angle) * first + np.sin(share * angle) * second) / safe, first)
    return tip, axis / np.linalg.norm(axis, axis=-1, keepdims=True), moving
