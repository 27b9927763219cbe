# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recompute watch: notifies a window of a recompute of its document.

Takes a name; calls back.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD


class RecomputeWatch:
    """A document observer, from its creation until ``end``; FreeCAD calls its slot.

    Args:
        tell: callback after a recompute.
        document: its name.
    """

    def __init__(self, tell: Callable[[], Any], document: str) -> None:
        self._tell, self._document = tell, document
        FreeCAD.addDocumentObserver(self)

    def end(self) -> None:
        """Stop watching."""
        FreeCAD.removeDocumentObserver(self)

    def slotRecomputedDocument(self, document: Any) -> None:
        """A document was recomputed."""
        if document.Name == self._document:
            self._tell()
