# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.writing.controllers.pvt.decimals import BLANK, print_columns, round_values


def texts(values, decimals):
    """Every number as text, without the blanks."""
    columns = print_columns(values, decimals)
    rows = columns.reshape(-1, columns.shape[-1])
    return [row.tobytes().replace(BLANK, b"").decode("ascii") for row in rows]


def printed_by_python(values, decimals):
    return [f"{value:.{decimals}f}" for value in (np.round(values, decimals) + 0.0).ravel().tolist()]


def ties(decimals):
    """Numbers half way between two decimals, as near as doubles come, and their neighbours."""
    halves = (np.arange(-1000, 1000) + 0.5) / 10.0**decimals
    return np.concatenate([halves, np.nextafter(halves, np.inf), np.nextafter(halves, -np.inf)])


@pytest.mark.slow
@pytest.mark.parametrize("decimals", range(1, 10))
@pytest.mark.parametrize("largest", [0.0, 1e-12, 0.4, 1.0, 9.99999, 31.0, 1200.0, 4294.0, 4295.0, 1e5, 1e9, 1e16, 1e25])
def test_numbers_are_printed_as_python_prints_them_rounded(decimals, largest):
    rng = np.random.default_rng(decimals)
    values = largest * rng.uniform(-1, 1, (500, 6)) * 10.0 ** rng.integers(-8, 1, (500, 6))
    assert texts(values, decimals) == printed_by_python(values, decimals)


@pytest.mark.parametrize("decimals", range(1, 10))
def test_ties_are_rounded_as_python_and_numpy_round_them(decimals):
    assert texts(ties(decimals), decimals) == printed_by_python(ties(decimals), decimals)


@pytest.mark.parametrize("decimals", [1, 4, 6, 9])
def test_numbers_about_what_is_exact_are_printed_alike_on_both_sides(decimals):
    for power in (2**32, 2**52, 2**53):
        values = (power + np.arange(-50.0, 50.0)) / 10.0**decimals
        assert texts(values, decimals) == printed_by_python(values, decimals)
        assert texts(values[:1], decimals) == printed_by_python(values[:1], decimals)


@pytest.mark.parametrize("at", [9.9999996, 99.9999996, 0.9999996, -9.9999996])
def test_a_number_that_rounds_to_one_more_digit_has_room_for_it(at):
    assert texts(np.array([at]), 6) == printed_by_python(np.array([at]), 6)
    assert texts(np.array([at, 0.5]), 6) == printed_by_python(np.array([at, 0.5]), 6)


def test_no_zero_has_a_sign():
    values = np.array([-0.0, -1e-300, -0.00004, -0.00005, -0.00006])
    assert texts(values, 4) == ["0.0000", "0.0000", "0.0000", "0.0000", "-0.0001"]
    assert not np.signbit(round_values(values[:4], 4)).any()


def test_the_shape_of_the_numbers_is_kept():
    values = np.arange(24.0).reshape(2, 3, 4)
    assert print_columns(values, 2).shape == (2, 3, 4, len("-12.34"))
    assert print_columns(1e20 * values, 2).shape[:3] == values.shape
