# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a program asks for in compensation is applied once, in 2D and in 3D, before it is placed."""

import dataclasses

import numpy as np
import pytest
from programs import BALL, program

from pkm_post.model import Tool
from pkm_post.toolpath.compensation.compensate import compensate
from pkm_post.toolpath.compensation.contour_elements import OffsetOptions

CONTOURS = OffsetOptions()


def with_normals():
    made = program([[0, 0, 30], [0, 0, 0], [10, 0, 0], [10, 0, 30]])
    normal = np.full((4, 3), np.nan)
    normal[1:3] = [0.0, 0.6, 0.8]
    return dataclasses.replace(made, normal=normal)


def test_a_program_that_asks_for_nothing_is_left_alone():
    made = program([[0, 0, 30], [10, 0, 30]])
    assert compensate(made, CONTOURS, {}) == (made, ())


def test_contours_are_offset():
    made = dataclasses.replace(program([[-20, 20, 0], [0, 0, 0], [30, 0, 0], [50, 20, 0]]), side_offset=[0, 5, 5, 0])
    moved, told = compensate(made, CONTOURS, {})
    assert not told
    assert not moved.side_offset.any()
    assert moved.position[1:3] == pytest.approx(np.array([[0.0, 5.0, 0.0], [30.0, 5.0, 0.0]]))


def test_a_smaller_cutter_goes_nearer_and_is_told_as_the_tool():
    # A ball of radius 6 and one of 5 that touch the same plane: the tips differ by (r2 - r1) (n - k).
    moved, told = compensate(with_normals(), CONTOURS, {1: Tool(1, "", 10.0, 5.0, 0.0)})
    assert not told
    assert moved.position[1] - with_normals().position[1] == pytest.approx([0.0, -0.6, 0.2])
    assert moved.tools[1] == dataclasses.replace(BALL, diameter=10.0, corner_radius=5.0)


@pytest.mark.parametrize(
    ("nominal", "actual", "code"),
    [
        (BALL, {7: BALL}, "N118"),
        (BALL, {1: Tool(1, "", 10.0, 6.0, 0.0)}, "N109"),
        (dataclasses.replace(BALL, diameter=0.0), {1: BALL}, "N109"),
        (dataclasses.replace(BALL, corner_known=False), {1: BALL}, "N117"),
        (BALL, {1: dataclasses.replace(BALL, corner_known=False)}, "N117"),
    ],
    ids=["another number", "a corner that does not fit", "unknown diameter", "unknown corner", "unknown corner now"],
)
def test_a_cutter_that_is_not_known_is_refused(nominal, actual, code):
    moved, told = compensate(dataclasses.replace(with_normals(), tools={1: nominal}), CONTOURS, actual)
    assert moved is None
    assert [fault.code for fault in told] == [code]


def test_a_program_without_normals_cannot_be_compensated_for_a_cutter():
    moved, told = compensate(program([[0, 0, 30], [10, 0, 30]]), CONTOURS, {1: BALL})
    assert moved is None
    assert [fault.code for fault in told] == ["N108"]
