# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD started in Chinese: buttons, a panel, the tool tip of a property; then English while it runs."""

import FreeCAD
import FreeCADGui
from gui import main, new_document, picture, press, settle, step
from PySide import QtCore, QtWidgets


def _buttons():
    window = FreeCADGui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtWidgets.QToolBar) if bar.objectName() == "PKM Post"]
    return [(action.text(), action.statusTip()) for bar in bars for action in bar.actions()]


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
    import Path.Main.Gui.Job

    from pkm_post.freecad_app.surface_finish import create_surface_finish
    from pkm_post.freecad_gui.surface_finish_panel import CHOICES, ROWS

    document = FreeCAD.newDocument("finish")
    stock = document.addObject("Part::Feature", "Block")
    stock.Shape = Part.makeBox(20, 20, 20)
    Path.Main.Gui.Job.Create([stock.Name], None, openTaskPanel=False)
    operation = create_surface_finish(document.getObject("Job"), [])
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
def buttons_become_english():
    FreeCADGui.setLocale("English")
    settle()
    return {"buttons": _buttons()}


main()
