# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options of surface finishing, apart from the faces and the cutter.

The values of the choices are shown to users and stored in documents.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, field

from pkm_post.toolpath.surface.poses import SurfaceTolerances
from pkm_post.toolpath.surface.stepover import Stepover
from pkm_post.toolpath.surface.tool_axis import AxisRule


class PassLines(enum.Enum):
    """Lines that the passes follow."""

    ALONG_U = "Along U"
    ALONG_V = "Along V"
    PLANES = "Parallel planes"


class PassOrder(enum.Enum):
    """Order of the passes."""

    ZIGZAG = "Zigzag"
    ONE_WAY = "One way"
    SPIRAL = "Spiral"


class CutMode(enum.Enum):
    """Climb or conventional milling; in a zigzag it applies to the first pass."""

    CLIMB = "Climb"
    CONVENTIONAL = "Conventional"
    AS_IT_COMES = "As it comes"


class LeadMove(enum.Enum):
    """Lead move of the cutter to and from the surface."""

    NONE = "None"
    TANGENT = "Tangent"
    ARC = "Arc"


@dataclass(frozen=True)
class SurfaceOptions:
    """Options for covering faces. Units: mm, mm/s, rad.

    Attributes:
        safe_height: z of the plane in which the tool moves from one run to the next.
        clearance_height: z of the plane of the first approach and the last retract.
        feed: feed of the tip while cutting.
        plunge_feed: feed of the tip on the last piece down to the surface.
        lines: lines that the passes follow.
        order: order of the passes.
        plane: (3,) normal of the parallel planes, of any length.
        reversed: whether the passes begin at the opposite side.
        stepover: distance of neighbouring passes.
        tolerances: tolerances of the straight moves.
        rule: rule of the tool axis.
        cut_mode: climb or conventional.
        clockwise: whether the spindle turns clockwise, seen from the spindle.
        lead_move: shape of lead-in and lead-out.
        lead_length: length of a straight lead, radius of an arc.
        approach: distance above the surface, along the tool axis, at which rapid motion ends.
    """

    safe_height: float
    clearance_height: float
    feed: float
    plunge_feed: float
    lines: PassLines = PassLines.ALONG_U
    order: PassOrder = PassOrder.ZIGZAG
    plane: tuple[float, float, float] = (1.0, 0.0, 0.0)
    reversed: bool = False
    stepover: Stepover = field(default_factory=lambda: Stepover(distance=1.0))
    tolerances: SurfaceTolerances = field(default_factory=SurfaceTolerances)
    rule: AxisRule = field(default_factory=AxisRule)
    cut_mode: CutMode = CutMode.AS_IT_COMES
    clockwise: bool = True
    lead_move: LeadMove = LeadMove.NONE
    lead_length: float = 0.0
    approach: float = 2.0

    def __post_init__(self) -> None:
        if not (self.feed > 0.0 and self.plunge_feed > 0.0):
            raise ValueError(f"SurfaceOptions: expected feeds above 0, got {self.feed} and {self.plunge_feed} mm/s")
        if not (self.lead_length >= 0.0 and self.approach >= 0.0):
            got = f"{self.lead_length} and {self.approach} mm"
            raise ValueError(f"SurfaceOptions: expected lead length and approach not below 0, got {got}")
        if not any(self.plane):
            raise ValueError("SurfaceOptions: expected a normal of the planes with a direction, got (0, 0, 0)")
