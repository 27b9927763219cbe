# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the tips of one cutter to those of another: the difference of two contacts, and programs with normals."""

import dataclasses

import numpy as np
import pytest
from cutters import BALL, BULL_NOSE, FLAT, TAPERED
from programs import program

from pkm_post.model import Event, EventKind, Kind, Place
from pkm_post.toolpath.compensation.compensate import compensate_tips
from pkm_post.toolpath.compensation.contact import tip_from_contact, tip_shift
from pkm_post.toolpath.compensation.cutter import Cutter

ROUNDING = 1e-9
NAN = np.full(3, np.nan)
X, Y, Z = np.eye(3)
SLOPE = (X + Z) * np.sqrt(0.5)
SMALLER_BALL = Cutter(4.0, 0.0, 4.0)


def contacts(count, seed):
    rng = np.random.default_rng(seed)
    azimuth, angle = rng.uniform(0, 2 * np.pi, count), rng.uniform(0.1, 1.3, count)
    normals = np.column_stack([np.sin(angle) * np.cos(azimuth), np.sin(angle) * np.sin(azimuth), np.cos(angle)])
    return rng.uniform(-50, 50, (count, 3)), normals, np.tile(Z, (count, 1))


@pytest.mark.parametrize("actual", [BALL, FLAT, BULL_NOSE, TAPERED])
@pytest.mark.parametrize("nominal", [BALL, FLAT, BULL_NOSE, TAPERED])
def test_shift_is_the_difference_of_the_tips_at_one_contact(nominal, actual):
    points, normals, axes = contacts(100, seed=1)
    before, after = (tip_from_contact(points, normals, axes, cutter)[0] for cutter in (nominal, actual))
    shift, told = tip_shift(normals, axes, nominal, actual, points)
    assert told == ()
    assert before + shift == pytest.approx(after, abs=ROUNDING)


def test_worn_ball_comes_nearer_along_normal_and_axis():
    # dr (n - k) with dr = -1, n = (1, 0, 1) / sqrt 2
    shift, _ = tip_shift([SLOPE], [Z], BALL, SMALLER_BALL)
    assert shift[0] == pytest.approx([-np.sqrt(0.5), 0.0, 1.0 - np.sqrt(0.5)], abs=ROUNDING)


def test_corner_of_both_cutters_has_to_touch():
    place = Place("part.h", "LN")
    for pair in ((BALL, TAPERED), (TAPERED, BALL)):
        found, told = tip_shift([X], [Z], *pair, place=place)
        assert found is None
        assert [(item.code, item.place) for item in told] == [("N102", Place("part.h", "LN", 1))]


def test_points_give_the_direction_where_normal_and_axis_are_parallel():
    path = np.outer([0.0, 1.0], Y)
    wider = Cutter(0.0, 6.0, 0.0)
    assert tip_shift([Z, Z], [Z, Z], FLAT, wider, path)[0] == pytest.approx(np.array([Y, Y]), abs=ROUNDING)
    assert [item.code for item in tip_shift([Z, Z], [Z, Z], FLAT, wider)[1]] == ["N103", "N103"]


def test_wrong_shapes_are_the_callers_fault():
    with pytest.raises(ValueError, match=r"tip_shift: expected 3 arrays \(N, 3\)"):
        tip_shift(np.zeros((2, 3)), np.zeros((3, 3)), BALL, FLAT)


RAPID, LINE, ARC = Kind.RAPID, Kind.LINE, Kind.ARC


def passes():
    """Two passes along slopes that face each other, with approach, retract and rapids between, which have no normal."""
    other = SLOPE * [-1.0, 1.0, 1.0]
    normal = [NAN, NAN, SLOPE, SLOPE, NAN, NAN, NAN, NAN, other, NAN]
    kind = [RAPID, LINE, LINE, LINE, LINE, RAPID, RAPID, LINE, LINE, RAPID]
    position = np.cumsum(np.random.default_rng(3).normal(size=(10, 3)), axis=0)
    return dataclasses.replace(program(position, kind=np.array(kind)), normal=normal)


def test_rows_without_a_normal_keep_their_distance_to_the_contact_they_leave_or_approach():
    before = passes()
    after, told = compensate_tips(before, BALL, SMALLER_BALL)
    assert told == ()
    first, second = (tip_shift([n], [Z], BALL, SMALLER_BALL)[0][0] for n in (before.normal[2], before.normal[8]))
    # The first rapid after a pass retracts; what follows it approaches the next pass.
    assert after.position - before.position == pytest.approx(np.array([first] * 6 + [second] * 4), abs=ROUNDING)


def test_all_but_the_tips_stays():
    before = passes()
    after, _ = compensate_tips(before, BALL, SMALLER_BALL)
    assert after.events == before.events
    for name in ("kind", "tool_axis", "feed", "line", "normal"):
        assert np.array_equal(getattr(after, name), getattr(before, name), equal_nan=True)


def test_same_cutter_moves_nothing():
    before = passes()
    assert np.array_equal(compensate_tips(before, BULL_NOSE, BULL_NOSE)[0].position, before.position)


def test_there_and_back_again():
    before = passes()
    there, _ = compensate_tips(before, BALL, BULL_NOSE)
    back, _ = compensate_tips(there, BULL_NOSE, BALL)
    assert back.position == pytest.approx(before.position, abs=ROUNDING)


def arc_program(normals):
    centre, turn = np.full((3, 3), np.nan), np.full((3, 3), np.nan)
    centre[2], turn[2] = [5.0, 0.0, 0.0], Z
    made = program([[0, 0, 5], [0, 0, 0], [10, 0, 0]], kind=np.array([RAPID, LINE, ARC]), centre=centre, turn=turn)
    return dataclasses.replace(made, normal=normals)


def test_arc_on_a_plane_is_shifted_as_it_is_and_one_on_a_wall_is_refused():
    flat = arc_program([NAN, SLOPE, SLOPE])
    moved, _ = compensate_tips(flat, BALL, SMALLER_BALL)
    shift = moved.position[1] - flat.position[1]
    assert moved.arc_centre[2] == pytest.approx(flat.arc_centre[2] + shift, abs=ROUNDING)
    found, told = compensate_tips(arc_program([NAN, -X + Z, X + Z]), BALL, SMALLER_BALL)
    assert found is None
    assert [(item.code, item.place, item.found) for item in told] == [
        ("N107", Place("part.FCStd", "Finish", 3), "its ends would move 1.414 mm apart")
    ]


def test_faults_name_the_row_of_the_program():
    made = dataclasses.replace(passes(), normal=[NAN] * 8 + [-Z, NAN])
    found, told = compensate_tips(made, BALL, SMALLER_BALL)
    assert found is None
    assert [(item.code, item.place.line) for item in told] == [("N102", 9)]


def test_program_without_normals_is_refused():
    found, told = compensate_tips(program(np.zeros((2, 3))), BALL, SMALLER_BALL)
    assert found is None
    assert [item.code for item in told] == ["N108"]


def test_rows_of_other_tools_stay():
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(5, EventKind.TOOL_CHANGE, 2))
    before = dataclasses.replace(passes(), events=events)
    with pytest.raises(ValueError, match="expected the number of a tool"):
        compensate_tips(before, BALL, SMALLER_BALL)
    after, _ = compensate_tips(before, BALL, SMALLER_BALL, tool=2)
    assert np.array_equal(after.position[:5], before.position[:5])
    assert np.all(np.any(after.position[5:] != before.position[5:], axis=1))
