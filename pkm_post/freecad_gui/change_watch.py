# SPDX-License-Identifier: LGPL-2.1-or-later
"""Change watch: tells a window that properties of some names changed in its document, by undo as well.

Names enter; a call leaves, one for all that changes together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import FreeCAD
from PySide import QtCore


class ChangeWatch:
    """An observer of documents, from when it is made until ``end``; FreeCAD calls its slots.

    Args:
        tell: called when the window is idle again.
        document: name of the document.
        names: of the properties.
    """

    def __init__(self, tell: Callable[[], Any], document: str, names: Iterable[str]) -> None:
        self._document, self._names = document, frozenset(names)
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.timeout.connect(tell)
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Watch no longer."""
        self._later.stop()
        FreeCAD.removeDocumentObserver(self)

    def slotChangedObject(self, item: Any, name: str) -> None:
        """A property has another value."""
        if name in self._names and item.Document.Name == self._document:
            self._later.start(0)

    def slotRemoveDynamicProperty(self, item: Any, name: str) -> None:
        """A property goes away."""
        self.slotChangedObject(item, name)
