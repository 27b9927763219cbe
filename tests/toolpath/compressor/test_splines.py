# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws of quintic pieces, of the direction of a vector, and of the bounds of both."""

import numpy as np
from smooth_runs import column_like, fitted_rows, wavy

from pkm_post.geometry import length_of
from pkm_post.toolpath.compressor.bounds import SplineBounds
from pkm_post.toolpath.compressor.splines import Splines, direction, polynomial, quintic_powers


def test_quintics_meet_what_is_given_at_both_ends():
    rng = np.random.default_rng(3)
    begin, end, width = rng.normal(size=(3, 2, 9)), rng.normal(size=(3, 2, 9)), rng.uniform(0.1, 3, 9)
    powers = quintic_powers(begin, end, width)
    for x, given in ((0.0, begin), (1.0, end)):
        found = polynomial(powers, np.full(9, x))
        for order in range(3):
            np.testing.assert_allclose(found[order] / width**order, given[order], atol=1e-9)


def test_derivatives_of_a_polynomial_are_those_of_its_powers():
    powers = np.random.default_rng(4).normal(size=(6, 2, 5))
    x = np.linspace(-0.5, 1.5, 5)
    found = polynomial(powers, x)
    for column in range(2):
        for k in range(5):
            whole = np.polynomial.Polynomial(powers[:, column, k])
            for order in range(3):
                expected = whole.deriv(order)(x[k]) if order else whole(x[k])
                np.testing.assert_allclose(found[order][column, k], expected, rtol=1e-12, atol=1e-12)


def test_the_direction_of_a_vector_has_the_derivatives_of_a_unit_vector():
    powers = np.random.default_rng(5).normal(size=(6, 3, 40)) + np.array([0, 0, 9.0])[:, None]
    x, step = np.linspace(0, 1, 40), 1e-5
    k, k1, k2 = direction(polynomial(powers, x))
    after, before = (direction(polynomial(powers, x + by)) for by in (step, -step))
    np.testing.assert_allclose(length_of(*k), 1, atol=1e-14)
    np.testing.assert_allclose(k1, (after[0] - before[0]) / (2 * step), atol=1e-7)
    np.testing.assert_allclose(k2, (after[1] - before[1]) / (2 * step), atol=1e-6)


def test_pieces_join_with_continuous_second_derivatives():
    splines, _ = fitted_rows(wavy(400, noise=0.002), tip=0.006)
    inner = np.flatnonzero(np.diff(splines.begin) - splines.width[:-1] < 1e-9)
    assert len(inner) > 40
    ends = polynomial(splines.powers[..., inner], np.ones(len(inner)))
    starts = polynomial(splines.powers[..., inner + 1], np.zeros(len(inner)))
    for order, tolerance in ((0, 1e-12), (1, 1e-11), (2, 1e-9)):
        at_end, at_start = (one[order] / splines.width[at] ** order for one, at in ((ends, inner), (starts, inner + 1)))
        np.testing.assert_allclose(at_end, at_start, atol=tolerance)


def test_beyond_its_ends_a_curve_goes_on_as_a_parabola():
    splines, _ = fitted_rows(wavy(60), tip=0.006)
    last = np.array([len(splines) - 1])
    value, slope, second = splines.at(last, splines.extent[last], splines.powers)
    ahead = 0.3
    beyond = splines.at(last, splines.extent[last] + ahead, splines.powers)
    np.testing.assert_allclose(beyond[0], value + ahead * slope + ahead**2 / 2 * second, atol=1e-12)
    np.testing.assert_allclose(beyond[1], slope + ahead * second, atol=1e-12)
    np.testing.assert_allclose(beyond[2], second, atol=1e-12)


def test_nothing_is_larger_than_its_bound():
    splines, _ = fitted_rows(column_like(200), tip=0.006, axis=1e-3)
    bounds = SplineBounds.of(splines)
    shares = np.linspace(0, 1, 41)
    rows = np.repeat(splines.row, len(shares))
    u = np.outer(splines.extent, shares).ravel()

    def largest(vectors):
        return length_of(*vectors).reshape(len(splines), -1).max(axis=1)

    _, tip_1, tip_2 = splines.at(rows, u, splines.tip)
    _, axis_1, axis_2 = direction(splines.at(rows, u, splines.axis))
    for name, found in (("tip_1", tip_1), ("tip_2", tip_2), ("axis_1", axis_1), ("axis_2", axis_2)):
        bound = getattr(bounds, name)
        assert (largest(found) <= bound * (1 + 1e-9)).all(), name
        assert np.median(bound / largest(found)) < 2, name


def test_curves_of_parts_are_those_of_the_whole():
    one, _ = fitted_rows(wavy(60), tip=0.006)
    other, _ = fitted_rows(wavy(80, noise=0.002), tip=0.006)
    both = Splines.joined([other.of(other.row, other.row + 100), one.of(one.row, one.row)])
    np.testing.assert_array_equal(both.row, np.concatenate([one.row, other.row + 100]))
    for part, rows in ((one, slice(0, 60)), (other, slice(60, 140))):
        u = 0.4 * part.extent
        found = both.at(np.arange(140)[rows], u, both.powers)
        for left, right in zip(found, part.at(part.row, u, part.powers), strict=True):
            np.testing.assert_allclose(left, right, atol=1e-10)


def test_rows_of_segments_are_found():
    one, _ = fitted_rows(wavy(60), tip=0.006)
    curve = one.of(one.row, 2 * one.row + 5)
    segment = np.random.default_rng(6).permutation(200)
    found, row = curve.among(segment)
    assert set(segment[found]) == set(curve.row)
    np.testing.assert_array_equal(curve.row[row], segment[found])
    assert not len(Splines.none().among(segment)[0])
