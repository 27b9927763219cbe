# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.geometry import along, along_rates, angle_between, dot, norm, towards, unit


def random_units(rng, count):
    return unit(rng.normal(size=(count, 3)))


def test_along_is_the_inverse_of_towards():
    rng = np.random.default_rng(11)
    start, end = random_units(rng, 500), random_units(rng, 500)
    tangent = towards(start, end)
    np.testing.assert_allclose(dot(tangent, start), 0, atol=1e-14)
    np.testing.assert_allclose(norm(tangent), angle_between(start, end), atol=1e-13)
    np.testing.assert_allclose(along(start, tangent), end, atol=1e-13)


def test_equal_directions_have_a_zero_tangent():
    start = random_units(np.random.default_rng(12), 10)
    np.testing.assert_allclose(towards(start, start), 0, atol=1e-15)
    np.testing.assert_allclose(along(start, np.zeros((10, 3))), start, atol=0)


def test_angles_near_zero_keep_their_digits():
    angle = np.array([1e-9, 1e-5, 1e-2, 3.14159])
    end = np.column_stack([np.sin(angle), np.zeros(4), np.cos(angle)])
    np.testing.assert_allclose(angle_between(np.tile([0.0, 0, 1], (4, 1)), end), angle, rtol=1e-12)


def test_rates_against_finite_differences_across_the_series_switch():
    # a(s) = b + r s + c s^2 / 2 at angles on both sides of the switch between series and quotient (0.01 rad).
    rng = np.random.default_rng(13)
    count, step = 400, 1e-4
    start = random_units(rng, count)
    flat = [vector - dot(vector, start)[:, None] * start for vector in rng.normal(size=(3, count, 3))]
    tangent, rate, second = flat[0] * np.geomspace(1e-4, 1, count)[:, None], flat[1], flat[2]

    def direction(s):
        return along(start, tangent + s * rate + s * s / 2 * second)

    here, first, curve = along_rates(start, tangent, rate, second)
    np.testing.assert_allclose(norm(here), 1, atol=1e-14)
    np.testing.assert_allclose(first, (direction(step) - direction(-step)) / (2 * step), atol=1e-6)
    np.testing.assert_allclose(curve, (direction(step) - 2 * here + direction(-step)) / step**2, atol=1e-4)
