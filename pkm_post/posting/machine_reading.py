# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine reading: reading options from a machine file, in the work frame of a post.

Input: the machine, the chosen work offset, and the reading options of the user, which take precedence. Output: reading
options with the zero of the machine, its other work offsets, its functions, the codes to skip and the tool table.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np

from pkm_post.model import Array, Machine
from pkm_post.options import Options
from pkm_post.reading import ReadingOptions

_OF_GCODE = re.compile(r"G5[4-9]|G59\.[123]")
_EXACT = 1e-12


def with_machine(reading: ReadingOptions, machine: Machine, options: Options) -> ReadingOptions:
    """Complete the reading options of the user from the machine file.

    Args:
        reading: as given by the user.
        machine: with its work offsets in {M}.
        options: with the chosen work offset.
    """
    name = options.work_offset
    pose = machine.work_offsets.get(name) if isinstance(name, str) else name
    reading = replace(
        reading,
        left_out=tuple(dict.fromkeys((*reading.left_out, *machine.left_out))),
        functions=machine.functions,
        spindle_axis=machine.spindle_axis is not None,
        tool_table=reading.tool_table or machine.tool_table,
    )
    if pose is None:  # posting refuses an unknown name
        return reading
    return replace(
        reading,
        machine_zero=reading.machine_zero or _zero(machine, pose),
        machine_offsets=_others(machine, pose) if isinstance(name, str) and _OF_GCODE.fullmatch(name) else {},
    )


def _zero(machine: Machine, pose: Array) -> tuple[float, float, float] | None:
    """The zero of the machine in {C}; None unless the axes are parallel to {M}."""
    if machine.machine_zero is None or np.abs(pose[:3, :3] - np.eye(3)).max() > _EXACT:
        return None
    x, y, z = (machine.machine_zero - pose[:3, 3]).tolist()
    return x, y, z


def _others(machine: Machine, pose: Array) -> dict[str, tuple[float, float, float, float]]:
    """Work offsets rotated from the chosen one about z only: origins in mm and rotations in degrees."""
    found = {}
    for name, other in machine.work_offsets.items():
        relative = np.linalg.inv(pose) @ other
        if _OF_GCODE.fullmatch(name) and abs(relative[2, 2] - 1) < _EXACT:
            x, y, z = relative[:3, 3].tolist()
            found[name] = x, y, z, math.degrees(math.atan2(relative[1, 0], relative[0, 0]))
    return found
