# SPDX-License-Identifier: LGPL-2.1-or-later
"""The PKM Post workbench, and its commands in CAM's own menu."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

import FreeCAD
import FreeCADGui

from pkm_post.freecad_gui.icons import ICONS

_RESOURCES = Path(__file__).parents[2] / "resources"
TRANSLATIONS = _RESOURCES / "translations"


class PkmPostWorkbench(FreeCADGui.Workbench):
    """Symmetry and posting for machines with six struts, beside CAM."""

    MenuText = "PKM Post"
    Icon = str(ICONS / "pkm_post.svg")

    def __init__(self):
        # FreeCAD reads it from the class
        PkmPostWorkbench.ToolTip = FreeCAD.Qt.translate("Workbench", "Post CAM jobs to hexapod machine tools")

    def Initialize(self):
        """Called by FreeCAD when the workbench is first shown."""
        from pkm_post.freecad_gui.commands import COMMANDS

        names = [command.name for command in COMMANDS]
        self.appendToolbar("PKM Post", names)
        self.appendMenu("&PKM Post", names)

    def GetClassName(self):
        """The kind of workbench that FreeCAD creates."""
        return "Gui::PythonWorkbench"


class CamMenu:
    """Adds the commands to CAM's menu; FreeCAD calls it at every change of workbench."""

    registered: ClassVar[list[CamMenu]] = []
    """Keeps the objects alive: FreeCAD holds no reference."""

    def modifyMenuBar(self):
        """Add the commands after CAM's own copy of an operation."""
        from pkm_post.freecad_gui.commands import COMMANDS

        return [{"append": command.name, "menuItem": "CAM_SimpleCopy"} for command in COMMANDS]


def install() -> None:
    """Register translations, workbench, commands and preferences; called once from InitGui.py."""
    from pkm_post.freecad_gui import preferences
    from pkm_post.freecad_gui.commands import register

    FreeCADGui.addLanguagePath(str(TRANSLATIONS))
    FreeCADGui.updateLocale()  # FreeCAD selects its language before it loads add-ons
    register()
    preferences.install()
    FreeCADGui.addWorkbench(PkmPostWorkbench())
    CamMenu.registered.append(CamMenu())
    FreeCADGui.addWorkbenchManipulator(CamMenu.registered[-1])
