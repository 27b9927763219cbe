# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments: the table of user options, for the command line and for one text as in jobs and macros.

Input: an argparse parser, which gets the arguments, or a text quoted as in a shell. Output: parsed arguments, in the
units of the user: mm, degrees, m/min. ``conversion`` makes options of them.
"""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Iterable
from typing import Any, NoReturn

from pkm_post.options.argument_types import above_zero, between, number, numbered, offset, tool_length, validated
from pkm_post.options.layers import NOTHING, add_recorded
from pkm_post.system import result_files

SIDE_OUTPUTS = tuple(result_files.SIDE_OUTPUTS)
"""Names of the optional files, in the order in which they are written."""
FIXTURE_OF_THE_JOB = "job"
"""Name of the work offset that stands for the fixture of the CAM job."""
READING_STEP = "reading"
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
RULES_WITH_HEADING = tuple(rule for rule, value in _SPINS.items() if value == "DEG")
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


def _also(text: str) -> tuple[str, ...]:
    """Distinct names; the word for nothing cancels a job's choice."""
    chosen = text.split(",") if text != NOTHING else []
    if not set(chosen) <= set(SIDE_OUTPUTS):
        raise argparse.ArgumentTypeError(f"expected names out of {', '.join(SIDE_OUTPUTS)}, got {text!r}")
    return tuple(name for name in SIDE_OUTPUTS if name in chosen)


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


GOTO_VALUES = (("x", "y", "z"), ("i", "j", "k"), ("nx", "ny", "nz"), ("px", "py", "pz"))
"""Meanings of the values of a GOTO, as in ``cldata.GOTO_VALUES``."""


def _goto_values(text: str) -> tuple[str, ...]:
    """Distinct names of whole vectors, x, y and z among them."""
    chosen = tuple(text.split(","))
    whole = [each for each in GOTO_VALUES if set(each) & set(chosen)]
    if len(set(chosen)) < len(chosen) or {*chosen} != {name for each in whole for name in each} or "x" not in chosen:
        names = "; ".join(",".join(each) for each in GOTO_VALUES)
        raise argparse.ArgumentTypeError(f"expected x,y,z and others of {names}, in any order, got {text!r}")
    return chosen


MIRRORS = ("xy", "xz", "yz")
"""Names of mirror planes, as in ``toolpath.MIRRORS``."""


def _copies(text: str) -> tuple[str | float, ...]:
    """Mirror planes and angles in degrees, in order; the word for nothing cancels a job's choice."""
    words = text.split(",") if text != NOTHING else []
    return tuple(word if word in MIRRORS else _copy_angle(word) for word in words)


_copy_angle = validated(number, lambda angle: 0 < abs(angle) < 360, "xy, xz, yz or an angle within 360 degrees")


GCODE_FLAVOURS = ("rs274", "fanuc")
"""Whose G-code it is, as in ``gcode.FLAVOUR_NAMES``."""
_CODE = re.compile(r"[GM]\d{1,4}(\.\d)?", re.IGNORECASE)


def _codes(text: str) -> tuple[str, ...]:
    """Codes without leading zeros, in upper case."""
    words = text.split(",")
    if not all(map(_CODE.fullmatch, words)):
        raise argparse.ArgumentTypeError(f"expected G and M codes such as M21,G187, got {text!r}")
    return tuple(f"{word[0].upper()}{float(word[1:]):g}" for word in words)


def _point(text: str) -> tuple[float, float, float]:
    """X, Y and Z in mm."""
    words = text.split(",")
    if len(words) != 3:
        raise argparse.ArgumentTypeError(f"expected X,Y,Z, got {text!r}")
    x, y, z = map(offset, words)
    return x, y, z


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
    "--feed": {
        "metavar": "MM/MIN",
        "type": above_zero(1_000_000),
        "help": "feed of the cutting moves of a part program before the first feed that it states (default: they are"
        " refused)",
    },
    "--flavour": {
        "choices": GCODE_FLAVOURS,
        "help": "whose G-code a part program is: rs274, that of LinuxCNC, or fanuc, that of controls of Fanuc's kind"
        " (default: the one whose codes it has; the report says which and why)",
    },
    "--machine-zero": {
        "metavar": "X,Y,Z",
        "type": _point,
        "help": "where G-code brings the tool tip with G53 X0 Y0 Z0, and with G28 and G30: mm in the work frame",
    },
    "--leave-out": {
        "metavar": "CODES",
        "type": _codes,
        "default": (),
        "help": "G and M codes of G-code that do not move the tool and are not known here, such as M21,G187: left out"
        " with their words, and named in the report",
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
    "--goto-values": {
        "metavar": "NAMES",
        "type": _goto_values,
        "default": (),
        "help": "what the values of those GOTO statements of CL data are that have as many: x,y,z the tool tip, i,j,k"
        " the tool axis, nx,ny,nz the surface normal, px,py,pz the contact point, in the order of the file",
    },
    "--allow-open-end": {
        "action": "store_true",
        "help": "take a part program without an end (M2, M30 or %% of G-code, FINI or END-OF-PATH of CL data), although"
        " it may have been cut short; --no-allow-open-end takes it back",
    },
    "--copies": {
        "metavar": "LIST",
        "type": _copies,
        "default": (),
        "help": "copies that follow the program, joined by commas: xy, xz or yz is the mirror image in that plane of"
        " the work frame, a number the rotation about z in degrees, as in xz,yz,180; none is the default",
    },
    "--keep-climb": {
        "action": "store_true",
        "help": "reverse each pass of the mirror images of --copies, to keep climb milling; --no-keep-climb takes it"
        " back",
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
        "help": f"what to write beside the program, joined by commas: {', '.join(SIDE_OUTPUTS)}; or {NOTHING},"
        " the default",
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
        (
            "--tool",
            "--unit",
            "--feed",
            "--flavour",
            "--machine-zero",
            "--leave-out",
            "--contour-data",
            "--wear",
            "--cl-dialect",
            "--cycle-values",
            "--goto-values",
            "--allow-open-end",
        ),
    )


def _add(parser: argparse.ArgumentParser, flags: Iterable[str]) -> None:
    for flag in flags:
        add_recorded(parser, flag, **_ARGUMENTS[flag])


class TextParser(argparse.ArgumentParser):
    """Raise a ``ValueError`` where a program of its own would print its usage and exit."""

    def error(self, message: str) -> NoReturn:
        """Handle a parse error of argparse."""
        raise ValueError(message)


def text_parser(name: str = "options", description: str = "") -> TextParser:
    """Parser of the common options, without abbreviations and built-in help."""
    parser = TextParser(prog=name, description=description, add_help=False, allow_abbrev=False, usage=argparse.SUPPRESS)
    vars(parser)["color"] = False  # Python 3.14 would colour the help on a terminal
    add_options(parser)
    return parser


def parse_text(text: str, parser: TextParser | None = None) -> argparse.Namespace:
    """Parse options from a text; the others have their defaults.

    Raises:
        ValueError: the text is invalid.
    """
    try:
        return (parser or text_parser()).parse_args(shlex.split(text))
    except ValueError as fault:
        raise ValueError(f"{fault} in {text!r}") from fault


PARITIES = {"none": "N", "odd": "O", "even": "E"}
"""Parities of a serial line, with their names in pyserial."""
START_TOLERANCE_MM = 0.05
"""Largest distance of each strut and of the tool tip to the start of a program: the following errors of standing
struts."""
MANUAL_MOVE_PROGRAM = 999
"""Program number of a manual move; jobs use others."""
APPROACH_MM_S = 10.0
"""Tip speed of the planned approach to the start of a program; for a turn in place, degrees per second."""
