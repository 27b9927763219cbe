# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job places: shows a place of a job in the tree.

Takes a job and a place; selects the operation, and shows the command in the status bar.
"""

from __future__ import annotations

from typing import Any

import FreeCADGui


def show_place(job: Any, label: str, line: int) -> None:
    """Select an operation of a job and show the number of one of its commands.

    Args:
        job: the CAM job; None shows nothing.
        label: of the operation.
        line: number of the command in it, from 1.
    """
    FreeCADGui.Selection.clearSelection()
    for operation in job.Operations.Group if job else ():
        if operation.Label == label:
            FreeCADGui.Selection.addSelection(operation)
            commands = operation.Path.Commands
            told = commands[line - 1].toGCode() if 0 < line <= len(commands) else ""
            FreeCADGui.getMainWindow().statusBar().showMessage(f"{label}, {line}: {told}")
