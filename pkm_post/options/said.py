# SPDX-License-Identifier: LGPL-2.1-or-later
"""Said: options in mm and rad as they would be typed, to compare them with those of a job.

The inverse of ``options_from``. Input: ``Options``. Output: values as from argparse.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pkm_post.options.layers import Given

if TYPE_CHECKING:
    from pkm_post.model import Tool
    from pkm_post.options.choices import Options


def said_by(options: Options) -> Given:
    """Values of all options, defaults included, by attribute name."""
    speed = options.surface_speed
    return {
        "work_offset": _offset(options.work_offset),
        "tip_tolerance": options.tip_tolerance,
        "axis_tolerance": math.degrees(options.axis_tolerance),
        "spin": (options.spin.rule.value, math.degrees(options.spin.heading), options.spin.objective),
        "corners": options.contours.corners,
        "leads": options.contours.leads,
        "swallowed": options.contours.swallowed,
        "actual_tool": [(number, _sizes(tool)) for number, tool in options.actual_tools.items()],
        "surface_speed": None if speed is None else speed.speed * 60 / 1000,
        "keep_chip_load": speed is not None and speed.keep_chip_load,
        "also": options.also,
        "part": options.mesh_files.part,
        "stock": options.mesh_files.stock,
        "fixture": [(file, file) for file in options.mesh_files.fixtures],
    }


def _sizes(tool: Tool) -> tuple[float, float | None]:
    return tool.diameter, tool.corner_radius if tool.corner_known else None


def _offset(offset: Any) -> Any:
    """A name; x, y, z and the rotation in degrees; or a full matrix that rotates about more than z."""
    if isinstance(offset, str):
        return offset
    if offset[2, 2] < 1.0:
        return tuple(float(value) for value in offset[:3].ravel())
    return (*(float(value) for value in offset[:3, 3]), math.degrees(math.atan2(offset[1, 0], offset[0, 0])))
