# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD started in Chinese: buttons, a panel, the tool tip of a property; then English while it runs."""

from types import SimpleNamespace

import FreeCAD
import FreeCADGui
from gui import FOLDER, job_on, main, new_document, picture, press, settle, step
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.post_job import post_job
from pkm_post.model import Finding, Place

IMPERIAL = 3
DEVIATION = 2.54, 25.4, True, 0.0, Place("")
"""Value and limit in mm, and the rest of a finding."""


def _buttons():
    window = FreeCADGui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtWidgets.QToolBar) if bar.objectName() == "PKM Post"]
    return [(action.text(), action.statusTip()) for bar in bars for action in bar.actions() if not action.isSeparator()]


def _labels(widget):
    return [label.text() for label in widget.findChildren(QtWidgets.QLabel) if label.text()]


@step
def buttons_are_chinese():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    settle()
    return {"buttons": _buttons(), "tip": FreeCADGui.getWorkbench("PkmPostWorkbench").ToolTip}


@step
def panel_is_chinese():
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    document = new_document("gui")
    press("PKM_Mirror", document.getObject("Custom"))
    panel = SymmetryPanel.opened
    reported = {"labels": _labels(panel.form), "undo": list(document.UndoNames), "drawn": picture("panel.png")}
    reported["climb"] = panel.keep_climb.text()
    panel.accept()
    settle()
    reported["undo"] = list(document.UndoNames)
    (made,) = document.getObject("Job").Operations.Group[1:]
    said = made.getDocumentationOfProperty("KeepClimb")
    reported["said"] = QtCore.QCoreApplication.translate("App::Property", said)
    return reported


@step
def post_panel_is_chinese():
    press("PKM_Post", FreeCAD.getDocument("gui").getObject("Job"))
    panel = FreeCADGui.getMainWindow().findChild(QtWidgets.QWidget, "PkmPostPanel")
    reported = {"labels": _labels(panel), "drawn": picture("post.png")}
    FreeCADGui.Control.closeDialog()
    settle()
    return reported


@step
def choices_are_chinese_and_properties_are_not():
    import Part

    from pkm_post.freecad_app.surface_finish import create_surface_finish
    from pkm_post.freecad_gui.surface_finish_panel import CHOICES, ROWS

    _, job = job_on("finish", Part.makeBox(20, 20, 20))
    operation = create_surface_finish(job, [])
    operation.Active = False
    operation.ViewObject.Document.setEdit(operation.ViewObject, 0)
    settle()
    page = operation.ViewObject.Proxy.panel.featurePages[-1]
    field, lines = page.form.fields["Lines"], operation.getEnumerationsOfProperty("Lines")
    field.setCurrentIndex(lines.index("Parallel planes"))
    page.pageGetFields()
    chosen = {"shown": field.currentText(), "kept": operation.Lines, "tip": field.toolTip()}
    operation.ViewObject.Proxy.panel.accept()
    settle()
    words = [word for kind, name, _ in ROWS if kind == "choice" for word in operation.getEnumerationsOfProperty(name)]
    return chosen | {"unknown": sorted(set(words) - set(CHOICES))}


@step
def findings_are_chinese_and_in_the_units_of_the_user():
    """The job stands where the machine does not reach."""
    from pkm_post.freecad_gui.control_panel.texts import result_texts
    from pkm_post.freecad_gui.post_outcome import PostOutcome
    from pkm_post.freecad_gui.verdict import FindingRows

    document = new_document("far")
    job = document.getObject("Job")
    job.PostProcessorArgs = "--machine example_6tps --work-offset=600,0,200,10 --part none --stock none"
    press("PKM_Reach", job)
    FreeCAD.Units.setSchema(IMPERIAL)
    found = document.getObject("Reach")
    found.ViewObject.Proxy.doubleClicked(found.ViewObject)
    settle()
    (table,) = FreeCADGui.getMainWindow().findChildren(QtWidgets.QTableWidget, "PkmReachTable")
    (rows,) = table.parentWidget().findChildren(FindingRows)
    reported = {
        "checks": [[table.item(row, column).text() for column in range(5)] for row in range(table.rowCount())],
        "rows": [rows.item(row).text() for row in range(rows.count())],
        "kept": list(found.Violations),
        "drawn": picture("findings.png"),
    }
    FreeCADGui.getDocument("far").resetEdit()
    settle()
    job.PostProcessorArgs = "--machine example_6tps --work-offset=0,0,250 --part none --stock none"
    document.recompute()
    outcome = PostOutcome()
    outcome.show_posted(post_job(job, out=FOLDER))
    table = outcome.findings
    reported["certificate"] = [
        [table.item(row, column).text() for column in range(4)] for row in range(table.rowCount())
    ]
    reported["meaning"] = outcome.meaning.text().splitlines()
    log = SimpleNamespace(seconds=2.0, findings=[Finding("P201", "deviation of the tool tip", "mm", *DEVIATION)])
    reported["play"] = [text for text, _ in result_texts(SimpleNamespace(finished=True, stops=0, log=log))]
    FreeCAD.Units.setSchema(0)
    return reported


@step
def buttons_become_english():
    FreeCADGui.setLocale("English")
    settle()
    return {"buttons": _buttons()}


main()
