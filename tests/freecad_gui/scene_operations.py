# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operations from their buttons: symmetry, Normal Compensation, Surface Finish; Escape stops what takes long."""

import os
import time

import FreeCAD
import FreeCADGui
from gui import FOLDER, click, job_on, main, new_document, picture_of_all, press, select, settle, step, until
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app import surface_check

surface_check._MOST_CLOSE = 1000  # how closely gouges are looked for is none of this scene's matter
PLATE = 8, 8, 4
"""mm. Every step along a pass and each point where a gouge is looked for takes its time."""


@step
def mirror_and_rotate_from_their_buttons():
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document = new_document("gui")
    for command in ("PKM_Mirror", "PKM_Rotate"):
        press(command, document.getObject("Custom"))
        SymmetryPanel.opened.accept()
        settle()
    made = document.getObject("Job").Operations.Group[1:]
    return {
        "labels": [item.Label for item in made],
        "views": [type(item.ViewObject.Proxy).__name__ for item in made],
        "icons": [os.path.basename(item.ViewObject.Proxy.getIcon()) for item in made],
        "moves": [len(item.Path.Commands) for item in made],
    }


@step
def undo_takes_one_step_back():
    document = FreeCAD.getDocument("gui")
    before = len(document.getObject("Job").Operations.Group)
    document.undo()
    document.recompute()
    return {"before": before, "after": len(document.getObject("Job").Operations.Group)}


@step
def normal_compensation_from_its_button():
    from cam_jobs import add_operation, new_job

    document = FreeCAD.newDocument("contacts")
    add_operation(new_job(document), ["G0 X5 Y5 Z40", "G1 Z20 F10", "G1 X15", "G0 Z40"])
    base = document.getObject("Custom")
    press("PKM_NormalCompensation", base)
    (dressup,) = document.getObject("Job").Operations.Group
    view = dressup.ViewObject.Proxy
    made = {
        "view": type(view).__name__,
        "icon": os.path.basename(view.getIcon()),
        "children": [child.Name for child in view.claimChildren()],
        "moves": len([command for command in dressup.Path.Commands if command.Name in ("G0", "G1")]),
        "base_is_shown": base.ViewObject.Visibility,
    }
    document.removeObject(dressup.Name)
    made["given_back"] = [item.Name for item in document.getObject("Job").Operations.Group]
    made["base_is_shown_again"] = base.ViewObject.Visibility
    FreeCAD.closeDocument("contacts")
    return made


@step
def surface_finish_from_its_button():
    import Part

    stock, job = job_on("finish", Part.makeBox(*PLATE), "600 mm/min")
    job.Document.UndoMode = 1
    active = {}
    for name, item in (("job", job), ("face", stock), ("controller", job.Tools.Group[0])):
        select(item)
        active[name] = FreeCADGui.Command.get("PKM_SurfaceFinish").isActive()
    select(stock, "Face6")
    press("PKM_SurfaceFinish")
    (operation,) = job.Operations.Group
    view = operation.ViewObject.Proxy
    reported = {
        "active": active,
        "view": type(view).__name__,
        "icon": os.path.basename(view.getIcon()),
        "faces": [name for _, names in operation.Base for name in names],
        "valid": operation.isValid(),
        "computed": operation.Path.Size > 0,
        "measured": operation.CheckSpacing.Value,
        "panel_is_open": view.panel is not None,
    }
    reported["stepover_shown"] = _change_stepover(view.panel, 2.0)
    view.panel.accept()
    job.Document.recompute()
    reported["accepted"], reported["passes"] = operation.Stepover.Value, operation.PassCount
    operation.ViewObject.Document.setEdit(operation.ViewObject, 0)
    settle()
    _change_stepover(view.panel, 5.0)
    view.panel.reject()
    settle()
    reported["rejected"], reported["panel_is_left_open"] = operation.Stepover.Value, FreeCADGui.Control.activeDialog()
    while job.Document.UndoCount and job.Operations.Group:
        job.Document.undo()
    reported["after_undo"] = len(job.Operations.Group)
    FreeCAD.closeDocument("finish")
    return reported


def _change_stepover(panel, to):
    """What the page shows for the stepover, before it is set to another one."""
    page = panel.featurePages[-1]
    field = page.form.fields["Stepover"]
    shown = field.property("rawValue")
    field.setProperty("rawValue", to)
    page.pageGetFields()
    return shown


@step
def escape_stops_a_long_computation():
    from pkm_post.freecad_app.progress import Progress, Stopped

    class Patient:
        """Computes until Escape is pressed, a minute at most."""

        def execute(self, item):
            item.Label2 = ""
            try:
                with Progress("Waiting", 6000) as progress:
                    for number in range(6000):
                        if number == 20:
                            window, key = FreeCADGui.getMainWindow(), QtCore.Qt.Key.Key_Escape
                            pressed = QtCore.QEvent.Type.KeyPress, key, QtCore.Qt.KeyboardModifier.NoModifier
                            QtCore.QCoreApplication.postEvent(window, QtGui.QKeyEvent(*pressed))
                        time.sleep(0.01)
                        progress.step()
            except Stopped as stopped:
                item.Label2 = f"{stopped}, step {number}"

    document = FreeCAD.newDocument("waiting")
    item = document.addObject("App::FeaturePython", "Patient")
    item.Proxy = Patient()
    document.recompute()
    inside = item.Label2
    item.Proxy.execute(item)
    reported = {"inside a recompute": inside, "alone": item.Label2}
    FreeCAD.closeDocument("waiting")
    return reported


@step
def escape_after_the_last_look_is_not_left_to_the_panel():
    from pkm_post.freecad_gui.observers import EscapeWatch

    watch, hits = EscapeWatch(), []
    watch.hit.connect(lambda: hits.append(True))
    watch.begin()
    watch.pressed("Waiting")
    key = QtCore.Qt.Key.Key_Escape, QtCore.Qt.KeyboardModifier.NoModifier
    event = QtGui.QKeyEvent(QtCore.QEvent.Type.KeyPress, *key)
    QtCore.QCoreApplication.postEvent(FreeCADGui.getMainWindow(), event)
    watch.pressed("Waiting")
    watch.end()
    return {"taken": len(hits)}


@step
def escape_pressed_twice_leaves_the_operation():
    import Part

    from pkm_post.freecad_app import surface_finish
    from pkm_post.freecad_app.progress import Stopped

    block, job = job_on("twice", Part.makeBox(*PLATE), "600 mm/min")
    job.Document.UndoMode = 1
    select(block, "Face6")
    press("PKM_SurfaceFinish")
    (operation,) = job.Operations.Group
    panel, steps = operation.ViewObject.Proxy.panel, surface_finish._steps
    field = panel.featurePages[-1].form.fields["Lines"]

    def escape():
        for kind in (QtCore.QEvent.Type.KeyPress, QtCore.QEvent.Type.KeyRelease):
            key = QtGui.QKeyEvent(kind, QtCore.Qt.Key.Key_Escape, QtCore.Qt.KeyboardModifier.NoModifier)
            QtCore.QCoreApplication.postEvent(field, key)

    def stopping(bar):
        escape()
        return steps(bar)

    kind, stopped = surface_finish.SurfaceFinish, []
    compute = kind.opExecute

    def without_report(proxy, item):
        """FreeCAD would write the exception to the Report view, and no scene may have one there."""
        try:
            compute(proxy, item)
        except Stopped as fault:
            stopped.append(str(fault))

    surface_finish._steps, kind.opExecute = stopping, without_report
    try:
        panel.clicked(QtWidgets.QDialogButtonBox.StandardButton.Apply)
        escape()
        settle()
    finally:
        surface_finish._steps, kind.opExecute = steps, compute
    reported = {
        "operations": len(job.Operations.Group),
        "open": bool(FreeCADGui.Control.activeDialog()),
        "stopped": stopped,
    }
    operation.touch()  # as it stays after an exception
    panel.clicked(QtWidgets.QDialogButtonBox.StandardButton.Apply)
    reported["computed later"] = operation.isValid() and operation.PassCount > 0
    panel.accept()
    settle()
    FreeCAD.closeDocument("twice")
    return reported


@step
def a_gouge_is_seen_on_the_part():
    """The floor beside a wall, finished with an upright flat mill: an error, in red, with a map."""
    import Part

    block, job = job_on("gouge", Part.makeBox(16, 8, 4).fuse(Part.makeBox(4, 8, 12)).removeSplitter(), "600 mm/min")
    faces = block.Shape.Faces
    is_floor = [abs(face.BoundBox.ZMax - 4) < 0.1 and face.BoundBox.ZLength < 0.1 for face in faces]
    select(block, f"Face{is_floor.index(True) + 1}")
    press("PKM_SurfaceFinish")
    (operation,) = job.Operations.Group
    page = operation.ViewObject.Proxy.panel.featurePages[-1]
    reported = {"before": _outcome(page)}
    nodes = FreeCADGui.activeView().getSceneGraph().getNumChildren()
    operation.ViewObject.Proxy.panel.clicked(QtWidgets.QDialogButtonBox.StandardButton.Apply)
    settle()
    reported |= {
        "gouged": _outcome(page),
        "state": operation.getStatusString(),
        "depth": operation.MaximumGouge,
        "map": FreeCADGui.activeView().getSceneGraph().getNumChildren() - nodes,
        "saved": picture_of_all("gouge.png"),
    }
    page.form.fields["CheckSpacing"].setProperty("rawValue", 0.0)
    operation.ViewObject.Proxy.panel.clicked(QtWidgets.QDialogButtonBox.StandardButton.Apply)
    settle()
    reported["not looked for"] = _outcome(page)
    operation.ViewObject.Proxy.panel.accept()
    settle()
    reported["left"] = FreeCADGui.activeView().getSceneGraph().getNumChildren() - nodes
    FreeCAD.closeDocument("gouge")
    return reported


@step
def the_map_of_a_reopened_document_comes_back_by_a_click():
    import Part

    block, job = job_on("again", Part.makeBox(*PLATE), "600 mm/min")
    select(block, "Face6")
    press("PKM_SurfaceFinish")
    (operation,) = job.Operations.Group
    operation.ViewObject.Proxy.panel.accept()
    job.Document.recompute()
    name = operation.Name
    measured = operation.MaximumGouge, operation.UnseenGouge
    file = FOLDER / "again.FCStd"
    job.Document.saveAs(str(file))
    FreeCAD.closeDocument(job.Document.Name)
    document = FreeCAD.openDocument(str(file))
    FreeCADGui.activateWorkbench("CAMWorkbench")
    operation = document.getObject(name)
    reported = {"measured": measured, "kept": (operation.MaximumGouge, operation.UnseenGouge)}
    operation.ViewObject.Document.setEdit(operation.ViewObject, 0)
    settle()
    page = operation.ViewObject.Proxy.panel.featurePages[-1]
    nodes = FreeCADGui.activeView().getSceneGraph().getNumChildren()
    reported |= {"before": _outcome(page), "offered": not page.form.again.isHidden()}
    click(page.form.again)
    until(page.form.again.isHidden)
    reported |= {
        "after": _outcome(page),
        "map": FreeCADGui.activeView().getSceneGraph().getNumChildren() - nodes,
        "saved": picture_of_all("map_again.png"),
    }
    operation.ViewObject.Proxy.panel.reject()
    settle()
    FreeCAD.closeDocument(document.Name)
    return reported


def _outcome(page):
    """The line at the top of the page, and its colour."""
    line = page.form.verdict
    colours = {"#1b7f3b": "green", "#b3261e": "red"}
    return [line.text(), next((name for code, name in colours.items() if code in line.styleSheet()), "")]


main()
