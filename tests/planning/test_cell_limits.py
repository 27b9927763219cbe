# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a cell allows, against the limits themselves, evaluated at many speeds and accelerations."""

import numpy as np
import pytest

from pkm_post.planning.profile.cell_limits import CellLimits, StationLimits, demand

CELLS = 300
ROUNDING = 1e-6
"""Derivatives are in single precision."""


@pytest.fixture(name="cells")
def random_cells():
    """Limits of stations, and of the cells between them, with random derivatives: a tip that turns, and two struts."""
    rng = np.random.default_rng(12)
    count = CELLS + 1
    tip_1, tip_2 = rng.normal(size=(2, count, 3))
    products = np.stack([(tip_1 * tip_1).sum(1), (tip_1 * tip_2).sum(1), (tip_2 * tip_2).sum(1)], axis=1)
    first, second = rng.normal(size=(2, count, 2))
    limits = StationLimits.of(np.full(count, 1e6), first, second, products)
    return limits, CellLimits.of(np.cumsum(10 ** rng.uniform(-2, 0.5, count)), limits, np.arange(CELLS))


def worst(limits, width, square, along):
    """The largest demand at both ends of cells."""
    ends = (StationLimits(limits.speed[rows], limits.table[rows]) for rows in (slice(None, -1), slice(1, None)))
    one = np.ones(CELLS)
    return np.maximum(
        *(demand(end, along, x, one) for end, x in zip(ends, (square, square + width * along), strict=True))
    )


def test_bounds_are_where_a_limit_is_reached(cells):
    limits, cell = cells
    highest = cell.highest(np.full(CELLS, 1e6))
    for share in (0.0, 0.3, 0.9):
        square = share * highest
        least, greatest = cell.ahead(1.0).bounds(square)
        assert np.all(least <= greatest)
        np.testing.assert_allclose(worst(limits, cell.width, square, greatest), 1.0, atol=ROUNDING * 100)
        stops = least <= -square / cell.width * (1 - ROUNDING)  # it stands still at the end of the cell
        np.testing.assert_allclose(worst(limits, cell.width, square, least)[~stops], 1.0, atol=ROUNDING * 100)
        assert np.all(worst(limits, cell.width, square, (least + greatest) / 2) < 1.0)


def test_above_the_highest_speed_no_acceleration_is_left(cells):
    limits, cell = cells
    highest = cell.highest(np.full(CELLS, 1e6))
    assert np.isfinite(highest).all()
    faster = 1.001 * highest
    least, greatest = cell.ahead(1.0).bounds(faster)
    assert np.all(least > greatest)
    for share in np.linspace(-1, 3, 81):  # from standstill at the end of the cell on
        assert np.all(worst(limits, cell.width, faster, share / cell.width * faster) > 1 - ROUNDING)


def test_from_before_the_end_is_met_within_the_limits_and_from_no_greater_speed(cells):
    _, cell = cells
    highest, one = cell.highest(np.full(CELLS, 1e6)), np.ones(CELLS)
    for share in (0.0, 0.2, 1.0):
        end = share * highest
        start = np.minimum(cell.behind(one).reached(end), highest)
        least, _ = cell.ahead(1.0).bounds(start)
        assert np.all(start + cell.width * least <= end + ROUNDING * (start + 1))
        faster = 1.001 * start
        beyond = cell.ahead(1.0).bounds(faster)
        assert np.all((beyond[0] > beyond[1]) | (faster + cell.width * beyond[0] > end - ROUNDING))


def test_struts_behind_the_tip_do_not_matter():
    rng = np.random.default_rng(3)
    tip_1, tip_2 = rng.normal(size=(2, 200, 3))
    products = np.stack([(tip_1 * tip_1).sum(1), (tip_1 * tip_2).sum(1), (tip_2 * tip_2).sum(1)], axis=1)
    towards = np.array([[0.6, 0.0, 0.8], [0.0, 0.0, 1.5]])  # a share of the tip's acceleration, and more than it
    limits = StationLimits.of(np.full(200, 1e6), tip_1 @ towards.T / 2, tip_2 @ towards.T / 2, products)
    assert limits.struts_that_matter(0.6).tolist() == [False, True]
