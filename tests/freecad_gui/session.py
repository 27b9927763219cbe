# SPDX-License-Identifier: LGPL-2.1-or-later
"""What happens in a FreeCAD with a window: run by FreeCAD, writes what it found as JSON and ends.

The environment names the files, since FreeCAD would open those that its command line names: PKM_RESULT for the JSON,
PKM_SCREENSHOT for a picture of the window. Each step is a function; an exception in one is its result, and the others
still run.
"""

import json
import os
import sys
import time
import traceback

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

sys.path[:0] = [os.path.dirname(os.path.dirname(os.path.abspath(__file__)))]
sys.path[:0] = [os.path.join(sys.path[0], "freecad_app")]

RESULT, SCREENSHOT = os.environ["PKM_RESULT"], os.environ["PKM_SCREENSHOT"]
STEPS = []


def step(function):
    STEPS.append(function)
    return function


def select(item):
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(item)


def settle():
    for _ in range(20):
        QtWidgets.QApplication.processEvents()


@step
def workbench_has_its_commands():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    settle()
    window = FreeCADGui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtWidgets.QToolBar) if bar.windowTitle() == "PKM Post"]
    actions = [action for bar in bars for action in bar.actions()]
    return {
        "listed": "PkmPostWorkbench" in FreeCADGui.listWorkbenches(),
        "buttons": [action.text() for action in actions],
        "icons": [not action.icon().isNull() for action in actions],
    }


@step
def job_is_made():
    from cam_jobs import add_operation, new_job

    document = FreeCAD.newDocument("gui")
    job = new_job(document)
    job.PostProcessor = "hexapod_pmac"
    job.PostProcessorArgs = "--work-offset=0,0,250"
    operation = add_operation(job)
    return {"job": job.Name, "operation": operation.Name}


@step
def commands_know_what_they_are_for():
    document = FreeCAD.getDocument("gui")
    job, operation = document.getObject("Job"), document.getObject("Custom")
    active = {}
    for name, item in (("job", job), ("operation", operation), ("controller", job.Tools.Group[0])):
        select(item)
        active[name] = [FreeCADGui.Command.get(f"PKM_{c}").isActive() for c in ("Mirror", "Rotate", "Post")]
    return active


@step
def mirror_and_rotate_from_their_buttons():
    document = FreeCAD.getDocument("gui")
    for command in ("PKM_Mirror", "PKM_Rotate"):
        select(document.getObject("Custom"))
        FreeCADGui.runCommand(command, 0)
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
    select(base)
    FreeCADGui.runCommand("PKM_NormalCompensation", 0)
    settle()
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
    FreeCAD.setActiveDocument("gui")
    return made


@step
def surface_finish_from_its_button():
    import Part
    import Path.Main.Gui.Job

    document = FreeCAD.newDocument("finish")
    stock = document.addObject("Part::Feature", "Block")
    stock.Shape = Part.makeBox(20, 20, 20)
    document.recompute()
    Path.Main.Gui.Job.Create([stock.Name], None, openTaskPanel=False)
    job = document.getObject("Job")
    controller = job.Tools.Group[0]
    controller.HorizFeed = controller.VertFeed = "600 mm/min"
    document.UndoMode = 1
    active = {}
    for name, item in (("job", job), ("face", stock), ("controller", controller)):
        select(item)
        active[name] = FreeCADGui.Command.get("PKM_SurfaceFinish").isActive()
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(stock, "Face6")
    FreeCADGui.runCommand("PKM_SurfaceFinish", 0)
    settle()
    (operation,) = job.Operations.Group
    view = operation.ViewObject.Proxy
    told = {
        "active": active,
        "view": type(view).__name__,
        "icon": os.path.basename(view.getIcon()),
        "faces": [name for _, names in operation.Base for name in names],
        "valid": operation.isValid(),
        "panel_is_open": view.panel is not None,
    }
    told["stepover_shown"] = _change_stepover(view.panel, 2.0)
    view.panel.accept()
    document.recompute()
    told["accepted"], told["passes"] = operation.Stepover.Value, operation.PassCount
    operation.ViewObject.Document.setEdit(operation.ViewObject, 0)
    settle()
    _change_stepover(view.panel, 5.0)
    view.panel.reject()
    settle()
    told["rejected"], told["panel_is_left_open"] = operation.Stepover.Value, FreeCADGui.Control.activeDialog()
    while document.UndoCount and job.Operations.Group:
        document.undo()
    told["after_undo"] = len(job.Operations.Group)
    FreeCAD.closeDocument("finish")
    FreeCAD.setActiveDocument("gui")
    return told


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
        """Computes for as long as nobody presses Escape, a minute at most."""

        def execute(self, item):
            item.Label2 = ""
            try:
                with Progress("Waiting", 6000) as progress:
                    for number in range(6000):
                        if number == 20:
                            window, key = FreeCADGui.getMainWindow(), QtCore.Qt.Key.Key_Escape
                            pressed = QtCore.QEvent.Type.KeyPress, key, QtCore.Qt.KeyboardModifier.NoModifier
                            QtWidgets.QApplication.postEvent(window, QtGui.QKeyEvent(*pressed))
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
    told = {"inside a recompute": inside, "alone": item.Label2}
    FreeCAD.closeDocument("waiting")
    FreeCAD.setActiveDocument("gui")
    return told


@step
def cam_menu_has_the_commands():
    FreeCADGui.activateWorkbench("CAMWorkbench")
    settle()
    texts = []
    for action in FreeCADGui.getMainWindow().menuBar().actions():
        if action.menu():
            texts += [item.text().replace("&", "") for item in _all_actions(action.menu())]
    return {"has": [text in texts for text in ("Mirror operation", "Rotate operation", "Post to a hexapod")]}


def _all_actions(menu):
    for action in menu.actions():
        yield action
        if action.menu():
            yield from _all_actions(action.menu())


@step
def post_command_writes_and_tells():
    document = FreeCAD.getDocument("gui")
    folder = os.path.dirname(RESULT)
    document.saveAs(os.path.join(folder, "gui.FCStd"))
    select(document.getObject("Job"))
    told = []
    QtCore.QTimer.singleShot(0, lambda: _close_message(told))
    FreeCADGui.runCommand("PKM_Post", 0)
    files = sorted(name for name in os.listdir(folder) if name.startswith("gui") and not name.endswith(".FCStd"))
    return {"files": files, "told": told}


@step
def refused_job_is_told_and_leaves_nothing():
    document = FreeCAD.getDocument("gui")
    folder = os.path.join(os.path.dirname(RESULT), "refused")
    os.mkdir(folder)
    document.saveAs(os.path.join(folder, "refused.FCStd"))
    for copy in document.getObject("Job").Operations.Group[1:]:
        document.removeObject(copy.Name)  # FreeCAD writes a traceback when a copy of a faulty operation is computed
    document.getObject("Custom").Gcode = ["G0 X0 Y0 Z30", "G1 X10 F0"]
    document.recompute()
    select(document.getObject("Job"))
    told = []
    QtCore.QTimer.singleShot(0, lambda: _close_message(told))
    FreeCADGui.runCommand("PKM_Post", 0)
    return {"files": [name for name in os.listdir(folder) if not name.endswith(".FCStd")], "told": told}


def _close_message(told):
    """Read the message box that is open and close it; come back while there is none."""
    box = QtWidgets.QApplication.activeModalWidget()
    if isinstance(box, QtWidgets.QMessageBox):
        told.append(box.text())
        box.accept()
    else:
        QtCore.QTimer.singleShot(50, lambda: _close_message(told))


@step
def window_is_drawn():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    FreeCADGui.SendMsgToActiveView("ViewFit")
    settle()
    return {"saved": QtGui.QGuiApplication.primaryScreen().grabWindow(0).save(SCREENSHOT)}


def main():
    results = {}
    for function in STEPS:
        try:
            results[function.__name__] = function()
        except Exception:
            results[function.__name__] = {"exception": traceback.format_exc()}
    with open(RESULT, "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


QtCore.QTimer.singleShot(1500, main)
