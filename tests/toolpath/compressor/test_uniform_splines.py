# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws of quintic B-splines on even grids, of several runs at once."""

import numpy as np
import pytest

from pkm_post.toolpath.compressor.polylines import Polylines
from pkm_post.toolpath.compressor.uniform_splines import (
    Grids,
    at_nodes,
    basis,
    basis_rates,
    end_bends,
    quasi_interpolant,
    refined,
    reflected,
    values,
)

ROUNDING = 1e-11
"""mm and 1/mm of numbers of some mm."""
GRIDS = Grids(np.array([3.0, 10.0, 0.7]), np.array([1, 7, 3]))


def some_curves(seed=1):
    """Coefficients of random curves on three grids, and the second derivatives at their ends."""
    rng = np.random.default_rng(seed)
    bend = rng.normal(size=(2, 2, 3))
    return reflected(GRIDS, rng.normal(size=(2, GRIDS.size)), bend), bend


def some_places(count=400):
    rng = np.random.default_rng(2)
    run = np.sort(rng.integers(0, 3, count))
    return run, rng.uniform(0, 1, count) * GRIDS.length[run]


def polylines(curve, counts=(40, 25), step=0.25):
    """Polylines of two runs with their vertices on a curve by path length along x."""
    s = [step * np.arange(count + 1) for count in counts]
    point = np.concatenate([curve(one) for one in s], axis=1)
    return Polylines.of(point, np.full(sum(counts), step), np.array(counts))


def test_weights_are_those_of_the_quintic():
    """They sum to one, their first moment is the place, their second one more by the variance, 6 / 12."""
    share = np.linspace(0, 1, 21)
    at = np.arange(-2, 4)[:, None]
    weights = basis(share)
    assert (weights >= 0).all()
    np.testing.assert_allclose(weights.sum(axis=0), 1, atol=1e-14)
    np.testing.assert_allclose((weights * at).sum(axis=0), share, atol=1e-14)
    np.testing.assert_allclose((weights * at**2).sum(axis=0), share**2 + 0.5, atol=1e-13)
    np.testing.assert_allclose(basis(np.zeros(1))[:, 0] * 120, [1, 26, 66, 26, 1, 0], atol=1e-12)
    np.testing.assert_allclose(basis_rates(share), np.gradient(weights, share, axis=1, edge_order=2), atol=0.01)


def test_slopes_are_those_of_the_curve():
    coefficients, _ = some_curves()
    run, s = some_places()
    step = 1e-5
    _, slope = values(GRIDS, coefficients, run, s)
    after, before = (values(GRIDS, coefficients, run, s + by)[0] for by in (step, -step))
    np.testing.assert_allclose(slope, (after - before) / (2 * step), atol=1e-6 * np.abs(slope).max())


def test_values_at_nodes_agree_with_those_between():
    coefficients, _ = some_curves()
    run, number = GRIDS.nodes
    s, step = number * GRIDS.width[run], 1e-4
    value, first, second = at_nodes(GRIDS, coefficients, run, number)
    np.testing.assert_allclose(value, values(GRIDS, coefficients, run, s)[0], atol=ROUNDING)
    np.testing.assert_allclose(first, values(GRIDS, coefficients, run, s)[1], atol=1e-9)
    inner = (number > 0) & (number < GRIDS.cells[run])
    slopes = [values(GRIDS, coefficients, run, s + by)[1] for by in (step, -step)]
    by_difference = (slopes[0] - slopes[1])[:, inner] / (2 * step)
    np.testing.assert_allclose(second[:, inner], by_difference, atol=1e-4 * np.abs(second).max())


def test_ends_have_the_second_derivative_that_was_given():
    coefficients, bend = some_curves()
    runs = np.arange(3)
    for side, number in enumerate((0 * GRIDS.cells, GRIDS.cells)):
        _, _, second = at_nodes(GRIDS, coefficients, runs, number)
        np.testing.assert_allclose(second, bend[side], atol=1e-9)


def test_a_finer_grid_has_the_same_curve():
    coefficients, bend = some_curves()
    run, s = some_places()
    fine, refined_coefficients = refined(GRIDS, coefficients, bend)
    assert (fine.cells == 2 * GRIDS.cells).all()
    for one, other in zip(values(GRIDS, coefficients, run, s), values(fine, refined_coefficients, run, s), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-10)


def test_columns_name_their_nodes():
    run, number = GRIDS.nodes
    again = GRIDS.numbers(GRIDS.first[run] + number)
    np.testing.assert_array_equal(again, [run, number])


def test_lines_remain():
    polyline = polylines(lambda s: np.stack([s, 2 - 0.5 * s, 0 * s]))
    grids = Grids(polyline.length, np.array([5, 3]))
    bend = end_bends(polyline, grids.width)
    np.testing.assert_allclose(bend, 0, atol=ROUNDING)
    coefficients = quasi_interpolant(grids, polyline, bend)
    place = np.linspace(0, 1, 50)
    for run in (0, 1):
        s = place * polyline.length[run]
        value, slope = values(grids, coefficients, np.full(50, run), s)
        np.testing.assert_allclose(value, [s, 2 - 0.5 * s, 0 * s], atol=ROUNDING)
        np.testing.assert_allclose(slope, np.tile([[1], [-0.5], [0]], 50), atol=ROUNDING)


def test_parabolas_remain_halfway_between_vertices_and_chords():
    """Chords of a parabola with the second derivative b lie inside of it by b c^2 / 8: half of that is left."""
    bend, step = 0.3, 0.25
    polyline = polylines(lambda s: np.stack([s, bend * s**2 / 2]), counts=(160, 25), step=step)
    grids = Grids(polyline.length, np.array([20, 3]))
    found = end_bends(polyline, 2 * grids.width)
    np.testing.assert_allclose(found[:, 1], bend, rtol=0.02)  # a sum over joints in place of an integral
    given = np.zeros((2, 2, 2))
    given[:, 1] = bend
    coefficients = quasi_interpolant(grids, polyline, given)
    s = np.linspace(0.4, 0.6, 30) * polyline.length[0]
    value, _ = values(grids, coefficients, np.zeros(30, dtype=int), s)
    off = value[1] - bend * s**2 / 2
    np.testing.assert_allclose(off, bend * step**2 / 16, rtol=1e-3)


@pytest.mark.parametrize("power", [2, 3])
def test_smooth_curves_are_averaged_without_shrinking(power):
    """With many vertices in a cell nothing but the chords is left: smoothing alone would take h^2 / 3 times P''."""
    polyline = polylines(lambda s: np.stack([s, (s / 10) ** power]), counts=(4000, 2500), step=0.0025)
    grids = Grids(polyline.length, np.array([20, 3]))
    coefficients = quasi_interpolant(grids, polyline, end_bends(polyline, grids.width))
    s = np.linspace(0.45, 0.55, 30) * polyline.length[0]
    value, _ = values(grids, coefficients, np.zeros(30, dtype=int), s)
    np.testing.assert_allclose(value[1], (s / 10) ** power, atol=1e-7)
