# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments: the table of user options, and the parsed values as options in mm and rad.

Input: an argparse parser, which gets the arguments. Output: ``Options``. No degrees beyond this module.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from pkm_post.options.argument_types import above_zero, between, number, numbered, offset, tool_length
from pkm_post.options.layers import NOTHING, add_noted

if TYPE_CHECKING:
    from pkm_post.machine import Policy
    from pkm_post.model import Tolerances, Tool
    from pkm_post.options.choices import Options
    from pkm_post.reading import Reading
    from pkm_post.toolpath import SurfaceSpeed

FIXTURE_OF_THE_JOB = "job"
"""Name of the work offset that stands for the fixture of the CAM job."""
READING = "reading"
"""Name of the progress step before those of the pipeline."""

Pose = tuple[float, float, float, float]


def _work_offset(text: str) -> str | Pose:
    """A name, or x, y, z in mm and the rotation about z in degrees."""
    words = text.split(",")
    if len(words) == 1:
        return text
    if len(words) not in (3, 4):
        raise argparse.ArgumentTypeError(f"expected X,Y,Z or X,Y,Z,DEG, got {text!r}")
    x, y, z = map(offset, words[:3])
    return x, y, z, number(words[3]) if words[3:] else 0.0


def _sizes(text: str) -> tuple[float, float | None]:
    """Diameter and corner radius, None if omitted."""
    word, comma, corner = text.partition(",")
    diameter = tool_length(word)
    return diameter, between(0, diameter / 2)(corner) if comma else None


_SPINS = {
    "zero": "",
    "file": "",
    "x-in-plane": "DEG",
    "y-in-plane": "DEG",
    "optimise": "OBJECTIVE",
}
"""Spin rules by name, each with its operand after ``=``."""
_OBJECTIVES = ("stroke", "joints", "singular", "weighted")
HEADED = tuple(rule for rule, value in _SPINS.items() if value == "DEG")
"""Rules that need a heading."""
SPIN_WORDS = (*(rule for rule in _SPINS if _SPINS[rule] != "OBJECTIVE"), *(f"optimise={one}" for one in _OBJECTIVES))
"""All choices for the spin, without headings."""


def _spin(text: str) -> tuple[str, float, str]:
    """Rule, heading in degrees and objective."""
    rule, given, value = text.partition("=")
    if rule not in _SPINS or (given and not _SPINS[rule]):
        raise argparse.ArgumentTypeError(f"expected one of {_spin_words()}, got {text!r}")
    if _SPINS[rule] == "DEG":
        return rule, number(value) if given else 0.0, _OBJECTIVES[0]
    if given and value not in _OBJECTIVES:
        raise argparse.ArgumentTypeError(f"expected one of {', '.join(_OBJECTIVES)} after =, got {value!r}")
    return rule, 0.0, value or _OBJECTIVES[0]


ALSO = ("csv", "halstreamer", "linuxcnc")
"""Optional files beside the program: two tables of the strut motion, and G-code for LinuxCNC's hexapod."""


def _also(text: str) -> tuple[str, ...]:
    """Distinct names; the word for nothing cancels a job's choice."""
    chosen = text.split(",") if text != NOTHING else []
    if not set(chosen) <= set(ALSO):
        raise argparse.ArgumentTypeError(f"expected names out of {', '.join(ALSO)}, got {text!r}")
    return tuple(name for name in ALSO if name in chosen)


CL_DIALECTS = ("nx", "creo", "catia", "solidworks", "makino", "apt")
"""Sources of CL data, as in ``cldata.DIALECTS``."""
CYCLE_VALUES = ("depth", "feed", "clearance", "return", "step", "dwell")
"""Meanings of a cycle's numbers, as in ``cldata.CYCLE_VALUES``."""


def _cycle_values(text: str) -> tuple[str, ...]:
    """Distinct names, in their order."""
    chosen = tuple(text.split(","))
    if not set(chosen) <= set(CYCLE_VALUES) or len(set(chosen)) < len(chosen):
        raise argparse.ArgumentTypeError(f"expected different names out of {', '.join(CYCLE_VALUES)}, got {text!r}")
    return chosen


def _surface_speed_or_none(text: str) -> float | None:
    return None if text == NOTHING else above_zero(100_000)(text)


def _fixture(file: str) -> tuple[str, str]:
    """A file with its own name: named in two layers of options, it counts once."""
    return file, file


def _spin_words() -> str:
    return ", ".join(rule + (f"[={value}]" if value else "") for rule, value in _SPINS.items())


_ARGUMENTS: dict[str, dict[str, Any]] = {
    "--machine": {
        "metavar": "NAME_OR_FILE",
        "default": "example_6tps",
        "help": "machine that comes with PKM Post, or path of a machine file (default: %(default)s)",
    },
    "--work-offset": {
        "metavar": "NAME_OR_POSE",
        "type": _work_offset,
        "default": FIXTURE_OF_THE_JOB,
        "help": "work offset of the machine file, or X,Y,Z[,DEG] in mm with a turn about z, as in "
        "--work-offset=-10,0,150,90 (default: the fixture of the CAM job)",
    },
    "--tip-tolerance": {
        "metavar": "MM",
        "type": between(1e-6, 100),
        "default": 0.001,
        "help": "how far the tool tip may be from the programmed path (default: %(default)s)",
    },
    "--axis-tolerance": {
        "metavar": "DEG",
        "type": between(1e-6, 45),
        "default": 0.001,
        "help": "how far the tool axis may be from the programmed axis (default: %(default)s)",
    },
    "--tool-length": {
        "metavar": "NUMBER=MM",
        "type": numbered(tool_length, "NUMBER=MM"),
        "action": "append",
        "default": [],
        "help": "gauge length of a tool, instead of the GaugeLength of its tool controller; may be repeated",
    },
    "--corners": {
        "choices": ("chord", "arc"),
        "default": "chord",
        "help": "what goes round outer corners in 2D cutter compensation (default: %(default)s)",
    },
    "--leads": {
        "choices": ("A", "B"),
        "default": "A",
        "help": "how 2D cutter compensation begins and ends: A straight to the contour, B round outer corners"
        " (default: %(default)s)",
    },
    "--swallowed": {
        "choices": ("refuse", "remove"),
        "default": "refuse",
        "help": "what becomes of blocks that the tool is too large for (default: %(default)s)",
    },
    "--tool": {
        "dest": "tools",
        "metavar": "NUMBER=D[,R]",
        "type": numbered(_sizes, "NUMBER=D[,R]"),
        "action": "append",
        "default": [],
        "help": "diameter and corner radius in mm of the cutter a part program was made for, instead of those that it"
        " states: G41 and G42 need the diameter, --actual-tool both; may be repeated",
    },
    "--actual-tool": {
        "metavar": "NUMBER=D[,R]",
        "type": numbered(_sizes, "NUMBER=D[,R]"),
        "action": "append",
        "default": [],
        "help": "diameter and corner radius in mm of the cutter in the spindle, where it is not the one that a program"
        " with surface normals was made for; may be repeated",
    },
    "--unit": {
        "choices": ("mm", "inch"),
        "help": "unit of length of a part program: of CL data whatever it says itself, of G-code before G20 or G21",
    },
    "--contour-data": {
        "choices": ("centre", "contour"),
        "help": "what the points of CL data under CUTCOM are: the centre of the tool, which wear alone offsets, or the"
        " contour of the part (default: as the file says)",
    },
    "--wear": {
        "metavar": "NUMBER=MM",
        "type": numbered(between(-100, 100), "NUMBER=MM"),
        "action": "append",
        "default": [],
        "help": "by how much a tool is larger in radius than the one CL data with CUTCOM was made for, below 0 for a"
        " worn one; may be repeated",
    },
    "--cl-dialect": {
        "choices": CL_DIALECTS,
        "help": "the CAM system that wrote CL data (default: the one whose words it has)",
    },
    "--cycle-values": {
        "metavar": "NAMES",
        "type": _cycle_values,
        "default": (),
        "help": "what the numbers of CYCLE statements of CL data are where they have no words, in order and joined by"
        f" commas: {', '.join(CYCLE_VALUES)}",
    },
    "--allow-open-end": {
        "action": "store_true",
        "help": "take a part program without an end (M2, M30 or %% of G-code, FINI or END-OF-PATH of CL data), although"
        " it may have been cut short; --no-allow-open-end takes it back",
    },
    "--surface-speed": {
        "metavar": "M/MIN",
        "type": _surface_speed_or_none,
        "default": None,
        "help": "speed of the cutting edge over the work: each cut gets its own spindle speed; none leaves the spindle"
        " as programmed, the default",
    },
    "--keep-chip-load": {
        "action": "store_true",
        "help": "change feeds as the spindle speed changes with --surface-speed; --no-keep-chip-load takes it back",
    },
    "--part": {
        "metavar": "FILE",
        "help": "STL or STEP file of the finished part, mm in the work frame: holder, spindle, struts, shanks and rapid"
        " moves are checked against it, or none (default: the models of the CAM job)",
    },
    "--stock": {
        "metavar": "FILE",
        "help": "STL or STEP file of the stock as it is before the first operation, likewise, or none (default: the"
        " stock of the CAM job)",
    },
    "--fixture": {
        "metavar": "FILE",
        "type": _fixture,
        "default": [],
        "help": "STL or STEP file of a clamp or vice, mm in the work frame, which nothing may touch; may be repeated",
    },
    "--spin": {
        "metavar": "RULE",
        "type": _spin,
        "default": "zero",
        "help": f"how the platform turns about the tool axis: {_spin_words()}; DEG is where its x axis points when the"
        f" tool is upright, OBJECTIVE one of {', '.join(_OBJECTIVES)} (default: zero, the shortest rotation from"
        " upright)",
    },
    "--also": {
        "metavar": "NAMES",
        "type": _also,
        "default": (),
        "help": f"what to write beside the program, joined by commas: {', '.join(ALSO)}; or {NOTHING}, the default",
    },
}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the arguments common to all entry points of PKM Post."""
    _add(parser, _ARGUMENTS)


def add_machine(parser: argparse.ArgumentParser) -> None:
    """Add the machine argument."""
    _add(parser, ("--machine",))


def add_part_program(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for what a part program does not state itself."""
    _add(
        parser,
        ("--tool", "--unit", "--contour-data", "--wear", "--cl-dialect", "--cycle-values", "--allow-open-end"),
    )


def _add(parser: argparse.ArgumentParser, flags: Iterable[str]) -> None:
    for flag in flags:
        add_noted(parser, flag, **_ARGUMENTS[flag])


def tolerances_from(namespace: argparse.Namespace) -> Tolerances:
    """The tolerances of a parsed command line, in mm and rad."""
    from pkm_post.model import Tolerances

    return Tolerances(namespace.tip_tolerance, math.radians(namespace.axis_tolerance))


def options_from(namespace: argparse.Namespace) -> Options:
    """The options of a parsed command line, in mm and rad."""
    from pkm_post.options.choices import MeshFiles, Options
    from pkm_post.toolpath import OffsetOptions

    offset, tolerances = namespace.work_offset, tolerances_from(namespace)
    return Options(
        work_offset=offset if isinstance(offset, str) else _pose(*offset),
        tip_tolerance=tolerances.tip,
        axis_tolerance=tolerances.axis,
        spin=_policy(*namespace.spin),
        contours=OffsetOptions(namespace.corners, namespace.leads, namespace.swallowed),
        surface_speed=_surface_speed(namespace.surface_speed, namespace.keep_chip_load),
        also=namespace.also,
        actual_tools=_cutters(namespace.actual_tool),
        mesh_files=MeshFiles(namespace.part, namespace.stock, tuple(dict(namespace.fixture).values())),
    )


def solid_files(namespace: argparse.Namespace) -> list[str]:
    """Files of part, stock and fixtures."""
    named = [namespace.part, namespace.stock, *dict(namespace.fixture).values()]
    return [file for file in named if file is not None]


def part_program_from(namespace: argparse.Namespace, axis_words: str) -> Reading:
    """Reading options of a part program, beside the tool axis notation of its G-code."""
    from pkm_post.reading import Reading

    return Reading(
        axis_words,
        tools_from(namespace),
        namespace.unit,
        namespace.contour_data,
        dict(namespace.wear),
        namespace.cl_dialect,
        namespace.cycle_values,
        allow_open_end=namespace.allow_open_end,
    )


def tools_from(namespace: argparse.Namespace) -> dict[int, Tool]:
    """Cutters of a part program by tool number; the last of several for one tool."""
    return _cutters(namespace.tools)


def _cutters(sizes: Iterable[tuple[int, tuple[float, float | None]]]) -> dict[int, Tool]:
    """Tools defined by diameter and corner radius only, mm."""
    from pkm_post.model import Tool

    return {
        tool: Tool(tool, "", diameter, corner or 0.0, 0.0, corner_known=corner is not None)
        for tool, (diameter, corner) in sizes
    }


def tool_lengths_from(namespace: argparse.Namespace) -> dict[int, float]:
    """Gauge lengths by tool number, mm; the last of several for one tool."""
    return dict(namespace.tool_length)


def _pose(x: float, y: float, z: float, turn_deg: float) -> Any:
    """The (4, 4) pose of {C} in {M}: an origin and a rotation about z."""
    from pkm_post.toolpath import rotation

    pose = rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.radians(turn_deg))
    pose[:3, 3] = x, y, z
    return pose


def _surface_speed(metres_per_minute: float | None, keep_chip_load: bool) -> SurfaceSpeed | None:
    from pkm_post.toolpath import SurfaceSpeed

    return None if metres_per_minute is None else SurfaceSpeed(metres_per_minute * 1000 / 60, keep_chip_load)


def _policy(rule: str, heading_deg: float, objective: str) -> Policy:
    from pkm_post.machine import Policy, Rule

    return Policy(Rule(rule), heading=math.radians(heading_deg), objective=objective)
