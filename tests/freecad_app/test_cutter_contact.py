# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which rows of a program of contact points move with which: small programs with the answer written beside each row."""

import numpy as np
import pytest

from pkm_post.freecad_app.cutter_contact import guide_rows
from pkm_post.model import Kind, Program

NONE = -1


def guided(rows, lead_length=0.0):
    """The guides and the rows gone off_face; a row is (R or L, x, z, touches)."""
    count = len(rows)
    letters, x, z, touches = zip(*rows, strict=True)
    program = Program(
        kind=[Kind.RAPID if letter == "R" else Kind.LINE for letter in letters],
        position=np.column_stack([x, np.zeros(count), z]),
        tool_axis=np.tile([0.0, 0.0, 1.0], (count, 1)),
        feed=np.where(np.array(letters) == "R", np.nan, 10.0),
        arc_centre=np.full((count, 3), np.nan),
        arc_axis=np.full((count, 3), np.nan),
        operation=np.zeros(count),
        line=np.arange(1, count + 1),
        events=(),
        operations=("Cut",),
        tools={},
        source="part.FCStd",
    )
    guide, off_face = guide_rows(program, np.array(touches), lead_length)
    return guide.tolist(), np.flatnonzero(off_face).tolist()


ON, OFF = True, False


def test_approach_goes_with_the_first_point_and_retract_with_the_last():
    rows = [
        ("R", 0, 30, OFF),
        ("R", 5, 30, OFF),
        ("L", 5, 0, ON),
        ("L", 6, 0, ON),
        ("R", 6, 30, OFF),
        ("R", 0, 40, OFF),
    ]
    assert guided(rows) == ([2, 2, 2, 3, 3, 3], [])


def test_straight_retract_goes_with_the_cut_before_and_the_way_over_with_the_next():
    rows = [
        ("L", 0, 0, ON), ("R", 0, 5, OFF), ("R", 0, 30, OFF), ("R", 9, 30, OFF), ("R", 9, 5, OFF), ("L", 9, 0, ON),
    ]  # fmt: skip
    assert guided(rows) == ([0, 0, 0, 5, 5, 5], [])


def test_first_of_several_rapid_moves_goes_with_the_cut_before_in_any_direction():
    rows = [("L", 0, 0, ON), ("R", 2, 5, OFF), ("R", 2, 30, OFF), ("R", 9, 5, OFF), ("L", 9, 0, ON)]
    assert guided(rows) == ([0, 0, 4, 4, 4], [])


def test_lone_rapid_move_from_cut_to_cut_goes_with_the_next():
    assert guided([("L", 0, 0, ON), ("R", 9, 5, OFF), ("L", 9, 0, ON)]) == ([0, 2, 2], [])


def test_rapid_move_that_ends_on_a_face_touches():
    assert guided([("R", 0, 30, OFF), ("R", 0, 0, ON), ("L", 9, 0, ON)]) == ([1, 1, 2], [])


def test_feed_move_off_the_faces_is_astray_unless_leads_are_allowed():
    rows = [("R", 0, 30, OFF), ("L", 0, 2, OFF), ("L", 0, 0, ON), ("L", 9, 0, ON), ("L", 9, 3, OFF), ("R", 9, 30, OFF)]
    assert guided(rows)[1] == [1, 4]
    assert guided(rows, lead_length=2.0)[1] == [4]
    assert guided(rows, lead_length=3.0) == ([2, 2, 2, 3, 3, 3], [])


def test_length_of_a_lead_is_along_its_way():
    rows = [("R", 3, 30, OFF), ("L", 3, 4, OFF), ("L", 3, 0, OFF), ("L", 0, 0, ON)]
    assert guided(rows, lead_length=5.0)[1] == [1]
    assert guided(rows, lead_length=7.0) == ([3, 3, 3, 3], [])


def test_gap_within_a_cut_is_no_lead():
    rows = [("L", 0, 0, ON), ("L", 1, 1, OFF), ("L", 2, 0, ON)]
    assert guided(rows, lead_length=100.0)[1] == [1]


def test_cut_that_touches_nowhere_is_no_lead():
    rows = [("L", 0, 0, ON), ("R", 0, 9, OFF), ("L", 5, 9, OFF), ("R", 5, 9, OFF), ("L", 9, 0, ON)]
    assert guided(rows, lead_length=100.0)[1] == [2]


def test_lead_at_the_very_beginning_and_end():
    rows = [("L", 0, 1, OFF), ("L", 0, 0, ON), ("L", 0, 1, OFF)]
    assert guided(rows, lead_length=1.0) == ([1, 1, 1], [])


def test_leads_around_rapid_moves_keep_to_their_own_cuts():
    rows = [
        ("L", 0, 0, ON), ("L", 1, 0, OFF), ("R", 1, 9, OFF), ("R", 7, 9, OFF), ("L", 8, 0, OFF), ("L", 9, 0, ON),
    ]  # fmt: skip
    assert guided(rows, lead_length=1.0) == ([0, 0, 0, 5, 5, 5], [])


@pytest.mark.parametrize("touches", [(OFF, OFF), (ON, OFF)])
def test_without_a_cut_there_may_be_no_guide(touches):
    rows = [("R", 0, 30, touches[0]), ("R", 9, 30, touches[1])]
    assert guided(rows) == ([0, 0] if touches[0] else [NONE, NONE], [])
