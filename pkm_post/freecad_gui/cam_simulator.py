# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM's simulator: shows the material removal of a job in CAM's own simulator.

Takes a job; opens CAM's panel with it. That simulator handles X, Y and Z only: it shows the tool upright.
"""

from __future__ import annotations

import importlib
from typing import Any

import FreeCAD
import FreeCADGui

translate = FreeCAD.Qt.translate

_COMMAND = "CAM_SimulatorGL"


def open_cam_simulator(job: Any) -> bool:
    """Open CAM's simulator with a job; return whether it opened. If not, the Report view states why."""
    importlib.import_module("Path.GuiInit").Startup()  # registers the commands where CAM has not been opened yet
    FreeCAD.setActiveDocument(job.Document.Name)
    if FreeCADGui.Control.activeDialog():
        text = translate("PKM_Simulate", "CAM's simulator needs the task panel: close what is open there first")
    elif not FreeCADGui.Command.get(_COMMAND).isActive():
        text = translate("PKM_Simulate", "CAM's simulator does not take this job")
    else:
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job)
        FreeCADGui.runCommand(_COMMAND, 0)
        return True
    FreeCAD.Console.PrintUserWarning(text + "\n")
    return False
