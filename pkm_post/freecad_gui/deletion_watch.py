# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deletion watch: notifies a window before its document, or the object it shows, is deleted.

Takes names; calls back. FreeCAD would leave the window open without its object.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD


class DeletionWatch:
    """A document observer, from its creation until ``end``; FreeCAD calls its slots.

    Args:
        tell: callback at the deletion.
        document: name of the document.
        item: name of the object in it; None if there is none.
    """

    def __init__(self, tell: Callable[[], Any], document: str, item: str | None) -> None:
        self._tell, self._document, self._item = tell, document, item
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Stop watching."""
        FreeCAD.removeDocumentObserver(self)

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is deleted."""
        if document.Name == self._document:
            self._tell()

    def slotDeletedObject(self, item: Any) -> None:
        """An object is deleted."""
        if (item.Document.Name, item.Name) == (self._document, self._item):
            self._tell()
