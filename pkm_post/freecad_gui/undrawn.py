# SPDX-License-Identifier: LGPL-2.1-or-later
"""Undrawn: objects of a document that something else covers in the 3D view, and that stay visible in the document."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import FreeCAD
from pivy import coin

from pkm_post.freecad_gui.observers import is_shown


class Undrawn:
    """Objects that are not drawn until ``end``. The document, saved or not, keeps their visibility.

    Args:
        document: its name.
        names: of the objects.
    """

    def __init__(self, document: str, names: Iterable[str]) -> None:
        self._document, self._drawn = document, {}
        for item in self._present(names):
            switch = item.ViewObject.SwitchNode
            if item.ViewObject.Visibility:
                self._drawn[item.Name] = switch.whichChild.getValue()
                switch.whichChild = coin.SO_SWITCH_NONE

    def _present(self, names: Iterable[str]) -> list[Any]:
        if not is_shown(self._document):
            return []
        return [item for item in map(FreeCAD.getDocument(self._document).getObject, names) if item is not None]

    def end(self) -> None:
        """Draw those again that are visible."""
        for item in self._present(self._drawn):
            if item.ViewObject.Visibility:
                item.ViewObject.SwitchNode.whichChild = self._drawn[item.Name]
        self._drawn = {}
