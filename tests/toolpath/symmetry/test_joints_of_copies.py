# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints of copies that meet, against distances known from the symmetry."""

import numpy as np
import pytest
from programs import cone, program

from pkm_post.toolpath.symmetry.coverage import joint, joints, sector
from pkm_post.toolpath.symmetry.transform import mirror, rotation, transform

EXACT = 1e-9
Z = ([0, 0, 0], [0, 0, 1])
XZ, YZ = mirror([0, 0, 0], [0, 1, 0]), mirror([0, 0, 0], [1, 0, 0])


def copies(made, *matrices):
    return [made, *(transform(made, matrix)[0] for matrix in matrices)]


def turns(*degrees):
    return [rotation(*Z, np.radians(angle)) for angle in degrees]


def test_quarters_meet_with_their_axes_where_these_lie_in_the_planes_of_symmetry():
    made = cone(40, turns=0.25)
    level = program(made.position * [1, 1, 0], made.tool_axis)
    all_round = copies(level, XZ, YZ, *turns(180))
    found = joints(all_round, [sector(each, *Z) for each in all_round])
    assert len(found) == 4
    assert [(each.distance, each.turn) for each in found] == [pytest.approx((0, 0), abs=EXACT)] * 4


def test_a_lean_along_the_way_turns_over_at_the_joint():
    made = cone(40, turns=0.25)
    lean = np.radians(5)
    axis = made.tool_axis + 0.0
    axis[0] = [0, np.sin(lean), np.cos(lean)]  # the mirror makes -5 degrees of it
    both = copies(program(made.position * [1, 1, 0], axis), XZ)
    (found,) = joints(both, [sector(each, *Z) for each in both])
    assert (found.distance, found.turn) == pytest.approx((0, 2 * lean), abs=EXACT)


def test_copies_that_do_not_meet_have_no_joint():
    both = copies(cone(40, turns=0.25), *turns(180))
    assert joints(both, [sector(each, *Z) for each in both]) == ()


@pytest.mark.parametrize("offset", [0.0, 2.5])
def test_the_joint_at_a_mirror_is_twice_as_wide_as_the_distance_to_it(offset):
    one, other = copies(program([[offset, 0, 0], [30, 40, 0]]), YZ)
    found = joint(one, other)
    assert (found.distance, found.turn) == pytest.approx((2 * offset, 0), abs=EXACT)


def test_the_worst_of_all_passes_counts():
    rows = [[1, 0, 50], [1, 0, 0], [30, 0, 0], [30, 0, 50], [4, 9, 50], [4, 9, 0], [30, 9, 0]]
    one, other = copies(program(rows, kind=[0, 1, 1, 0, 0, 1, 1]), YZ)
    assert joint(one, other).distance == pytest.approx(8)


def test_programs_with_different_passes_are_no_copies():
    with pytest.raises(ValueError, match="1 and 0 passes"):
        joint(program([[0, 0, 0], [9, 0, 0]]), program([[0, 0, 0]]))
