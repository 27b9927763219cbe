# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np

from pkm_post.report.plots import _only, shown


def test_a_short_line_is_drawn_as_it_is():
    time, values = np.arange(5.0), np.array([1.0, 3.0, 2.0, 0.0, 1.0])
    found = shown(time, values)
    np.testing.assert_array_equal(found, (time, values))


def test_a_long_line_keeps_its_ends_in_time_and_every_peak_of_one_point():
    rng = np.random.default_rng(4)
    time, values = np.cumsum(rng.uniform(0.001, 0.1, 100_000)), rng.normal(size=100_000)
    peaks = rng.choice(100_000, 300, replace=False)
    values[peaks] = np.where(np.arange(300) % 2, 1, -1) * np.linspace(10, 20, 300)
    when, drawn = shown(time, values)
    assert len(when) == len(drawn) < 2500
    assert np.all(np.diff(when) >= 0)
    assert when[0] == time[0] and when[-1] == time[-1]
    assert drawn.min() == values.min() and drawn.max() == values.max()
    width = (time[-1] - time[0]) / 900
    for peak in peaks:
        near = np.abs(when - time[peak]) <= width
        assert drawn[near].max() >= values[peak] if values[peak] > 0 else drawn[near].min() <= values[peak]


def test_runs_of_chosen_points_are_drawn_without_those_between():
    points = np.arange(24.0).reshape(8, 3)
    chosen = np.array([False, True, True, False, False, False, True, True])
    x, _, _ = _only(points, chosen)
    np.testing.assert_array_equal(x, [3, 6, np.nan, 18, 21])
