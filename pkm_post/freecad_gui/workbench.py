# SPDX-License-Identifier: LGPL-2.1-or-later
"""The PKM Post workbench, its tool bar and menu in CAM, and a button for the example on FreeCAD's start page.

FreeCAD has no interface for add-ons there. So the button goes into the named row of buttons for new documents whenever
a start page comes to the front; if a future page has no such row, nothing is added.
"""

from __future__ import annotations

import importlib
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.window import ESCAPE_WATCHES, REFUSALS, VERDICTS, VIEWS
from pkm_post.freecad_gui.icons import ICONS

translate = FreeCAD.Qt.translate

_EXAMPLE = "PkmPostExample"
_ROW = "CreateNewRow"
_ICON = 48
"""px."""
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
    from pkm_post.freecad_gui import preferences, verdict_icons
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
    _watch_start_pages()


def _attach(module: str, name: str, *arguments: Any) -> Any:
    return getattr(importlib.import_module(module), name)(*arguments)


def _watch_start_pages() -> None:
    """Add the button to the open start page, and to later ones."""
    (area,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QMdiArea)
    area.subWindowActivated.connect(lambda _window: QtCore.QTimer.singleShot(0, _add_example))
    QtCore.QTimer.singleShot(0, _add_example)


def _add_example() -> None:
    """Add the button to each start page without it."""
    for row in FreeCADGui.getMainWindow().findChildren(QtWidgets.QWidget, _ROW):
        if row.layout() is not None and row.findChild(QtWidgets.QAbstractButton, _EXAMPLE) is None:
            row.layout().addWidget(_button(row))


def _button(row: Any) -> QtWidgets.QPushButton:
    button = QtWidgets.QPushButton(row)
    button.setObjectName(_EXAMPLE)
    button.setIcon(QtGui.QIcon(str(ICONS / "example.svg")))
    button.setIconSize(QtCore.QSize(_ICON, _ICON))
    button.setText(translate("PKM_Example", "Hexapod example"))
    button.setToolTip(translate("PKM_Example", "A blade with a job for a hexapod machine tool, of PKM Post"))
    button.clicked.connect(lambda: FreeCADGui.runCommand("PKM_Example", 0))
    return button
