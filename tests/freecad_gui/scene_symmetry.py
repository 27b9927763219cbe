# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of mirrored and turned operations: opened by its buttons and by double click, accepted and cancelled."""

import FreeCAD
import FreeCADGui
import numpy as np
from gui import main, new_document, picture, press, settle, step, until
from PySide import QtWidgets

QUARTER = [
    "G0 X60 Y0 Z90",
    "G0 Z40",
    "G1 Z30 F5",
    "G3 X0 Y60 I-60 J0 F20",
    "G0 Z40",
    "G0 Z90",
]


def panel_of():
    """The panel that is open."""
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    return SymmetryPanel.opened


def quadrant(name):
    """A job with a quarter of a ring."""
    document = new_document(name)
    base = document.getObject("Custom")
    base.Gcode = QUARTER
    document.recompute()
    return document, base


def opened(document):
    return bool(FreeCADGui.getDocument(document.Name).getInEdit())


def labels(document):
    return [item.Label for item in document.getObject("Job").Operations.Group]


@step
def mirror_from_its_button():
    document, base = quadrant("mirror")
    before = document.UndoCount
    press("PKM_Mirror", base)
    made = document.getObject("Job").Operations.Group[-1]
    panel = panel_of()
    reported = {
        "open": opened(document),
        "choices": [panel.place.choice.itemText(index) for index in range(panel.place.choice.count())],
        "chosen": panel.place.choice.currentText(),
        "report": panel.report.text(),
    }
    panel.place.choice.setCurrentIndex(2)
    panel.place.point.fields[0].setProperty("rawValue", 5.0)
    panel.place.point.fields[0].editingFinished.emit()
    panel.side.setCurrentIndex(1)
    panel.keep_climb.setChecked(True)
    reported["computed later"] = until(lambda: made.ReversedPasses == 1 and "1" in panel.report.text())
    reported["live report"] = panel.report.text()
    reported["picture"] = picture("mirror_panel.png")
    panel.accept()
    settle()
    reported |= {
        "closed": not opened(document),
        "normal": list(made.Normal),
        "point": list(made.Point),
        "keeps": made.KeepClimb,
        "cuts": [made.CutOfBase, made.CutOfCopies],
        "undo steps": document.UndoCount - before,
    }
    document.undo()
    document.recompute()
    reported["after undo"] = labels(document)
    document.redo()
    document.recompute()
    reported["after redo"] = [labels(document), document.getObject("Job").Operations.Group[-1].KeepClimb]
    return reported


@step
def cancel_takes_a_new_one_back():
    document, base = quadrant("cancel")
    before = document.UndoCount
    press("PKM_Rotate", base)
    inside = labels(document)
    panel_of().reject()
    settle()
    return {"inside": inside, "after": labels(document), "undo": document.UndoCount - before, "open": opened(document)}


@step
def edit_by_double_click():
    from pkm_post.freecad_app.symmetry import create_mirror

    document, base = quadrant("again")
    made = create_mirror(base, (0, 1, 0))
    document.recompute()
    view = made.ViewObject
    before = document.UndoCount
    view.Proxy.doubleClicked(view)
    settle()
    panel_of().place.choice.setCurrentIndex(0)
    panel_of().compute()
    inside = list(made.Normal)
    panel_of().reject()
    settle()
    reported = {"inside": inside, "rejected": list(made.Normal), "undo": document.UndoCount - before}
    view.Proxy.doubleClicked(view)
    settle()
    panel_of().place.choice.setCurrentIndex(4)
    for values in ((0.0, 0.0, 0.0), (1.0, 1.0, 0.0)):
        for field, value in zip(panel_of().place.direction.fields, values, strict=True):
            field.setProperty("rawValue", value)
        if not any(values):
            panel_of().apply()
            panel_of().compute()
            reported["no direction"] = list(made.Normal)
    panel_of().accept()
    settle()
    reported |= {"accepted": list(made.Normal), "undo steps": document.UndoCount - before}
    document.undo()
    return reported | {"undone": list(made.Normal), "open": opened(document)}


@step
def fields_keep_decimals_that_they_do_not_show():
    from pkm_post.freecad_app.symmetry import create_mirror, create_rotation

    document, base = quadrant("decimals")
    mirror, turned = create_mirror(base, (0.6, 0.8, 0)), create_rotation(base, axis=(0, 0, 1), angle=1.23456789)
    mirror.Point = turned.Point = FreeCAD.Vector(1.23456, 2.34567, 0.12345)
    document.recompute()
    angle, reported = turned.Angle.Value, {}
    for system in (3, 7):
        mirror.Point = turned.Point = FreeCAD.Vector(1.23456, 2.34567, 0.12345)
        FreeCAD.Units.setSchema(system)
        for made in (mirror, turned):
            made.ViewObject.Proxy.doubleClicked(made.ViewObject)
            settle()
            panel = panel_of()
            angle_field = [panel.angle] if made == turned else []
            for field in [*panel.place.point.fields, *angle_field]:
                field.setFocus()
                settle()
                field.editingFinished.emit()
            before = list(made.Point)
            panel.place.point.fields[1].findChild(QtWidgets.QLineEdit).setText("25.4 mm")
            panel.place.point.fields[1].editingFinished.emit()
            panel.accept()
            settle()
            reported[f"{made.Name} {system}"] = before + list(made.Point)
        FreeCAD.Units.setSchema(0)
    return reported | {"angle": turned.Angle.Value - angle, "normal": list(mirror.Normal)}


@step
def plane_by_a_picked_face_and_a_datum_plane():
    from pkm_post.freecad_app.symmetry import create_mirror

    document, base = quadrant("picked")
    made = create_mirror(base, (0, 1, 0))
    body = document.addObject("PartDesign::Body", "Body")
    datum = body.newObject("PartDesign::Plane", "Datum")
    datum.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 7, 0), FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 90))
    document.recompute()
    made.ViewObject.Proxy.doubleClicked(made.ViewObject)
    settle()
    panel = panel_of()
    panel.place.choice.setCurrentIndex(3)
    reported = {"hint": panel.place.picked.text()}
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.getObject("Stock"), "Edge1")
    reported["unfit"] = panel.place.picked.text()
    FreeCADGui.Selection.addSelection(document.getObject("Stock"), "Face2")
    reported["face"] = panel.place.picked.text()
    panel.compute()
    reported["plane of face"] = [list(made.Point), list(made.Normal)]
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(body, "Datum.")
    panel.compute()
    reported["datum"] = panel.place.picked.text()
    reported["plane of datum"] = [list(made.Point), [abs(round(each, 9)) for each in made.Normal]]
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(made)
    reported["itself"] = panel.place.picked.text()
    panel.accept()
    settle()
    reported["link"] = made.Plane[0].Label
    datum.Placement.Base = FreeCAD.Vector(0, 9, 0)
    document.recompute()
    reported["follows"] = round(made.Point.y, 9)
    return reported


@step
def another_edit_leaves_nothing_behind():
    from pkm_post.freecad_app.symmetry import create_mirror

    document, base = quadrant("left")
    made = create_mirror(base, (0, 1, 0))
    document.recompute()
    made.ViewObject.Proxy.doubleClicked(made.ViewObject)
    settle()
    panel = panel_of()
    FreeCADGui.getDocument(document.Name).resetEdit()
    settle()
    reported = {"panel": panel_of() is not None, "dialog": bool(FreeCADGui.Control.activeDialog())}
    picks = []
    panel.place.pick = lambda *args: picks.append(args)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(base)
    settle()
    return reported | {"picks": len(picks), "open": opened(document)}


@step
def turns_with_their_report():
    document, base = quadrant("turns")
    press("PKM_Rotate", base)
    made, panel = document.getObject("Job").Operations.Group[-1], panel_of()
    reported = {"half turn": panel.report.text()}
    panel.angle.setProperty("rawValue", 90.0)
    panel.copies.setValue(3)
    panel.compute()
    reported["three quarters"] = panel.report.text()
    reported["picture"] = picture("rotation_panel.png")
    panel.angles.setText("90; 100 deg; no angle")
    panel.angles.editingFinished.emit()
    reported["no list"] = [list(made.Angles), panel.angles.text()]
    panel.angles.setText("90; 1e400")
    panel.angles.editingFinished.emit()
    reported["no number"] = list(made.Angles)
    panel.angles.setText("90; 1 rad")
    panel.angles.editingFinished.emit()
    reported["list"] = [list(made.Angles), panel.angles.text()]
    panel.apply()
    reported["list again"] = list(made.Angles)
    panel.compute()
    reported["list report"] = panel.report.text()
    panel.angles.setText("")
    panel.angles.editingFinished.emit()
    panel.place.choice.setCurrentIndex(3)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(document.getObject("Stock"), "Edge1")
    panel.compute()
    reported["axis of edge"] = [abs(each) for each in made.Axis]
    panel.accept()
    settle()
    return reported | {"moves": len(made.Path.Commands), "copies": made.Copies, "angle": made.Angle.Value}


@step
def mirror_of_a_rotation_and_the_whole_family():
    from pkm_post.freecad_app.symmetry import create_mirror, create_rotation

    document, base = quadrant("family")
    half = create_rotation(base, (0, 0, 1), np.pi)
    across = create_mirror(base, (0, 1, 0))
    document.recompute()
    press("PKM_Mirror", half)
    reported = {"report": panel_of().report.text(), "label": document.getObject("Job").Operations.Group[-1].Label}
    panel_of().accept()
    settle()
    across.ViewObject.Proxy.doubleClicked(across.ViewObject)
    settle()
    reported["other"] = panel_of().report.text()
    panel_of().reject()
    settle()
    return reported


main()
