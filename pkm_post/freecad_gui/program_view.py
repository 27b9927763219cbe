# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program view: how part programs look in the tree; a double click opens them in the editor.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

ICONS = Path(__file__).parents[2] / "resources" / "icons"


class ProgramView:
    """The icon of a part program, and the way to its editor."""

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Remember the object that is shown; called for new and for restored ones."""
        self.Object = vobj.Object

    def getIcon(self) -> str:
        """A sheet with lines."""
        return str(ICONS / "program.svg")

    def doubleClicked(self, vobj: Any) -> bool:
        """Called by FreeCAD: open the editor."""
        from pkm_post.freecad_gui.editor import open_editor

        open_editor(vobj.Object)
        return True

    def claimChildren(self) -> list[Any]:
        """No children."""
        return []

    def dumps(self) -> None:
        """Nothing is saved."""

    def loads(self, state: object) -> None:
        """Nothing was saved."""
