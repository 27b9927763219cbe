# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program link: the program object for the file of an editor, in any open document, and its block at the cursor.

Looks it up by file name at every use: documents are closed and objects deleted without notice.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import FreeCAD
from pivy import coin
from PySide import QtWidgets

from pkm_post.freecad_app.document import is_job, is_program, transaction
from pkm_post.freecad_app.program_object import create_program, decode, set_reading
from pkm_post.geometry import Array
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
    """Make the object read its file again, with the editor's reading options."""
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


_COLOUR = 1.0, 0.45, 0.0


class ShownBlock:
    """At most one block at a time, in one scene."""

    def __init__(self) -> None:
        self._places, self._lines, self._points = coin.SoCoordinate3(), coin.SoLineSet(), coin.SoPointSet()
        self._branch = coin.SoSeparator()
        pick, colour, style, light = coin.SoPickStyle(), coin.SoBaseColor(), coin.SoDrawStyle(), coin.SoLightModel()
        pick.style = coin.SoPickStyle.UNPICKABLE
        colour.rgb.setValue(*_COLOUR)
        style.lineWidth, style.pointSize = 5, 8
        light.model = coin.SoLightModel.BASE_COLOR
        for node in (pick, light, colour, style, self._places, self._lines, self._points):
            self._branch.addChild(node)
        self._root: Any = None

    def show(self, root: Any, ways: Sequence[Array]) -> None:
        """Draw polylines (n, 3) in a scene; ``root`` may be None to draw nothing."""
        if root is not self._root:
            self.remove()
        if root is not None and self._root is None:
            root.addChild(self._branch)
            self._root = root
        points = [tuple(map(float, point)) for way in ways for point in way]
        self._places.point.deleteValues(0)
        self._places.point.setValues(0, len(points), points)
        self._lines.numVertices.deleteValues(0)
        self._lines.numVertices.setValues(0, len(ways), [len(way) for way in ways])
        self._points.numPoints = len(points) if len(ways) == 1 else 0

    def remove(self) -> None:
        """Remove the drawing."""
        if self._root is not None:
            self._root.removeChild(self._branch)
            self._root = None
