# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting from the panel: files and the certificate, or the reasons and no file; what the job and the user keep."""

import contextlib
import os
import sys
import time
from pathlib import Path
from unittest import mock

import FreeCAD
import FreeCADGui
from gui import (
    FOLDER,
    answer,
    click,
    click_named,
    main,
    new_document,
    picture,
    picture_of_all,
    press,
    select,
    settle,
    step,
    until,
)
from PySide import QtCore, QtGui, QtWidgets

NUMBERS = "--tip-tolerance 0.00137 --axis-tolerance 0.00123 --spin x-in-plane=12.3456 --work-offset=0.5,-1.25,250"
LONG = ["G0 X0 Y0 Z30", *(f"G1 X{x % 2 * 20} Y{x * 0.02} Z20 F30" for x in range(400)), "G0 Z30"]


class Panel:
    """The panel that is open, by its widgets."""

    def __init__(self):
        from pkm_post.freecad_gui.post_fields import PostChoices
        from pkm_post.freecad_gui.post_outcome import PostOutcome
        from pkm_post.freecad_gui.post_panel import NAME

        self.form = FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, NAME)
        inside = self.form.findChildren(QtWidgets.QWidget)
        (self.choices,) = [each for each in inside if isinstance(each, PostChoices)]
        (self.outcome,) = [each for each in inside if isinstance(each, PostOutcome)]
        self.buttons = {each.text(): each for each in inside if isinstance(each, QtWidgets.QPushButton)}

    def post(self):
        """Press the button and wait for the end; the longest time for which the window did nothing, ms."""
        clock = _Clock()
        click(self.buttons["Post"])
        self.wait()
        return clock.longest()

    def wait(self):
        return until(self.buttons["Post"].isEnabled, 60)

    def rows(self):
        listed = self.outcome.diagnostics
        return [listed.item(row).text() for row in range(listed.count())]


class _Clock:
    """Measures how long the window does nothing."""

    def __init__(self):
        self._timer, self._last, self._longest = QtCore.QTimer(), time.perf_counter(), 0.0
        self._timer.timeout.connect(self._tick)
        self._timer.start(5)

    def _tick(self):
        now = time.perf_counter()
        self._longest, self._last = max(self._longest, now - self._last), now

    def longest(self):
        self._timer.stop()
        return round(1000 * self._longest)


def saved(name):
    document, folder = new_document(name), FOLDER / name
    folder.mkdir()
    document.saveAs(str(folder / f"{name}.FCStd"))
    return document, folder


def names_in(folder):
    return sorted(file.name for file in folder.iterdir())


def open_panel(document):
    press("PKM_Post", document.getObject("Job"))
    return Panel()


def typed(field, text):
    """Type into a field with a unit, and leave it."""
    field.selectAll()
    field.findChild(QtWidgets.QLineEdit).setText(text)
    field.editingFinished.emit()


def clicked(listed, item):
    """Click a row: names of what is selected then, and what the status bar says."""
    FreeCADGui.Selection.clearSelection()
    listed.itemClicked.emit(item)
    selected = [each.Name for each in FreeCADGui.Selection.getSelection()]
    return selected, FreeCADGui.getMainWindow().statusBar().currentMessage()


def close():
    FreeCADGui.Control.closeDialog()
    settle()


@step
def posting_shows_the_certificate():
    document, folder = saved("gui")
    panel = open_panel(document)
    panel.choices.also["csv"].setChecked(True)
    typed(panel.choices.tip_tolerance, "0.002 mm")
    before = document.UndoCount
    longest = panel.post()
    found = {
        "steps to undo": document.UndoCount - before,
        "files": names_in(folder),
        "verdict": panel.outcome.verdict.text(),
        "findings": panel.outcome.findings.rowCount(),
        "report": panel.outcome.report.isVisible(),
        "drawn": picture("posted.png"),
        "longest": longest,
        "clicked": clicked(panel.outcome.findings, panel.outcome.findings.item(0, 0)),
        "where": panel.outcome.findings.item(0, 4).text(),
    }
    close()
    return found


@step
def panel_fits_a_narrow_dock():
    """Its least width, and its numbers with the decimals that they need."""
    document, _ = saved("narrow")
    document.getObject(
        "Job"
    ).PostProcessorArgs = "--tip-tolerance 0.001 --axis-tolerance 0.00123 --spin x-in-plane=12.3456"
    panel = open_panel(document)
    fields = panel.choices.tip_tolerance, panel.choices.axis_tolerance, panel.choices.heading
    for field in fields:  # a field that was visited keeps its number
        field.setFocus()
        settle()
        field.clearFocus()
        field.editingFinished.emit()
    found = {
        "width": panel.form.minimumSizeHint().width(),
        "shown": [field.property("text") for field in fields],
        "text": panel.choices.text(),
    }
    panel.post()
    found["width with a certificate"] = panel.form.minimumSizeHint().width()
    close()
    return found


@step
def numbers_stay_in_every_unit_system():
    """Each field is visited and the panel opened again; FreeCAD's own fields round, and cannot read 12°20′44″."""
    document, found = new_document("units"), {}
    job = document.getObject("Job")
    for system in range(10):
        job.PostProcessorArgs = NUMBERS
        FreeCAD.Units.setSchema(system)
        for _ in range(2):
            panel = open_panel(document)
            for field in (panel.choices.tip_tolerance, panel.choices.axis_tolerance, panel.choices.heading):
                field.setFocus()
                settle()
                field.clearFocus()
                field.editingFinished.emit()
            click_named("Apply")
            close()
        FreeCAD.Units.setSchema(0)
        found[system] = job.PostProcessorArgs
    return found


@step
def job_keeps_what_was_chosen():
    from pkm_post.writing import manifest

    document = FreeCAD.getDocument("gui")
    job, folder = document.getObject("Job"), FOLDER / "gui"
    kept = [job.PostProcessor, job.PostProcessorArgs, job.PostProcessorOutputFile]
    ours = (folder / "gui.pmc").read_bytes()
    (folder / "gui.pmc").unlink()
    FreeCADGui.activateWorkbench("CAMWorkbench")
    FreeCAD.setActiveDocument("gui")
    press("CAM_Post", job)
    same = (folder / "gui.pmc").read_bytes() == ours
    listed = manifest.check(folder / "gui.pmc")[0] is not None
    shown = open_panel(document)
    again = {"text": shown.choices.text(), "folder": shown.choices.folder.text()}
    close()
    document.undo()
    document.undo()
    return {"kept": kept, "same": same, "listed": listed, "again": again, "undone": job.PostProcessorArgs}


@step
def refused_job_is_reported_and_leaves_nothing():
    document, folder = saved("refused")
    document.getObject("Custom").Gcode = ["G0 X0 Y0 Z30", "G1 X10 F0"]
    document.recompute()
    panel = open_panel(document)
    panel.post()
    place = clicked(panel.outcome.diagnostics, panel.outcome.diagnostics.item(0))
    found = {"files": names_in(folder), "reported": panel.rows(), "clicked": place, "drawn": picture("refused.png")}
    close()
    return found


@step
def refusal_that_a_place_mends_offers_one():
    """The job stands where the machine does not reach. Escape stops a search; what a second one finds is posted."""
    from pkm_post.freecad_gui.place_row import PlaceRow

    document, folder = saved("place")
    job = document.getObject("Job")
    job.PostProcessorArgs = "--work-offset=600,0,200 --part none --stock none"
    panel = open_panel(document)
    (row,) = panel.form.findChildren(PlaceRow)
    found = {"at first": row.isVisible()}
    panel.post()
    found |= {"refused": panel.rows(), "offered": row.isVisible()}
    click(row.search)
    found["bar"] = row.bar.isVisible() and row.stop.isVisible()
    escape = QtGui.QKeyEvent(
        QtCore.QEvent.Type.KeyPress, QtCore.Qt.Key.Key_Escape, QtCore.Qt.KeyboardModifier.NoModifier
    )
    QtWidgets.QApplication.sendEvent(panel.form, escape)
    until(row.search.isEnabled)
    found |= {"stopped": row.result.text(), "panel": panel.form.isVisible(), "nothing": row.found is None}
    click(row.search)
    until(lambda: row.found is not None, 60)
    click(row.take)
    found["offset"] = panel.choices.work_offset.currentText()
    panel.post()
    found |= {"verdict": panel.outcome.verdict.text(), "files": names_in(folder), "kept": job.PostProcessorArgs}
    close()
    return found


@step
def refusal_of_cams_own_command_is_shown_once():
    """Its rows stand in a window; the document, its undo steps and the folder are as before."""
    FreeCADGui.activateWorkbench("CAMWorkbench")
    document, folder = saved("cam_refused")
    job = document.getObject("Job")
    job.PostProcessorOutputFile = str(folder / "cam_refused.pmc")
    document.getObject("Custom").Gcode = ["G0 X0 Y0 Z30", "G1 X10 F0"]
    document.recompute()
    before, FreeCAD.ActiveDocument = document.UndoCount, document
    press("CAM_Post", job)
    press("CAM_Post", job)
    windows = FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialog, "PkmRefusal")
    (shown,) = [each for each in windows if each.isVisible()]
    rows = shown.outcome.diagnostics
    found = {
        "files": names_in(folder),
        "rows": [rows.item(number).text() for number in range(rows.count())],
        "verdict": shown.outcome.verdict.text(),
        "undo steps": document.UndoCount - before,
        "transaction is open": document.HasPendingTransaction,
        "drawn": picture("cam_refused.png"),
        "clicked": clicked(rows, rows.item(0)),
        "offers a place": shown.place.isVisible(),
    }
    document.getObject("Custom").Gcode = ["G0 X0 Y0 Z30", "G1 X10 F10"]
    job.PostProcessorArgs = "--work-offset=600,0,200 --part none --stock none"
    document.recompute()
    press("CAM_Post", job)
    windows = FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialog, "PkmRefusal")
    (shown,) = [each for each in windows if each.isVisible()]
    found["offers a place out of reach"] = shown.place.isVisible()
    shown.reject()
    return found


def lacking(*_, **__):
    raise MemoryError("Unable to allocate 7 GiB")


@step
def lack_of_memory_is_reported_and_leaves_nothing():
    from pkm_post.freecad_gui import command, post_panel
    from pkm_post.planning import feed_plan

    document, folder = saved("lacking")
    panel, reported, boxes = open_panel(document), [], []
    with mock.patch.object(post_panel, "prepared_job", lacking):  # in the thread of the window
        panel.post()
    reported.append(panel.rows())
    with mock.patch.object(feed_plan, "tool_path", lacking):  # beside it
        panel.post()
    reported.append(panel.rows())
    close()
    shown = mock.patch.object(command.QtWidgets.QMessageBox, "warning", lambda *what: boxes.append(what[2]))
    with shown, command.show_faults("Mirror"):
        lacking()
    return {"files": names_in(folder), "reported": reported, "boxes": boxes}


@step
def arguments_without_a_meaning_are_reported():
    document, folder = saved("meaningless")
    panel = open_panel(document)
    panel.choices.more.setText("--no-such-argument 'and a quote")
    panel.post()
    found = {"files": names_in(folder), "reported": panel.rows(), "kept": document.getObject("Job").PostProcessorArgs}
    close()
    return found


@step
def cancelled_job_leaves_nothing():
    document, folder = saved("cancelled")
    document.getObject("Custom").Gcode = LONG
    document.recompute()
    panel = open_panel(document)
    click(panel.buttons["Post"])
    enabled = panel.buttons["Cancel"].isEnabled()
    click(panel.buttons["Cancel"])
    ended = panel.wait()
    found = {
        "files": names_in(folder),
        "reported": panel.outcome.verdict.text(),
        "ended": ended,
        "could": enabled,
        "can": panel.buttons["Cancel"].isEnabled(),
    }
    close()
    return found


@step
def editor_asks_in_the_same_fields():
    from pkm_post.freecad_gui.editor import open_editor
    from pkm_post.freecad_gui.post_fields import PostChoices

    file, ended, reported = FOLDER / "lines" / "lines.ngc", [], []
    file.parent.mkdir()
    file.write_text("T1 M6 G43 H1\nG21 G90 G94 S8000 M3\nG0 X0 Y0 Z30\nG1 X10 F600\nM5\nM30\n")

    def fill():
        dialog = QtWidgets.QApplication.activeModalWidget()
        (fields,) = [each for each in dialog.findChildren(QtWidgets.QWidget) if isinstance(each, PostChoices)]
        fields.work_offset.setEditText("0,0,250")
        fields.folder.setText(str(FOLDER / "lines" / "out"))
        answer(reported)
        dialog.accept()

    editor = open_editor()
    editor.open_file(file)
    editor.posting.ended.connect(lambda: ended.append(True))
    QtCore.QTimer.singleShot(300, fill)
    editor.post()
    until(lambda: ended, 60)
    editor.close()
    return {"files": names_in(FOLDER / "lines" / "out"), "reported": reported}


@step
def preferences_are_what_a_new_job_is_offered():
    from pkm_post.freecad_gui.preferences import PostPreferences

    page = PostPreferences()
    page.loadSettings()
    typed(page.choices.axis_tolerance, "0.005 deg")
    page.choices.spin.setCurrentIndex(page.choices.spin.findData("y-in-plane"))
    typed(page.choices.heading, "30 deg")
    page.choices.folder.setText(str(FOLDER / "elsewhere"))
    page.saveSettings()
    document, _ = saved("new")
    job = document.getObject("Job")
    job.PostProcessorArgs = ""
    panel = open_panel(document)
    offered = {"text": panel.choices.text(), "folder": panel.choices.folder.text()}
    close()
    from pkm_post.freecad_app.arguments import own_arguments

    return {"offered": offered, "headless": own_arguments(job).axis_tolerance}


@step
def preferences_have_a_page():
    seen = []

    def look():
        dialog = QtWidgets.QApplication.activeModalWidget()
        if dialog is None:
            QtCore.QTimer.singleShot(100, look)
            return
        settle()
        seen.append(picture("preferences.png"))
        seen.append([each.text() for each in dialog.findChildren(QtWidgets.QLabel) if "post panel" in each.text()])
        dialog.reject()

    QtCore.QTimer.singleShot(200, look)
    FreeCADGui.showPreferences("PKM Post", 0)
    return {"seen": seen}


@step
def preferences_are_judged_kept_and_reset():
    from pkm_post.freecad_gui.preferences import GROUP, PostPreferences

    page, found = PostPreferences(), {}
    page.loadSettings()
    page.form.show()
    for name, field, text in (
        ("machine", page.choices.machine.lineEdit(), "nosuch"),
        ("file", page.choices.machine.lineEdit(), "beside the document.toml"),
        ("number", page.choices.more, "--surface-speed=fast"),
        ("quote", page.choices.more, '--part "my part.stl'),
        ("none", page.choices.more, ""),
    ):
        field.setText(text)
        found[name] = page.verdict.text() if page.verdict.isVisible() else ""
    typed(page.choices.tip_tolerance, "0.002 mm")
    page.choices.more.setText('--part "my part.stl')
    page.every.setValue(7)
    page.saveSettings()
    again = PostPreferences()
    again.loadSettings()
    found["text"] = again.choices.more.text()
    again.choices.more.setText(found["text"] + '"')
    found["cured"], found["every"] = again.choices.text(), again.every.value()

    def choose():
        menu = QtWidgets.QApplication.activePopupWidget()
        if menu is None:
            QtCore.QTimer.singleShot(100, choose)
            return
        menu.setActiveAction(menu.actions()[0])
        for kind in (QtCore.QEvent.Type.KeyPress, QtCore.QEvent.Type.KeyRelease):
            key = QtGui.QKeyEvent(kind, QtCore.Qt.Key.Key_Return, QtCore.Qt.KeyboardModifier.NoModifier)
            QtWidgets.QApplication.sendEvent(menu, key)

    def look():
        dialog = QtWidgets.QApplication.activeModalWidget()
        if dialog is None:
            QtCore.QTimer.singleShot(100, look)
            return
        buttons = dialog.findChildren(QtWidgets.QPushButton)
        reset = [each for each in buttons if each.text() == "Reset" and each.isVisible()]
        QtCore.QTimer.singleShot(100, choose)
        reset[0].click()
        dialog.reject()

    QtCore.QTimer.singleShot(200, look)
    FreeCADGui.showPreferences("PKM Post", 0)
    entries = FreeCAD.ParamGet(GROUP)
    return found | {
        "left": [entries.GetString("Arguments"), entries.GetString("Folder"), entries.GetInt("ToolAxisEvery")]
    }


@step
def panel_closes_with_its_job():
    document, _ = saved("deleted")
    open_panel(document)
    select(document.getObject("Job"))
    FreeCAD.closeDocument(document.Name)
    settle()
    return {"open": bool(FreeCADGui.Control.activeDialog())}


@step
def panel_closed_by_another_command_stops_posting():
    document, folder = saved("closed")
    document.getObject("Custom").Gcode = LONG
    document.recompute()
    panel = open_panel(document)
    click(panel.buttons["Post"])
    running = panel.buttons["Cancel"].isEnabled()
    FreeCADGui.Control.closeDialog()
    until(lambda: not FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, "PkmPostPanel"))
    FreeCAD.closeDocument(document.Name)  # a traceback of what still follows it would be a fault of the scene
    settle()
    return {"running": running, "files": names_in(folder)}


def column_is_posted():
    """A picture of the panel with the tapered column for docs/pictures; it asserts nothing, and so it is no test."""
    sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "tapered_column"))
    from build import build

    build(out=FOLDER)
    for name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)
    document = FreeCAD.openDocument(str(FOLDER / "tapered_column.FCStd"))  # as make demo does, for the same figures
    document.recompute()
    job = document.getObject("Job")
    job.PostProcessorArgs = "--machine example_6tps"
    for item in (job.Stock, job.Tools.Group[0].Tool):
        item.ViewObject.Visibility = False
    FreeCADGui.activateWorkbench("CAMWorkbench")
    panel = open_panel(document)
    with contextlib.chdir(FOLDER):
        panel.choices.folder.setText("programs")  # in the picture no folder of this computer
        panel.post()
    found = picture_of_all("post_panel.png")
    close()
    return {"drawn": found}


if "PKM_PICTURES" in os.environ:
    step(column_is_posted)


main()
