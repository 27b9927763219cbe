# SPDX-License-Identifier: LGPL-2.1-or-later
"""Observers: Escape during a long computation; changes, recomputes and deletions in a document; what is open.

Each takes a callback and calls it in the GUI thread. During a computation FreeCAD's progress bar blocks other keys and
the mouse, so that nothing can be changed while events are processed.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Any

import FreeCAD
import FreeCADGui
from pivy import coin
from PySide import QtCore, QtGui, QtWidgets

translate = FreeCAD.Qt.translate

_CALM_MS = 700
"""ms without Escape until it has its usual meaning again: longer than the initial delay of key repeat."""
_LOOK_S = 0.2
"""s between two polls of the keys: each repaints the GUI, which may take longer than many steps."""


_CALMING: list[EscapeWatch] = []
"""Watches whose computation has ended; this is the only reference to them."""


class EscapeWatch(QtCore.QObject):
    """Filters every key from ``begin`` to ``end``."""

    hit = QtCore.Signal()
    """Escape was pressed."""
    _was_pressed = False
    _last_look, _skipped_last = -_LOOK_S, False
    _calm: QtCore.QTimer | None = None

    def begin(self) -> None:
        """Filter keys ahead of FreeCAD's progress bar, which would ask a question at the end of the recompute."""
        QtWidgets.QApplication.instance().installEventFilter(self)

    def end(self) -> None:
        """Stop filtering; after an Escape, only once the key has been idle for a moment.

        Pressed twice or held, it would otherwise close the panel of a new operation, which deletes the operation.
        """
        FreeCADGui.getMainWindow().statusBar().clearMessage()
        if self._skipped_last:
            FreeCADGui.updateGui()  # an Escape since the last poll is also for the computation
        if not self._was_pressed:
            self._remove()
            return
        _CALMING.append(self)
        self._calm = QtCore.QTimer()
        self._calm.setSingleShot(True)
        self._calm.timeout.connect(self._remove)
        self._calm.start(_CALM_MS)

    def _remove(self) -> None:
        QtWidgets.QApplication.instance().removeEventFilter(self)
        self._calm = None
        if self in _CALMING:
            _CALMING.remove(self)

    def pressed(self, text: str) -> bool:
        """Show a text in the status bar and process events, at intervals; return whether Escape was pressed."""
        self._skipped_last = time.monotonic() - self._last_look < _LOOK_S
        if not self._skipped_last:
            FreeCADGui.getMainWindow().statusBar().showMessage(text)
            FreeCADGui.updateGui()
            self._last_look = time.monotonic()
        return self._was_pressed

    def eventFilter(self, _target: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Consume Escape.

        PySide2 may pass a deleted widget that previously had the event's address. Accessing an attribute that it lacks
        would crash FreeCAD, so only its class is examined.
        """
        if not issubclass(type(event), QtGui.QKeyEvent):
            return False
        if event.type() == QtCore.QEvent.Type.KeyPress and event.key() == QtCore.Qt.Key.Key_Escape:
            self._was_pressed = True
            self.hit.emit()
            if self._calm is not None:
                self._calm.start(_CALM_MS)
            return True
        return False


class ChangeWatch:
    """A document observer, from its creation until ``end``; FreeCAD calls its slots.

    Args:
        notify: callback when the GUI is idle again.
        document: name of the document.
    """

    def __init__(self, notify: Callable[[], Any], document: str, names: Iterable[str]) -> None:
        self._document, self._names = document, frozenset(names)
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.timeout.connect(notify)
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Stop watching."""
        self._later.stop()
        FreeCAD.removeDocumentObserver(self)

    def slotChangedObject(self, item: Any, name: str) -> None:
        """A property has a new value."""
        if name in self._names and item.Document.Name == self._document:
            self._later.start(0)

    def slotRemoveDynamicProperty(self, item: Any, name: str) -> None:
        """A property is removed."""
        self.slotChangedObject(item, name)


class UndoWatch(ChangeWatch):
    """A watch for undo, redo and other commands: each ends the transaction of a panel, or changes what it shows."""

    def __init__(self, notify: Callable[[], Any], document: str) -> None:
        super().__init__(notify, document, ())

    def slotUndoDocument(self, document: Any) -> None:
        """A step was undone."""
        if document.Name == self._document:
            self._later.start(0)

    slotRedoDocument = slotUndoDocument

    def slotCloseTransaction(self, _aborted: bool) -> None:
        """A transaction has ended, in any document: FreeCAD has one for all."""
        self._later.start(0)


class DeletionWatch:
    """A document observer, from its creation until ``end``; FreeCAD calls its slots.

    Args:
        notify: callback at the deletion.
        document: name of the document.
        item: name of the object in it; None if there is none.
    """

    def __init__(self, notify: Callable[[], Any], document: str, item: str | None) -> None:
        self._notify, self._document, self._item = notify, document, item
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Stop watching."""
        FreeCAD.removeDocumentObserver(self)

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is deleted."""
        if document.Name == self._document:
            self._notify()

    def slotDeletedObject(self, item: Any) -> None:
        """An object is deleted."""
        if (item.Document.Name, item.Name) == (self._document, self._item):
            self._notify()


class OnceClosed:
    """Calls a function once: when called itself, or when a widget is deleted.

    FreeCAD deletes a task panel without calling its ``reject`` where a command closes it by ``Control.closeDialog``.
    """

    def __init__(self, widget: QtWidgets.QWidget, function: Callable[[], Any]) -> None:
        self._function: Callable[[], Any] | None = function
        widget.destroyed.connect(lambda *_: self())

    def __call__(self) -> None:
        """Call the function, unless it was called before."""
        function, self._function = self._function, None
        if function is not None:
            function()


def keep_wrappers(widget: QtWidgets.QWidget) -> None:
    """Keep the Python wrappers of what a widget holds until Qt has deleted all of it.

    PySide 6.11 frees the wrapper of a deleted object, and uses it again if another wrapper has the same address.
    FreeCAD leaves wrappers of its deleted panels behind, and new widgets get their addresses.
    """
    kept = widget.findChildren(QtCore.QObject)
    widget.destroyed.connect(lambda *_, kept=kept: None)  # the connection ends after the children


def show_panel(panel: Any) -> None:
    """Show a task panel."""
    keep_wrappers(panel.form)
    FreeCADGui.Control.showDialog(panel)


def is_shown(document: str) -> bool:
    """Whether a document still has its views, which close before it."""
    try:
        return FreeCADGui.getDocument(document) is not None
    except NameError:
        return False


def view_of(document: str) -> Any:
    """The active 3D view of a document; another 3D view of it while a sheet or a page is active, None without one."""
    shown = FreeCADGui.getDocument(document)
    views = [shown.activeView(), *shown.mdiViewsOfType("Gui::View3DInventor")]
    return next((each for each in views if hasattr(each, "getSceneGraph")), None)


def scene_graph_of(document: str) -> Any:
    """The scene graph of that view; without a view, one that is not shown."""
    view = view_of(document)
    return coin.SoSeparator() if view is None else view.getSceneGraph()


def docked(kind: type[QtWidgets.QDockWidget], name: str) -> Any:
    """The dock of that name at the right of the main window, visible in front of others; made if there is none."""
    window = FreeCADGui.getMainWindow()
    dock = window.findChild(QtWidgets.QDockWidget, name)
    if dock is None:
        dock = kind(window)
        window.addDockWidget(QtCore.Qt.DockWidgetArea.RightDockWidgetArea, dock)
    dock.show()
    dock.raise_()
    return dock


def is_panel_open(title: str) -> bool:
    """Whether a task panel is open; if so, a message says to close it first."""
    if not FreeCADGui.Control.activeDialog():
        return False
    text = translate("PostPanel", "Another task panel is open: close it first.")
    QtWidgets.QMessageBox.warning(FreeCADGui.getMainWindow(), title, text)
    return True


class RecomputeWatch:
    """A document observer, from its creation until ``end``; FreeCAD calls its slot.

    Args:
        notify: callback after a recompute.
        document: its name.
    """

    def __init__(self, notify: Callable[[], Any], document: str) -> None:
        self._notify, self._document = notify, document
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Stop watching."""
        FreeCAD.removeDocumentObserver(self)

    def slotRecomputedDocument(self, document: Any) -> None:
        """A document was recomputed."""
        if document.Name == self._document:
            self._notify()
