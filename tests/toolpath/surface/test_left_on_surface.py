# SPDX-License-Identifier: LGPL-2.1-or-later
"""What whole paths leave on a surface, measured with the envelope of the cutter, which knows nothing of passes."""

import math

import numpy as np
import pytest
from shapes import BALL, BULL, FLAT, PLACE, covered, plate, settings, torus

from pkm_post.toolpath.compensation.stock_left import stock_left
from pkm_post.toolpath.surface.moves import program_from_poses
from pkm_post.toolpath.surface.options import LeadMove, PassLines, PassOrder
from pkm_post.toolpath.surface.poses import SurfaceTolerances
from pkm_post.toolpath.surface.stepover import Stepover
from pkm_post.toolpath.surface.tool_axis import AxisRule

TOLERANCE = 1e-4


def left_on(surface, cutter, count=12, **chosen):
    """Material left at points all over the middle of a surface, by a whole program with its leads and lifts."""
    poses = covered(surface, cutter, **chosen)
    program, faults = program_from_poses([poses], settings(**chosen), PLACE)
    assert program is not None, faults
    rng = np.random.default_rng(5)
    u, v = (rng.uniform(span.first + 0.2 * span.width, span.last - 0.2 * span.width, count**2)
            for span in (surface.u, surface.v))  # fmt: skip
    samples = surface.at(u, v)
    return stock_left(
        program.position, program.tool_axis, cutter, samples.point, samples.normal, tolerance=TOLERANCE, reach=5.0
    )


LEANS = [(BALL, AxisRule()), (BALL, AxisRule(lead=0.2)), (BULL, AxisRule(lead=0.2)), (BULL, AxisRule(0.3, 0.2))]


@pytest.mark.parametrize(("cutter", "rule"), LEANS)
def test_scallops_on_a_plate_are_as_high_as_wanted(cutter, rule):
    height = 0.02
    left = left_on(
        plate(), cutter, stepover=Stepover(scallop=height), rule=rule, tolerances=SurfaceTolerances(0.001, 0.01)
    )
    assert left.min() > -0.001 - TOLERANCE
    # the profile is taken for the circle that fits it best: this is as far as that goes with this lean
    assert 0.6 * height < left.max() < 1.15 * height


def test_sharp_corner_leaves_no_more_than_wanted():
    left = left_on(plate(), FLAT, stepover=Stepover(scallop=0.05), rule=AxisRule(tilt=0.2))
    assert left.min() > -0.011
    assert left.max() < 0.05 + TOLERANCE


@pytest.mark.slow
@pytest.mark.parametrize("lines", [PassLines.ALONG_U, PassLines.PLANES])
def test_torus_is_neither_gouged_nor_left(lines):
    chord, height = 0.02, 0.1
    left = left_on(
        torus(20.0, 10.0, lowest=0.5, highest=math.pi - 0.5),
        BALL,
        7,
        lines=lines,
        order=PassOrder.ONE_WAY,
        stepover=Stepover(scallop=height),
        tolerances=SurfaceTolerances(chord, 0.01),
        rule=AxisRule(lead=0.1, cone=1.0),
        lead_move=LeadMove.ARC,
        lead_length=3.0,
    )
    assert left.min() > -chord - TOLERANCE
    assert 0.6 * height < left.max() < height + chord + TOLERANCE


@pytest.mark.parametrize("cutter", [BULL, FLAT], ids=["bull", "flat"])
def test_links_do_not_gouge_where_the_lead_turns_round(cutter):
    left = left_on(torus(lowest=0.9, highest=1.5), cutter, tolerances=SurfaceTolerances(0.005, 0.01),
                   stepover=Stepover(distance=1.5), rule=AxisRule(lead=0.25))  # fmt: skip
    assert left.min() > -0.005 - TOLERANCE
