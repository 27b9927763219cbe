# SPDX-License-Identifier: LGPL-2.1-or-later
"""Linked: the program object for the file of an editor, in any open document.

It is looked up by file name at every use: documents are closed and objects deleted without notice.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
from PySide import QtWidgets

from pkm_post.freecad_app.document import is_job, is_program, transaction
from pkm_post.freecad_app.program_object import create_program, decode, set_reading
from pkm_post.reading import ReadingOptions

translate = FreeCAD.Qt.translate


def object_of(file: Path | None) -> Any:
    """The program object of a file; None if there is none."""
    if file is None:
        return None
    active = FreeCAD.ActiveDocument
    documents = sorted(FreeCAD.listDocuments().values(), key=lambda document: document is not active)
    items = (item for document in documents for item in document.Objects)
    return next((item for item in items if is_program(item) and Path(item.File) == file), None)


def bring_up_to_date(obj: Any, reading: ReadingOptions) -> None:
    """Let the object read its file again, with the editor's reading options."""
    set_reading(obj, reading)
    obj.touch()
    obj.Document.recompute()


def scene_of(obj: Any) -> Any:
    """The scene in which to draw beside the path of an object; None if there is none."""
    return obj.ViewObject.RootNode if obj is not None and obj.ViewObject is not None else None


def jobs() -> list[Any]:
    """The CAM jobs of the active document."""
    document = FreeCAD.ActiveDocument
    items = document.Objects if document is not None else []
    return [item for item in items if is_job(item)]


def chosen_job(parent: QtWidgets.QWidget, title: str) -> Any:
    """The only job of the active document, or the one that the user chooses; None if there is none."""
    known = {job.Label: job for job in jobs()}
    if len(known) < 2:
        return next(iter(known.values()), None)
    label, chosen = QtWidgets.QInputDialog.getItem(parent, title, "", list(known), 0, False)
    return known[label] if chosen else None


def decode_file(file: Path, reading: ReadingOptions, job: Any) -> Any:
    """Convert a file to an operation of a job, in one undo step; it gets a program object if it has none.

    Raises:
        Refused: as ``decode``; the document is unchanged.
    """
    document = job.Document
    with transaction(document, translate("PKM_Editor", "Decode into a job")):
        obj = object_of(file)
        if obj is None:
            obj = create_program(document, file)
            bring_up_to_date(obj, reading)
        return decode(obj, job)
