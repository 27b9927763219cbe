# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench PKM Post, and its commands in CAM's own menu."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

import FreeCADGui

ICONS = Path(__file__).parents[2] / "resources" / "icons"


class PkmPostWorkbench(FreeCADGui.Workbench):
    """Symmetry and posting for machines with six struts, beside CAM."""

    MenuText = "PKM Post"
    ToolTip = "Post CAM jobs to hexapod machine tools"
    Icon = str(ICONS / "pkm_post.svg")

    def Initialize(self):
        """Called by FreeCAD when the workbench is first shown."""
        from pkm_post.freecad_gui.commands import COMMANDS

        names = [command.name for command in COMMANDS]
        self.appendToolbar("PKM Post", names)
        self.appendMenu("&PKM Post", names)

    def GetClassName(self):
        """The kind of workbench FreeCAD makes of this."""
        return "Gui::PythonWorkbench"


class CamMenu:
    """Puts the commands into CAM's menu; FreeCAD asks it at every change of workbench."""

    registered: ClassVar[list[CamMenu]] = []
    """FreeCAD keeps no reference of its own."""

    def modifyMenuBar(self):
        """The commands behind CAM's own copy of an operation."""
        from pkm_post.freecad_gui.commands import COMMANDS

        return [{"append": command.name, "menuItem": "CAM_SimpleCopy"} for command in COMMANDS]


def install() -> None:
    """Register workbench, commands and preferences; called once from InitGui.py."""
    from pkm_post.freecad_gui import preferences
    from pkm_post.freecad_gui.commands import register

    register()
    preferences.install()
    FreeCADGui.addWorkbench(PkmPostWorkbench())
    CamMenu.registered.append(CamMenu())
    FreeCADGui.addWorkbenchManipulator(CamMenu.registered[-1])
