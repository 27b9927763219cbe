# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rational B-spline surfaces: known shapes, finite differences, and the laws of the basis."""

import numpy as np
import pytest

from pkm_post.geometry.nurbs import NurbsSurface, basis

ROUNDING = 1e-12
RADIUS, HEIGHT = 20.0, 50.0


def clamped(degree, count, rng):
    inner = np.sort(rng.uniform(0.0, 1.0, count - degree - 1))
    return np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])


def random_surface(seed, degrees=(3, 2), counts=(7, 5), rational=True):
    rng = np.random.default_rng(seed)
    knots = tuple(clamped(degree, count, rng) for degree, count in zip(degrees, counts, strict=True))
    weights = rng.uniform(0.5, 2.0, counts) if rational else np.ones(counts)
    return NurbsSurface(degrees, knots, rng.normal(size=(*counts, 3)), weights)


def quarter_cylinder():
    """Quadratic along u: a quarter circle, its middle weight cos 45 degrees; linear along v."""
    arc = RADIUS * np.array([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    poles = np.stack([np.column_stack([arc, np.full(3, z)]) for z in (0.0, HEIGHT)], axis=1)
    weights = np.repeat([[1.0], [np.sqrt(0.5)], [1.0]], 2, axis=1)
    return NurbsSurface((2, 1), (np.array([0, 0, 0, 1, 1, 1.0]), np.array([0, 0, 1, 1.0])), poles, weights)


def parameters(seed, count=200):
    return np.random.default_rng(seed).uniform(0.0, 1.0, (2, count))


def test_quarter_cylinder_is_round():
    u, v = parameters(1)
    points = quarter_cylinder().points(u, v)
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(RADIUS, abs=1e-11)
    assert points[:, 2] == pytest.approx(HEIGHT * v, abs=1e-11)


@pytest.mark.parametrize(("degree", "count"), [(1, 2), (1, 6), (2, 5), (5, 6), (14, 28)])
def test_basis_sums_to_one_and_its_derivatives_to_nothing(degree, count):
    rng = np.random.default_rng(2)
    at = np.concatenate([rng.uniform(0.0, 1.0, 300), [0.0, 1.0]])
    first, values = basis(clamped(degree, count, rng), degree, at, 2)
    assert values[:, 0].sum(axis=1) == pytest.approx(1.0, abs=ROUNDING)
    scale = np.abs(values[:, 1:]).sum(axis=2)
    assert np.all(np.abs(values[:, 1:].sum(axis=2)) <= 1e-12 * (1.0 + scale))
    assert first.min() >= 0
    assert first.max() <= count - degree - 1


def test_one_span_is_the_polynomial_of_bernstein():
    at = np.linspace(0.0, 1.0, 11)
    _, values = basis(np.repeat([0.0, 1.0], 4), 3, at, 2)
    t, s = at, 1.0 - at
    assert values[:, 0] == pytest.approx(np.stack([s**3, 3 * t * s**2, 3 * t**2 * s, t**3], axis=1), abs=ROUNDING)
    assert values[:, 2] == pytest.approx(np.stack([6 * s, 18 * t - 12, 6 - 18 * t, 6 * t], axis=1), abs=1e-11)


@pytest.mark.parametrize("rational", [False, True])
def test_derivatives_agree_with_finite_differences(rational):
    surface = random_surface(3, rational=rational)
    step = 1e-5
    u, v = 0.01 + 0.98 * parameters(4)
    for direction, first, seconds in ((np.array([step, 0.0]), 1, (3, 4)), (np.array([0.0, step]), 2, (4, 5))):
        inside = [np.min(np.abs(p[:, None] - k), axis=1) > 2 * step for p, k in zip((u, v), surface.knots, strict=True)]
        some = inside[0] & inside[1]
        ahead, behind = (
            surface.derivatives(u[some] + sign * direction[0], v[some] + sign * direction[1]) for sign in (1, -1)
        )
        exact = surface.derivatives(u[some], v[some])
        slope = (ahead - behind) / (2 * step)
        scale = 1.0 + np.abs(exact).max()
        assert np.max(np.abs(slope[0] - exact[first])) < 1e-5 * scale
        for lower, higher in zip((1, 2), seconds, strict=True):
            assert np.max(np.abs(slope[lower] - exact[higher])) < 1e-4 * scale


def test_lower_orders_are_the_beginning_of_the_highest():
    surface, (u, v) = random_surface(5), parameters(6, 50)
    everything = surface.derivatives(u, v)
    assert everything.shape == (6, 50, 3)
    assert surface.derivatives(u, v, order=1) == pytest.approx(everything[:3], abs=ROUNDING)
    assert surface.points(u, v) == pytest.approx(everything[0], abs=ROUNDING)


def test_knots_in_between_do_not_change_the_shape():
    # Boehm's insertion of a knot at 0.5 into the quarter circle, worked in homogeneous poles.
    plain = quarter_cylinder()
    homogeneous = np.concatenate([plain.poles * plain.weights[..., None], plain.weights[..., None]], axis=2)
    middle = (homogeneous[:-1] + homogeneous[1:]) / 2
    split = np.stack([homogeneous[0], middle[0], middle[1], homogeneous[2]])
    knots = (np.array([0, 0, 0, 0.5, 1, 1, 1]), plain.knots[1])
    finer = NurbsSurface((2, 1), knots, split[..., :3] / split[..., 3:], split[..., 3])
    u, v = parameters(7)
    assert finer.derivatives(u, v) == pytest.approx(plain.derivatives(u, v), abs=1e-9)
    assert finer.breaks(0).tolist() == [0.0, 0.5, 1.0]


def test_ends_belong_to_the_surface():
    surface = random_surface(8)
    corners = surface.points([0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0])
    expected = surface.poles[[0, 0, -1, -1], [0, -1, 0, -1]]
    assert corners == pytest.approx(expected, abs=ROUNDING)
    assert surface.bounds.tolist() == [[0.0, 1.0], [0.0, 1.0]]


def test_many_parameters_are_done_in_pieces():
    surface, (u, v) = random_surface(9), parameters(10, 20_000)
    assert np.array_equal(surface.points(u, v)[12_345:12_355], surface.points(u[12_345:12_355], v[12_345:12_355]))


def test_wrong_shapes_are_the_callers_fault():
    surface = quarter_cylinder()
    with pytest.raises(ValueError, match=r"one shape \(N,\)"):
        surface.points([0.0, 1.0], [0.5])
    with pytest.raises(ValueError, match="expected 6 ascending knots, degree 2, got 5"):
        NurbsSurface((2, 1), (np.array([0, 0, 0, 1, 1.0]), surface.knots[1]), surface.poles, surface.weights)
    with pytest.raises(ValueError, match=r"expected poles \(M, N, 3\)"):
        NurbsSurface((2, 1), surface.knots, surface.poles, surface.weights[:2])
