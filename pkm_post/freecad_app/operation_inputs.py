# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operation inputs: whether the path of an operation holds what its user gave.

Input: an operation. Output: what differs, empty if nothing does. FreeCAD reads the lines of a Custom operation: of
``G1 X1,5`` it makes ``G1 X15``, a move with a comment behind it becomes a comment, and other lines are left out. A Z
correction keeps the heights that it had when its file changes, and an operation on the whole model its path when the
model changes. Holes, narrow pockets and holding tags may be disabled or lost.
"""

from __future__ import annotations

import re
from itertools import chain, zip_longest
from pathlib import Path as FilePath
from typing import Any

import FreeCAD as App
import numpy as np
import Part
import Path
from Path.Base.Util import opProperty
from PathScripts import PathUtils

from pkm_post.freecad_app.commands.words import CommandWords
from pkm_post.freecad_app.frames import rows_of
from pkm_post.geometry import Array
from pkm_post.model import Amount, Phrase, fill_gaps

_STORED = 1e-6
"""FreeCAD stores six decimals."""
_TOUCHES = 1e-3
"""mm: a tool as close as this to another face has not cut it."""
_COMMENT = re.compile(r"\([^()]*\)")
_WORD = re.compile(r"\s*([A-Z])\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))", re.ASCII | re.IGNORECASE)
_PLAIN = re.compile(r"[GM][0-9.]+(?: [A-Z]-?[0-9]+\.?[0-9]*)*+", re.ASCII)
"""A code and words with single blanks between them: most lines."""
_TRIES = 4
"""CAM may add an inner contour where faces of a model lie in one plane, in one computation of ten."""
_NODES = 16
"""Enough for the figures of a full circle to ten digits."""
_COMPUTED_AGAIN = {f"Path.Op.{kind}" for kind in ("Engrave", "MillFace", "Pocket", "PocketShape", "Profile", "Vcarve")}
"""The kinds of operations that need not be linked to what they cut, and are computed without windows and objects."""
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


class _StandIn:
    """An operation that keeps to itself what CAM writes while it computes a path."""

    def __init__(self, operation: Any) -> None:
        self.__dict__["_operation"] = operation

    def __getattr__(self, name: str) -> Any:
        return getattr(self._operation, name)

    def __setattr__(self, name: str, value: Any) -> None:
        self.__dict__[name] = value


def outdated_path(operation: Any) -> str:
    """What an operation cuts, and what CAM would compute now, if that is something else.

    CAM links operations to chosen faces only: a change of the whole model or of the sides of the stock leaves their
    path as it is.
    """
    if not _may_be_outdated(operation):
        return ""
    kept = new = _cut_figures(operation.Path.Commands)
    for _ in range(_TRIES):
        try:
            new = _cut_figures(_computed(operation))
        except MemoryError:
            raise
        except Exception as fault:  # as in a recompute: whatever CAM raises is the fault of the operation
            return str(fault)
        if np.allclose(kept, new, rtol=_STORED, atol=_TOUCHES, equal_nan=True):
            return ""
    amounts = (Amount(number, "mm", "z.3f") for figures in (kept, new) for number in figures[:4])
    return Phrase("{} long around X {} Y {} Z {}, now {} around X {} Y {} Z {}", *amounts)


def _may_be_outdated(operation: Any) -> bool:
    """Whether an operation is computed from anything that it is not linked to, and can soon be computed again."""
    kind = type(getattr(operation, "Proxy", None)).__module__
    if kind not in _COMPUTED_AGAIN or not operation.Active or operation.ToolController is None:
        return False
    if getattr(operation, "UseRestMachining", False):  # takes seconds, and never gives the same twice
        return False
    unlinked = not (operation.Base or getattr(operation, "BaseShapes", ()))
    in_stock = getattr(operation, "ProcessStockArea", False) or getattr(operation, "BoundaryShape", "") == "Stock"
    return unlinked or in_stock


def cleared_sides(operation: Any) -> tuple[float, ...]:
    """Least X and Y and greatest X and Y, mm, of the stock from which Adaptive cleared to the outside: it stores it."""
    state = getattr(operation, "AdaptiveInputState", None)
    outline = state.get("stockGeometry") if isinstance(state, dict) and operation.Side == "Outside" else None
    if not isinstance(outline, list):  # by level, where the experiment with models is on
        return ()
    points = np.array(list(chain.from_iterable(outline)))
    return *points.min(axis=0), *points.max(axis=0)


def _cut_figures(commands: list[Any]) -> Array:
    """Length, centre and spread of what commands cut sideways, (7,), mm.

    CAM begins and divides the same round contour elsewhere each time, so commands cannot be compared one by one.
    """
    points, share = _cut_points(commands)
    length = share.sum()
    centre = np.tensordot(share, points, 2) / max(length, _STORED)
    spread = np.tensordot(share, (points - centre) ** 2, 2) / max(length, _STORED)
    return np.array([length, *centre, *np.sqrt(spread)])


def _cut_points(commands: list[Any]) -> tuple[Array, Array]:
    """Points of the cutting moves, (nodes, n, 3), and the length that each stands for, (nodes, n), by Gauss."""
    words = CommandWords.of(commands)
    start, end = _ends(words, "XYZ")
    cuts = words.among("G2", "G3") | words.among("G1") & (np.abs(end - start)[:, :2] > _STORED).any(axis=1)
    start, end, is_arc = start[cuts], end[cuts], words.among("G2", "G3")[cuts]
    sense = np.where(words.among("G3")[cuts], 1.0, -1.0)
    radius = -np.nan_to_num(words.value("I") + 1j * words.value("J"))[cuts]  # from the centre, as complex numbers
    first, last = start[:, 0] + 1j * start[:, 1], end[:, 0] + 1j * end[:, 1]
    turn = sense * np.angle((last - first + radius) / np.where(is_arc, radius, 1.0))
    turn = sense * np.where(turn > _STORED, turn, turn + 2.0 * np.pi)
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    part = (nodes[:, None] + 1.0) / 2.0
    across = first + np.where(is_arc, radius * (np.exp(1j * turn * part) - 1.0), (last - first) * part)
    points = np.stack([across.real, across.imag, start[:, 2] + (end - start)[:, 2] * part], axis=-1)
    sideways = np.where(is_arc, np.abs(radius * turn), np.abs(last - first))
    return points, weights[:, None] / 2.0 * np.hypot(sideways, (end - start)[:, 2])


def _ends(words: CommandWords, letters: str) -> tuple[Array, Array]:
    """Start and end of each command, (n, letters); NaN before the first."""
    end = np.column_stack([fill_gaps(words.value(letter), np.nan) for letter in letters])
    return np.vstack([end[:1], end[:-1]]), end


def _computed(operation: Any) -> list[Any]:
    """The commands that CAM computes for an operation, which stays as it is [Path/Op/Base.py, execute]."""
    proxy, controller = operation.Proxy, operation.ToolController
    kept = dict(vars(proxy))
    try:
        proxy._setBaseAndStock(operation)
        proxy.tool, proxy.commandlist = controller.Tool, []
        proxy.radius = float(controller.Tool.Diameter) / 2.0
        for name in ("HorizFeed", "VertFeed", "HorizRapid", "VertRapid"):
            setattr(proxy, name[0].lower() + name[1:], getattr(controller, name).Value)
        proxy.opExecute(_StandIn(operation))
        return [*proxy.commandlist, Path.Command("G0", {"Z": operation.ClearanceHeight.Value})]
    finally:
        vars(proxy).clear()
        vars(proxy).update(kept)


def left_out(operation: Any) -> str:
    """What CAM leaves out of an operation, which it says in its Report view, or nowhere: holes, faces, holding tags."""
    if opProperty(operation, "Active") is False:
        return ""
    if hasattr(operation, "Positions") and hasattr(operation, "Disabled"):
        return _missing_tags(operation)
    proxy, lost = getattr(operation, "Proxy", None), []
    if not hasattr(proxy, "isHoleEnabled"):
        lost = _uncut(operation)
        return Phrase("{}, where the tool cuts nothing", ", ".join(lost)) if lost else ""
    for base, face in ((base, face) for base, faces in operation.Base for face in faces):
        if not proxy.isHoleEnabled(operation, base, face) or proxy.holePosition(operation, base, face) is None:
            lost.append(f"{base.Label}.{face}")
    return Phrase("holes {}", ", ".join(lost)) if lost else ""


def _uncut(operation: Any) -> list[str]:
    """What the tool of a pocket, or of a profile inside, never comes to: CAM drops what is too narrow for it.

    Compared by boxes in XY, so that nothing is listed that is cut. With rest machining less is cut on purpose.
    """
    kind = type(getattr(operation, "Proxy", None)).__module__
    inside = getattr(operation, "Side", "Inside") == "Inside" and not getattr(operation, "UseRestMachining", False)
    if kind not in ("Path.Op.Profile", "Path.Op.PocketShape") or not inside:
        return []
    chosen = [(base, name) for base, names in operation.Base for name in names]
    shapes = {f"{base.Label}.{name}": base.Shape.getElement(name) for base, name in chosen}
    is_pocket = kind == "Path.Op.PocketShape"
    boxes = {name: shape.BoundBox for name, shape in shapes.items() if _is_region(shape, is_pocket)}
    low, high = _cut_boxes(operation)
    return [  # the outline of a profile around several faces does not come to those within it
        name
        for name, box in boxes.items()
        if not np.any((low < (box.XMax, box.YMax)).all(axis=1) & (high > (box.XMin, box.YMin)).all(axis=1))
        and (is_pocket or not any(other is not box and other.isInside(box) for other in boxes.values()))
    ]


def _is_region(shape: Any, is_pocket: bool) -> bool:
    """Whether a chosen edge or face encloses what is cut: a closed edge, a bore, or the bottom of a pocket."""
    if shape.ShapeType != "Face":
        return bool(shape.ShapeType == "Edge" and shape.isClosed())
    if isinstance(shape.Surface, Part.Cylinder):
        start, end, *_ = shape.ParameterRange
        return abs(shape.Surface.Axis.z) > 1 - _STORED and end - start > 2 * np.pi - _STORED
    return is_pocket and shape.BoundBox.ZLength < _STORED


def _cut_boxes(operation: Any) -> tuple[Array, Array]:
    """Lower and upper corners in XY, (n, 2), of boxes around what the tool covers in each cutting move."""
    words = CommandWords.of(operation.Path.Commands)
    start, end = _ends(words, "XY")
    low, high = np.fmin(start, end), np.fmax(start, end)
    arc = words.among("G2", "G3")
    offset = np.nan_to_num(np.column_stack([words.value(letter) for letter in "IJ"]))[arc]
    radius = np.hypot(*offset.T)[:, None]
    low[arc], high[arc] = start[arc] + offset - radius, start[arc] + offset + radius
    cuts, reach = words.among("G1", "G2", "G3"), operation.OpToolDiameter.Value / 2 - _TOUCHES
    return low[cuts] - reach, high[cuts] + reach


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
