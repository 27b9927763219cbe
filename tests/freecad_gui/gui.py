# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the scenes share: steps in a FreeCAD with a window, and what they found as JSON.

A scene is a script that FreeCAD runs in its window: functions marked as steps, and a call of ``main``. An exception in
a step is its result, and ends the scene: what follows might wait for ever. The environment names the folder for what is
written (PKM_FOLDER), since FreeCAD would open files that its command line names. The last thing a scene reports is the
text of the Report view.
"""

import json
import os
import sys
import time
import traceback
from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

FOLDER = Path(os.environ["PKM_FOLDER"])
STEPS = []

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "freecad_app"))


def step(function):
    """Mark a function as a step; steps run in their order, and return what is written as JSON."""
    STEPS.append(function)
    return function


def select(item, *names):
    """Select one object, or some of its faces, and nothing else."""
    FreeCADGui.Selection.clearSelection()
    for name in names or ("",):
        FreeCADGui.Selection.addSelection(item, name)


def press(command, item=None):
    """Run a command as its button does, with this object selected, as soon as its button is not grey."""
    if item is not None:
        select(item)
    until(FreeCADGui.Command.get(command).isActive)
    FreeCADGui.runCommand(command, 0)
    settle()


def player_dock():
    """The open player; None if there is none."""
    return FreeCADGui.getMainWindow().findChild(QtWidgets.QDockWidget, "PkmPlayer")


def simulate(item):
    """Simulate a job, or show a simulation, and wait for its player: it opens when the document is computed."""
    before = player_dock()
    press("PKM_Simulate", item)
    until(lambda: player_dock() not in (None, before))
    return player_dock()


def settle():
    """Let the window do what is due."""
    for _ in range(20):
        QtWidgets.QApplication.processEvents()


def until(condition, seconds=900):
    """Let the window work until something is so; that it does not come to be so is an exception.

    The limit is for what hangs: on a busy machine a play may take minutes.
    """
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"not so within {seconds} s")
        QtWidgets.QApplication.processEvents()
        time.sleep(0.01)
    return True


def click(button):
    """Click a button as soon as it can be clicked; the click of a grey one would do nothing, without a word."""
    until(button.isEnabled)
    button.click()


def widget(kind, name):
    """The widget with this name, as soon as it can be seen."""

    def visible():
        return [each for each in FreeCADGui.getMainWindow().findChildren(kind, name) if each.isVisible()]

    until(visible)
    (found,) = visible()
    return found


def click_named(text):
    """Press the button of the open panel with this text."""
    buttons = FreeCADGui.getMainWindow().findChildren(QtWidgets.QPushButton)
    (button,) = [each for each in buttons if each.isVisible() and each.text().replace("&", "") == text]
    click(button)
    settle()


def agree():
    """Accept each question that CAM asks while its command runs."""
    asked, timer = [], QtCore.QTimer()

    def look():
        dialog = QtWidgets.QApplication.activeModalWidget()
        if dialog is not None:
            asked.append(dialog.windowTitle())
            dialog.accept()

    timer.timeout.connect(look)
    timer.start(100)
    return timer, asked


def tab_of(form, text):
    """The number of the tab with this text."""
    (index,) = [index for index in range(form.count()) if form.tabText(index).replace("&", "") == text]
    return index


def draw_views(are_drawn):
    """Draw the 3D views at each change, which the processor does here, or leave them as they are."""
    FreeCADGui.getMainWindow().centralWidget().setUpdatesEnabled(are_drawn)


def picture(name):
    """Keep a picture of the whole screen with its 3D views; whether it could be saved."""
    drawn_before = FreeCADGui.getMainWindow().centralWidget().updatesEnabled()
    draw_views(True)
    settle()
    saved = QtGui.QGuiApplication.primaryScreen().grabWindow(0).save(str(FOLDER / name))
    draw_views(drawn_before)
    return saved


def picture_of_all(name):
    """Look at everything that is visible, from the corner, and keep a picture."""
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    return picture(name)


def answer(reported):
    """Read the message box that will open, and close it."""
    QtCore.QTimer.singleShot(0, lambda: _close_message(reported))


def _close_message(reported):
    box = QtWidgets.QApplication.activeModalWidget()
    if isinstance(box, QtWidgets.QMessageBox):
        reported.append(box.text())
        box.accept()
    else:
        QtCore.QTimer.singleShot(50, lambda: _close_message(reported))


def new_document(name):
    """A document with undo, and a CAM job for a hexapod with one operation."""
    from cam_jobs import add_operation, new_job

    document = FreeCAD.newDocument(name)
    job = new_job(document)
    job.PostProcessor, job.PostProcessorArgs = "hexapod_pmac", "--work-offset=0,0,250"
    add_operation(job)
    document.UndoMode = 1
    return document


def job_on(name, shape, feed="0 mm/min"):
    """A document of this name with a solid of this shape and a job on it; the solid and the job."""
    import Path.Main.Gui.Job

    document = FreeCAD.newDocument(name)
    solid = document.addObject("Part::Feature", "Block")
    solid.Shape = shape
    document.recompute()
    Path.Main.Gui.Job.Create([solid.Name], None, openTaskPanel=False)
    job = document.getObject("Job")
    job.Tools.Group[0].HorizFeed = job.Tools.Group[0].VertFeed = feed
    return solid, job


def main(are_drawn=False):
    """Run the steps of the scene when the window stands, then end FreeCAD; views are drawn for pictures, or always."""
    QtCore.QTimer.singleShot(1500, lambda: _run(are_drawn))


def _run(are_drawn):
    results = {}
    draw_views(are_drawn)
    for function in STEPS:
        try:
            results[function.__name__] = function()
        except Exception:
            results[function.__name__] = {"exception": traceback.format_exc()}
            break
        (FOLDER / "so_far.txt").write_text("\n".join(results), encoding="utf-8")  # what a scene that hangs has done
    results["report view"] = _report_view()
    (FOLDER / "result.json").write_text(json.dumps(results, indent=1), encoding="utf-8")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


def _report_view():
    views = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTextEdit)
    (report,) = [view for view in views if view.metaObject().className() == "Gui::DockWnd::ReportOutput"]
    return report.toPlainText()
