# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.geometry import hermite_lengths
from pkm_post.model import StrutMotion


def test_cubics_lead_from_knot_to_knot():
    rng = np.random.default_rng(8)
    time_ms = np.array([0, 4, 24, 4119])
    motion = StrutMotion(time_ms, rng.uniform(300, 1500, (4, 6)), rng.normal(0, 30, (4, 6)), ())
    rows = np.array([2, 0])
    cubics = motion.cubics(rows)
    assert [column.shape for column in cubics] == [(2, 6)] * 4 + [(2,)]
    assert cubics[-1].tolist() == [4.095, 0.004]
    ends = hermite_lengths(*cubics, np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends[:, 0], motion.length[rows], rtol=0, atol=1e-12)
    np.testing.assert_allclose(ends[:, 1], motion.length[rows + 1], rtol=0, atol=1e-9)
    assert np.array_equal(cubics[1], motion.speed[rows]) and np.array_equal(cubics[3], motion.speed[rows + 1])
