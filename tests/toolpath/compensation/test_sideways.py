# SPDX-License-Identifier: LGPL-2.1-or-later
"""The direction in which a cutter lies from its contact, where the normal hardly says it."""

import numpy as np

from pkm_post.toolpath.compensation.contact import sideways

X, Y, Z = np.eye(3)
TENTH_MICRON = 1e-4
E = 6.0


def leaning(sine, azimuth):
    sine, azimuth = np.broadcast_arrays(sine, azimuth)
    return np.column_stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.sqrt(1.0 - sine**2)])


def upright(count):
    return np.tile(Z, (count, 1))


def test_direction_is_where_the_normal_leans():
    azimuth = np.linspace(0.0, 6.0, 50)
    m, near = sideways(np.zeros((50, 3)), leaning(0.5, azimuth), upright(50), E)
    assert np.allclose(m, leaning(1.0, azimuth), rtol=0, atol=1e-12)
    assert not near.any()


def test_noise_of_rounded_normals_is_averaged_out():
    # Normals 0.06 degrees from the axis and 3e-5 off, which is what four decimals do: the azimuth is off by 2 degrees.
    count, sine = 400, 1e-3
    true = leaning(1.0, np.linspace(0.0, 0.5, count))
    rounded = leaning(sine, np.linspace(0.0, 0.5, count)) + np.random.default_rng(2).normal(0.0, 3e-5, (count, 3))
    m, near = sideways(np.zeros((count, 3)), rounded / np.linalg.norm(rounded, axis=1)[:, None], upright(count), E)
    raw = rounded[:, :2] / np.linalg.norm(rounded[:, :2], axis=1)[:, None]
    assert near.all()
    error, raw_error = np.linalg.norm(m - true, axis=1), np.linalg.norm(raw - true[:, :2], axis=1)
    assert np.sqrt(np.mean(error**2)) < 0.5 * np.sqrt(np.mean(raw_error**2))


def test_averaging_never_lets_the_cutter_into_the_surface_by_more_than_a_tenth_of_a_micron():
    rng = np.random.default_rng(1)
    normals = leaning(10 ** rng.uniform(-5.5, -1.0, 3000), rng.uniform(0.0, 2 * np.pi, 3000))
    m, near = sideways(np.zeros((3000, 3)), normals, upright(3000), E)
    exact = normals - normals[:, 2:] * Z
    exact /= np.linalg.norm(exact, axis=1)[:, None]
    into_surface = E * np.einsum("nj,nj->n", exact - m, normals)
    assert np.all(into_surface <= TENTH_MICRON * (1 + 1e-9))
    assert np.max(into_surface) > 0.5 * TENTH_MICRON
    assert np.array_equal(m[~near], exact[~near])


def test_only_parallel_rows_are_carried():
    normals = leaning(np.array([0.5, 0.0, 1e-7, 0.5]), np.array([0.0, 0.0, 2.0, 1.0]))
    m, near = sideways(np.outer(np.arange(4.0), Y), normals, upright(4), E)
    assert np.allclose(m[:3], X, rtol=0, atol=1e-12)
    assert np.allclose(m[3], [np.cos(1.0), np.sin(1.0), 0.0], rtol=0, atol=1e-12)
    assert not near.any()
