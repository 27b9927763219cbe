# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish mirrored twice with Keep climb: every order, lead and lean comes back, and plunges keep their feed."""

import FreeCAD as App
import numpy as np
import Part
import pytest
from part_jobs import job_on
from surface_finishes import coarse, valid

from pkm_post.freecad_app.commands import read_commands
from pkm_post.freecad_app.symmetry import create_mirror
from pkm_post.toolpath.symmetry.passes import moving_rows, pass_rows

SIX_DECIMALS = 1e-6
"""mm: what rounding of a stored path moves a point by, and half of what it changes a distance by."""
PLUNGE = 5.0
"""mm/s, the vertical feed of the tool controller."""


def saddle_back():
    """A block with a round top that falls to one end: passes along it begin and end at different heights."""
    axis = App.Vector(1, 0.2, -0.25)
    return Part.makeBox(40, 30, 40).common(Part.makeCylinder(30, 90, App.Vector(-20, 15, 5) - axis * 5, axis))


def is_round(face):
    return isinstance(face.Surface, Part.Cylinder)


def moves_of(operation):
    """The program of an operation, and its columns without the rows that move nothing."""
    program, faults = read_commands(operation.Path.Commands, "part", operation.Label)
    assert not faults
    moves = moving_rows(program)
    moves[0] = True
    return program, {name: getattr(program, name)[moves] for name in ("kind", "position", "tool_axis", "feed")}


def plunges(program):
    """How far the plunge to each pass goes, mm."""
    begins = pass_rows(program)[:, 0] - 1
    return np.linalg.norm(program.position[begins] - program.position[begins - 1], axis=1)


@pytest.mark.slow
@pytest.mark.parametrize(
    "choices",
    [
        {"Order": "One way", "Lead": 5.0, "Tilt": 10.0},
        {"Order": "One way", "Lead": 5.0, "Tilt": 10.0, "ApproachDistance": 9.0},  # more than the safe height
        {"Order": "One way", "Lead": 5.0, "Tilt": -20.0, "LeadMove": "Arc"},
        {"Order": "One way", "Lines": "Along V", "Lead": 12.0, "LeadMove": "Tangent"},
        {"Order": "One way", "ConeLimit": 0.0},
        {"Order": "One way", "Lines": "Parallel planes", "Tilt": 15.0},
        {"Order": "Zigzag", "Lead": 5.0, "Tilt": 10.0},
        {"Order": "Zigzag", "Lines": "Along V", "Tilt": 15.0, "LeadMove": "Arc"},
        {"Order": "Zigzag", "Lines": "Parallel planes", "Lead": 8.0},
    ],
    ids=lambda choices: " ".join(map(str, choices.values())),
)
def test_twice_is_the_operation_and_once_plunges_as_it_did(document, choices):
    job = job_on(document, saddle_back())
    operation = valid(coarse(job, is_round, Stepover=6.0, ChordTolerance=0.05, AxisTolerance=1.0, **choices))
    once = create_mirror(operation, (0, 1, 0), point=(0, 15, 0), keep_climb=True)
    twice = create_mirror(once, (0, 1, 0), point=(0, 15, 0), keep_climb=True)
    document.recompute()
    (original, before), (between, _), (_, after) = (moves_of(valid(each)) for each in (operation, once, twice))
    for name, column in before.items():
        np.testing.assert_allclose(after[name], column, atol=SIX_DECIMALS, err_msg=name)
    np.testing.assert_allclose(between.feed[pass_rows(between)[:, 0] - 1], PLUNGE)
    approach, down = operation.ApproachDistance.Value, plunges(between)
    # where the safe height is nearer than the approach, the plunge begins there, as that of the original does
    nearer = down < approach - 2 * SIX_DECIMALS
    assert nearer.any() == ("ApproachDistance" in choices)
    np.testing.assert_allclose(down, np.where(nearer, plunges(original), approach), atol=2 * SIX_DECIMALS)
