# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fits: which options apply to which input. One that does not apply is refused: it was typed for a reason.

Input: attribute names and kinds of files. Output: messages on the misfits, and options without them.
"""

from __future__ import annotations

import enum
from collections.abc import Collection, Iterable
from pathlib import Path

from pkm_post.options.layers import Given, flag_of


class Source(enum.Enum):
    """Kind of input that options are given for."""

    GCODE = "G-code"
    CLDATA = "CL data"
    JOB = "CAM jobs"


_PART_PROGRAMS = (Source.GCODE, Source.CLDATA)
_FOR: dict[str, tuple[Source, ...]] = {
    "axis_words": (Source.GCODE,),
    "dwell_unit": (Source.GCODE,),
    "contour_data": (Source.CLDATA,),
    "cl_dialect": (Source.CLDATA,),
    "cycle_values": (Source.CLDATA,),
    "tools": _PART_PROGRAMS,
    "unit": _PART_PROGRAMS,
    "allow_open_end": _PART_PROGRAMS,
    "wear": _PART_PROGRAMS,  # L432 names the alternative when it is given for G-code
    "job": (Source.JOB,),
}
"""Input kinds of an option, by attribute; all others apply to everything."""


def source_of(file: Path) -> Source:
    """Kind of a file by its suffix; anything but a part program is a document with jobs."""
    from pkm_post.reading import SUFFIXES, is_part_program

    if not is_part_program(file):
        return Source.JOB
    return Source.GCODE if SUFFIXES[file.suffix.lower()] is SUFFIXES[".ngc"] else Source.CLDATA


def misfits(names: Iterable[str], sources: Collection[Source]) -> list[str]:
    """Messages on the options that apply to none of the sources."""
    return [
        f"{flag_of(name)} is for {' and '.join(each.value for each in _FOR[name])}"
        for name in names
        if name in _FOR and not set(_FOR[name]) & set(sources)
    ]


def fitting(given: Given, source: Source) -> Given:
    """Options that apply to a source: of several files each option may be for some of them."""
    return {name: value for name, value in given.items() if source in _FOR.get(name, Source)}
