# SPDX-License-Identifier: LGPL-2.1-or-later
"""Converters: the text of one option to its value, in the units of the user; for ``type=`` of ``argparse``.

Input: the text as typed. Output: the value; or ``argparse.ArgumentTypeError`` with the expected form. NumPy is not
needed.
"""

from __future__ import annotations

import re

from pkm_post.options.argument_types import UnexpectedError, above_zero, between, number, offset, tool_length, validated
from pkm_post.options.layers import NOTHING
from pkm_post.system import result_files

SIDE_OUTPUTS = tuple(result_files.SIDE_OUTPUTS)
"""Names of the optional files, in the order in which they are written."""

Pose = tuple[float, float, float, float]


def work_offset(text: str) -> str | Pose:
    """A name, or x, y, z in mm and the rotation about z in degrees."""
    words = text.split(",")
    if len(words) == 1:
        return text
    if len(words) not in (3, 4):
        raise UnexpectedError("X,Y,Z or X,Y,Z,DEG", text)
    x, y, z = map(offset, words[:3])
    return x, y, z, number(words[3]) if words[3:] else 0.0


def sizes(text: str) -> tuple[float, float | None]:
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
OBJECTIVES = ("stroke", "joints", "singular", "weighted")
RULES_WITH_HEADING = tuple(rule for rule, value in _SPINS.items() if value == "DEG")
"""Rules that need a heading."""
SPIN_WORDS = (*(rule for rule in _SPINS if _SPINS[rule] != "OBJECTIVE"), *(f"optimise={one}" for one in OBJECTIVES))
"""All choices for the spin, without headings."""


def spin(text: str) -> tuple[str, float, str]:
    """Rule, heading in degrees and objective."""
    rule, given, value = text.partition("=")
    if rule not in _SPINS or (given and not _SPINS[rule]):
        raise UnexpectedError("one of {}", text, spin_words())
    if _SPINS[rule] == "DEG":
        return rule, number(value) if given else 0.0, OBJECTIVES[0]
    if given and value not in OBJECTIVES:
        raise UnexpectedError("one of {} after =", value, ", ".join(OBJECTIVES))
    return rule, 0.0, value or OBJECTIVES[0]


def also(text: str) -> tuple[str, ...]:
    """Distinct names; the word for none cancels a job's choice."""
    chosen = text.split(",") if text != NOTHING else []
    if not set(chosen) <= set(SIDE_OUTPUTS):
        raise UnexpectedError("names out of {}", text, ", ".join(SIDE_OUTPUTS))
    return tuple(name for name in SIDE_OUTPUTS if name in chosen)


OPTIONAL_STOPS = ("written", "stop", "leave-out")
"""Treatments of optional stops, as in ``toolpath.OPTIONAL_STOPS``."""

CL_DIALECTS = ("nx", "creo", "catia", "solidworks", "camplete", "makino", "apt")
"""Sources of CL data, as in ``cldata.DIALECTS``."""
CYCLE_VALUES = ("depth", "feed", "clearance", "return", "step", "dwell", "diameter")
"""Meanings of a cycle's numbers, as in ``cldata.CYCLE_VALUES``."""


def cycle_values(text: str) -> tuple[str, ...]:
    """Distinct names, in their order."""
    chosen = tuple(text.split(","))
    if not set(chosen) <= set(CYCLE_VALUES) or len(set(chosen)) < len(chosen):
        raise UnexpectedError("different names out of {}", text, ", ".join(CYCLE_VALUES))
    return chosen


CYCLE_STROKES = ("drill", "deep", "break", "ream")
"""Strokes of a kind of cycle, as in ``cldata.CYCLE_STROKES``."""
_CYCLE_KIND = re.compile(r"(\w+)=(\w+)", re.ASCII)


def cycle_kinds(text: str) -> tuple[tuple[str, str], ...]:
    """Distinct words in upper case, with their strokes."""
    pairs = [match.groups() if (match := _CYCLE_KIND.fullmatch(part)) else ("", "") for part in text.split(",")]
    chosen = {word.upper(): strokes for word, strokes in pairs}
    if not set(chosen.values()) <= set(CYCLE_STROKES) or len(chosen) < len(pairs):
        raise UnexpectedError("KIND=STROKES,... with strokes out of {}", text, ", ".join(CYCLE_STROKES))
    return tuple(chosen.items())


GOTO_VALUES = (("x", "y", "z"), ("i", "j", "k"), ("nx", "ny", "nz"), ("px", "py", "pz"))
"""Meanings of the values of a GOTO, as in ``cldata.GOTO_VALUES``."""


def goto_values(text: str) -> tuple[str, ...]:
    """Distinct names of whole vectors: with x, y and z, or with contact point and normal."""
    chosen = tuple(text.split(","))
    whole = [each for each in GOTO_VALUES if set(each) & set(chosen)]
    placed = "x" in chosen or {"px", "nx"} <= set(chosen)
    if len(set(chosen)) < len(chosen) or {*chosen} != {name for each in whole for name in each} or not placed:
        names = "; ".join(",".join(each) for each in GOTO_VALUES)
        raise UnexpectedError("x,y,z or px,py,pz and nx,ny,nz, and others of {}, in any order", text, names)
    return chosen


MIRRORS = ("xy", "xz", "yz")
"""Names of mirror planes, as in ``toolpath.symmetry.copies``."""


def copies(text: str) -> tuple[str | float, ...]:
    """Mirror planes and angles in degrees, in order; the word for none cancels a job's choice."""
    words = text.split(",") if text != NOTHING else []
    return tuple(word if word in MIRRORS else _copy_angle(word) for word in words)


_copy_angle = validated(float, lambda angle: 0 < abs(angle) < 360, "xy, xz, yz or an angle within 360 degrees")


MOST_FEED = 1_000_000
"""mm/min."""
GCODE_FLAVOURS = ("rs274", "fanuc", "siemens")
"""Flavours of G-code, as in ``reading.FLAVOUR_NAMES``."""
_CODE = re.compile(r"[GM]\d{1,4}(\.\d)?", re.IGNORECASE)


def codes(text: str) -> tuple[str, ...]:
    """Codes without leading zeros, in upper case."""
    words = text.split(",")
    if not all(map(_CODE.fullmatch, words)):
        raise UnexpectedError("G and M codes such as M21,G187", text)
    return tuple(f"{word[0].upper()}{float(word[1:]):g}" for word in words)


def switches(text: str) -> tuple[int, ...]:
    """Numbers of switches of block delete, 0 to 9."""
    if not re.fullmatch(r"[0-9](,[0-9])*", text, re.ASCII):
        raise UnexpectedError("numbers from 0 to 9 such as 2,3", text)
    return tuple(map(int, text.split(",")))


_ORIGIN = re.compile(
    r"(G5[4-9]|G59\.[123]|G54\.1P(?:[1-9]\d?|[12]\d\d|300)|G500|G50[5-9]|G5[1-9]\d)=(.*)", re.IGNORECASE
)


def shift(text: str) -> tuple[float, float, float]:
    """A distance along X, Y and Z, mm."""
    return _three_lengths(text, "DX,DY,DZ")


def origin(text: str) -> tuple[str, Pose]:
    """Name of a work offset of G-code in upper case; x, y, z in mm and the rotation about z in degrees."""
    found = _ORIGIN.fullmatch(text)
    pose = work_offset(found[2]) if found else ""
    if found is None or isinstance(pose, str):
        raise UnexpectedError("NAME=X,Y,Z[,DEG] with G54 to G59.3, G54.1P1 to G54.1P300 or G500 to G599", text)
    return found[1].upper(), pose


def point(text: str) -> tuple[float, float, float]:
    """X, Y and Z in mm."""
    return _three_lengths(text, "X,Y,Z")


def _three_lengths(text: str, expected: str) -> tuple[float, float, float]:
    words = text.split(",")
    if len(words) != 3:
        raise UnexpectedError(expected, text)
    x, y, z = map(offset, words)
    return x, y, z


def surface_speed_or_none(text: str) -> float | None:
    """A surface speed in m/min; None for the word for none."""
    return None if text == NOTHING else above_zero(100_000)(text)


def start_line(text: str) -> tuple[int, str] | None:
    """A line and its operation, which may be empty; None for the word for none."""
    operation, _, line = text.rpartition(":")
    if text == NOTHING:
        return None
    if not _is_index(line):
        raise UnexpectedError("N or OPERATION:N, a line from 1 on", text)
    return int(line), operation


def _is_index(text: str) -> bool:
    return text.isascii() and text.isdigit() and 0 < int(text) < 1 << 31


def side(text: str) -> int | None:
    """The number of a side, from 1; None for the word for none."""
    if text == NOTHING:
        return None
    if not _is_index(text):
        raise UnexpectedError("the number of a side, from 1", text)
    return int(text)


def listed(file: str) -> tuple[str, str]:
    """A file keyed by its own name, so that naming it in two layers of options counts once."""
    return file, file


def spin_words() -> str:
    """The spin rules with their operands, for help and messages."""
    return ", ".join(rule + (f"[={value}]" if value else "") for rule, value in _SPINS.items())
