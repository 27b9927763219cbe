# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program view: how part programs look in the tree; a double click opens them in the editor.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD

from pkm_post.freecad_gui.context_menu import add_entry
from pkm_post.freecad_gui.views import View

translate = FreeCAD.Qt.translate


class ProgramView(View):
    """The icon of a part program, and the way to its editor."""

    icon = "program.svg"

    def doubleClicked(self, vobj: Any) -> bool:
        """Called by FreeCAD: open the editor."""
        from pkm_post.freecad_gui.editor import open_editor

        open_editor(vobj.Object)
        return True

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """The editor, and what it does with a program."""
        obj = vobj.Object
        add_entry(menu, translate("PKM_Editor", "Open in the editor"), lambda: self.doubleClicked(vobj), self.icon)
        add_entry(menu, translate("PKM_Editor", "Decode into a job"), lambda: _in_editor(obj, "decode"))
        add_entry(menu, translate("PKM_Editor", "Post program"), lambda: _in_editor(obj, "post"))
        super().setupContextMenu(vobj, menu)


def _in_editor(obj: Any, call: str) -> None:
    """Open the editor and let it do something with the program, unless it keeps another one that is not saved."""
    from pkm_post.freecad_gui.editor import open_editor

    editor = open_editor(obj)
    if editor.body.file == Path(obj.File):
        getattr(editor, call)()
