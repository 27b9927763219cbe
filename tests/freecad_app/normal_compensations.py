# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensations over operations of a few moves: made, computed, and what came of them."""

import math

import FreeCAD as App
import numpy as np
import Part
from cam_jobs import add_operation, moves
from part_jobs import corner

from pkm_post.freecad_app.job import read_job
from pkm_post.freecad_app.normal_compensation import create_normal_compensation

MICRON = 1e-3
SIX_DECIMALS = 1e-6
X, Y, Z = np.eye(3)
COMMENTS = 2
"""Commands that a Custom operation puts before those it is given."""
ACROSS_THE_TOP = [(5.0, 5.0, 20.0), (15.0, 5.0, 20.0), (15.0, 12.0, 20.0)]
SPHERE_RADIUS, BALL_RADIUS = 20.0, 5.0


def bull_nose(diameter, radius):
    return {"bit": "bullnose.fcstd", "Diameter": diameter, **corner(diameter, radius)}


def lines(points, axes=None):
    """G-code of a cut along contact points, from above and back."""
    rows = [np.round([*point], 6) for point in points]
    turned = [""] * len(rows) if axes is None else [" I{:.6f} J{:.6f} K{:.6f}".format(*axis) for axis in axes]
    words = ["X{:.6f} Y{:.6f} Z{:.6f}".format(*row) for row in rows]
    above = ["X{:.6f} Y{:.6f} Z60".format(*rows[place]) for place in (0, -1)]
    cut = [f"G1 {row}{axis} F10" for row, axis in zip(words, turned, strict=True)]
    return [f"G0 {above[0]}{turned[0]}", *cut, f"G0 {above[1]}{turned[-1]}"]


def dressed(job, code, **properties):
    """The dress-up over an operation with these lines of G-code, computed."""
    dressup = create_normal_compensation(add_operation(job, code))
    for name, value in properties.items():
        setattr(dressup, name, value)
    job.Document.recompute()
    return dressup


def valid(dressup):
    assert dressup.isValid(), dressup.getStatusString()
    return dressup


def poses(operation, code="G1"):
    """Tips and unit tool axes of moves, upright where no axis is given."""
    words = [words for name, words in moves(operation) if name == code]
    tips = np.array([[each[letter] for letter in "XYZ"] for each in words])
    axes = np.array([[each.get(letter, up) for letter, up in zip("IJK", Z, strict=True)] for each in words])
    return tips, axes / np.linalg.norm(axes, axis=1)[:, None]


def refused(dressup):
    """The text at a dress-up that could not be computed; it has no path then, and the job is not posted."""
    assert not dressup.isValid()
    assert moves(dressup) == []
    job = next(each for each in dressup.Document.Objects if hasattr(each, "PostProcessor"))
    program, faults = read_job(job)
    assert program is None
    assert ("J116", dressup.Label) in [(fault.code, fault.place.operation) for fault in faults]
    return dressup.getStatusString()


def slope():
    """A wedge whose slope through the origin has the normal (1, 0, 1) / sqrt 2."""
    corners = [App.Vector(*corner) for corner in [(-20, -20, 20), (20, -20, -20), (-20, -20, -20), (-20, -20, 20)]]
    return Part.Face(Part.makePolygon(corners)).extrude(App.Vector(0, 40, 0))


def over_the_sphere(spacing=0.05):
    """Unit vectors along a half circle over a sphere, not through its pole."""
    angle = np.arange(-1.2, 1.2, spacing)
    return np.column_stack([np.sin(angle), np.full(len(angle), 0.3), np.cos(angle)]) / math.hypot(1.0, 0.3)
