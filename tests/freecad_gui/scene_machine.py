# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine and Reach from their buttons."""

import contextlib
import os

import FreeCAD
import FreeCADGui
from gui import FOLDER, click, click_named, main, new_document, picture, picture_of_all, press, settle, step, until
from pivy import coin
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.core_texts import fault_text
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
    panel_axes = table.parentWidget().findChild(QtWidgets.QSpinBox)
    panel_axes.setValue(2)
    reported["axes"] = view._axes.getNumChildren()
    panel_axes.setValue(0)
    reported["no axes"] = view._axes.getNumChildren()
    reported["seen"] = [a - b for a, b in zip((camera.position.getValue() + direction).getValue(), point, strict=True)]
    reported["verdict"], reported["posed"] = _verdict(table.parentWidget()), scene.mover is not None
    found.Machine.ViewObject.Visibility = False
    reported["saved"] = picture_of_all("reach.png")
    found.Machine.ViewObject.Visibility = True
    FreeCADGui.getDocument("hexapod").resetEdit()
    settle()
    reported["posed at rest again"] = scene.mover is None
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
        "posed": machine.ViewObject.Proxy.mover is not None,
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


@step
def icons_say_what_reach_found():
    """Job and operations in the tree: no sign, then green, old after a change, and red where an error is."""
    import Path.Main.Gui.Job
    import Path.Op.Gui.Base
    import Path.Op.Gui.Custom
    from cam_jobs import add_operation

    document = new_document("icons")
    job, good = document.getObject("Job"), document.getObject("Custom")
    job.PostProcessorArgs += " --part none --stock none"
    bad = add_operation(job, label="Bad")
    job.ViewObject.Proxy = Path.Main.Gui.Job.ViewProvider(job.ViewObject)
    for each in (good, bad):
        each.ViewObject.Proxy = Path.Op.Gui.Base.ViewProvider(each.ViewObject, Path.Op.Gui.Custom.Command.res)
    labels = {"job": "Job", "good": good.Label, "bad": bad.Label}
    found = {"at first": _signs(labels)}
    press("PKM_Reach", job)
    reach = document.getObject("Reach")
    labels["reach"] = reach.Label
    until(lambda: all(_signs(labels).values()))
    found["all well"] = _signs(labels)
    bad.Gcode = ["G0 X0 Y0 Z30", "G1 X900 Y0 Z30 F25"]
    until(lambda: not _signs({"bad": bad.Label})["bad"])
    found["changed"] = _signs({"bad": bad.Label})
    document.recompute()
    until(lambda: _signs(labels)["bad"] == "bad")
    found["out of reach"] = _signs(labels)
    found["saved"] = picture("verdict_icons.png")
    document.removeObject(reach.Name)
    until(lambda: not _signs({"job": "Job"})["job"])
    others = {name: label for name, label in labels.items() if name != "reach"}
    found["without reach"] = _signs(others)
    from pkm_post.freecad_app.simulation_object import create_simulation

    create_simulation(job)
    document.recompute()
    until(lambda: _signs(others)["bad"] == "bad")
    found["by a simulation"] = _signs(others)
    document.removeObject("Simulation")
    until(lambda: not _signs({"job": "Job"})["job"])
    found["refused"] = _signs_after_post(job, others)
    bad.Gcode = ["G0 X0 Y0 Z30", "G1 X9 Y0 Z30 F25"]
    document.recompute()
    until(lambda: not _signs({"job": "Job"})["job"])
    found["mended"] = _signs(others)
    found["posted"] = _signs_after_post(job, others)
    good.Visibility = not good.Visibility  # changes nothing of what was posted
    found["hidden"] = _signs(others)
    FreeCAD.closeDocument("icons")
    return found


def _signs_after_post(job, labels):
    """The signs that a post brings."""
    folder = FOLDER / "icons"
    folder.mkdir(exist_ok=True)
    with contextlib.suppress(Refused):
        post_job(job, out=folder)
    until(lambda: _signs({"job": "Job"})["job"])
    return _signs(labels)


@step
def icons_of_dressups_and_copies_say_it_too():
    """A compensated operation and its copies have signs; what they are made from has none where it is not posted."""
    from cam_jobs import add_operation, job_in_reach

    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document = FreeCAD.newDocument("dressups")
    job = job_in_reach(document)
    job.PostProcessorArgs += " --part none --stock none"
    contacts = add_operation(job, ["G0 X5 Y5 Z40", "G1 Z20 F10", "G1 X15", "G0 Z40"], "Contacts")
    press("PKM_NormalCompensation", contacts)
    for command in ("PKM_Mirror", "PKM_Rotate"):
        press(command, job.Operations.Group[0])
        SymmetryPanel.opened.accept()
        settle()
    compensated, mirrored, turned = job.Operations.Group
    labels = {"base": contacts.Label, "compensated": compensated.Label, "mirrored": mirrored.Label}
    labels["turned"] = turned.Label
    found = {"at first": _signs(labels, "dressups")}
    press("PKM_Reach", job)
    until(lambda: _signs(labels, "dressups")["turned"])
    found["all well"] = _signs(labels, "dressups")
    found["saved"] = picture("verdict_dressups.png")
    contacts.Gcode = ["G0 X5 Y5 Z900", "G1 Z20 F10", "G1 X15", "G0 Z900"]
    until(lambda: not _signs(labels, "dressups")["compensated"])
    document.recompute()
    until(lambda: _signs(labels, "dressups")["turned"] == "bad")
    found["out of reach"] = _signs(labels, "dressups")
    turned.Copies = 0  # an error, after which FreeCAD leaves Reach as it was
    document.recompute()
    settle()
    found["with an error"] = _signs(labels, "dressups")
    reach = document.getObject("Reach")
    reach.ViewObject.Proxy.doubleClicked(reach.ViewObject)
    settle()
    (table,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTableWidget, "PkmReachTable")
    found["panel"], found["turned"] = _verdict(table.parentWidget()), turned.Label
    FreeCADGui.getDocument("dressups").resetEdit()
    settle()
    FreeCAD.closeDocument("dressups")
    return found


def _signs(labels, name="icons"):
    """For each object the sign in its icon in the tree, by the colour that its lower right corner has."""
    trees = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTreeWidget)
    (tree,) = [each for each in trees if each.topLevelItemCount()]

    def entry(label):
        tree.expandAll()  # FreeCAD 1.0 fills what is closed when it is opened
        document = _index(tree.model(), FreeCAD.getDocument(name).Label, QtCore.QModelIndex())
        return None if document is None else _index(tree.model(), label, document)

    until(lambda: all(entry(label) is not None for label in labels.values()))
    return {name: _sign(entry(label)) for name, label in labels.items()}


def _index(model, text, below):
    """The entry with this text in the tree; a wrapped item would not outlive that of its parent."""
    left = [model.index(row, 0, below) for row in range(model.rowCount(below))]
    while left:
        index = left.pop()
        if index.data() == text:
            return index
        left += [model.index(row, 0, index) for row in range(model.rowCount(index))]
    return None


def _sign(index):
    image = index.data(QtCore.Qt.ItemDataRole.DecorationRole).pixmap(64, 64).toImage()
    width, height = image.width(), image.height()
    pixels = [image.pixelColor(x, y) for x in range(width * 5 // 8, width) for y in range(height * 5 // 8, height)]
    signs = {"good": (27, 127, 59), "bad": (179, 38, 30)}
    found = {
        sign: sum(max(abs(p.red() - r), abs(p.green() - g), abs(p.blue() - b)) < 40 for p in pixels) / len(pixels)
        for sign, (r, g, b) in signs.items()
    }
    return next((sign for sign, share in found.items() if share > 0.25), "")


def _refusals(job):
    try:
        post_job(job, out=FOLDER)
    except Refused as refused:
        return sorted(map(fault_text, errors(refused.diagnostics)))
    return []


@step
def jogged_after_a_double_click():
    """Steps, typed values, out of limits, home; Cancel takes all of it back. The camera shows the new machine."""
    from pkm_post.freecad_gui.jog_panel import JogPanel

    document = new_document("jogged")
    camera = FreeCADGui.activeView().getCameraNode()
    camera.height = 5.0  # the machine is a metre wide
    press("PKM_Machine", document.getObject("Job"))
    machine = document.getObject("Machine")
    until(lambda: camera.height.getValue() > 500.0)
    view, begun = machine.ViewObject.Proxy, list(machine.Tip)
    opened, panels = JogPanel.__init__, []
    JogPanel.__init__ = lambda panel, obj: (opened(panel, obj), panels.append(panel))[0]
    try:
        view.doubleClicked(machine.ViewObject)
        settle()
    finally:
        JogPanel.__init__ = opened
    (panel,) = panels
    found = {"verdict": _verdict(panel.form), "fields": len(panel.fields), "saved": picture("jog.png")}
    panel.buttons[0][1].click()
    panel.buttons[4][1].click()
    found |= {
        "moved": [a - b for a, b in zip(machine.Tip, begun, strict=True)],
        "axis": list(machine.ToolAxis),
        "struts": [machine.Strut1.Value, machine.Strut4.Value],
    }
    panel.fields[0].setProperty("rawValue", 900.0)
    panel.fields[0].editingFinished.emit()
    found |= {"far": machine.Tip.x, "out": _verdict(panel.form)[1], "words": list(machine.OutOfLimits) != []}
    found["saved too"] = picture("jog_out.png")
    panel.home.click()
    machine.Tip = FreeCAD.Vector(900, 0, 100)  # as in the property view
    document.recompute()
    until(lambda: not _verdict(panel.form)[1], 10)
    found["followed"] = panel.fields[0].property("rawValue")
    panel.home.click()
    found["home"] = [a - b for a, b in zip(machine.Tip, begun, strict=True)]
    panel.buttons[2][0].click()
    panel.reject()
    settle()
    found |= {"back": list(machine.Tip) == begun, "closed": not FreeCADGui.Control.activeDialog()}
    FreeCAD.closeDocument("jogged")
    return found


@step
def stiffness_from_its_button():
    """The map over job and table, the softest place of each operation."""
    from pkm_post.freecad_gui.stiffness_panel import NAME

    document = FreeCAD.getDocument("hexapod")
    FreeCAD.setActiveDocument("hexapod")
    FreeCADGui.ActiveDocument = FreeCADGui.getDocument("hexapod")
    graph = FreeCADGui.activeView().getSceneGraph()
    before = graph.getNumChildren()
    press("PKM_Stiffness", document.getObject("Job"))
    form = FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, NAME)
    (line,), (rows,) = form.findChildren(Verdict), form.findChildren(FindingRows)
    (table,) = form.findChildren(QtWidgets.QCheckBox)
    found = {"summary": line.text(), "rows": [rows.item(row).text() for row in range(rows.count())]}
    rows.picked.emit(1)
    settle()
    machine = document.getObject("Machine").ViewObject
    found["selected"] = [item.Label for item in FreeCADGui.Selection.getSelection()]
    found["posed"] = machine.Proxy.mover is not None
    table.setChecked(True)
    reach = document.getObject("Reach").ViewObject
    found["reach"] = [reach.SwitchNode.whichChild.getValue(), reach.Visibility]  # not drawn, but visible once saved
    machine.Visibility = False
    found["saved"] = picture_of_all("stiffness.png")
    machine.Visibility = True
    click_named("Close")
    found["nodes left"] = graph.getNumChildren() - before
    found["reach again"] = reach.SwitchNode.whichChild.getValue()
    found["posed at rest again"] = machine.Proxy.mover is None
    press("PKM_Stiffness", document.getObject("Job"))
    FreeCADGui.Control.closeDialog()
    until(lambda: not FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, NAME))
    found["nodes left by another command"] = graph.getNumChildren() - before
    return found


main()
