# SPDX-License-Identifier: LGPL-2.1-or-later
"""The PKM Post workbench, and its tool bar and menu in CAM."""

from __future__ import annotations

import importlib
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import FreeCAD
import FreeCADGui

from pkm_post.freecad_app.window import ESCAPE_WATCHES, REFUSALS, VERDICTS, VIEWS
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


NAME = "PKM Post"
"""Of the tool bar and the menu."""


class PkmPostWorkbench(FreeCADGui.Workbench):
    """Symmetry and posting for machines with six struts, beside CAM."""

    MenuText = "PKM Post"
    Icon = str(ICONS / "pkm_post.svg")

    def __init__(self):
        # FreeCAD reads it from the class
        PkmPostWorkbench.ToolTip = FreeCAD.Qt.translate("Workbench", "Post CAM jobs to hexapod machine tools")

    def Initialize(self):
        """Called by FreeCAD when the workbench is first shown."""
        _add_commands(self)

    def GetClassName(self):
        """The kind of workbench that FreeCAD creates."""
        return "Gui::PythonWorkbench"


def _add_commands(workbench: Any) -> None:
    """Add tool bar and menu, in groups, to a workbench."""
    from pkm_post.freecad_gui.commands import grouped

    workbench.appendToolbar(NAME, grouped())
    workbench.appendMenu(f"&{NAME}", grouped())


class CamBar:
    """Adds tool bar and menu to CAM when CAM is first shown: before that it has neither."""

    waits: ClassVar[bool] = True

    @staticmethod
    def add(name: str) -> None:
        """Called with the name of the workbench that became active."""
        if name == "CAMWorkbench" and CamBar.waits:
            CamBar.waits = False
            cam = FreeCADGui.getWorkbench(name)
            _add_commands(cam)
            cam.reloadActive()


def install() -> None:
    """Register translations, workbench, commands and preferences; called once from InitGui.py."""
    from pkm_post.freecad_gui import preferences, start_page, verdict_icons
    from pkm_post.freecad_gui.commands import register

    FreeCADGui.addLanguagePath(str(TRANSLATIONS))
    FreeCADGui.updateLocale()  # FreeCAD selects its language before it loads add-ons
    register()
    preferences.install()
    VIEWS.update({kind: partial(_attach, *where) for kind, where in _VIEWS.items()})
    VERDICTS[:] = [partial(_attach, "pkm_post.freecad_gui.verdict_icons", "keep_verdict")]
    REFUSALS[:] = [partial(_attach, "pkm_post.freecad_gui.refusal", "show_refusal")]
    ESCAPE_WATCHES[:] = [partial(_attach, "pkm_post.freecad_gui.observers", "EscapeWatch")]
    verdict_icons.install()
    FreeCADGui.addWorkbench(PkmPostWorkbench())
    FreeCADGui.getMainWindow().workbenchActivated.connect(CamBar.add)
    start_page.install()


def _attach(module: str, name: str, *arguments: Any) -> Any:
    return getattr(importlib.import_module(module), name)(*arguments)
