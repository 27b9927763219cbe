# SPDX-License-Identifier: LGPL-2.1-or-later
"""Change watch: notifies a window of changes to named properties in its document, including undo.

Takes names; calls back once for all simultaneous changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import FreeCAD
from PySide import QtCore


class ChangeWatch:
    """A document observer, from its creation until ``end``; FreeCAD calls its slots.

    Args:
        tell: callback when the window is idle again.
        document: name of the document.
        names: names of the properties.
    """

    def __init__(self, tell: Callable[[], Any], document: str, names: Iterable[str]) -> None:
        self._document, self._names = document, frozenset(names)
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.timeout.connect(tell)
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
