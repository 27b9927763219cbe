# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program view: part programs in the tree; a double click opens them in the editor.

Takes a view object and sets its provider. Saved documents store the module of this class: module and class name are a
file format.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD

from pkm_post.freecad_gui.context_menu import add_entry
from pkm_post.freecad_gui.views import View

translate = FreeCAD.Qt.translate


class ProgramView(View):
    """The icon of a part program, and access to its editor."""

    icon = "program.svg"

    def doubleClicked(self, vobj: Any) -> bool:
        """Called by FreeCAD: open the editor."""
        from pkm_post.freecad_gui.editor import open_editor

        open_editor(vobj.Object)
        return True

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the editor, and its actions on a program."""
        obj = vobj.Object
        add_entry(menu, translate("PKM_Editor", "Open in the editor"), lambda: self.doubleClicked(vobj), self.icon)
        add_entry(menu, translate("PKM_Editor", "Decode into a job"), lambda: _in_editor(obj, "decode"))
        add_entry(menu, translate("PKM_Editor", "Post program"), lambda: _in_editor(obj, "post"))
        super().setupContextMenu(vobj, menu)


def _in_editor(obj: Any, call: str) -> None:
    """Open the editor and run one of its actions on the program, unless it holds another unsaved program."""
    from pkm_post.freecad_gui.editor import open_editor

    editor = open_editor(obj)
    if editor.widget.file == Path(obj.File):
        getattr(editor, call)()
