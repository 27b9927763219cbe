# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from machines import direction, rotation_about

from pkm_post.geometry import (
    along,
    along_rates,
    angle_between,
    dot,
    largest_tilt,
    norm,
    tilt,
    torsion,
    torsion_free_axes,
    towards,
    unit,
)


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


def axes(count=50):
    random = np.random.default_rng(8)
    return direction(random.uniform(0, 170, count), random.uniform(0, 360, count)).T


def test_the_frame_is_the_shortest_rotation_from_upright():
    # By Rodrigues' formula about z x k, by the angle between them.
    for axis, x, y in zip(axes(), *torsion_free_axes(axes()), strict=True):
        about, angle = unit(np.cross([0, 0, 1], axis)[None])[0], np.arccos(axis[2])
        for start, found in (([1.0, 0, 0], x), ([0, 1.0, 0], y)):
            turned = (
                np.cos(angle) * np.array(start)
                + np.sin(angle) * np.cross(about, start)
                + (1 - np.cos(angle)) * (about @ start) * about
            )
            assert found == pytest.approx(turned)


def test_the_torsion_of_a_frame_is_the_turn_it_was_given():
    random = np.random.default_rng(9)
    axis, psi = axes(), random.uniform(-3, 3, 50)
    x, y = torsion_free_axes(axis)
    turned = np.cos(psi)[:, None] * x + np.sin(psi)[:, None] * y
    assert torsion(axis, 2.5 * turned + 0.7 * axis) == pytest.approx(psi)


def test_a_turn_about_z_alone_is_all_torsion():
    rotation = rotation_about(2, 40.0)
    assert np.degrees(torsion(rotation[:, 2][None], rotation[:, 0][None])) == pytest.approx([40.0])


def test_straight_down_has_no_shortest_rotation():
    with pytest.raises(ValueError, match="straight down"):
        torsion_free_axes(np.array([[0.0, 0.0, -1.0]]))


def test_the_largest_tilt_of_a_turn_is_that_of_its_points():
    """The oracle: many points of each great circle."""
    rng = np.random.default_rng(159)
    before, after = (unit(rng.normal(size=(2000, 3))) for _ in range(2))
    after[:500] = unit(before[:500] * [-1, -1, 1] + rng.normal(scale=1e-3, size=(500, 3)))  # over or under the pole
    after[500:600] = before[500:600]
    share = np.linspace(0, 1, 2001)[:, None, None]
    points = along(before, share * towards(before, after))
    expected = np.max([tilt(each) for each in points], axis=0)
    found = largest_tilt(before, after)
    assert np.all(found >= expected - 1e-9) and np.all(found - expected < np.pi / 2000)
