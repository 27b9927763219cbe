# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conversion: parsed arguments to options in mm and rad, and options back to the values of arguments.

The command line imports this module in a Python without NumPy: functions import modules that need NumPy.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from pkm_post.options.argument_types import LONGEST_TOOL
from pkm_post.options.layers import ArgumentValues

if TYPE_CHECKING:
    from pkm_post.machine import SpinPolicy
    from pkm_post.model import Diagnostics, Place, Tolerances, Tool
    from pkm_post.options.choices import Options
    from pkm_post.reading import ReadingOptions
    from pkm_post.toolpath import StartLine, SurfaceSpeed


def options_from(namespace: argparse.Namespace) -> Options:
    """The options of a parsed command line, in mm and rad."""
    from pkm_post.options.choices import MeshFiles, Options
    from pkm_post.toolpath import Copies, OffsetOptions

    offset, tolerances = namespace.work_offset, tolerances_from(namespace)
    return Options(
        work_offset=offset if isinstance(offset, str) else _pose(*offset),
        tip_tolerance=tolerances.tip,
        axis_tolerance=tolerances.axis,
        spin=_policy(*namespace.spin),
        contours=OffsetOptions(namespace.corners, namespace.leads, namespace.swallowed),
        copies=Copies(tuple(map(_move, namespace.copies)), namespace.keep_climb),
        surface_speed=_surface_speed(namespace.surface_speed, namespace.keep_chip_load),
        optional_stops=namespace.optional_stops,
        side=namespace.side,
        from_line=_start_line(namespace.from_line, namespace.repeat_codes),
        also=namespace.also,
        report_unit=namespace.report_unit,
        report_date=namespace.report_date,
        actual_tools=_cutters(namespace.actual_tool),
        mesh_files=MeshFiles(namespace.part, namespace.stock, tuple(dict(namespace.fixture).values())),
    )


def tolerances_from(namespace: argparse.Namespace) -> Tolerances:
    """The tolerances of a parsed command line, in mm and rad."""
    from pkm_post.model import Tolerances

    return Tolerances(namespace.tip_tolerance, math.radians(namespace.axis_tolerance))


def _pose(x: float, y: float, z: float, turn_deg: float) -> Any:
    """The (4, 4) pose of {C} in {M}: an origin and a rotation about z."""
    from pkm_post.toolpath import rotation

    pose = rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.radians(turn_deg))
    pose[:3, 3] = x, y, z
    return pose


def _policy(rule: str, heading_deg: float, objective: str) -> SpinPolicy:
    from pkm_post.machine import SpinPolicy, SpinRule

    return SpinPolicy(SpinRule(rule), heading=math.radians(heading_deg), objective=objective)


def _move(move: str | float) -> str | float:
    """A mirror plane, or an angle in rad."""
    return move if isinstance(move, str) else math.radians(move)


def _surface_speed(metres_per_minute: float | None, keep_chip_load: bool) -> SurfaceSpeed | None:
    if metres_per_minute is None:
        return None
    from pkm_post.toolpath import SurfaceSpeed

    return SurfaceSpeed(metres_per_minute * 1000 / 60, keep_chip_load)


def _start_line(start: tuple[int, str] | None, repeat_codes: bool) -> StartLine | None:
    if start is None:
        return None
    from pkm_post.toolpath import StartLine

    return StartLine(*start, repeat_codes)


def _cutters(sizes: Iterable[tuple[int, tuple[float, float | None]]]) -> dict[int, Tool]:
    """Tools defined by diameter and corner radius only, mm."""
    from pkm_post.model import Tool

    return {
        tool: Tool(tool, "", diameter, corner or 0.0, 0.0, corner_known=corner is not None)
        for tool, (diameter, corner) in sizes
    }


def part_program_from(namespace: argparse.Namespace, axis_words: str) -> ReadingOptions:
    """Reading options of a part program, without the tool axis notation of its G-code."""
    from pkm_post.reading import ReadingOptions

    return ReadingOptions(
        axis_words,
        tools_from(namespace),
        namespace.unit,
        namespace.contour_data,
        dict(namespace.wear),
        namespace.cl_dialect,
        namespace.cycle_values,
        cycle_kinds=dict(namespace.cycle_kinds),
        allow_open_end=namespace.allow_open_end,
        flavour=namespace.flavour,
        machine_zero=namespace.machine_zero,
        left_out=namespace.leave_out,
        work_offsets=dict(namespace.origin),
        subprograms=tuple(dict(namespace.subprograms).values()),
        block_delete=namespace.block_delete,
        delete_switches=namespace.delete_switches,
        tool_table=namespace.tool_table,
        goto_values=namespace.goto_values,
        feed=None if namespace.feed is None else namespace.feed / 60,
    )


def tools_from(namespace: argparse.Namespace) -> dict[int, Tool]:
    """Cutters of a part program by tool number; the last value for a tool counts."""
    return _cutters(namespace.tools)


def tool_lengths_from(namespace: argparse.Namespace) -> dict[int, float]:
    """Gauge lengths by tool number, mm; the last value for a tool counts."""
    return dict(namespace.tool_length)


def gauge_length_faults(number: int, length: float, place: Place) -> Diagnostics:
    """J113 for a tool whose gauge length, mm, is unknown or above ``LONGEST_TOOL``; nothing for any other."""
    from pkm_post.model import Amount, Diagnostic, Phrase

    if 0.0 < length <= LONGEST_TOOL:
        return ()
    most = Amount(LONGEST_TOOL, "mm", "g")
    found = Phrase("T{}, {} is more than {}", number, Amount(length, "mm"), most) if length > 0.0 else f"T{number}"
    return (Diagnostic("J113", place, found),)


def solid_files(namespace: argparse.Namespace) -> list[str]:
    """Files of part, stock and fixtures."""
    named = [namespace.part, namespace.stock, *dict(namespace.fixture).values()]
    return [file for file in named if file is not None]


def argument_values(options: Options) -> ArgumentValues:
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
        "copies": tuple(move if isinstance(move, str) else math.degrees(move) for move in options.copies.moves),
        "keep_climb": options.copies.keep_climb,
        "surface_speed": None if speed is None else speed.speed * 60 / 1000,
        "keep_chip_load": speed is not None and speed.keep_chip_load,
        "optional_stops": options.optional_stops,
        "side": options.side,
        "from_line": None if options.from_line is None else (options.from_line.line, options.from_line.operation),
        "repeat_codes": options.from_line is not None and options.from_line.repeat_codes,
        "also": options.also,
        "report_unit": options.report_unit,
        "report_date": options.report_date,
        "part": options.mesh_files.part,
        "stock": options.mesh_files.stock,
        "fixture": [(file, file) for file in options.mesh_files.fixtures],
    }


def _offset(offset: Any) -> Any:
    """A name; x, y, z and the rotation in degrees; or a full matrix that rotates about more than z."""
    if isinstance(offset, str):
        return offset
    if offset[2, 2] < 1.0:
        return tuple(float(value) for value in offset[:3].ravel())
    return (*(float(value) for value in offset[:3, 3]), math.degrees(math.atan2(offset[1, 0], offset[0, 0])))


def _sizes(tool: Tool) -> tuple[float, float | None]:
    return tool.diameter, tool.corner_radius if tool.corner_known else None
