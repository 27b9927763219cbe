# SPDX-License-Identifier: LGPL-2.1-or-later
"""NURBS motion of Creo: curves of MOVNRB statements, in place of the points on them.

Input: MOVNRB statements and the points of the file. Output: the points, with chords of the curves in place of those
between MOVNRB/NEXT and OFF. Creo writes both, the curve and its points; a feed between two points applies on the curve
between the places nearest to them.

    MOVNRB/M3AXIS              MOVNRB/5AXIS,LENGTH,l: the second curve is l above the tip, on the tool axis
    MOVNRB/ON,o,k,w,n,s        order, numbers of knots, weights (0) and control points, length
    MOVNRB/1,knots             in one or more statements; 2: control points of the tip, 3: those of the second curve
    MOVNRB/NEXT                the points follow, up to MOVNRB/OFF

Source: [PTC NURBS].
"""

from __future__ import annotations

import math

import numpy as np

from pkm_post.geometry import bspline_points, norm
from pkm_post.model import Array
from pkm_post.reading.cldata.arc_statements import MAX_DEVIATION
from pkm_post.reading.cldata.points import Points, scale_at
from pkm_post.reading.cldata.state import NurbsMotion, ReaderState
from pkm_post.reading.cldata.statements import Statement

CHORD_TOLERANCE = 5e-4
"""mm between a curve and its chords."""
_MOST_CHORDS = 1_000_000
_KNOTS, _LOW, _HIGH = 1.0, 2.0, 3.0
"""First numbers of the statements with data."""
_SAME = 1e-7
"""Difference of parameters, as a part of the range, below which a chord is dropped."""


class _CurveError(Exception):
    """A curve cannot be followed; the message is the reason."""


def movnrb(state: ReaderState, row: int, statement: Statement) -> None:
    """Collect one statement of a motion."""
    motion = state.nurbs[-1] if state.nurbs and not state.nurbs[-1].points[1] else None
    match statement.items:
        case ["M3AXIS" | "3AXIS"] if motion is None:
            state.nurbs.append(NurbsMotion(row))
        case ["M5AXIS" | "5AXIS", "LENGTH", float()] if motion is None:
            state.nurbs.append(NurbsMotion(row, five_axis=True))
        case ["ON", float(o), float(k), float(w), float(n), float()] if motion is not None and not motion.counts:
            motion.counts = [o, k, w, n]
        case [float(what), *values] if motion is not None and what in motion.values and statement.values:
            motion.values[what] += [value for value in values if isinstance(value, float)]
        case ["NEXT"] if motion is not None and motion.counts and not motion.points[0]:
            motion.points = (row, 0)
        case ["OFF"] if motion is not None and motion.points[0]:
            motion.points = (motion.points[0], row)
        case _:
            state.report_items(row, statement, "M3AXIS or 5AXIS,LENGTH,l; ON,o,k,w,n,s; 1, 2 and 3; NEXT; OFF")


def with_curves(state: ReaderState, points: Points) -> Points:
    """The points, with chords of the curves in place of those on them; report curves that do not fit them."""
    kept, added = np.ones(len(points.row), dtype=np.bool_), list[Points]()
    for motion in state.nurbs:
        mine = np.flatnonzero((points.row > motion.points[0]) & (points.row < motion.points[1]))
        try:
            added.append(_chords(state, motion, points, mine))
            kept[mine] = False
        except _CurveError as fault:
            state.report("L446", motion.row, str(fault))
    if not added:
        return points
    columns = [np.concatenate([one[kept], *more]) for one, *more in zip(*map(_columns, [points, *added]), strict=True)]
    order = np.argsort(columns[0], kind="stable")
    return Points(*(column[order] for column in columns))


def _columns(points: Points) -> tuple[Array, ...]:
    return points.row, points.position, points.axis, points.normal, points.start, points.contact


def _chords(state: ReaderState, motion: NurbsMotion, points: Points, mine: Array) -> Points:
    """The points of the chords, each with the row of the written point that it leads to.

    Raises:
        _CurveError: the curve is incomplete, or does not pass through the points.
    """
    if not motion.points[1]:
        raise _CurveError("no MOVNRB/OFF after it")
    knots, degree, curves = _curves(motion)
    if not len(mine):
        raise _CurveError("no point between NEXT and OFF")
    scale = float(scale_at(state, np.array([motion.row]))[0])
    at = _parameters(knots, degree, [curve * scale for curve in curves])
    before = points.position[mine[0] - 1] if mine[0] else None
    parameters = _point_parameters(knots, degree, curves[0], at, points.position[mine], before, MAX_DEVIATION / scale)
    beside = np.searchsorted(parameters, at)
    apart = np.minimum(at - parameters[beside - 1], np.append(parameters, np.inf)[beside] - at) > _SAME
    at = np.unique(np.concatenate([at[apart & (beside > 0)], parameters]))[1:]
    which = np.searchsorted(parameters[1:], at, "left")
    tip = bspline_points(knots, degree, curves[0], at)
    axis = np.full_like(tip, np.nan)
    if motion.five_axis:
        axis = bspline_points(knots, degree, curves[1], at) - tip
        axis /= np.where(norm(axis) > 0, norm(axis), 1.0)[:, None]
    start, contact = np.zeros((2, len(at)), dtype=np.bool_)
    return Points(points.row[mine][which], tip, axis, np.full_like(tip, np.nan), start, contact)


def _curves(motion: NurbsMotion) -> tuple[Array, int, list[Array]]:
    """Knots from 0 to 1, degree, and control points of the curves, (n, 3) each.

    Raises:
        _CurveError: the numbers do not define a curve.
    """
    order, knot_count, weights, count = motion.counts
    knots = np.array(motion.values[_KNOTS])
    poles = [np.array(motion.values[what]) for what in ((_LOW, _HIGH) if motion.five_axis else (_LOW,))]
    if weights:
        raise _CurveError(f"{weights:g} weights, expected 0")
    if len(knots) != knot_count or any(len(one) != 3 * count for one in poles):
        found = " and ".join(f"{len(one) / 3:g}" for one in poles)
        raise _CurveError(f"{len(knots)} knots and {found} control points, {knot_count:g} and {count:g} stated")
    degree = int(knot_count - count) - 1
    if not 1 <= degree < count or order != degree + 1:
        raise _CurveError(f"order {order:g}, {knot_count:g} knots and {count:g} control points do not agree")
    first, last = knots[degree], knots[-degree - 1]
    if (np.diff(knots) < 0).any() or not first < last:
        raise _CurveError("its knots do not ascend")
    return (knots - first) / (last - first), degree, [one.reshape(-1, 3) for one in poles]


def _parameters(knots: Array, degree: int, curves: list[Array]) -> Array:
    """Parameters between which chords are within tolerance: h^2 / 8 times the largest second derivative in each span.

    The control points of the second derivative bound it.
    """
    breaks = np.unique(knots[degree : len(knots) - degree])
    bends = np.max([_second_derivatives(knots, degree, curve) for curve in curves], axis=0)
    span = np.searchsorted(knots, breaks[:-1], "right") - 1
    most = np.array([bends[max(one - degree, 0) : one - 1].max(initial=0.0) for one in span.tolist()])
    pieces = np.ceil(np.diff(breaks) * np.sqrt(most / (8 * CHORD_TOLERANCE))).astype(np.int64)
    pieces = np.maximum(pieces, 1)
    if pieces.sum() > _MOST_CHORDS:
        raise _CurveError(f"{pieces.sum()} chords, at most {_MOST_CHORDS}")
    steps = [
        np.linspace(first, last, count, endpoint=False)
        for first, last, count in zip(breaks[:-1].tolist(), breaks[1:].tolist(), pieces.tolist(), strict=True)
    ]
    return np.concatenate([*steps, breaks[-1:]])


def _second_derivatives(knots: Array, degree: int, poles: Array) -> Array:
    """Lengths of the control points of the second derivative, (n - 2,)."""
    for order in range(2):
        width = knots[degree + 1 : len(knots) - 1 - order] - knots[1 + order : len(knots) - degree - 1]
        factor = (degree - order) / np.where(width > 0, width, np.inf)
        poles = np.diff(poles, axis=0) * factor[:, None]
    return norm(poles)


def _point_parameters(
    knots: Array, degree: int, poles: Array, at: Array, points: Array, before: Array | None, tolerance: float
) -> Array:
    """Parameters of the start of the motion and of its points, ascending.

    Raises:
        _CurveError: a point is not on the curve, or the curve begins or ends elsewhere.
    """
    curve = bspline_points(knots, degree, poles, at)
    found, place = list[float](), 0
    for number, point in enumerate(points, start=1):
        far = norm(curve[place:] - point)
        chord = norm(np.diff(curve[place:], axis=0)).max(initial=0.0) + tolerance
        near = np.flatnonzero(far <= chord)
        if not len(near):
            raise _CurveError(f"point {number} is {far.min():.6g} off the curve")
        run = near[: int(np.argmax(np.append(np.diff(near) > 1, True))) + 1]
        place += int(run[np.argmin(far[run])])
        parameter, off = _foot(curve, at, place, point)
        if off > tolerance:
            raise _CurveError(f"point {number} is {off:.6g} off the curve")
        found.append(max(parameter, found[-1] if found else 0.0))
        place = max(int(np.searchsorted(at, parameter, "right")) - 1, 0)
    if norm(curve[-1] - points[-1]) > tolerance:
        raise _CurveError("it ends behind its last point")
    at_start = norm(curve[0] - points[0]) <= tolerance
    if not at_start and (before is None or norm(curve[0] - before) > tolerance):
        raise _CurveError("it begins before its first point, and not at the tool")
    if at_start:
        found[0] = 0.0
    return np.array([-1.0 if at_start else 0.0, *found[:-1], 1.0])


def _foot(curve: Array, at: Array, place: int, point: Array) -> tuple[float, float]:
    """Parameter of the nearest place on the chords next to a point of the curve, and the distance."""
    best = (float(at[place]), float(norm(curve[place] - point)))
    for first in (place - 1, place):
        if 0 <= first < len(at) - 1:
            along = curve[first + 1] - curve[first]
            share = float(np.clip((point - curve[first]) @ along / max(float(along @ along), 1e-300), 0.0, 1.0))
            off = float(norm(curve[first] + share * along - point))
            if off < best[1] and math.isfinite(off):
                best = (float(at[first] + share * (at[first + 1] - at[first])), off)
    return best
