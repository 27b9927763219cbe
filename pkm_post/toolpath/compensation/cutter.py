# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cutter: the shape of a rotating tool, by the APT parameters d, r, e, f, a, b, h, and distances from its solid.

The profile runs from the tip along the bottom, which rises by a, around the corner arc, and up the side, which leans
outwards by b. Ball, bull nose, flat and tapered end mills and drills are such cutters. Revolved about the tool axis,
the centre of the corner arc describes a circle, and the corner is the torus around it. The solid is convex: bottom
cone, corner torus and side cone, capped by a plane at its height. Lengths in mm, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import (
    Amount,
    Diagnostic,
    Diagnostics,
    Phrase,
    Place,
    Tool,
    corner_reach,
    largest_corner_radius,
    valid_cutter_angles,
)

_TANGENT = 2e-3
"""Tolerance in mm of a given e or f against the arc tangent to bottom and side: files round to three decimals."""


@dataclass(frozen=True)
class Cutter:
    """The profile of a cutter.

    Attributes:
        corner_radius: r, radius of the corner arc; 0 for a sharp corner.
        radial_offset: e, distance of the centre of the arc from the tool axis: 0 for a ball, negative for a lens,
            whose arc has its centre beyond the axis.
        axial_offset: f, height of the centre of the arc above the tool tip.
        bottom_angle: a, rise of the bottom against the plane across the axis, 0 <= a < pi/2.
        side_angle: b, angle of the side to the axis, -pi/2 < b < pi/2, positive where the cutter widens upwards.
        height: h, height of the cutter above its tip; infinite when unknown.
    """

    corner_radius: float
    radial_offset: float
    axial_offset: float
    bottom_angle: float = 0.0
    side_angle: float = 0.0
    height: float = math.inf

    def __post_init__(self) -> None:
        r, e, f = self.corner_radius, self.radial_offset, self.axial_offset
        if not (all(map(math.isfinite, (r, e, f))) and r >= 0.0 and f >= 0.0):
            raise ValueError(f"Cutter: expected r, e, f finite, and r and f not negative, got {(r, e, f)}")
        if not r + e > 0.0:
            raise ValueError(f"Cutter: expected a radius r + e above 0, got {r + e}")
        _check_angles(self.bottom_angle, self.side_angle)
        if not self.height > 0.0:
            raise ValueError(f"Cutter: expected a height above 0, got {self.height}")

    @classmethod
    def apt(
        cls,
        d: float,
        r: float = 0.0,
        e: float | None = None,
        f: float | None = None,
        a: float = 0.0,
        b: float = 0.0,
        h: float = math.inf,
    ) -> Cutter:
        """The cutter of APT's seven parameters; e and f follow from the others.

        The arc is tangent to bottom and side: (f - e tan a) cos a = r, (d/2 - e) cos b + (f - d/2 tan a) sin b = r.

        Args:
            d: diameter of the circle where the lines of bottom and side meet, mm.
            r: corner radius, mm.
            e: radial offset of the arc's centre, mm; None to derive it.
            f: axial offset of the arc's centre, mm; None to derive it.
            a: bottom angle, rad.
            b: side angle, rad.
            h: height, mm.

        Raises:
            ValueError: a value is out of its range, or a given e or f is of an arc that is not tangent.
        """
        if not (math.isfinite(d) and d > 0.0):
            raise ValueError(f"Cutter: expected a diameter above 0, got {d}")
        if not (math.isfinite(r) and r >= 0.0):
            raise ValueError(f"Cutter: expected a corner radius not below 0, got {r}")
        _check_angles(a, b)
        touching_e = d / 2.0 - r * corner_reach(a, b)
        touching_f = touching_e * math.tan(a) + r / math.cos(a)
        for name, given, touching in (("e", e, touching_e), ("f", f, touching_f)):
            if given is not None and not abs(given - touching) <= _TANGENT:
                raise ValueError(f"Cutter: expected {name} = {touching:.6g}, where the corner touches, got {given:.6g}")
        return cls(r, touching_e, touching_f, a, b, h)

    @classmethod
    def of(cls, tool: Tool) -> Cutter:
        """The cutter of a tool.

        Args:
            tool: a tool of known diameter whose corner fits: its centre is not beyond the axis.

        Raises:
            ValueError: the diameter is not above 0, an angle is out of its range, or the corner does not fit.
        """
        radius = tool.diameter / 2.0
        if not (math.isfinite(radius) and radius > 0.0):
            raise ValueError(f"tool {tool.number}: expected a diameter above 0 mm, got {tool.diameter}")
        _check_angles(tool.bottom_angle, tool.side_angle)
        largest = largest_corner_radius(tool.diameter, tool.bottom_angle, tool.side_angle)
        if not 0.0 <= tool.corner_radius <= largest * (1.0 + 1e-9):
            raise ValueError(
                f"tool {tool.number}: expected a corner radius from 0 to {largest} mm, got {tool.corner_radius}"
            )
        corner = min(tool.corner_radius, largest)
        return cls.apt(tool.diameter, corner, a=tool.bottom_angle, b=tool.side_angle)

    @property
    def radius(self) -> float:
        """Half the nominal diameter d, mm: of the circle where the lines of bottom and side meet."""
        return self.radial_offset + self.corner_radius * corner_reach(self.bottom_angle, self.side_angle)

    @property
    def corner_start(self) -> float:
        """Angle in rad from the axis to the normal of the corner where it meets the bottom or, for a lens, the axis."""
        if self.radial_offset >= 0.0:
            return self.bottom_angle
        return max(self.bottom_angle, math.asin(-self.radial_offset / self.corner_radius))

    @property
    def corner_end(self) -> float:
        """Angle in rad from the axis to the normal of the corner where it meets the side."""
        return math.pi / 2.0 - self.side_angle


def _check_angles(a: float, b: float) -> None:
    """Bottom and side must meet: they are parallel where a + b is a right angle."""
    if not valid_cutter_angles(a, b):
        raise ValueError(
            "Cutter: expected a bottom angle from 0 and a side angle from -90 to less than 90 degrees, together less "
            f"than 90, got {math.degrees(a):.6g} and {math.degrees(b):.6g}"
        )


def known_cutter(tool: Tool, place: Place) -> tuple[Cutter | None, Diagnostics]:
    """The cutter of a tool whose diameter and corner radius are given, or None; and diagnostics: N109, N117."""
    try:
        cutter = Cutter.of(tool)
    except ValueError as impossible:
        return None, (Diagnostic("N109", place, str(impossible)),)
    if not tool.corner_known:
        return None, (
            Diagnostic(
                "N117",
                place,
                Phrase("T{}, of which the diameter alone is given: {}", tool.number, Amount(tool.diameter, "mm", "g")),
            ),
        )
    return cutter, ()


@dataclass(frozen=True)
class CutterProfile:
    """The outline of a cutter in the half-plane of radius and level: line, arc, line, and a line across the top.

    Attributes:
        foot: level where the outline leaves the axis.
        start: angle from the axis to the normal of the bottom and of the start of the arc.
        end: angle from the axis to the normal of the end of the arc and of the side.
        radius: radius of the arc.
        centre: centre of the arc: radius and level.
        top: level of the top.
    """

    foot: float
    start: float
    end: float
    radius: float
    centre: tuple[float, float]
    top: float

    @classmethod
    def of(cls, cutter: Cutter, tallest: float) -> CutterProfile:
        """The outline of a cutter.

        Args:
            cutter: the cutter.
            tallest: height in mm above which nothing matters; it caps cutters of unknown height.
        """
        r, e, f = cutter.corner_radius, cutter.radial_offset, cutter.axial_offset
        foot = f - r * math.cos(cutter.corner_start) if e < 0.0 else 0.0
        ends_at = f - r * math.cos(cutter.corner_end)
        top = min(cutter.height, max(tallest, ends_at))
        if cutter.side_angle < 0.0:  # the side converges upwards
            top = min(top, ends_at - (e + r * math.sin(cutter.corner_end)) / math.tan(cutter.side_angle))
        return cls(foot, cutter.corner_start, cutter.corner_end, r, (e, f), top)

    def corner(self, angle: float) -> tuple[float, float]:
        """The point of the arc whose normal is at this angle to the axis: radius and level."""
        return self.centre[0] + self.radius * math.sin(angle), self.centre[1] - self.radius * math.cos(angle)

    def distance(self, radius: Array, level: Array) -> Array:
        """Signed distances of points to the solid, negative inside, of the shape of the arguments.

        Args:
            radius: distances from the tool axis, not negative.
            level: heights above the tip.
        """
        bottom, to_bottom = _line(radius, level - self.foot, self.start, self._bottom_length)
        end_radius, end_level = self.corner(self.end)
        side, to_side = _line(radius - end_radius, level - end_level, self.end, self._side_length)
        above, beyond = level - self.top, np.maximum(radius - self._top_radius, 0.0)
        x, z = radius - self.centre[0], level - self.centre[1]
        from_arc = np.sqrt(x * x + z * z) - self.radius
        at_corner = (x * math.cos(self.start) + z * math.sin(self.start) >= 0.0) & (
            x * math.cos(self.end) + z * math.sin(self.end) <= 0.0
        )
        to_corner = np.where(at_corner, from_arc * from_arc, np.inf)
        nearest = np.minimum(np.minimum(to_bottom, to_side), np.minimum(beyond * beyond + above * above, to_corner))
        outside = np.maximum(np.maximum(bottom, side), np.maximum(above, np.where(at_corner, from_arc, -np.inf)))
        return np.copysign(np.sqrt(nearest), outside)

    @property
    def reach(self) -> float:
        """Distance from the tip to the farthest point of the solid, mm."""
        return max(math.hypot(self._top_radius, self.top), math.hypot(*self.corner(self.end)))

    @property
    def _bottom_length(self) -> float:
        return math.hypot(self.corner(self.start)[0], self.corner(self.start)[1] - self.foot)

    @property
    def _side_length(self) -> float:
        return max(0.0, (self.top - self.corner(self.end)[1]) / math.sin(self.end))

    @property
    def _top_radius(self) -> float:
        return self.corner(self.end)[0] + self._side_length * math.cos(self.end)


def _line(x: Array, z: Array, angle: float, length: float) -> tuple[Array, Array]:
    """Signed distances of points from a line through the origin, and squares of those from its segment of a length.

    The normal of the line is at the angle to the axis, down and out; the line runs out and up.
    """
    along = x * math.cos(angle) + z * math.sin(angle)
    outside = x * math.sin(angle) - z * math.cos(angle)
    beyond = along - np.minimum(np.maximum(along, 0.0), length)
    return outside, outside * outside + beyond * beyond
