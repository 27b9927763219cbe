# SPDX-License-Identifier: LGPL-2.1-or-later
"""The 6-TPS machine: its geometry and limits, as stated in a machine file.

Frames: {M} machine, z up, fixed to the table; {T} platform, origin in the plane its joints are given in, z along the
tool axis from the tip towards the spindle. Units: mm, rad, s, N.

The length of a strut is the one its controller counts: the distance of its joint centres, corrected for the rotation of
its screw, minus its length offset. Without screw lead and offsets, the defaults, it is the distance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pkm_post.model.columns import Array, freeze


@dataclass(frozen=True)
class Body:
    """A cylinder about the tool axis that moves with the platform: spindle, holder, or the platform itself.

    Attributes:
        name: name in messages.
        radius: mm.
        start: z of one end in {T}, mm; the tool is at negative z.
        end: z of the other end in {T}, mm, above ``start``.
    """

    name: str
    radius: float
    start: float
    end: float


@dataclass(frozen=True)
class Box:
    """A fixed box with edges along the axes of {M}: table, vice, fixture.

    Attributes:
        name: name in messages.
        lowest: (3,) its corner with the least coordinates in {M}, mm.
        highest: (3,) the opposite corner.
    """

    name: str
    lowest: Array
    highest: Array

    def __post_init__(self) -> None:
        freeze(self, 3, {"lowest": (np.float64, ()), "highest": (np.float64, ())})


@dataclass(frozen=True)
class ToolChange:
    """Tool-change pose, and the safe height for travel to and from it.

    Attributes:
        nose: (3,) centre of the spindle nose in {M}, mm: the tip is below it by the gauge length of the tool.
        axis: (3,) unit tool axis in {M}.
        spin: of the platform about it, rad.
        safe_height: least z in {M} at which the tip may travel between any two points, mm.
    """

    nose: Array
    axis: Array
    spin: float
    safe_height: float

    def __post_init__(self) -> None:
        freeze(self, 3, {"nose": (np.float64, ()), "axis": (np.float64, ())})

    def tip(self, tool_length: float) -> Array:
        """(3,) tip of a tool at the pose, mm: nose - length axis."""
        return np.asarray(self.nose - tool_length * self.axis)


@dataclass(frozen=True)
class SpindleAxis:
    """A spindle that the controller can move as an axis, for threads.

    Attributes:
        motor: motor number.
        letter: of the axis in the coordinate system of the struts; its unit is a turn.
        counts_per_turn: encoder counts of one turn of the spindle clockwise, seen from the spindle.
        speed: highest speed as an axis, turns/s.
        acceleration: highest acceleration as an axis, turns/s^2.
        lead_tolerance: largest deviation of the depth from turns times lead, mm.
    """

    motor: int
    letter: str
    counts_per_turn: float
    speed: float
    acceleration: float
    lead_tolerance: float


def _no_axes() -> Array:
    return np.zeros((6, 3))


@dataclass(frozen=True)
class Machine:
    """A hexapod of six telescopic struts; strut i joins base joint i to platform joint i.

    Attributes:
        name: name of the machine file.
        fingerprint: SHA-256 of the machine file, hexadecimal; it ties outputs to the machine they were made for.
        base_joints: (6, 3) joint centres in {M}.
        platform_joints: (6, 3) joint centres in {T}.
        spindle_nose: distance from the {T} origin along -z to the spindle nose, where gauge lengths begin.
        strut_stroke: shortest and longest length of a strut.
        strut_speed: highest rate of strut length, mm/s.
        strut_acceleration: highest second rate of strut length, mm/s^2.
        base_rest: (6, 3) unit rest axes of the base joints in {M}, from the base towards the platform.
        base_cone: (6,) half angle each base joint may swing from its rest axis; or one number for all.
        platform_rest: (6, 3) unit rest axes of the platform joints in {T}, from the platform towards the base.
        platform_cone: (6,) half angle each platform joint may swing from its rest axis; or one number for all.
        characteristic_length: mm; divides the rotation columns of the Jacobian to make it dimensionless.
        least_singular_value: least singular value of the Jacobian allowed on the path, dimensionless.
        home_tip: (3,) tool tip in {M} where a program starts.
        rapid_speed: tool-tip speed of rapid moves, mm/s.
        feed_speed: highest tool-tip speed of cutting moves, mm/s.
        tip_acceleration: highest acceleration of the tool tip, mm/s^2.
        axis_speed: highest turning rate of the tool axis, rad/s.
        spindle_speed: highest spindle speed in revolutions per minute.
        work_offsets: for each name (G54, ...) the (4, 4) pose of {C} in {M}.
        controller: settings of the controller, as in the machine file.
        strut_jerk: highest third rate of strut length, mm/s^3; infinite when no limit is stated.
        tip_jerk: highest third rate of the tool tip position, mm/s^3; infinite when no limit is stated.
        length_offset: (6,) joint distance of each strut minus the length its controller counts, mm.
        base_joint_kind: ``"universal"`` or ``"spherical"``.
        platform_joint_kind: ``"universal"`` or ``"spherical"``.
        base_axes: (6, 3) unit axes of the universal base joints that are fixed to the base, in {M}; zero if unstated.
        platform_axes: (6, 3) the same for the platform joints, fixed to the platform, in {T}; zero if unstated.
        screw_lead: nut travel per turn of the screw when only the joints keep the strut's halves from turning against
            each other, mm; negative for a left-hand screw, zero with a key.
        tube_radius: of the strut's outer part, fixed to its base joint; zero when strut bodies are not stated.
        tube_length: from the centre of the base joint along the strut.
        rod_radius: of the strut's inner part, fixed to its platform joint.
        rod_length: from the centre of the platform joint along the strut; more than the strut's length when the rod
            emerges behind the base joint.
        base_joint_radius: mm from the centre of a base joint within which contact is no collision.
        platform_joint_radius: the same around a platform joint.
        clearance: least distance between bodies, mm.
        bodies: cylinders that move with the platform.
        fixtures: fixed boxes.
        rest_tool_length: gauge length of the tool in the rest pose; also used at the home pose.
        home_axis: (3,) unit tool axis in {M} where a program starts.
        home_spin: spin where a program starts.
        spindle_least_speed: lowest spindle speed in revolutions per minute.
        strut_stiffness: stiffness of one strut with its joints, without the part that depends on the length, N/mm;
            None if not stated.
        strut_rigidity: Young's modulus times cross-section of the screw, N: a length l has the stiffness
            rigidity / l, in series with ``strut_stiffness``. Infinite when unstated.
        shortest_interval: between two points that the controller accepts, ms.
        block_rate: most points that the controller accepts in any second; infinite when no limit is stated.
        velocity_gain: (6,) of the position loop of each strut, 1/s: a strut lags by its speed over the gain; None if
            not stated.
        tool_change: tool-change pose; without one, None, tools are changed at the current pose.
        spin_up_time: of the spindle from rest to its highest speed, s; None if not stated.
        spin_down_time: from its highest speed to rest, s; None when equal to ``spin_up_time``.
        largest_tool_diameter: of the spindle, mm; infinite when no limit is stated.
        longest_tool: largest gauge length that the spindle accepts, mm; infinite when no limit is stated.
        machine_zero: (3,) tool tip in {M} at zero of the G53, G28 and G30 coordinates; None if not stated.
        left_out: unsupported codes of G-code to skip, such as "M21".
        optional_stops: treatment of M1: "written", "stop" or "leave-out".
        spindle_axis: the spindle as an axis, for threads; None if it cannot be one.
        tool_table: path of the tool table for part programs, with its unit after a comma; None if not stated.
    """

    name: str
    fingerprint: str
    base_joints: Array
    platform_joints: Array
    spindle_nose: float
    strut_stroke: tuple[float, float]
    strut_speed: float
    strut_acceleration: float
    base_rest: Array
    base_cone: Array
    platform_rest: Array
    platform_cone: Array
    characteristic_length: float
    least_singular_value: float
    home_tip: Array
    rapid_speed: float
    feed_speed: float
    tip_acceleration: float
    axis_speed: float
    spindle_speed: float
    work_offsets: dict[str, Array]
    controller: dict[str, Any]
    strut_jerk: float = math.inf
    tip_jerk: float = math.inf
    length_offset: Array = field(default_factory=lambda: np.zeros(6))
    base_joint_kind: str = "universal"
    platform_joint_kind: str = "spherical"
    base_axes: Array = field(default_factory=_no_axes)
    platform_axes: Array = field(default_factory=_no_axes)
    screw_lead: float = 0.0
    tube_radius: float = 0.0
    tube_length: float = 0.0
    rod_radius: float = 0.0
    rod_length: float = 0.0
    base_joint_radius: float = 0.0
    platform_joint_radius: float = 0.0
    clearance: float = 0.0
    bodies: tuple[Body, ...] = ()
    fixtures: tuple[Box, ...] = ()
    rest_tool_length: float = 0.0
    home_axis: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    home_spin: float = 0.0
    spindle_least_speed: float = 0.0
    strut_stiffness: float | None = None
    strut_rigidity: float = math.inf
    shortest_interval: int = 1
    block_rate: float = math.inf
    velocity_gain: Array | None = None
    tool_change: ToolChange | None = None
    spin_up_time: float | None = None
    spin_down_time: float | None = None
    largest_tool_diameter: float = math.inf
    longest_tool: float = math.inf
    machine_zero: Array | None = None
    left_out: tuple[str, ...] = ()
    tool_table: str | None = None
    optional_stops: str = "written"
    spindle_axis: SpindleAxis | None = None

    @property
    def functions(self) -> tuple[int, ...]:
        """Numbers of the M codes of part programs that map to a code of the controller."""
        named = self.controller.get("codes", {})
        return tuple(int(name[1:]) for name in named if name[0] == "M" and name[1:].isdecimal())

    @property
    def thread_codes(self) -> tuple[int, ...]:
        """Numbers of the M codes that switch the spindle to an axis, and back to speed control."""
        texts = [self.controller.get("codes", {}).get(name, "") for name in ("spindle_axis", "spindle_speed")]
        return tuple(int(text[1:]) for text in texts if text[:1] == "M" and text[1:].isdecimal())

    def __post_init__(self) -> None:
        for name in ("base_cone", "platform_cone"):
            object.__setattr__(self, name, np.broadcast_to(getattr(self, name), 6))
        six_points = (
            "base_joints", "platform_joints", "base_rest", "platform_rest", "base_axes", "platform_axes",
        )  # fmt: skip
        freeze(self, 6, dict.fromkeys(six_points, (np.float64, (3,))))
        freeze(self, 6, dict.fromkeys(("base_cone", "platform_cone", "length_offset"), (np.float64, ())))
        freeze(self, 3, {"home_tip": (np.float64, ()), "home_axis": (np.float64, ())})
