# SPDX-License-Identifier: LGPL-2.1-or-later
import re

import numpy as np

from pkm_post.report.charts import Line, TimeBand, chart, decimated, legend


def test_a_short_line_is_drawn_as_it_is():
    time, values = np.arange(5.0), np.array([1.0, 3.0, 2.0, 0.0, 1.0])
    found = decimated(time, values)
    np.testing.assert_array_equal(found, (time, values))


def test_a_long_line_keeps_its_ends_in_time_and_every_peak_of_one_point():
    rng = np.random.default_rng(4)
    time, values = np.cumsum(rng.uniform(0.001, 0.1, 100_000)), rng.normal(size=100_000)
    peaks = rng.choice(100_000, 300, replace=False)
    values[peaks] = np.where(np.arange(300) % 2, 1, -1) * np.linspace(10, 20, 300)
    when, drawn = decimated(time, values)
    assert len(when) == len(drawn) < 1500
    assert np.all(np.diff(when) >= 0)
    assert when[0] == time[0] and when[-1] == time[-1]
    assert drawn.min() == values.min() and drawn.max() == values.max()
    width = (time[-1] - time[0]) / 450
    for peak in peaks:
        near = np.abs(when - time[peak]) <= width
        assert drawn[near].max() >= values[peak] if values[peak] > 0 else drawn[near].min() <= values[peak]


def points_of(svg):
    """The points of all lines of a chart, (N, 2) each."""
    lines = re.findall(r'<polyline [^>]*points="([^"]*)"', svg)
    return [np.array([pair.split(",") for pair in line.split()], dtype=float) for line in lines]


def test_points_are_at_their_share_of_time_and_of_the_span():
    rising = Line("a", np.array([0.0, 1.0, 4.0]), np.array([0.0, 5.0, 10.0]), "c1")
    (found,) = points_of(chart("mm", [rising], 4.0, span=(0.0, 10.0)))
    left, right = found[0, 0], found[-1, 0]
    assert found[1, 0] == np.round(left + (right - left) / 4, 1)
    assert found[1, 1] == (found[0, 1] + found[2, 1]) / 2
    assert found[0, 1] > found[2, 1]  # SVG counts downwards


def test_limits_and_bands_are_drawn_and_names_are_text():
    line = Line("<b>", np.array([0.0, 1.0]), np.array([1.0, 1.0]), "c1")
    svg = chart("mm", [line], 1.0, limits=(0.0, 2.0), bands=[TimeBand("</svg>", 0.0, 0.5), TimeBand("b", 0.5, 1.0)])
    assert svg.count('class="limit"') == 2
    assert svg.count("<rect") == 2 and svg.count("</svg>") == 1
    assert "&lt;b&gt;" in legend([line])


def test_a_constant_line_has_a_span():
    assert points_of(chart("mm", [Line("a", np.array([0.0, 1.0]), np.zeros(2), "c1")], 1.0))


def test_ticks_are_round_numbers():
    svg = chart("mm", [Line("a", np.array([0.0, 7.3]), np.array([-0.013, 0.027]), "c1")], 7.3)
    ticks = re.findall(r'class="tick"[^>]*>([^<]*)<', svg)
    assert ticks == ["-0.01", "0", "0.01", "0.02", "0", "2", "4", "6"]
