# SPDX-License-Identifier: LGPL-2.1-or-later
"""Set-up: commands that make axis values true strut lengths, loaded once by the controls engineer.

Enters: settings and the stroke of the struts in mm. Leaves: ASCII text of on-line commands, separate from the programs,
as a part program must not redefine the machine. Positions are in motor units from motor zero; a motor unit is one
count.
"""

from __future__ import annotations

import math

from pkm_post.writing.controllers.power_pmac.settings import PowerPmacSettings
from pkm_post.writing.controllers.pvt.axes import ROTARY_LETTERS, axis_definitions, check_stroke, stroke_counts
from pkm_post.writing.controllers.pvt.comment import comment_lines

_COMMENT = "//"


def setup_text(settings: PowerPmacSettings, machine_name: str, stroke: tuple[float, float]) -> str:
    """Write the set-up file of a machine.

        motor units = counts_per_mm * (strut length - zero_length)

    Args:
        settings: settings of the controller.
        machine_name: name of the machine, for the comment on top.
        stroke: shortest and longest length of a strut, mm.

    Raises:
        ValueError: the stroke is not two increasing lengths.
    """
    check_stroke(stroke)
    lines = [
        *comment_lines(f"Set-up of {machine_name}", settings.line_limit, _COMMENT),
        "// Strut i is motor i. Axis values are joint-to-joint strut lengths in mm, speeds are in mm/s.",
        f"&{settings.coordinate_system} // the coordinate system that runs the program",
        "// #motor->SCALE LETTER OFFSET: motor units = SCALE * strut length + OFFSET",
        *axis_definitions(settings),
        *_coordinate_system_lines(settings),
        *_motor_lines(settings, stroke),
    ]
    return "\n".join(lines) + "\n"


def _coordinate_system_lines(settings: PowerPmacSettings) -> list[str]:
    system = f"Coord[{settings.coordinate_system}]"
    rollover = [
        f"{system}.PosRollover[{ROTARY_LETTERS.index(letter)}]=0 // {letter} is a length here, not an angle"
        for letter in settings.letters
        if letter in ROTARY_LETTERS
    ]
    return [
        f"{system}.FeedTime=1000 // speeds are per 1000 ms, so mm/s",
        f"{system}.SegMoveTime=0 // no segmentation: each interval is one cubic",
        *rollover,
    ]


def _motor_lines(settings: PowerPmacSettings, stroke: tuple[float, float]) -> list[str]:
    lines = ["// Soft limits: the stroke in motor units. They act while the higher one is above the lower one"]
    for motor, (low, high) in enumerate(stroke_counts(settings, stroke), start=1):
        lines.append(f"Motor[{motor}].MaxPos={math.floor(high)} // strut {motor}")
        lines.append(f"Motor[{motor}].MinPos={math.ceil(low)} // strut {motor}")
    return lines
