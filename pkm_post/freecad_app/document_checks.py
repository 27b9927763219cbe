# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document checks: faults of a document and its operations that FreeCAD does not report.

Takes a file, a document or an operation; returns its faults. FreeCAD opens a truncated or modified file without an
error and replaces unreadable paths with empty ones. The file is therefore checked before it is opened, and again when a
job of an open document is read: until it is saved, the file is still the one that was opened. Operations that FreeCAD
could not read or compute are only marked.

Dress-ups, arrays and copies derive from an operation, linked by their ``Base``. Those of FreeCAD rebuild moves from X Y
Z, and arrays rotate only these: I J K words below them are dropped or left unchanged, which is right in a linear array.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import Path
from Path.Base.Util import toolControllerForOp
from Path.Main.Stock import StockType

from pkm_post.freecad_app.commands.rows import is_row
from pkm_post.freecad_app.commands.words import CommandWords, undecodable_command
from pkm_post.freecad_app.document import document_name, job_of, members
from pkm_post.freecad_app.operation_inputs import cleared_sides, left_out, misread_line, outdated_heights, outdated_path
from pkm_post.geometry import Array
from pkm_post.model import Amount, Diagnostic, Diagnostics, Kind, Phrase, Place, Program, Refused
from pkm_post.system import DamagedDocument, DocumentContent, read_document

_PACKAGE = "pkm_post."
_STANDS = 1e-6
"""mm"""
_SAME_HEIGHT = 0.01
"""mm: FreeCAD's boxes of round shapes are less exact than their sizes."""
_BOXES = StockType.FromBase, StockType.CreateBox
_NOT_READ, _NOT_COMPUTED = "Restore", "Touched"
"""Entries of ``State``. The first remains until the document is closed, whatever is computed."""


def read_content(file: FilePath) -> DocumentContent:
    """Contents listed in a document, after checking its file.

    Raises:
        Refused: it cannot be read, or is damaged: J101, J129, J130.
    """
    try:
        return read_document(file)
    except OSError as fault:
        raise Refused([Diagnostic("J101", Place(str(file)), str(fault))]) from fault
    except DamagedDocument as damaged:
        raise Refused([Diagnostic(damaged.code, Place(str(file)), damaged.found)]) from damaged


def check_operations(document: Any, content: DocumentContent) -> None:
    """Compare the operations of a newly opened document with those listed in its file.

    Raises:
        Refused: some are missing, J131.
    """
    place, faults = Place(document.FileName), []
    for job in content.jobs:
        item = document.getObject(job.name)
        read = [each.Name for each in members(getattr(item, "Operations", None))]
        if read != list(job.operations):
            missing = ", ".join(sorted(set(job.operations) - set(read))) or "none is missing, the order differs"
            found = f"{len(read)} of {len(job.operations)} operations of {job.label}: {missing}"
            faults.append(Diagnostic("J131", place, found))
    if faults:
        raise Refused(faults)


def file_faults(document: Any) -> Diagnostics:
    """Faults in the file of an open document; none if it was never saved or no longer exists."""
    file = FilePath(document.FileName)
    if not document.FileName or not file.is_file():
        return ()
    status = file.stat()
    return _faults_of(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=16)
def _faults_of(file: FilePath, changed: int, size: int) -> Diagnostics:
    """The same, cached by file state: document objects check on every recompute."""
    try:
        read_content(file)
    except Refused as refused:
        return refused.diagnostics
    return ()


def require_computed(document: Any) -> None:
    """Recompute a document whose paths are to be read.

    A timer may fire within a recompute, since its progress bar processes events of the window. A second recompute then
    does nothing, and later operations have old paths or none.

    Raises:
        Refused: the document is being recomputed, J137.
    """
    if document.Recomputing:
        raise Refused([Diagnostic("J137", Place(document_name(document)), Phrase("a recompute is under way"))])
    document.recompute()


def state_faults(operation: Any, source: str) -> list[Diagnostic]:
    """The faults of an operation before its commands are read: the first fault, or all incompatible dress-ups.

    Args:
        operation: of a job, active.
        source: name of the document.
    """
    place = Place(source, operation.Label)
    try:
        for code, check in _FAULTS:
            found = check(operation)
            if found:
                return [Diagnostic(code, place, found)]
        return [Diagnostic("J108", place, dressup.Label) for dressup in incompatible_dressups(operation)]
    except UnicodeDecodeError as fault:
        return [undecodable_command(fault, source, operation.Label)]


def feed_faults(operation: Any, controller: Any, program: Program, start: Array, source: str) -> Iterator[Diagnostic]:
    """Yield J105 for moves across the tool without a feed: CAM leaves F out, and that of the plunge would go on.

    Feeds of Custom operations are as typed. ``program`` and ``start``, (3,), are in the frame of the operation, mm.
    """
    if controller is None or controller.HorizFeed.Value or _is_typed(operation):
        return
    steps = np.abs(np.diff(program.position[:, :2], axis=0, prepend=start[None, :2])).max(axis=1)
    if np.any((program.kind == Kind.ARC) | (program.kind == Kind.LINE) & (steps > _STANDS)):
        found = Phrase("HorizFeed of {} is 0", controller.Label)
        yield Diagnostic("J105", Place(source, operation.Label), found)


def left_out_faults(operation: Any, source: str) -> Iterator[Diagnostic]:
    """Yield J149 for an operation, and each below it, of which CAM leaves something out."""
    for each in _with_bases(operation):
        if found := left_out(each):
            yield Diagnostic("J149", Place(source, each.Label), found)


def change_faults(operation: Any, stock: Any, source: str, known: set[str]) -> Iterator[Diagnostic]:
    """Yield J150 for an operation, and each below it, computed with a stock of other size; else J151.

    CAM links operations to chosen faces only: with the stock, or a model without chosen faces, they are not computed.
    Computing one again takes time: those whose names are in ``known`` are left out, and the others added to it.
    """
    shape = getattr(stock, "Shape", None)
    for each in _with_bases(operation) if shape is not None and not shape.isNull() else ():
        computed = hasattr(each, "OpStockZMin") and getattr(each, "Active", True) and not _is_typed(each)
        if computed and each.Name not in known:
            known.add(each.Name)
            place = Place(source, each.Label)
            if found := _other_stock(each, shape.BoundBox, StockType.FromStock(stock)):
                yield Diagnostic("J150", place, found)
            elif found := outdated_path(each):
                yield Diagnostic("J151", place, found)


def _other_stock(operation: Any, box: Any, kind: str) -> str:
    """The size of the stock with which an operation was computed, and that of the present one, if they differ."""
    then, now = (operation.OpStockZMin.Value, operation.OpStockZMax.Value), (box.ZMin, box.ZMax)
    if not np.allclose(then, now, rtol=0.0, atol=_SAME_HEIGHT):
        return Phrase("from Z {} to {}, now from Z {} to {}", *(Amount(each, "mm", "z.2f") for each in (*then, *now)))
    then, now = cleared_sides(operation), (box.XMin, box.YMin, box.XMax, box.YMax)
    if not then or kind not in _BOXES or np.allclose(then, now, rtol=0.0, atol=_SAME_HEIGHT):
        return ""
    amounts = (Amount(each, "mm", "z.2f") for each in (*then, *now))
    return Phrase("from X {} Y {} to X {} Y {}, now from X {} Y {} to X {} Y {}", *amounts)


def _is_typed(operation: Any) -> bool:
    """Whether an operation is Custom, or is made from such."""
    return hasattr(operation, "Gcode") or any(map(_is_typed, base_operations(operation)))


def _has_no_path(operation: Any) -> str:
    return "" if operation.isDerivedFrom("Path::Feature") else f"a {operation.TypeId}"


def _not_read(operation: Any) -> str:
    return "its state is Restore" if _NOT_READ in operation.State else ""


_UNSAID = "Error"
"""The status in FreeCAD of an object with an error from the file: only the error itself is stored."""


def _not_valid(operation: Any) -> str:
    if not operation.isValid():
        said = str(operation.getStatusString())
        return _gone_face(operation) or (Phrase("the document does not store why") if said == _UNSAID else said)
    if not getattr(operation, "Base", True) and (is_pkm_object(operation) or hasattr(operation, "JitterPercent")):
        return Phrase("its base operation no longer exists")
    found = _kept_by_cam(operation) or failed_input(operation)
    # behind those: CAM looks for a controller without an end where operations are made from each other in a circle
    if not found and len(set(map(toolControllerForOp, base_operations(operation)))) > 1:
        return Phrase("its operations have different tool controllers")
    return found


def _gone_face(operation: Any) -> str:
    """The first chosen face or edge that FreeCAD has lost: it puts a question mark before its name."""
    base = getattr(operation, "Base", None)
    chosen = (each for each in (base if isinstance(base, list) else ()) if isinstance(each, tuple))
    gone = next((f"{item.Label}.{name}" for item, names in chosen for name in names if name.startswith("?")), "")
    return Phrase("{} no longer exists", gone) if gone else ""


def failed_input(item: Any) -> str:
    """Which object that another is made from has an error; FreeCAD then leaves the other one as it was, unmarked."""
    try:
        failed = next((each for each in item.OutListRecursive if not each.isValid()), None)
    except IndexError as circle:
        return str(circle)
    return "" if failed is None else Phrase("{} has an error", failed.Label)


def _kept_by_cam(operation: Any) -> str:
    """Why CAM left an operation, or one below it, as it was or unfinished, and in order [Path/Op/Base.py, execute]."""
    if getattr(operation, "StopProcessing", False) and operation.Active:  # of Adaptive, until it is computed again
        return Phrase("its computation was stopped")
    job, controller = job_of(operation), getattr(operation, "ToolController", None)
    if hasattr(operation, "OpToolDiameter") and operation.Active:
        if job is not None and not members(job.Model):
            return Phrase("its job has no model")
        if controller is not None and controller.Tool is None:
            return Phrase("its tool controller has no tool")
        if controller is not None and not (controller.ToolNumber and float(getattr(controller.Tool, "Diameter", 1))):
            return Phrase("number or diameter of its tool is 0")
    below = (each for each in base_operations(operation) if each.isValid())  # invalid: perhaps in a circle
    return next(filter(None, map(_kept_by_cam, below)), "")


def _text_in_path(operation: Any) -> str:
    """What FreeCAD made of label and comment behind a bracket when it read the path of a file: both are comments there.

    A path with another label is of an operation renamed since: CAM begins with a rapid move to a height.
    """
    label, comment = operation.Label, getattr(operation, "Comment", "")
    text = "\n".join(f"({each})" for each in (label, comment) if each)
    path, commands = Path.Path(), operation.Path.Commands
    try:  # its own reading of a text ends in a C++ exception
        path.setFromGCode(text if ")" in label + comment else "")
    except RuntimeError:  # Base.BadFormatError
        return Phrase("nothing behind its label") if _NOT_READ in operation.State else ""
    read = path.Commands
    codes = [each.toGCode() for each in read if not each.Name.startswith("(")]
    begins = [each.toGCode() for each in commands[: len(read)]]
    if codes and begins == [each.toGCode() for each in read]:
        return ", ".join(codes)
    if not commands or commands[0].Name == f"({label})" or not hasattr(operation, "SafeHeight"):
        return ""
    first = next((each for each in commands if not each.Name.startswith("(")), None)
    return "" if first is None or _is_start(operation, first) else first.toGCode()


def _is_start(operation: Any, command: Any) -> bool:
    """Whether an operation of CAM may begin with a command."""
    heights = (operation.ClearanceHeight.Value, operation.SafeHeight.Value)
    height = command.Parameters.get("Z", heights[0])
    return command.Name == "G90" or command.Name == "G0" and min(abs(height - each) for each in heights) < _STANDS


def _not_computed(operation: Any) -> str:
    return "its state is Touched" if _NOT_COMPUTED in operation.State else ""


def _empty(operation: Any) -> str:
    """A path that CAM computes has at least a comment, but not an inactive Array, nor what is made from one."""
    return "" if operation.Path.Size or _is_off(operation) else "no command, not even a comment"


def _is_off(operation: Any) -> bool:
    return getattr(operation, "Active", True) is False or has_inactive_base(operation)


def has_inactive_base(operation: Any) -> bool:
    """Whether an operation is made from one that is switched off."""
    return any(map(_is_off, base_operations(operation)))


def _outdated_heights(operation: Any) -> str:
    return "" if has_inactive_base(operation) else outdated_heights(operation)


def _anywhere(check: Callable[[Any], str]) -> Callable[[Any], str]:
    """A check of an operation and of all below it: dress-ups may keep their path where one below has none."""

    def found(operation: Any) -> str:
        return next(filter(None, map(check, _with_bases(operation))), "")

    return found


def _with_bases(operation: Any) -> list[Any]:
    """An operation and all below it, each once: they may be made from each other in a circle."""
    every = [operation]
    for each in every:
        every += [below for below in base_operations(each) if below not in every]
    return every


_FAULTS: tuple[tuple[str, Callable[[Any], str]], ...] = (
    ("J136", _has_no_path),
    ("J148", _anywhere(_text_in_path)),
    ("J134", _not_read),
    ("J116", _not_valid),
    ("J133", _not_computed),
    ("J132", _anywhere(_empty)),
    ("J116", _anywhere(_outdated_heights)),
    ("J146", _anywhere(misread_line)),
)
"""Finding by code, empty if there is none, in this order: each test relies on the previous ones."""


def is_pkm_object(operation: Any) -> bool:
    """Whether the object belongs to this add-on, whose objects transform tool axes together with points."""
    return type(getattr(operation, "Proxy", None)).__module__.startswith(_PACKAGE)


def base_operations(operation: Any) -> list[Any]:
    """The operations directly below; faces and edges from which an operation is made are excluded."""
    base = getattr(operation, "Base", None)
    linked = base if isinstance(base, list | tuple) else [base]
    return [below for below in linked if hasattr(below, "isDerivedFrom") and below.isDerivedFrom("Path::Feature")]


def incompatible_dressups(operation: Any) -> Iterator[Any]:
    """Yield foreign dress-ups, the object itself or below it, that do more to tool-axis words than repeat them."""
    for below in base_operations(operation):
        if not is_pkm_object(operation):
            words = CommandWords.of(below.Path.Commands)
            if words.axis_words().any() and not is_row(CommandWords.of(operation.Path.Commands), words):
                yield operation
        yield from incompatible_dressups(below)
