# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pace: whether the struts are fast enough for given cell durations, or for the feed.

On a stretch of a cell, the mean speed of a strut is its length change by the time. The strut reaches it somewhere; the
highest speed exceeds it by at most half the stretch times the bound of l''. Where that is inconclusive, the stretch is
halved. With r from the tip to a joint, by the share of a cell, at constant rates:

    |l''| <= bend + r (|w'| + turn^2) + (travel + turn r)^2 / shortest distance
    |w'|  <= turn angle + h (1 + h^2) / 2 angle^2,   h = tan(tilt / 2)

The second derivative of the screw correction is not in the bound; it is small, as the lead is small beside a strut.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.kinematics.checks import STRUTS, arms_from_tip
from pkm_post.machine.kinematics.findings import ReachFinding, Subject
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.kinematics.way import Way
from pkm_post.model import Machine

_RESOLUTION = 1e-3
"""Resolution, as a share of the strut speed."""


def pace_finding(machine: Machine, way: Way, shortest: float, duration: Array) -> ReachFinding:
    """Margins of strut speed.

    Args:
        machine: with ``strut_speed``.
        way: the pose path.
        shortest: lower bound of a strut's joint distance on the path, mm.
        duration: (N,) duration of each cell, s; that of cell 0 is ignored.
    """
    limit = machine.strut_speed
    subject = Subject("strut speed", "K118", "mm/s", STRUTS, f"strut {{part}} by {{by:.1f}} mm/s; it reaches {limit:g}")
    lengths = strut_lengths(machine, *way.rows(slice(None)))
    cells = np.arange(1, len(way))
    margin, part = np.full(len(way), limit), np.zeros(len(way), dtype=np.int32)
    at_least = limit
    if len(cells):
        bend = _second_derivative(machine, way, shortest)
        speed, part[1:] = _fastest(lengths[:-1], lengths[1:], duration[1:])
        margin[1:] = limit - speed
        at_least = _halve(machine, way, lengths, duration, bend, margin, part)
    return ReachFinding(subject, margin, part, at_least)


def _second_derivative(machine: Machine, way: Way, shortest: float) -> Array:
    """Bounds of |l''| by the share of each cell, (N,)."""
    arm = arms_from_tip(machine, way.tool_length).max()
    half_tilt, turn = way.half_tilt(), way.turn()
    turn_1 = turn * way.angle + half_tilt * (1 + half_tilt**2) / 2 * way.angle**2
    return way.bend + arm * (turn_1 + turn**2) + (way.travel + turn * arm) ** 2 / shortest


def _fastest(start: Array, end: Array, duration: Array) -> tuple[Array, Array]:
    """Mean speeds of the fastest strut and its index, (M,) each."""
    way = np.abs(end - start)
    part = np.argmax(way, axis=1)
    return way[np.arange(len(way)), part] / duration, part


def _halve(
    machine: Machine, way: Way, lengths: Array, duration: Array, bend: Array, margin: Array, part: Array
) -> float:
    """Write the margins found by halving; return the proven lower bound of the margin."""
    limit, at_least = machine.strut_speed, machine.strut_speed
    cell = np.arange(1, len(way))
    start, before, after, width, found = np.zeros(len(cell)), lengths[:-1], lengths[1:], 1.0, margin[1:].copy()
    while True:
        swing = bend[cell] * width / 2 / duration[cell]
        settled = (found >= swing) | (found < 0) | (swing < _RESOLUTION * limit)
        at_least = float(np.min(found[settled] - swing[settled], initial=at_least))
        cell, start, before, after = cell[~settled], start[~settled], before[~settled], after[~settled]
        if not len(cell):
            return at_least
        width /= 2
        middle = strut_lengths(machine, *way.inside(cell, start + width))
        cell, start = np.tile(cell, 2), np.concatenate([start, start + width])
        before, after = np.concatenate([before, middle]), np.concatenate([middle, after])
        speed, which = _fastest(before, after, duration[cell] * width)
        found = limit - speed
        order = np.flatnonzero(found < margin[cell])
        order = order[np.argsort(-found[order], kind="stable")]  # the least of several in one cell is written last
        margin[cell[order]], part[cell[order]] = found[order], which[order]
