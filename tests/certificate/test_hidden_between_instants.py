# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.certificate.between import arch, bow
from pkm_post.geometry import norm


def leaving(curve, instants):
    """Most by which curves (3, N, dense), sampled at even shares, leave the chords between some of them, (N,)."""
    dense = curve.shape[2]
    at, few = np.linspace(0, 1, dense), np.linspace(0, 1, instants)
    chosen = curve[..., :: (dense - 1) // (instants - 1)]
    chords = np.array([[np.interp(at, few, row) for row in rows] for rows in chosen])
    return norm(np.moveaxis(curve - chords, 0, -1)).max(axis=1)


@pytest.mark.parametrize("instants", [5, 9, 33])
def test_cubics_leave_their_chords_by_no_more_than_is_said_and_not_much_less(instants):
    rng = np.random.default_rng(instants)
    share = np.linspace(0, 1, 3201)
    curve = np.einsum("cnk,kd->cnd", rng.normal(size=(3, 200, 4)), share ** np.arange(4)[:, None])
    told = bow(curve[..., :: 3200 // (instants - 1)].swapaxes(1, 2))
    found = leaving(curve, instants)
    assert np.all(found <= told)
    assert np.all(told <= 1.5 * found)


def test_a_straight_way_hides_nothing():
    way = np.arange(9.0)[:, None] * np.array([1.0, -2.0, 3.0])[:, None, None]
    assert bow(way) == pytest.approx([0.0], abs=1e-12)
    assert arch(way, 0.0) == pytest.approx([0.0], abs=0)


def test_a_circle_leaves_its_chords_by_what_its_bend_says():
    turn, radius = np.linspace(0, 0.8, 801), 5.0
    circle = radius * np.stack([np.cos(turn), np.sin(turn), 0 * turn])[:, None]
    few = circle[..., ::100].swapaxes(1, 2)
    told, found = arch(few, 1 / radius), leaving(circle, 9)
    assert found[0] <= told[0] <= 1.2 * found[0]
    assert found[0] <= bow(few)[0] <= 1.3 * found[0]
