# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs: compute the centre from centre words or a radius, and split multi-turn arcs.

Enters and leaves: columns in program coordinates, mm. An arc lies in one of the three planes; a change of the third
coordinate makes it a helix. Tolerances are those of LinuxCNC, so programs that run there are accepted here: end points
may have been rounded to a hundredth of a millimetre or a thousandth of an inch [LinuxCNC, interp_internal.hh].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import arc_points, arc_sweep
from pkm_post.model import Array
from pkm_post.reading.gcode.frames import normal_coordinate, plane_axes
from pkm_post.reading.gcode.options import UNITS

ROUNDED_MM, ROUNDED_INCH = 0.01, 0.001 * UNITS["inch"]
"""Permitted rounding of arc end points, mm, in programs in mm and in inches."""
RADIUS_RELATIVE = 1e-3
"""Permitted difference of start and end radius relative to the radius, where it exceeds the rounding error."""
RADIUS_MOST = 100
"""Upper bound of the permitted difference, as a multiple of the rounding error."""
HALF_CIRCLE = 0.00127
"""mm by which a radius may fall short of half the chord."""
_NO_RADIUS = 1e-9


@dataclass(frozen=True)
class ArcWords:
    """Programmed words of n arcs.

    Attributes:
        start: (n, 3) start points.
        end: (n, 3) end points.
        plane: (n,) code of the plane.
        clockwise: (n,) whether they run clockwise seen from the tip of the plane normal (G2).
        centre: (n, 3) words I J K in mm, NaN where absent.
        absolute: (n,) whether I J K are coordinates (G90.1) rather than offsets from the start point.
        radius: (n,) word R in mm, NaN where absent.
        unit: (n,) mm per programmed length unit.
    """

    start: Array
    end: Array
    plane: Array
    clockwise: Array
    centre: Array
    absolute: Array
    radius: Array
    unit: Array


def arc_axes(words: ArcWords) -> Array:
    """Unit axes of right-handed rotation of the arcs, (n, 3)."""
    axis = np.zeros((len(words.plane), 3))
    axis[np.arange(len(axis)), normal_coordinate(words.plane)] = np.where(words.clockwise, -1.0, 1.0)
    return axis


def centres(words: ArcWords) -> tuple[Array, list[tuple[int, str, str]]]:
    """Centres of arcs, at the height of their start points.

    Returns:
        (n, 3) centres, and for each invalid arc its index, the fault code and what was found.
    """
    axes = plane_axes(words.plane)
    start, end = (np.take_along_axis(points, axes, axis=1) for points in (words.start, words.end))
    said = np.take_along_axis(words.centre, axes, axis=1)
    by_radius = ~np.isnan(words.radius)
    from_words = np.where(words.absolute[:, None], said[:, :2], start[:, :2] + np.nan_to_num(said[:, :2]))
    from_radius = _by_radius(start[:, :2], end[:, :2], words.radius, words.clockwise)
    flat = np.where(by_radius[:, None], from_radius, from_words)
    centre = np.empty_like(start)
    np.put_along_axis(centre, axes, np.column_stack([flat, start[:, 2]]), axis=1)
    return centre, _faults(words, start, end, said, flat)


def _by_radius(start: Array, end: Array, radius: Array, clockwise: Array) -> Array:
    """Centres from radii, (n, 2): to the left of the chord for the short counterclockwise arc."""
    chord = end - start
    length = _length(chord)
    height = np.sqrt(np.maximum(radius**2 - (length / 2) ** 2, 0.0))
    side = np.where(clockwise == (radius > 0), -1.0, 1.0)
    left = np.column_stack([-chord[:, 1], chord[:, 0]]) / np.where(length > 0, length, 1.0)[:, None]
    return start + chord / 2 + (side * height)[:, None] * left


def _faults(words: ArcWords, start: Array, end: Array, said: Array, flat: Array) -> list[tuple[int, str, str]]:
    by_radius, given = ~np.isnan(words.radius), ~np.isnan(said)
    first, last = (_length(points[:, :2] - flat) for points in (start, end))
    off, larger = np.abs(first - last), np.maximum(first, last)
    half = _length((end - start)[:, :2]) / 2
    lacking = ~by_radius & np.where(words.absolute, ~given[:, :2].all(axis=1), ~given[:, :2].any(axis=1))
    rounding = _rounding(words.unit)
    beyond = (off > RADIUS_MOST * rounding) | ((off > rounding) & (off > RADIUS_RELATIVE * larger))
    no_circle = (larger < _NO_RADIUS) | (first < _NO_RADIUS)
    found: tuple[tuple[str, Array, Callable[[int], str]], ...] = (
        ("G410", by_radius & given.any(axis=1), lambda i: f"R{words.radius[i]:g} and centre words"),
        ("G410", lacking, lambda i: "neither R nor the centre words of the plane"),
        ("G410", given[:, 2] & (np.nan_to_num(said[:, 2]) != 0), lambda i: "a centre word across the plane"),
        ("G409", by_radius & (half == 0), lambda i: f"R{words.radius[i]:g}, and it ends where it starts"),
        (
            "G409",
            by_radius & (half - np.abs(words.radius) > HALF_CIRCLE),
            lambda i: _too_far(float(half[i]), float(words.radius[i])),
        ),
        ("G409", ~by_radius & ~lacking & (beyond | no_circle), lambda i: _radii(float(first[i]), float(last[i]))),
    )
    return [(i, code, text(i)) for code, wrong, text in found for i in np.flatnonzero(wrong).tolist()]


def _rounding(unit: Array) -> Array:
    """Largest difference of start and end radius, mm, that rounding of all three points can cause, (n,)."""
    return 2 * np.sqrt(2) * np.where(unit == UNITS["inch"], ROUNDED_INCH, ROUNDED_MM)


def _length(flat: Array) -> Array:
    """Lengths of (n, 2) vectors, (n,)."""
    length: Array = np.hypot(flat[:, 0], flat[:, 1])
    return length


def _too_far(half: float, radius: float) -> str:
    return f"R{radius:g}, and its ends are {2 * half:.4f} mm apart"


def _radii(first: float, last: float) -> str:
    return f"radius {first:.4f} mm at its start, {last:.4f} mm at its end"


def whole_turns(words: ArcWords, centre: Array, turns: Array) -> tuple[Array, Array, Array]:
    """Split arcs of more than one turn at full turns.

    Args:
        words: n arcs.
        centre: (n, 3) their centres.
        turns: (n,) the P word: number of turns begun, from 1.

    Returns:
        index (m,) of the source arc of each piece, and its start and end, (m, 3) each.
    """
    axis = arc_axes(words)
    count = turns.astype(np.int64)
    sweep = arc_sweep(words.start, words.end, centre, axis) + 2 * np.pi * (count - 1)
    index = np.repeat(np.arange(len(count)), count)
    piece = np.arange(len(index)) - np.repeat(np.cumsum(count) - count, count)
    rise = np.einsum("ij,ij->i", words.end - words.start, axis)

    def at(turn: Array) -> Array:
        angle = 2 * np.pi * turn
        height = rise[index] * angle / sweep[index]
        return arc_points(words.start[index], centre[index], axis[index], angle, height)

    last = piece + 1 == count[index]
    start = np.where((piece == 0)[:, None], words.start[index], at(piece))
    return index, start, np.where(last[:, None], words.end[index], at(piece + 1))
