# SPDX-License-Identifier: LGPL-2.1-or-later
"""Charts: lines over time as SVG text, for the report page.

Input: lines, limits and bands of time. Output: an ``<svg>`` element; colours and fonts come from the style sheet of
the page, so that the chart follows the theme of the browser. Numbers are printed with fixed decimals: the same lines
give the same text.
"""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import checkpoint, distinct

_WIDTH, _HEIGHT = 1000.0, 240.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 78.0, 990.0, 14.0, 210.0
_COLUMNS = 500
"""Columns of a chart; each shows the minimum and maximum of its values."""
_TICKS = 6
_LETTER = 7.0
"""Width of a letter: the name of a band is printed in it if it fits."""
_ROOM = 0.04
"""Margin above and below the lines, as a share of the range."""


class Line(NamedTuple):
    """A line of a chart.

    Attributes:
        name: in the legend.
        time: (N,) s, not decreasing.
        values: (N,).
        style: CSS classes.
    """

    name: str
    time: Array
    values: Array
    style: str


class TimeBand(NamedTuple):
    """A stretch of time with a name, such as an operation; s."""

    name: str
    begin: float
    end: float


def chart(
    label: str,
    lines: Sequence[Line],
    duration: float,
    limits: Sequence[float] = (),
    bands: Sequence[TimeBand] = (),
    span: tuple[float, float] | None = None,
) -> str:
    """Lines over time as an SVG element.

    Args:
        label: quantity and unit of the vertical axis.
        duration: s, the end of the time axis; above 0.
        limits: values of dashed horizontal lines.
        bands: drawn behind the lines, every other one shaded.
        span: lowest and highest value shown; by default those of lines and limits.
    """
    checkpoint()
    low, high = span or _span(lines, limits)

    def x_of(time: Array) -> Array:
        return np.asarray(_LEFT + (_RIGHT - _LEFT) * time / duration)

    def y_of(value: Array) -> Array:
        return np.asarray(_BOTTOM - (_BOTTOM - _TOP) * (np.clip(value, low, high) - low) / (high - low))

    box = f'viewBox="0 0 {_WIDTH:.0f} {_HEIGHT:.0f}" data-left="{_LEFT:.0f}" data-right="{_RIGHT:.0f}"'
    parts = [f'<svg class="chart" {box} data-duration="{duration:.6g}">']
    for number, band in enumerate(bands):
        left, right = x_of(np.array([band.begin, band.end]))
        shade = "band odd" if number % 2 else "band"
        parts.append(f'<rect class="{shade}" x="{left:.1f}" y="{_TOP:.1f}" width="{right - left:.1f}" '
                     f'height="{_BOTTOM - _TOP:.1f}"><title>{html.escape(band.name)}</title></rect>')  # fmt: skip
        if len(band.name) * _LETTER < right - left:
            parts.append(f'<text class="tick" x="{left + 3:.1f}" y="{_TOP - 4:.1f}">{html.escape(band.name)}</text>')
    parts += [_across("grid", y, f"{tick:g}") for tick, y in _ticks(low, high, y_of)]
    parts += [_upright(x, f"{tick:g}") for tick, x in _ticks(0.0, duration, x_of)]
    parts += [_across("limit", float(y_of(np.array(limit)))) for limit in limits if low <= limit <= high]
    parts += [_polyline(line, x_of, y_of) for line in lines]
    middle = (_TOP + _BOTTOM) / 2
    parts.append(f'<text class="label" transform="translate(12 {middle:.0f}) rotate(-90)">{html.escape(label)}</text>')
    parts.append(f'<text class="label" x="{_RIGHT:.0f}" y="{_HEIGHT - 2:.0f}" text-anchor="end">time, s</text></svg>')
    return "\n".join(parts)


def legend(lines: Sequence[Line]) -> str:
    """The names of lines, each with a sample of its line."""
    sample = '<svg class="sample" viewBox="0 0 24 8"><path class="line {}" d="M0 4H24"/></svg>'
    names = (f"<span>{sample.format(line.style)}{html.escape(line.name)}</span>" for line in lines)
    return f'<p class="legend">{"".join(names)}</p>'


def decimated(time: Array, values: Array) -> tuple[Array, Array]:
    """Reduce a line with more points than columns to the minimum and maximum of each column of pixels."""
    if len(time) <= 2 * _COLUMNS:
        return time, values
    first = distinct(np.searchsorted(time, np.linspace(time[0], time[-1], _COLUMNS)))
    both = np.stack([np.minimum.reduceat(values, first), np.maximum.reduceat(values, first)], axis=1)
    both[1::2] = both[1::2, ::-1].copy()  # alternate up and down: half the ink of going up in every column
    return np.repeat(time[first], 2), both.ravel()


def _span(lines: Sequence[Line], limits: Sequence[float]) -> tuple[float, float]:
    values = np.concatenate(
        [*(line.values for line in lines), np.asarray(limits, dtype=np.float64), [0.0][: not lines]]
    )
    low, high = float(values.min()), float(values.max())
    room = _ROOM * (high - low) or 1.0
    return low - room, high + room


def _ticks(low: float, high: float, place: Callable[[Array], Array]) -> list[tuple[float, float]]:
    """Round numbers between two values, with their positions."""
    step = 10 ** math.floor(math.log10((high - low) / _TICKS))
    step *= next(factor for factor in (1, 2, 5, 10, 20) if (high - low) / (factor * step) <= _TICKS)
    ticks = np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step
    return [(float(tick), float(at)) for tick, at in zip(ticks, place(ticks), strict=True)]


def _across(kind: str, y: float, text: str = "") -> str:
    line = f'<path class="{kind}" d="M{_LEFT:.0f} {y:.1f}H{_RIGHT:.0f}"/>'
    return line + (
        f'<text class="tick" x="{_LEFT - 6:.0f}" y="{y + 4:.1f}" text-anchor="end">{text}</text>' * bool(text)
    )


def _upright(x: float, text: str) -> str:
    line = f'<path class="grid" d="M{x:.1f} {_TOP:.0f}V{_BOTTOM:.0f}"/>'
    return f'{line}<text class="tick" x="{x:.1f}" y="{_BOTTOM + 14:.0f}" text-anchor="middle">{text}</text>'


def _polyline(line: Line, x_of: Callable[[Array], Array], y_of: Callable[[Array], Array]) -> str:
    checkpoint()
    time, values = decimated(line.time, line.values)
    points = np.stack([x_of(time), y_of(values)], axis=1).ravel().tolist()
    text = ("%.1f,%.1f " * len(time) % tuple(points)).rstrip()
    return f'<polyline class="line {line.style}" points="{text}"/>'
