# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine and Reach from their buttons."""

import os

import FreeCAD
import FreeCADGui
from gui import FOLDER, click, main, new_document, picture_of_all, press, settle, step, until
from pivy import coin
from PySide import QtWidgets

from pkm_post.freecad_app.post_job import post_job
from pkm_post.freecad_gui.place_row import PlaceRow
from pkm_post.freecad_gui.verdict import FindingRows, Verdict
from pkm_post.model import Refused, errors


@step
def machine_from_its_button():
    from cam_jobs import ARC, BELOW, FIVE_AXIS, add_operation, new_job

    document = FreeCAD.newDocument("hexapod")
    job = new_job(document, BELOW)
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
    scene = found.Machine.ViewObject.Proxy
    camera, point = FreeCADGui.activeView().getCameraNode(), found.WorstPoints[row]
    direction = camera.orientation.getValue().multVec(coin.SbVec3f(0, 0, -1)) * camera.focalDistance.getValue()
    reported["seen"] = [a - b for a, b in zip((camera.position.getValue() + direction).getValue(), point, strict=True)]
    reported["verdict"], reported["posed"] = _verdict(table.parentWidget()), scene.played
    found.Machine.ViewObject.Visibility = False
    reported["saved"] = picture_of_all("reach.png")
    found.Machine.ViewObject.Visibility = True
    FreeCADGui.getDocument("hexapod").resetEdit()
    settle()
    reported["posed at rest again"] = not scene.played
    reported["panel_is_left_open"] = bool(FreeCADGui.Control.activeDialog())
    document.undo()
    reported["after_undo"] = found.ColourBy
    return reported


def _verdict(panel):
    (line,) = [each for each in panel.findChildren(Verdict) if each.parent() == panel]
    return [line.text(), "#1b7f3b" in line.styleSheet()]


@step
def a_place_is_found():
    """The job stands where the machine does not reach; the panel finds where it does, previews and takes it."""
    document = new_document("far_away")
    job = document.getObject("Job")
    job.PostProcessorArgs = "--machine example_6tps --work-offset=600,0,200,10 --part none --stock none"
    document.recompute()
    press("PKM_Machine", job)
    press("PKM_Reach", job)
    found, machine = document.getObject("Reach"), document.getObject("Machine")
    found.ViewObject.Proxy.doubleClicked(found.ViewObject)
    settle()
    (row,) = FreeCADGui.getMainWindow().findChildren(PlaceRow)
    reported = {"before": _verdict(row.parentWidget()), "take is shown at first": row.take.isVisible()}
    click(row.search)
    until(lambda: row.found is not None)
    reported |= {
        "text": row.result.text(),
        "amounts": row.found.text(),
        "posed": machine.ViewObject.Proxy.played,
        "unchanged": job.PostProcessorArgs,
        "saved": picture_of_all("place.png"),
    }
    offset = row.found.reach.trajectory.machine_from_work[:3, 3].tolist()
    click(row.take)
    settle()
    reported |= {
        "after": _verdict(row.parentWidget()),
        "reachable": found.Reachable,
        "arguments": job.PostProcessorArgs,
        "moved": [a - b for a, b in zip(machine.WorkOffset.Base, offset, strict=True)],
    }
    FreeCADGui.getDocument("far_away").resetEdit()
    settle()
    document.undo()
    document.recompute()
    reported["after undo"] = [job.PostProcessorArgs, found.Reachable]
    FreeCAD.closeDocument("far_away")
    return reported


@step
def reach_of_a_collision():
    """A rapid move through the stock: struts and joints are in their limits, and posting refuses it."""
    document = new_document("colliding")
    job, operation = document.getObject("Job"), document.getObject("Custom")
    operation.Gcode = ["G0 X0 Y0 Z60", "G0 Z-15", "G1 X2 Y1 Z-15 F25", "G0 Z60"]
    document.recompute()
    press("PKM_Reach", job)
    found = document.getObject("Reach")
    found.ViewObject.Proxy.doubleClicked(found.ViewObject)
    settle()
    (table,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTableWidget, "PkmReachTable")
    (rows,) = table.parentWidget().findChildren(FindingRows)
    texts = [rows.item(number).text() for number in range(rows.count())]
    rows.picked.emit(0)
    settle()
    message = FreeCADGui.getMainWindow().statusBar().currentMessage()
    reported = {
        "verdict": _verdict(table.parentWidget()),
        "rows": sorted(text for text in texts if "error" in text),
        "posting": _refusals(job),
        "selected": [item.Label for item in FreeCADGui.Selection.getSelection()],
        "reported": message,
        "saved": picture_of_all("collision.png"),
    }
    FreeCADGui.getDocument("colliding").resetEdit()
    settle()
    return reported


def _refusals(job):
    try:
        post_job(job, out=FOLDER)
    except Refused as refused:
        return sorted(str(each) for each in errors(refused.diagnostics))
    return []


main()
