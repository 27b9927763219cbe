# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arcs: centre and axis of G2, G3, CIP and CT.

Input: columns of points and words in coordinates of the program, mm. Output: centres at the height of the start
points, and unit axes of right-handed rotation. G2 and G3 share their geometry and its limits with G-code; AR= is the
opening angle, CIP goes through I1= J1= K1=, CT continues along the tangent of the previous motion [SiemensNC, circular
interpolation].
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from pkm_post.geometry import cross, norm
from pkm_post.model import Array
from pkm_post.reading.gcode.arcs import ArcWords, arc_axes, centres
from pkm_post.reading.gcode.codes import Word
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.state import CLOCKWISE

CENTRE = ("I", "J", "K")
POINT = ("I1", "J1", "K1")
_STRAIGHT = 1e-9
"""Sine of the angle between chord and tangent below which CT is a line; and largest distance of three points on a line
from it, as a share of the chord."""

Words = Mapping[str, Array]
Geometry = tuple[Array, Array]
"""Centres and axes, (n, 3) each."""


def plane_arcs(
    motion: Array, start: Array, end: Array, words: Words, absolute: Array, plane: int, unit: float
) -> tuple[Array, Array, list[tuple[int, str, str]]]:
    """Centres and axes of G2 and G3, and for each faulty one its index, code and finding.

    Args:
        motion: (n,) motion codes.
        start: (n, 3).
        end: (n, 3).
        words: I, J, K and CR in mm, (n,) each, NaN where absent.
        absolute: (n, 3) whether I, J and K are coordinates.
        plane: code of the plane.
        unit: mm per unit of lengths.
    """
    count = len(motion)
    nothing = np.full(count, np.nan)
    centre = np.column_stack([words.get(name, nothing) for name in CENTRE])
    arcs = ArcWords(
        start=start,
        end=end,
        plane=np.full(count, plane),
        clockwise=motion == CLOCKWISE,
        centre=np.where(absolute, centre - start, centre),
        absolute=np.zeros(count, dtype=np.bool_),
        radius=words.get("CR", nothing),
        unit=np.full(count, unit),
    )
    found, faults = centres(arcs)
    return found, arc_axes(arcs), [(index, code, _shown(text)) for index, code, text in faults]


def _shown(found: object) -> str:
    """The text of a fault, with CR= for the radius."""
    parts = found if isinstance(found, tuple) and not isinstance(found, Word) else (found,)
    return "".join(_named(part) if isinstance(part, Word) else str(part) for part in parts).replace("R and", "CR= and")


def _named(word: Word) -> str:
    return f"CR={word.value:g}" if word.name == "R" and word.value is not None else str(word)


def by_opening_angle(start: Array, end: Array, centre: Array, degrees: float, plane: int, motion: int) -> Array:
    """The centre of an arc with AR=, in degrees, and its end if the centre is given: (2, 3) end and centre.

    ``start`` and ``end`` are (3,); ``centre`` has the offsets I, J and K from the start, NaN where absent.

    Raises:
        BlockFault: the arc does not exist.
    """
    first, second, _ = PLANES[plane]
    if not 0 < degrees < 360:  # noqa: PLR2004 - a full turn
        raise BlockFault("G606", f"AR={degrees:g}")
    sense = -1.0 if motion == CLOCKWISE else 1.0
    here = complex(start[first], start[second])
    angle = sense * np.radians(degrees)
    if not np.isnan(centre[[first, second]]).all():
        middle = here + complex(*np.nan_to_num(centre[[first, second]]))
        there = middle + (here - middle) * np.exp(1j * angle)
    else:
        there = complex(end[first], end[second])
        if there == here:
            raise BlockFault("G409", "AR= and the end is the start")
        middle = (there - here * np.exp(1j * angle)) / (1 - np.exp(1j * angle))
    points = np.array([end, start], dtype=np.float64)
    points[:, first], points[:, second] = [there.real, middle.real], [there.imag, middle.imag]
    return points


def through_point(start: Array, point: Array, end: Array) -> Geometry:
    """Centre and axis of the arc from start through a point to its end, (3,) each.

    Raises:
        BlockFault: the three points are on a line.
    """
    first, second = point - start, end - start
    normal = cross(first[None], second[None])[0]
    area = float(norm(normal[None])[0])
    longest = max(float(norm(first[None])[0]), float(norm(second[None])[0]))
    if area <= _STRAIGHT * longest**2:
        raise BlockFault("G409", "start, intermediate point and end of CIP are on a line")
    towards = (first @ first) * cross(second[None], normal[None])[0] + (second @ second) * cross(
        normal[None], first[None]
    )[0]
    return start + towards / (2 * area**2), normal / area


def along_tangent(start: Array, end: Array, tangent: Array, plane: int) -> Geometry | None:
    """Centre and axis of the arc that leaves its start along a tangent in the plane; None if it is a line.

    Raises:
        BlockFault: there is no tangent in the plane, or it points away from the end.
    """
    first, second, normal = PLANES[plane]
    here, there = (complex(each[first], each[second]) for each in (start, end))
    direction = complex(tangent[first], tangent[second])
    chord = there - here
    if abs(direction) < _STRAIGHT:
        raise BlockFault("G409", "CT without a motion in its plane before it")
    if not abs(chord):
        raise BlockFault("G409", "CT ends where it starts")
    left = 1j * direction / abs(direction)
    across = (chord * left.conjugate()).real
    if abs(across) <= _STRAIGHT * abs(chord):
        if (chord * direction.conjugate()).real < 0:
            raise BlockFault("G409", "CT ends behind its start")
        return None
    middle = here + left * abs(chord) ** 2 / (2 * across)
    centre, axis = start.copy(), np.zeros(3)
    centre[first], centre[second] = middle.real, middle.imag
    axis[normal] = np.sign(across)
    return centre, axis
