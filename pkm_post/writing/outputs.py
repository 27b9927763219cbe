# SPDX-License-Identifier: LGPL-2.1-or-later
"""Outputs: files written beside a motion program, and files in several parts.

Texts are written side by side; a certified motion becomes a table, a trajectory becomes a program for LinuxCNC. Only
files that are read back and measured are certified.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection
from pathlib import Path, PurePath

import numpy as np

from pkm_post.model import Diagnostic, Diagnostics, Kind, Place, Program, StrutMotion, Trajectory, pieces
from pkm_post.system import result_files
from pkm_post.writing.controllers import Table, part_names

_CHARACTERS_AT_ONCE = 1 << 20
"""Characters written at once, which avoids a second copy of the whole text as bytes."""


def left_over(program: Path, names: Collection[str], earlier: Collection[str] = ()) -> Diagnostics:
    """Warn if files of an earlier result remain beside a new one.

    A smaller memory gives more parts, and the suffix of the program or the additional files may have changed: leftovers
    then appear to belong to the new program. ``earlier`` are the files that the previous manifest lists.
    """
    endings = (program.suffix, *result_files.SETUPS.values(), *result_files.SIDE_OUTPUTS.values())
    kin = re.compile("|".join(_with_parts(program.stem + ending) for ending in endings))
    there = os.listdir(program.parent)
    found = sorted(name for name in there if (kin.fullmatch(name) or name in earlier) and name not in names)
    return (Diagnostic("F104", Place(str(program)), ", ".join(found)),) if found else ()


def _with_parts(name: str) -> str:
    """A pattern for the name of a file and those of its parts."""
    path = PurePath(name)
    return re.escape(path.stem) + "(?:-part[1-9][0-9]*)?" + re.escape(path.suffix)


def write_parts(path: Path, texts: tuple[str, ...]) -> list[str]:
    """Write the parts of a file and return their names."""
    names = part_names(path.name, len(texts))
    for name, text in zip(names, texts, strict=True):
        with path.with_name(name).open("w", encoding="ascii", newline="\n") as file:
            file.writelines(text[rows] for rows in pieces(len(text), _CHARACTERS_AT_ONCE))
    return names


def read_parts(path: Path, names: list[str]) -> list[tuple[str, str]]:
    """Names and texts of the parts of a file, read back."""
    return [(name, path.with_name(name).read_text(encoding="ascii")) for name in names]


def write_table(path: Path, table: Table, played: StrutMotion, heading: list[str]) -> tuple[str, Diagnostics]:
    """Write a table of a certified motion beside its program; return the result of reading it back and measuring it."""
    target = path.with_name(path.stem + table.SUFFIX)
    names = write_parts(target, table.texts(played, heading))
    return table.measured(read_parts(target, names), played)


def write_for_linuxcnc(path: Path, trajectory: Trajectory, tip_tolerance: float) -> Diagnostics:
    """Write the trajectory for a control with its own kinematics and planner."""
    text, found = linuxcnc_text(trajectory, tip_tolerance)
    if text is not None:
        file = path.with_name(path.stem + result_files.SIDE_OUTPUTS["linuxcnc"])
        file.write_text(text, encoding="ascii", newline="\n")
    return found


def linuxcnc_text(trajectory: Trajectory, tip_tolerance: float) -> tuple[str | None, Diagnostics]:
    """The trajectory as G-code for LinuxCNC's hexapod: X Y Z A B C in {M}, or None with diagnostics.

    ``tip_tolerance`` in mm applies where the program states none, as P of G64: without P LinuxCNC rounds corners as far
    as its speed requires.
    """
    from pkm_post.writing.gcode import GcodeDialect, write

    text, found = write(_as_program(trajectory, tip_tolerance), GcodeDialect.LINUXCNC)
    comment = "(coordinates of the machine frame, work offsets are zero; not certified)\n"
    return (None if text is None else comment + text), found


def _as_program(trajectory: Trajectory, tip_tolerance: float) -> Program:
    """A trajectory as a program whose work frame is {M}."""
    return Program(
        kind=trajectory.kind,
        position=trajectory.tip,
        tool_axis=trajectory.axis,
        spin=trajectory.spin,
        feed=np.where(trajectory.kind == Kind.RAPID, np.nan, trajectory.feed),
        arc_centre=trajectory.arc_centre,
        arc_axis=trajectory.arc_axis,
        exact_stop=trajectory.exact_stop,
        tip_tolerance=trajectory.tip_tolerances(tip_tolerance),
        operation=trajectory.operation,
        line=trajectory.line,
        events=trajectory.events,
        operations=trajectory.operations,
        tools=trajectory.tools,
        source=trajectory.source,
    )
