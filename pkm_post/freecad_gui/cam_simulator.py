# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAM's simulator: what a job removes of its stock is shown by CAM itself.

A job enters; CAM's panel opens with it. That simulator knows X, Y and Z alone: it shows the tool upright.
"""

from __future__ import annotations

import importlib
from typing import Any

import FreeCAD
import FreeCADGui

translate = FreeCAD.Qt.translate

_COMMAND = "CAM_SimulatorGL"


def open_cam_simulator(job: Any) -> bool:
    """Open CAM's simulator with a job; whether it did. If not, the Report view says why."""
    importlib.import_module("Path.GuiInit").Startup()  # makes the commands known where CAM was not looked at yet
    FreeCAD.setActiveDocument(job.Document.Name)
    if FreeCADGui.Control.activeDialog():
        told = translate("PKM_Simulate", "CAM's simulator needs the task panel: close what is open there first")
    elif not FreeCADGui.Command.get(_COMMAND).isActive():
        told = translate("PKM_Simulate", "CAM's simulator does not take this job")
    else:
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job)
        FreeCADGui.runCommand(_COMMAND, 0)
        return True
    FreeCAD.Console.PrintUserWarning(told + "\n")
    return False
