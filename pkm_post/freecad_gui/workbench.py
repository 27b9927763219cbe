# SPDX-License-Identifier: LGPL-2.1-or-later
"""The PKM Post workbench, and its commands in CAM's own menu."""

from __future__ import annotations

import importlib
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import FreeCAD
import FreeCADGui

from pkm_post.freecad_app.window import ESCAPE_WATCHES, REFUSALS, VIEWS
from pkm_post.freecad_gui.icons import ICONS

_RESOURCES = Path(__file__).parents[2] / "resources"
TRANSLATIONS = _RESOURCES / "translations"

_VIEWS = {
    "machine": ("pkm_post.freecad_gui.machine_view", "MachineView"),
    "normal_compensation": ("pkm_post.freecad_gui.normal_compensation_view", "NormalCompensationView"),
    "program": ("pkm_post.freecad_gui.program_view", "ProgramView"),
    "reach": ("pkm_post.freecad_gui.reach_view", "ReachView"),
    "simulation": ("pkm_post.freecad_gui.simulation_view", "SimulationView"),
    "surface_finish": ("pkm_post.freecad_gui.surface_finish_view", "SurfaceFinishView"),
    "symmetry": ("pkm_post.freecad_gui.symmetry_view", "SymmetryView"),
}
"""Module and class of the view provider for each kind of object; imported when the first of its kind is made."""


_CAM_BARS = {
    "Project Setup": "PKM_Machine PKM_Reach PKM_Simulate PKM_Post",
    "New Operations": "PKM_SurfaceFinish",
    "Path Modification": "PKM_NormalCompensation PKM_Mirror PKM_Rotate",
}
"""Commands by CAM's tool bar that they belong to."""


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

    def modifyToolBars(self):
        """Add the commands to CAM's tool bars, at the end of the one where CAM has commands of their kind."""
        return [{"append": name, "toolBar": bar} for bar, names in _CAM_BARS.items() for name in names.split()]


def install() -> None:
    """Register translations, workbench, commands and preferences; called once from InitGui.py."""
    from pkm_post.freecad_gui import preferences
    from pkm_post.freecad_gui.commands import register

    FreeCADGui.addLanguagePath(str(TRANSLATIONS))
    FreeCADGui.updateLocale()  # FreeCAD selects its language before it loads add-ons
    register()
    preferences.install()
    VIEWS.update({kind: partial(_attach, *where) for kind, where in _VIEWS.items()})
    REFUSALS[:] = [partial(_attach, "pkm_post.freecad_gui.refusal", "show_refusal")]
    ESCAPE_WATCHES[:] = [partial(_attach, "pkm_post.freecad_gui.observers", "EscapeWatch")]
    FreeCADGui.addWorkbench(PkmPostWorkbench())
    CamMenu.registered.append(CamMenu())
    FreeCADGui.addWorkbenchManipulator(CamMenu.registered[-1])


def _attach(module: str, name: str, *arguments: Any) -> Any:
    return getattr(importlib.import_module(module), name)(*arguments)
