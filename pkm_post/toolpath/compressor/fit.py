# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit: smooth curves of runs as pieces, the place of each row on them, and the deviation of each row.

Input: polylines of tip, tool axis and spin, and the allowed deviations. Output: pieces that join with continuous second
derivatives, and for each row the largest deviation relative to the allowed one; above 1 the curve is useless there. A
curve is shorter than a noisy polyline, so the parameter is scaled to the length of the curve.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array, length_of
from pkm_post.model import distinct
from pkm_post.toolpath.compressor.levels import Curves, fitted_curves
from pkm_post.toolpath.compressor.polylines import Allowed, PolylinePoints, Polylines, by_allowed, deviation
from pkm_post.toolpath.compressor.splines import Splines, quintic_powers
from pkm_post.toolpath.compressor.uniform_splines import at_nodes

_CHECKED = np.array([0.25, 0.5, 0.75, 1.0])
"""Shares of each row at which the result is measured."""
_NEWTON_STEPS = 2
_LONGER = 0.3
"""Largest relative difference in length of a row and its curve; beyond it the curve is useless."""


def fit(point: Array, extent: Array, count: Array, allowed: Allowed) -> tuple[Splines, Array]:
    """Curves of R runs, with rows numbered from 0; and the relative deviation of each row, (n,).

    Args:
        point: (7, n + R) vertices: tip, tool axis, spin; or (3, n + R), the tip only.
        extent: (n,) path length of each row, mm.
        count: (R,) number of rows of each run.
        allowed: (n,) allowed deviations on each row.
    """
    polyline = Polylines.of(point, extent, count)
    splines = _as_splines(polyline, fitted_curves(polyline, allowed))
    for _ in range(_NEWTON_STEPS):
        splines = _nearer(splines, polyline)
    off = _off(splines, polyline, allowed)
    off[np.abs(splines.extent / extent - 1) > _LONGER] = np.inf
    return _scaled(splines, polyline), off


def _as_splines(polyline: Polylines, curves: Curves) -> Splines:
    """The curves as pieces between nodes; each row ends at its path length."""
    grids = curves.grids
    run, number = grids.numbers(distinct(curves.nodes))
    s = number * grids.width[run]
    state = at_nodes(grids, curves.coefficients, run, number)
    begin = np.flatnonzero(run[1:] == run[:-1])
    width = s[begin + 1] - s[begin]
    before = np.cumsum(polyline.length) - polyline.length
    pieces = np.bincount(run) - 1
    last = np.cumsum(pieces) - 1
    start = polyline.starts
    of_row = polyline.run[start]
    return Splines(
        row=np.arange(len(start)),
        place=polyline.s[start] + before[of_row],
        extent=polyline.s[start + 1] - polyline.s[start],
        first=(last - pieces + 1)[of_row],
        last=last[of_row],
        begin=(s + before[run])[begin],
        width=width,
        powers=quintic_powers(state[..., begin], state[..., begin + 1], width),
    )


def _nearer(splines: Splines, polyline: Polylines) -> Splines:
    """Move the ends of rows nearer to their programmed points by one step of Newton's method."""
    end = polyline.starts + 1
    value, slope = splines.within(splines.row, splines.extent, splines.powers)
    _, ahead = deviation(polyline.point[:, end], value, slope)
    ahead = np.where(polyline.inner[end], ahead, 0.0)  # the ends of runs are met exactly
    shift = np.concatenate([[0.0], ahead[:-1]])
    return replace(splines, place=splines.place + shift, extent=splines.extent + ahead - shift)


def _scaled(splines: Splines, polyline: Polylines) -> Splines:
    """Scale the parameter to the path length of the tip over each run."""
    row, run = splines.row, polyline.run[polyline.starts]
    _, slope = splines.within(row, splines.extent / 2, splines.tip)
    travel = np.bincount(run, length_of(*slope) * splines.extent)
    scale, start = travel / polyline.length, np.cumsum(polyline.length) - polyline.length
    begin = np.cumsum(travel) - travel
    piece_run = np.searchsorted(splines.last[polyline.begin - np.arange(len(travel))], np.arange(len(splines.begin)))
    return replace(
        splines,
        place=begin[run] + (splines.place - start[run]) * scale[run],
        extent=splines.extent * scale[run],
        begin=begin[piece_run] + (splines.begin - start[piece_run]) * scale[piece_run],
        width=splines.width * scale[piece_run],
    )


def _off(splines: Splines, polyline: Polylines, allowed: Allowed) -> Array:
    """The largest relative deviation on each row, (n,)."""
    places = PolylinePoints.of(polyline, _CHECKED)
    u = (splines.extent[:, None] * _CHECKED).ravel()
    value, slope = splines.within(places.row, u, splines.powers)
    off, _ = deviation(places.point, value, slope)
    worst = np.maximum(*by_allowed(off, allowed[places.row]))
    return np.asarray(worst.reshape(-1, len(_CHECKED)).max(axis=1))
