# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deletion watch: tells a window that its document, or an object that it shows, is going to be deleted.

Names enter; a call leaves. FreeCAD would leave the window open with nothing behind it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD


class DeletionWatch:
    """An observer of documents, from when it is made until ``end``; FreeCAD calls its slots.

    Args:
        tell: called when one of them goes away.
        document: name of the document.
        item: name of the object in it; None if there is none.
    """

    def __init__(self, tell: Callable[[], Any], document: str, item: str | None) -> None:
        self._tell, self._document, self._item = tell, document, item
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Watch no longer."""
        FreeCAD.removeDocumentObserver(self)

    def slotDeletedDocument(self, document: Any) -> None:
        """A document goes away."""
        if document.Name == self._document:
            self._tell()

    def slotDeletedObject(self, item: Any) -> None:
        """An object goes away."""
        if (item.Document.Name, item.Name) == (self._document, self._item):
            self._tell()
