# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recompute watch: tells a window that its document was computed anew.

A name enters; a call leaves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD


class RecomputeWatch:
    """An observer of documents, from when it is made until ``end``; FreeCAD calls its slot.

    Args:
        tell: called when the document was computed.
        document: its name.
    """

    def __init__(self, tell: Callable[[], Any], document: str) -> None:
        self._tell, self._document = tell, document
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Watch no longer."""
        FreeCAD.removeDocumentObserver(self)

    def slotRecomputedDocument(self, document: Any) -> None:
        """A document was computed."""
        if document.Name == self._document:
            self._tell()
