# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine and Reach from their buttons."""

import os

import FreeCAD
import FreeCADGui
from gui import main, picture_of_all, press, settle, step
from PySide import QtWidgets


@step
def machine_from_its_button():
    from cam_jobs import ARC, FIVE_AXIS, add_operation, new_job

    document = FreeCAD.newDocument("hexapod")
    job = new_job(document)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--work-offset=0,0,250"
    add_operation(job, ARC, "Arcs")
    add_operation(job, FIVE_AXIS, "Tilted")
    document.UndoMode = 1
    FreeCADGui.Selection.clearSelection()
    alone = FreeCADGui.Command.get("PKM_Machine").isActive()
    press("PKM_Machine", job)
    document.undo()
    undone = document.getObject("Machine") is None
    press("PKM_Machine", job)
    machine = document.getObject("Machine")
    view, tops = machine.ViewObject.Proxy, []
    for height in (20, 120):
        machine.Tip = FreeCAD.Vector(0, 0, height)
        document.recompute()
        tops.append(_highest(view.scene._platform))
    reported = {
        "alone": alone,
        "undone": undone,
        "job": machine.Job.Name,
        "icon": os.path.basename(view.getIcon()),
        "moved": tops[1] - tops[0],
        "out_of_limits": list(machine.OutOfLimits),
    }
    machine.Tip = FreeCAD.Vector(600, 0, -300)
    document.recompute()
    reported["red"] = [tuple(strut._rod.diffuseColor[0].getValue()) for strut in view.scene._struts]
    machine.MachineFile = "no_such_machine"
    reported["scene_without_machine"] = view.scene is not None
    machine.MachineFile, machine.Tip = "example_6tps", FreeCAD.Vector(0, 0, 60)
    document.recompute()
    reported["scene"] = view.scene is not None
    return reported


def _highest(transform):
    """The height of the platform in the machine, out of the scene graph."""
    return transform.matrix.getValue().getValue()[3][2]


@step
def reach_from_its_button():
    document = FreeCAD.getDocument("hexapod")
    press("PKM_Reach", document.getObject("Job"))
    found = document.getObject("Reach")
    view = found.ViewObject.Proxy
    reported = {"machine": found.Machine.Name, "reachable": found.Reachable, "nodes": view._root.getNumChildren()}
    view.doubleClicked(found.ViewObject)
    settle()
    (table,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTableWidget, "PkmReachTable")
    row = list(found.Checks).index("base joints")
    table.cellClicked.emit(row, 0)
    settle()
    reported |= {
        "rows": [table.item(line, 0).text() for line in range(table.rowCount())] == list(found.Checks),
        "colour_by": found.ColourBy,
        "selected": [item.Label for item in FreeCADGui.Selection.getSelection()] == [found.WorstOperations[row]],
    }
    found.Machine.ViewObject.Visibility = False
    reported["saved"] = picture_of_all("reach.png")
    found.Machine.ViewObject.Visibility = True
    FreeCADGui.getDocument("hexapod").resetEdit()
    settle()
    reported["panel_is_left_open"] = bool(FreeCADGui.Control.activeDialog())
    document.undo()
    reported["after_undo"] = found.ColourBy
    return reported


main()
