# SPDX-License-Identifier: LGPL-2.1-or-later
"""The spline of the speed squared: its values against sums, differences and its own law beside rests."""

import numpy as np

from pkm_post.planning.speed_spline import SpeedSpline, durations, highest_within, inverse_tangent, within_cells


def made():
    random = np.random.default_rng(5)
    s = np.concatenate([[0.0], np.cumsum(random.uniform(0.05, 2, 14))])
    rest = np.zeros(15, dtype=bool)
    rest[[0, 5, 14]] = True
    spline = SpeedSpline.of(s, rest)
    return spline, random.uniform(1, 5, len(spline.left))


def test_there_is_one_unknown_for_each_cell_that_touches_no_rest():
    spline, _ = made()
    assert spline.left.tolist() == [1, 2, 3, 6, 7, 8, 9, 10, 11, 12]
    assert sorted(spline.ends.place[spline.knots()]) == [1, 2, 3, 4, *range(6, 14)]


def test_speed_and_acceleration_do_not_jump_and_the_acceleration_is_the_slope():
    spline, unknowns = made()
    square, acceleration = spline.at_places(unknowns)
    change, a, x = spline.ends.values(unknowns)
    np.testing.assert_allclose(x, square[spline.ends.place], rtol=1e-12)
    np.testing.assert_allclose(a, acceleration[spline.ends.place], rtol=1e-9, atol=1e-12)
    width, count = np.diff(spline.s)[spline.left], len(spline.left)
    np.testing.assert_allclose(np.diff(acceleration)[spline.left], change[:count] * width, atol=1e-12)
    mean = (acceleration[spline.left] + acceleration[spline.left + 1]) / 2
    np.testing.assert_allclose(np.diff(square)[spline.left], 2 * mean * width, atol=1e-12)


def test_beside_a_rest_the_jerk_is_constant():
    # s = j t^3 / 6: after 2 s of the jerk 3 mm/s^3 there are 4 mm, 6 mm/s, 6 mm/s^2
    s = np.array([0.0, 4.0, 5.0, 6.0, 10.0])
    rest = np.array([True, False, False, False, True])
    spline = SpeedSpline.of(s, rest)
    unknowns = np.ones(len(spline.left))
    unknowns *= 36.0 / spline.at_places(unknowns)[0][1]
    square, acceleration = spline.at_places(unknowns)
    np.testing.assert_allclose([square[1], acceleration[1]], [36.0, 6.0])
    np.testing.assert_allclose([square[3], acceleration[3]], [36.0, -6.0])
    np.testing.assert_allclose(durations(np.diff(s), square, acceleration)[[0, 3]], 2.0)
    after = spline.ends.place == 1
    jerk = spline.ends.values(unknowns)[0, after & (spline.ends.cell == 0)] * 6.0
    np.testing.assert_allclose(jerk, 3.0)
    np.testing.assert_allclose(within_cells(s, square, acceleration, np.array([0]), np.array([0.5])), [[2.25], [3.0]])


def test_the_unknowns_of_a_spline_that_is_known_at_its_places():
    spline, unknowns = made()
    np.testing.assert_allclose(spline.unknowns(*spline.at_places(unknowns)), unknowns, rtol=1e-12)


def test_durations_against_sums():
    spline, unknowns = made()
    square, acceleration = spline.at_places(unknowns)
    share = (np.arange(4000) + 0.5) / 4000
    width = np.diff(spline.s)
    for cell in (1, 2, 7, 10):
        x, _ = within_cells(spline.s, square, acceleration, np.full(4000, cell), spline.s[cell] + width[cell] * share)
        time = (width[cell] / 4000 / np.sqrt(x)).sum()
        np.testing.assert_allclose(durations(width, square, acceleration)[cell], time, rtol=1e-6)


def test_the_highest_speed_within_cells():
    spline, unknowns = made()
    square, acceleration = spline.at_places(unknowns)
    highest = highest_within(np.diff(spline.s), square, acceleration)
    share = np.linspace(0, 1, 2001)
    for cell in spline.left:
        at = spline.s[cell] + share * (spline.s[cell + 1] - spline.s[cell])
        x, _ = within_cells(spline.s, square, acceleration, np.full(2001, cell), at)
        np.testing.assert_allclose(max(highest[cell], square[cell], square[cell + 1]), x.max(), rtol=1e-6)


def test_the_inverse_tangent_across_zero():
    z = np.array([-50.0, -1e-2, -1.01e-4, -0.99e-4, -1e-9, 0.0, 1e-9, 0.99e-4, 1.01e-4, 0.5, 0.999])
    root = np.sqrt(z.astype(complex))
    expected = np.divide(np.arctanh(root), root, out=np.ones_like(root), where=z != 0).real
    np.testing.assert_allclose(inverse_tangent(z), expected, rtol=1e-12)


def test_ends_at_which_only_free_unknowns_count_have_the_same_values():
    spline, unknowns = made()
    held = np.full(len(unknowns), np.nan)
    held[4:7] = unknowns[4:7]
    free = spline.ends.where_free(held)
    few = unknowns[np.isnan(held)]
    ends = zip(free.cell, free.place, strict=True)
    rows = [np.flatnonzero((spline.ends.cell == c) & (spline.ends.place == p))[0] for c, p in ends]
    np.testing.assert_allclose(free.values(few), spline.ends.values(unknowns)[:, rows], rtol=1e-12, atol=1e-12)
    touched = np.isnan(np.concatenate([[0.0], held, [0.0]]))[spline.ends.unknown[:, None] + np.arange(3)].any(axis=1)
    assert len(rows) == touched.sum() < len(spline.ends.cell)
    step = np.random.default_rng(3).normal(size=len(few))
    np.testing.assert_allclose(free.values(few + step) - free.values(few), free.changes(step), atol=1e-12)
    nothing_held = spline.ends.where_free(np.full(len(unknowns), np.nan))
    np.testing.assert_array_equal(nothing_held.values(unknowns), spline.ends.values(unknowns))
