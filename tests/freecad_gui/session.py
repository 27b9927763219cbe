# SPDX-License-Identifier: LGPL-2.1-or-later
"""What happens in a FreeCAD with a window: run by FreeCAD, writes what it found as JSON and ends.

The environment names the files, since FreeCAD would open those that its command line names: PKM_RESULT for the JSON,
PKM_SCREENSHOT for a picture of the window. Each step is a function; an exception in one is its result, and the others
still run.
"""

import json
import os
import sys
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
