# SPDX-License-Identifier: LGPL-2.1-or-later
"""File drop: accepts part programs dropped from a file manager on a widget."""

from __future__ import annotations

from pathlib import Path

from PySide import QtCore, QtWidgets

from pkm_post.reading import is_part_program

_DRAGGED = (QtCore.QEvent.Type.DragEnter, QtCore.QEvent.Type.DragMove)


class FileDrop(QtCore.QObject):
    """Accepts part programs dropped on widgets. Text is handled as usual, other files by the enclosing window."""

    dropped = QtCore.Signal(object)
    """The path of the first file."""

    def __init__(self, parent: QtCore.QObject, *widgets: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        for widget in widgets:
            widget.setAcceptDrops(True)
            widget.installEventFilter(self)

    def eventFilter(self, watched: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Called by Qt."""
        is_drop = event.type() == QtCore.QEvent.Type.Drop
        if not is_drop and event.type() not in _DRAGGED:
            return False
        if not event.mimeData().hasUrls():
            return False
        file = _part_program(event.mimeData())
        if file is None:  # a text widget would insert the file name; FreeCAD's window may handle it
            event.ignore()
            return True
        event.setDropAction(QtCore.Qt.DropAction.CopyAction)
        event.accept()
        if is_drop:
            self.dropped.emit(file)
        return True


def _part_program(data: QtCore.QMimeData) -> Path | None:
    """The first part program among the dragged files."""
    files = (Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile())
    return next((file for file in files if is_part_program(file)), None)
