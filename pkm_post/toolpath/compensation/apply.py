# SPDX-License-Identifier: LGPL-2.1-or-later
"""Apply: all compensation that a program asks for, with the cutters that are in the spindle.

Takes a program as read; returns one whose tips are where the tool has to go. Compensation precedes symmetry and
placement: a mirror would swap left and right.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pkm_post.model import Diagnostic, Place, Program, Tool
from pkm_post.toolpath.compensation.known_cutter import known_cutter
from pkm_post.toolpath.compensation.options import OffsetOptions
from pkm_post.toolpath.compensation.side import offset_contours
from pkm_post.toolpath.compensation.tips import compensate_tips


def compensate(
    program: Program, contours: OffsetOptions, actual: Mapping[int, Tool]
) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """Offset contours in 2D and move tips along their surface normals in 3D.

    Args:
        program: with side offsets, normals, or neither.
        contours: how contours are offset.
        actual: by number, the tools whose cutters differ from those the program was made for.
    """
    told: tuple[Diagnostic, ...] = ()
    moved, faults = offset_contours(program, contours)
    told += faults
    for number, tool in sorted(actual.items()):
        if moved is None:
            break
        moved, faults = _for_cutter(moved, number, tool)
        told += faults
    return moved, told


def _for_cutter(program: Program, number: int, actual: Tool) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    place = Place(program.source)
    if number not in program.tools:
        known = ", ".join(f"T{known}" for known in sorted(program.tools))
        return None, (Diagnostic("N118", place, f"T{number}, the program has {known}"),)
    tool = program.tools[number]
    nominal, faults = known_cutter(tool, place)
    ground, more = known_cutter(actual, place)
    if nominal is None or ground is None:
        return None, (*faults, *more)
    moved, told = compensate_tips(program, nominal, ground, number if len(program.tools) > 1 else None)
    if moved is None:
        return None, told
    ground_tool = replace(actual, number=number, name=tool.name, length=tool.length)
    return replace(moved, tools=program.tools | {number: ground_tool}), told
