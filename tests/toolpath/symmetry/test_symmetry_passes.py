# SPDX-License-Identifier: LGPL-2.1-or-later
"""What belongs to a pass, and what leads from one to the next."""

import numpy as np
import pytest
from programs import program, square_with_arc

from pkm_post.geometry import norm
from pkm_post.model import Kind
from pkm_post.toolpath.symmetry.passes import axial_moves, closed_passes, cut_chords, links, pass_rows

LEANING = np.array([0.6, 0, 0.8])
R, L = Kind.RAPID, Kind.LINE


def leaning(*steps):
    """A program of (kind, up along the axis, across), its axis leaning all the way."""
    kinds, up, across = zip(*steps, strict=True)
    way = np.outer(np.cumsum(up), LEANING) + np.outer(np.cumsum(across), [0, 1, 0])
    return program(way, np.tile(LEANING, (len(kinds), 1)), kind=kinds)


TWO = leaning(
    (R, 50, 0), (R, 0, 5), (R, -30, 0), (L, -20, 0), (L, 0, 10), (L, 0, 0), (L, 0, 10),
    (R, 50, 0), (R, 0, 7), (L, -50, 0), (L, -1, 8), (L, 10, 0), (R, 40, 0),
)  # fmt: skip


def test_moves_along_the_tool_axis_lead_to_passes_and_away():
    assert axial_moves(TWO).tolist() == [0, 0, -1, -1, 0, 0, 0, 1, 0, -1, 0, 1, 1]
    assert pass_rows(TWO).tolist() == [[4, 7], [10, 11]]


def test_rows_of_the_links():
    before, between, behind = links(TWO, pass_rows(TWO))
    assert [each.tolist() for each in (before.travel, before.approach)] == [[0, 1], [2, 3]]
    assert [each.tolist() for each in (between.departure, between.travel, between.approach)] == [[7], [8], [9]]
    assert [each.tolist() for each in (behind.departure, behind.travel, behind.approach)] == [[11, 12], [], []]


def test_a_rapid_move_aslant_counts_where_none_goes_along_the_axis():
    made = program([[0, 0, 0], [9, 0, 0], [20, 5, 30], [30, 9, 0], [40, 0, 0]], kind=[R, L, R, R, L])
    _, between, _ = links(made, pass_rows(made))
    assert [each.tolist() for each in (between.departure, between.travel, between.approach)] == [[2], [], [3]]


def test_a_plunge_ends_a_pass():
    made = program([[0, 0, 9], [0, 0, 5], [9, 0, 5], [9, 0, 1], [0, 0, 1]])
    assert pass_rows(made).tolist() == [[2, 3], [4, 5]]


def test_a_turn_of_the_tool_axis_on_the_way_down_is_no_plunge():
    made = program([[0, 0, 9], [0, 0, 5]], np.array([[0, 0, 1], LEANING]))
    assert pass_rows(made).tolist() == [[1, 2]]


def test_a_closed_pass_has_its_axis_back_as_well():
    square = [[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 0, 5]]
    upright = program(square)
    assert closed_passes(upright, pass_rows(upright)).tolist() == [True]
    turned = program(square, np.array([[0, 0, 1], [0, 0, 1], [0, 0, 1], LEANING]))
    assert closed_passes(turned, pass_rows(turned)).tolist() == [False]


def test_chords_join_the_ends_of_what_is_cut_and_keep_to_the_arcs():
    made = square_with_arc()
    starts, ends = cut_chords(made)
    first = len(starts) - 2 * 24  # the straight rows come first, then 24 chords for each of two arcs
    assert first == 3
    on_circle = ends[first : first + 24]
    np.testing.assert_allclose(norm(on_circle - made.arc_centre[3]), 10.0)
    np.testing.assert_allclose([starts[first], on_circle[-1]], [made.position[2], made.position[3]], atol=1e-9)
    np.testing.assert_allclose(ends[-1], made.position[6], atol=1e-9)


def test_a_program_without_a_cut_has_no_passes():
    assert pass_rows(program([[0, 0, 9], [0, 0, 5]])).shape == (0, 2)
    assert cut_chords(program([[0, 0, 9]]))[0].shape == (0, 3)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_rapid_moves_alone(count):
    made = program(np.arange(3.0 * count).reshape(-1, 3), kind=[R] * count)
    assert len(pass_rows(made)) == 0
