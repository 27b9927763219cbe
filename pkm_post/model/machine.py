# SPDX-License-Identifier: LGPL-2.1-or-later
"""The 6-TPS machine: its geometry and limits, as a machine file states them.

Frames: {M} machine, z up, fixed to the table; {T} platform, origin in the plane its joints are given in, z along the
tool axis from the tip towards the spindle. Units: mm, rad, s.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pkm_post.model.columns import freeze

Array = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Machine:
    """A hexapod of six telescopic struts; strut i joins base joint i to platform joint i.

    Attributes:
        name: name of the machine file.
        fingerprint: SHA-256 of the machine file, hexadecimal; it ties outputs to the machine they were made for.
        base_joints: (6, 3) joint centres in {M}.
        platform_joints: (6, 3) joint centres in {T}.
        spindle_nose: distance from the {T} origin along -z to the spindle nose, where gauge lengths begin.
        strut_stroke: shortest and longest joint-to-joint length of a strut.
        strut_speed: highest rate of strut length, mm/s.
        strut_acceleration: highest second rate of strut length, mm/s^2.
        base_rest: (6, 3) unit rest axes of the base joints in {M}, from the base towards the platform.
        base_cone: half angle each base joint may swing from its rest axis.
        platform_rest: (6, 3) unit rest axes of the platform joints in {T}, from the platform towards the base.
        platform_cone: half angle each platform joint may swing from its rest axis.
        characteristic_length: divides the rotation columns of the Jacobian so that all its entries are plain numbers.
        least_singular_value: the path may not come nearer to a singular pose than this, dimensionless.
        home_tip: (3,) tool tip in {M} where a program starts, with the tool axis vertical.
        rapid_speed: tool-tip speed of rapid moves, mm/s.
        feed_speed: highest tool-tip speed of cutting moves, mm/s.
        tip_acceleration: highest acceleration of the tool tip, mm/s^2.
        axis_speed: highest turning rate of the tool axis, rad/s.
        spindle_speed: highest spindle speed in revolutions per minute.
        work_offsets: for each name (G54, ...) the (4, 4) pose of {C} in {M}.
        controller: settings of the controller, as the machine file has them.
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
    base_cone: float
    platform_rest: Array
    platform_cone: float
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

    def __post_init__(self) -> None:
        six_points = ("base_joints", "platform_joints", "base_rest", "platform_rest")
        freeze(self, 6, {name: (np.float64, (3,)) for name in six_points})
        freeze(self, 3, {"home_tip": (np.float64, ())})
