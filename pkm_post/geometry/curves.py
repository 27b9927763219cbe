# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves: circular arcs and helices, and cubic Hermite segments.

An arc turns right-handed about its unit axis. A Hermite segment is the motion of a controller between two
position-velocity-time points: p(t) = p0 + v0 t + c2 t^2 + c3 t^3 with c2 = (3 d - (2 v0 + v1) T) / T^2,
c3 = (-2 d + (v0 + v1) T) / T^3, d = p1 - p0, the unique cubic with these end conditions. Its positions and speeds are
(N, 6), the durations T (N,); the share of the duration is (M,), the same for all, or (N, M), which gives (N, M, 6).
Functions of columns take (C, N) instead, which is faster for long programs.
"""

from __future__ import annotations

import numpy as np

from pkm_post.geometry.vectors import Array, across, cross, dot, norm

_SAME_DIRECTION = 1e-9
"""Angle in rad below which start and end count as the same point of the circle: a full circle."""


def arc_sweep(start: Array, end: Array, centre: Array, axis: Array) -> Array:
    """Sweep angles of arcs from start to end, 0 < sweep <= 2 pi; a full circle where both have the same direction.

    Args:
        start: (..., 3) start points.
        end: (..., 3) end points; for a helix shifted along the axis.
        centre: (..., 3) points on the axis.
        axis: (..., 3) unit axes.
    """
    first = across(start - centre, axis)
    last = across(end - centre, axis)
    sweep = np.arctan2(dot(cross(first, last), axis), dot(first, last))
    return np.where(sweep <= _SAME_DIRECTION, sweep + 2 * np.pi, sweep)


def arc_points(start: Array, centre: Array, axis: Array, angle: Array, rise: Array) -> Array:
    """Points of an arc that has turned by ``angle`` and risen by ``rise`` along the axis since ``start``.

    Args:
        start: (..., 3) start points.
        centre: (..., 3) points on the axis.
        axis: (..., 3) unit axes.
        angle: (...) rad.
        rise: (...) mm.
    """
    radius = across(start - centre, axis)
    turned = np.cos(angle)[..., None] * radius + np.sin(angle)[..., None] * cross(axis, radius)
    return start - radius + turned + rise[..., None] * axis


def chord_counts(radius: Array, sweep: Array, error: float) -> Array:
    """Least numbers of equal chords within an error of arcs, (N,): each spans at most 2 acos(1 - e / r).

    Args:
        radius: (N,) mm.
        sweep: (N,) rad.
        error: largest distance of an arc from its chords, mm.
    """
    span = 2 * np.arccos(np.clip(1 - error / np.maximum(radius, error), 0.0, 1.0))
    return np.ceil(sweep / span).astype(np.int64)


def arc_turning_points(start: Array, end: Array, centre: Array, axis: Array, sweep: Array) -> Array:
    """For each coordinate the two places at which an arc turns back in it, (2, A, 3); its start where there is none.

    A coordinate at the angle t is a cos t + b sin t + c t + const: it turns back where a sin t - b cos t = c.

    Args:
        start: (A, 3) start points.
        end: (A, 3) end points.
        centre: (A, 3) points on the axis.
        axis: (A, 3) unit axes.
        sweep: (A,) angles turned.
    """
    radius = across(start - centre, axis)
    side, slope = cross(axis, radius), (dot(end - start, axis) / sweep)[:, None] * axis
    phase, size = np.arctan2(side, radius), np.maximum(np.hypot(radius, side), np.finfo(float).tiny)
    lean = np.arcsin(np.clip(slope / size, -1.0, 1.0))
    turn = np.mod(np.stack([phase + lean, phase + np.pi - lean]), 2 * np.pi)
    turn = np.where(turn <= sweep[:, None], turn, 0.0)
    return np.asarray(start - radius + np.cos(turn) * radius + np.sin(turn) * side + turn * slope)


def bounding_box(points: Array, *arcs: Array) -> tuple[Array, Array]:
    """Least and greatest coordinates of points, (N, 3), and of arcs between them, (3,) each.

    ``arcs`` are the arguments of ``arc_turning_points``.
    """
    turns = arc_turning_points(*arcs)
    # numpy takes ten times as long along the first axis
    columns = [(points[:, axis], turns[..., axis]) for axis in range(3)]
    lowest = [turning.min(initial=ends.min()) for ends, turning in columns]
    highest = [turning.max(initial=ends.max()) for ends, turning in columns]
    return np.array(lowest), np.array(highest)


def arc_length(start: Array, end: Array, centre: Array, axis: Array) -> Array:
    """Lengths of arcs and helices, mm, with the mean of start and end radius."""
    radius = (norm(across(start - centre, axis)) + norm(across(end - centre, axis))) / 2
    return np.hypot(radius * arc_sweep(start, end, centre, axis), dot(end - start, axis))


def move_lengths(start: Array, end: Array, is_arc: Array, centre: Array, axis: Array) -> Array:
    """Lengths of moves, (N,) mm: of arcs and helices where ``is_arc``, else of straight lines."""
    length = norm(end - start)
    length[is_arc] = arc_length(start[is_arc], end[is_arc], centre[is_arc], axis[is_arc])
    return length


def _coefficients(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array) -> tuple[Array, Array]:
    """c2 T^2 and c3 T^3, each (N, 6): in units of length, to avoid division by a short time."""
    distance = p1 - p0
    span = duration[:, None]
    return 3 * distance - (2 * v0 + v1) * span, -2 * distance + (v0 + v1) * span


def hermite_lengths(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array, share: Array) -> Array:
    """Positions at shares of the duration, (N, M, 6)."""
    square, cube = _coefficients(p0, v0, p1, v1, duration)
    x = np.atleast_2d(share)[..., None]
    linear = v0 * duration[:, None]
    return p0[:, None] + x * (linear[:, None] + x * (square[:, None] + x * cube[:, None]))


def hermite_speeds(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array, share: Array) -> Array:
    """Speeds at shares of the duration, (N, M, 6)."""
    square, cube = _coefficients(p0, v0, p1, v1, duration)
    x = np.atleast_2d(share)[..., None]
    return v0[:, None] + x * (2 * square[:, None] + 3 * x * cube[:, None]) / duration[:, None, None]


def hermite_accelerations(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array) -> tuple[Array, Array]:
    """Accelerations at both ends, (N, 6) each; between them they are linear, so these are the extremes."""
    square, cube = _coefficients(p0, v0, p1, v1, duration)
    per_square_second = np.square(duration)[:, None]
    return 2 * square / per_square_second, (2 * square + 6 * cube) / per_square_second


def cubic_ranges(p0: Array, v0: Array, a0: Array, jerk: Array, p1: Array, duration: Array) -> tuple[Array, Array]:
    """Least and greatest value of cubics, of any shape: at an end, or where the speed is zero, up to two times.

    Args:
        p0: at the start.
        v0: speed there.
        a0: acceleration there.
        jerk: constant.
        p1: at the end.
        duration: s, of a shape that fits.
    """
    stops = np.clip(np.stack(_roots(jerk / 2, a0, v0)), 0.0, duration)  # an end if there is none inside
    at_stops = p0 + stops * (v0 + stops * (a0 / 2 + stops * jerk / 6))
    places = np.concatenate([np.stack([p0, p1]), at_stops])
    return places.min(axis=0), places.max(axis=0)


def _roots(square: Array, linear: Array, constant: Array) -> tuple[Array, Array]:
    """Roots of quadratics; 0 for missing roots."""
    discriminant = linear**2 - 4 * square * constant
    there = discriminant >= 0
    # this sum has no cancellation; one root is a quotient by it, the other follows from the product of the roots
    half = -(linear + np.copysign(np.sqrt(np.where(there, discriminant, 0.0)), linear)) / 2
    none = np.zeros_like(half)
    one = np.divide(half, square, out=none.copy(), where=there & (np.abs(square) > 0))
    other = np.divide(constant, half, out=none, where=there & (np.abs(half) > 0))
    return one, other


def hermite_powers(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array) -> Array:
    """Coefficients of the powers of the share, (4, C, N), of C columns, (C, N)."""
    distance, linear, last = p1 - p0, v0 * duration, v1 * duration
    return np.stack([p0, linear, 3 * distance - 2 * linear - last, linear + last - 2 * distance])


def hermite_columns(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array, share: Array) -> Array:
    """Positions of C columns, (C, N), at shares (M, 1) or (M, N): (C, M, N)."""
    place, linear, square, cube = hermite_powers(p0, v0, p1, v1, duration)[:, :, None]
    return np.asarray(place + share * (linear + share * (square + share * cube)))


def hermite_column_speeds(p0: Array, v0: Array, p1: Array, v1: Array, duration: Array, share: Array) -> Array:
    """Speeds of C columns, (C, M, N)."""
    _, linear, square, cube = hermite_powers(p0, v0, p1, v1, duration)[:, :, None]
    return np.asarray((linear + share * (2 * square + 3 * share * cube)) / duration)
