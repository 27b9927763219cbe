# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program view: how part programs look in the tree; a double click opens them in the editor.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from typing import Any

from pkm_post.freecad_gui.views import View


class ProgramView(View):
    """The icon of a part program, and the way to its editor."""

    icon = "program.svg"

    def doubleClicked(self, vobj: Any) -> bool:
        """Called by FreeCAD: open the editor."""
        from pkm_post.freecad_gui.editor import open_editor

        open_editor(vobj.Object)
        return True
