# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.planning.blends import OFFSET, half_widths, smooth_step, step


def test_step_is_the_chain_of_its_derivatives():
    d, h = 0.7, 1e-5
    x = np.linspace(-0.69, 0.69, 50)
    width = np.full(50, d)
    for steps in (step, smooth_step):
        below, above, here = steps(x - h, width), steps(x + h, width), steps(x, width)
        for lower, higher in ((0, 1), (1, 2)):
            np.testing.assert_allclose((above[lower] - below[lower]) / (2 * h), here[higher], atol=1e-8)


def test_step_goes_from_nothing_to_the_next_segment_and_is_off_by_three_sixteenths():
    d = np.array([0.7])
    first, last, middle = step(-d, d), step(d, d), step(0 * d, d)
    np.testing.assert_allclose(first[:3], 0, atol=1e-15)
    np.testing.assert_allclose([last[0], last[1], last[2]], [d, [1.0], [0.0]], atol=1e-15)
    np.testing.assert_allclose(middle[0], OFFSET * d)


def test_smooth_step_has_no_second_derivative_at_its_ends():
    d = np.array([0.7])
    np.testing.assert_allclose(smooth_step(-d, d), [[0], [0], [0]], atol=1e-15)
    np.testing.assert_allclose(smooth_step(d, d), [[1], [0], [0]], atol=1e-15)


def test_half_width_obeys_the_tightest_of_its_bounds():
    zero, one = np.zeros(1), np.ones(1)
    corner = half_widths(one, zero, zero, zero, 100 * one, tip=1e-3, axis=1.0)
    np.testing.assert_allclose(OFFSET * corner, 1e-3)
    both = half_widths(one, one, one, zero, 100 * one, tip=1e-3, axis=1.0)
    np.testing.assert_allclose(OFFSET * both + 0.0134 * both**2, 1e-3)
    axis = half_widths(zero, zero, zero, one, 100 * one, tip=1.0, axis=1e-5)
    np.testing.assert_allclose(OFFSET * axis, 1e-5)
    assert half_widths(zero, zero, zero, zero, one, tip=1.0, axis=1.0)[0] < 0.5
    assert half_widths(one, one, one, one, zero, tip=1.0, axis=1.0)[0] == 0
    assert half_widths(one, one, 4 * one, one, 100 * one, tip=1.0, axis=1.0)[0] == 0.5 / 4
