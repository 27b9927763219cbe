# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operation inputs: whether the path of an operation holds what its user gave.

Input: an operation. Output: what differs, empty if nothing does. FreeCAD reads the lines of a Custom operation: of
``G1 X1,5`` it makes ``G1 X15``, a move with a comment behind it becomes a comment, and other lines are left out. A Z
correction keeps the heights that it had when its file changes. Holes and holding tags may be disabled or lost.
"""

from __future__ import annotations

import re
from itertools import chain, zip_longest
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App
import numpy as np
import Part
from Path.Base.Util import opProperty
from PathScripts import PathUtils

from pkm_post.freecad_app.frames import rows_of
from pkm_post.model import Phrase

_STORED = 1e-6
"""FreeCAD stores six decimals."""
_COMMENT = re.compile(r"\([^()]*\)")
_WORD = re.compile(r"\s*([A-Z])\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))", re.ASCII | re.IGNORECASE)
_PLAIN = re.compile(r"[GM][0-9.]+(?: [A-Z]-?[0-9]+\.?[0-9]*)*+", re.ASCII)
"""A code and words with single blanks between them: most lines."""
_Words = list[tuple[str, float]]
"""Letters and numbers."""


def misread_line(operation: Any) -> str:
    """The first line of a Custom operation that its path does not hold as typed."""
    if not hasattr(operation, "Gcode") or not operation.Active:
        return ""
    lines = _typed_lines(operation)
    return Phrase("{} cannot be read", operation.GcodeFile) if lines is None else _first_difference(lines, operation)


def _typed_lines(operation: Any) -> list[str] | None:
    """The lines of a Custom operation; None if they are in a file that is not there."""
    if getattr(operation, "Source", "Text") == "Text" or not operation.GcodeFile:
        return list(operation.Gcode)
    file = FilePath(operation.Document.FileName).parent / operation.GcodeFile
    try:
        return file.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return None


def _first_difference(lines: list[str], operation: Any) -> str:
    """The first line that is not the next command of the path; comments and lines without words do not matter."""
    typed = [(number, line) for number, line in enumerate(lines, 1) if line and not _COMMENT.fullmatch(line)]
    read = [each for each in operation.Path.Commands if (name := each.Name) and not name.startswith("(")]
    if len(typed) == len(read) and all(
        _is_plainly(line, command) for (_, line), command in zip(typed, read, strict=True)
    ):
        return ""
    meant = [(number, line, words) for number, line in typed if (words := _words(line)) != []]
    for (number, line, words), command in zip_longest(meant, read[: len(meant)]):
        if words is None or command is None or not _holds(command, words):
            has = Phrase("nothing") if command is None else command.toGCode()
            return Phrase("line {}, {!r}, where its path has {}", number, line, has)
    more = read[len(meant) :]
    return Phrase("behind the last line its path has {}", more[0].toGCode()) if more else ""


def _is_plainly(line: str, command: Any) -> bool:
    """Whether a line is plain, and exactly this command."""
    if not _PLAIN.fullmatch(line):
        return False
    name, *words = line.split(" ")
    stored = command.Parameters
    numbers = {word[0]: float(word[1:]) for word in words}
    return name == command.Name and len(words) == len(stored) and numbers == stored


def _holds(command: Any, words: _Words) -> bool:
    """Whether a command has a code and these words, each once."""
    stored = command.Parameters
    return (
        words[:1] == _words(command.Name)
        and len(words) == 1 + len(stored)
        and all(abs(stored.get(letter, np.nan) - number) <= _STORED for letter, number in words[1:])
    )


def _words(line: str) -> _Words | None:
    """The words of a line, without its comments; None if it has anything else."""
    for _ in range(line.count("(")):
        line = _COMMENT.sub(" ", line)
    line = line.partition(";")[0].strip("()% \t\r\n")
    words = _WORD.findall(line)
    return [(letter.upper(), float(number)) for letter, number in words] if not _WORD.sub("", line).strip() else None


def outdated_heights(operation: Any) -> str:
    """Why the heights of a Z correction are not those of its file: CAM keeps earlier ones, or corrects nothing.

    The surface of the file is made again, as CAM does: measuring that of the operation takes minutes.
    """
    if not hasattr(operation, "interpSurface"):
        return ""
    if operation.interpSurface.isNull():
        return Phrase("it has no probed heights")
    if not operation.probefile:
        return ""
    try:
        surface = _probed_surface(FilePath(operation.probefile))
    except (OSError, ValueError, IndexError, TypeError, Part.OCCError):
        return Phrase("{} cannot be read", operation.probefile)
    surfaces = operation.interpSurface.Faces[0].Surface, surface
    made, probed = (rows_of(list(chain.from_iterable(each.getPoles()))) for each in surfaces)
    if made.shape == probed.shape and np.allclose(made, probed, rtol=0.0, atol=_STORED):
        return ""
    return Phrase("its heights are not those of {}: clear the name, then choose it again", operation.probefile)


def left_out(operation: Any) -> str:
    """The holes or holding tags of an operation that CAM leaves out, which it says in its Report view, or nowhere."""
    if opProperty(operation, "Active") is False:
        return ""
    if hasattr(operation, "Positions") and hasattr(operation, "Disabled"):
        return _missing_tags(operation)
    proxy, lost = getattr(operation, "Proxy", None), []
    if not hasattr(proxy, "isHoleEnabled"):
        return ""
    for base, face in ((base, face) for base, faces in operation.Base for face in faces):
        if not proxy.isHoleEnabled(operation, base, face) or proxy.holePosition(operation, base, face) is None:
            lost.append(f"{base.Label}.{face}")
    return Phrase("holes {}", ", ".join(lost)) if lost else ""


def _missing_tags(dressup: Any) -> str:
    """The disabled tags; all of them where CAM could not make any and took the path below as it is."""
    listed, below = len(dressup.Positions), PathUtils.getPathWithPlacement(dressup.Base)
    is_plain = listed and dressup.Path.toGCode() == below.toGCode()
    missing = range(listed) if is_plain else dressup.Disabled
    numbers = ", ".join(str(index + 1) for index in missing)
    return Phrase("holding tags {} of {}", numbers, listed) if numbers else ""


def _probed_surface(file: FilePath) -> Any:
    """The surface that CAM lays through the points of a file, each X Y Z in mm [Path/Dressup/Gui/ZCorrect.py]."""
    words = (line.split()[:3] for line in file.read_text(encoding="utf-8").splitlines() if line)
    points = sorted([round(float(word), 2) for word in each] for each in words)
    rows = sorted({y for _, y, _ in points})
    surface = Part.BSplineSurface()
    surface.interpolate([[App.Vector(*each) for each in points if each[1] == y] for y in rows])
    return surface
