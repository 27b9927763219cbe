# SPDX-License-Identifier: LGPL-2.1-or-later
"""Set-up: data of a job other than its motions: tools, part, stock and fixtures.

Meshes are in the work frame {C}, in mm. Unknown items are None or missing; they are not checked, and the certificate
states that.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.model.columns import Array, freeze


@dataclass(frozen=True)
class Tool:
    """A rotating cutter.

    Attributes:
        number: tool number, 0 when the source names none.
        name: display name.
        diameter: cutter diameter in mm, at the intersection of bottom and side line; 0 when unknown.
        corner_radius: corner radius in mm: 0 for a flat end mill, half the diameter for a ball.
        length: gauge length in mm, from the spindle nose to the tip.
        bottom_angle: rise of the bottom from the tip outwards, in rad: 0 for a flat bottom, 31 degrees for a drill
            with a point of 118.
        side_angle: angle of the side to the tool axis in rad, positive where the tool widens upwards.
        corner_known: whether the source gives the corner radius; if not, it is 0, since a flat end mill contains every
            other cutter of its diameter.
    """

    number: int
    name: str
    diameter: float
    corner_radius: float
    length: float
    bottom_angle: float = 0.0
    side_angle: float = 0.0
    corner_known: bool = True


def corner_reach(bottom_angle: float, side_angle: float) -> float:
    """Distance from the centre of a corner of radius 1 out to the circle where the lines of bottom and side meet.

    (cos a - sin b) / cos(a + b), from the arc touching both lines; 1 for a flat bottom and an upright side.

    Args:
        bottom_angle: a, 0 <= a < pi/2, rad.
        side_angle: b, with a + b < pi/2, rad.
    """
    return (math.cos(bottom_angle) - math.sin(side_angle)) / math.cos(bottom_angle + side_angle)


def largest_corner_radius(diameter: float, bottom_angle: float = 0.0, side_angle: float = 0.0) -> float:
    """Corner radius in mm that puts the centre of the corner on the axis: that of a ball.

    Args:
        diameter: of the circle where the lines of bottom and side meet, mm.
        bottom_angle: rad.
        side_angle: rad.
    """
    return diameter / 2.0 / corner_reach(bottom_angle, side_angle)


def valid_cutter_angles(bottom_angle: float, side_angle: float) -> bool:
    """Whether the lines of bottom and side meet: a bottom angle from 0, and a sum below a right angle."""
    right = math.pi / 2.0
    return 0.0 <= bottom_angle < right and -right < side_angle < right and bottom_angle + side_angle < right


def gauge_lengths(tools: Mapping[int, Tool], numbers: Array) -> Array:
    """Gauge lengths of a column of tool numbers, (N,) in mm.

    Args:
        tools: the tools by number.
        numbers: (N,) numbers, all of them among the tools.
    """
    known = np.array(sorted(tools), dtype=np.int64)
    return np.array([tools[number].length for number in known])[np.searchsorted(known, numbers)]


@dataclass(frozen=True)
class Shank:
    """Shape of a tool above its cutting edges.

    Attributes:
        start: height above the tip where the cutting edges end and the shank begins, mm.
        diameter: mm.
    """

    start: float
    diameter: float


@dataclass(frozen=True)
class Mesh:
    """The surface of a solid.

    Attributes:
        source: origin for messages: the name of a file or of an object.
        triangles: (T, 3, 3) corners in {C}, anticlockwise as seen from outside.
        assumed: whether it is a guess, such as the default stock box that CAM puts around a model.
    """

    source: str
    triangles: Array
    assumed: bool = False

    def __post_init__(self) -> None:
        freeze(self, len(self.triangles), {"triangles": (np.float64, (3, 3))})


@dataclass(frozen=True)
class Setup:
    """Solids on the table, and tool shapes above the cutting edges.

    Attributes:
        part: the finished part.
        stock: the stock before the first operation.
        fixtures: clamps, vice and other fixed solids.
        shanks: by tool number, where known.
        unknown_corners: numbers of tools with unknown corner radius.
        cores: by tool number, diameter in mm of a cylinder inside the cutting part, of tools such as thread mills whose
            outline no ``Tool`` has: the tool is then one around it.
    """

    part: Mesh | None = None
    stock: Mesh | None = None
    fixtures: tuple[Mesh, ...] = ()
    shanks: Mapping[int, Shank] = field(default_factory=dict)
    unknown_corners: frozenset[int] = frozenset()
    cores: Mapping[int, float] = field(default_factory=dict)

    @property
    def is_empty(self) -> bool:
        """Whether there are no solids to collide with."""
        return self.part is None and self.stock is None and not self.fixtures

    def core_of(self, tool: Tool) -> Tool:
        """The cylinder that a tool certainly fills where ``cores`` has it; else the tool itself."""
        core = self.cores.get(tool.number)
        return tool if core is None else replace(tool, diameter=min(core, tool.diameter), corner_radius=0.0)


EMPTY_SETUP = Setup()
"""Setup of a program without further data."""
