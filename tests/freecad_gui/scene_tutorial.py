# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steps of docs/tutorial.md in their order, through the buttons and panels that it names.

What comes of each step is written down, and a picture of it is kept. With the folder docs/pictures in PKM_PICTURES the
test of this scene puts them there.
"""

import json

import FreeCAD
import FreeCADGui
from gui import FOLDER, agree, click, click_named, main, press, select, settle, simulate, step, tab_of, until, widget
from PySide import QtCore, QtGui, QtWidgets

NAME = "tapered_column"
ARGUMENTS = "--machine example_6tps --work-offset G54"
SIZE, MARGIN, WIDE = (1000, 800), 12, 560
"""Pixels: a picture of the 3D view before it is trimmed, below the content of a panel, and a dock."""
FROM_ABOVE = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 30) * FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 55)
STANDING_UP = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 20) * FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 75)


def keep(name, part, height=None):
    """Keep a picture of a part of the window, down to the end of its content or as high as is said."""
    settle()
    _save(name, part.grab(QtCore.QRect(0, 0, part.width(), height or _content(part))).toImage())


def widen(part):
    """Draw the dock of a panel wider, as with the mouse at its border."""
    dock = part
    while not isinstance(dock, QtWidgets.QDockWidget):
        dock = dock.parentWidget()
    FreeCADGui.getMainWindow().resizeDocks([dock], [WIDE], QtCore.Qt.Orientation.Horizontal)
    settle()


def _content(part):
    """The height down to the lowest thing to read or to press."""
    kinds = (QtWidgets.QAbstractButton, QtWidgets.QLineEdit, QtWidgets.QAbstractItemView, QtWidgets.QLabel)
    inside = [each for each in part.findChildren(QtWidgets.QWidget) if isinstance(each, kinds) and each.isVisible()]
    return max(each.mapTo(part, QtCore.QPoint(0, each.height())).y() for each in inside) + MARGIN


def keep_view(name, orientation=FROM_ABOVE):
    """Keep a picture of what the 3D view shows."""
    view = FreeCADGui.activeView()
    view.setAnimationEnabled(False)
    view.setCameraOrientation(orientation)
    view.fitAll(1.0)
    settle()
    target = str(FOLDER / f"tutorial_{name}.png")
    view.saveImage(target, *SIZE, "White")
    image = QtGui.QImage(target)
    for _ in range(4):
        image = _trimmed(image).transformed(QtGui.QTransform().rotate(90))
    _save(name, image)


def _trimmed(image):
    """Without what is empty below: rows that are all alike."""
    rows = image.height()
    while rows > 1 and image.copy(0, rows - 1, image.width(), 1) == image.copy(0, rows - 2, image.width(), 1):
        rows -= 1
    return image.copy(0, 0, image.width(), rows)


def _save(name, image):
    """As small as it can be without loss."""
    image.convertToFormat(QtGui.QImage.Format.Format_RGB32).save(str(FOLDER / f"tutorial_{name}.png"), "PNG", 0)


def document():
    return FreeCAD.ActiveDocument


def job():
    return document().getObject("Job")


@step
def column_is_modelled():
    # Edit > Preferences > General > Units: Metric small parts & CNC
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units").SetInt("UserSchema", 6)
    FreeCAD.Units.setSchema(6)
    FreeCADGui.activateWorkbench("PartWorkbench")
    press("Std_New")
    made = FreeCAD.ActiveDocument
    made.saveAs(str(FOLDER / f"{NAME}.FCStd"))
    _add_foot_and_top()
    foot, top = made.Objects
    top.Placement.Base.z = 80
    press("Part_Loft")
    _choose_sections()
    column = made.Objects[-1]
    press("Part_Box")
    box = made.Objects[-1]
    box.Length = box.Width = box.Height = 100
    made.recompute()
    FreeCADGui.Selection.clearSelection()
    for item in (column, box):
        FreeCADGui.Selection.addSelection(item)
    FreeCADGui.runCommand("Part_Slice", 0)
    settle()
    sliced = made.Objects[-1]
    keep_view("column")
    return {
        "name": made.Name,
        "shapes": [[foot.MajorRadius.Value, foot.MinorRadius.Value], [top.Radius.Value, top.Placement.Base.z]],
        "volume": column.Shape.Volume,
        "ruled": [column.Solid, column.Ruled],
        "sliced": [solid.Volume for solid in sliced.Shape.Solids],
        "wall": _quarter(sliced),
    }


def _add_foot_and_top():
    """An ellipse and a circle from the panel of primitives."""
    press("Part_Primitives")
    kinds = widget(QtWidgets.QComboBox, "PrimitiveTypeCB")
    for kind, sizes in (
        ("Ellipse", {"ellipseMajorRadius": 60.0, "ellipseMinorRadius": 40.0}),
        ("Circle", {"circleRadius": 25.0}),
    ):
        kinds.setCurrentIndex(kinds.findText(kind))
        kinds.activated.emit(kinds.currentIndex())
        settle()
        for name, size in sizes.items():
            widget(QtWidgets.QWidget, name).setProperty("rawValue", size)
        if kind == "Ellipse":
            keep("primitives", _task_panel())
        click_named("Create")
    click_named("Close")


def _choose_sections():
    """Both shapes to the right side of the loft, solid and ruled."""
    tree = widget(QtWidgets.QTreeWidget, "availableTreeWidget")
    while tree.topLevelItemCount():
        tree.setCurrentItem(tree.topLevelItem(0))
        settle()
        click(widget(QtWidgets.QPushButton, "addButton"))
        settle()
    for name in ("checkSolid", "checkRuledSurface"):
        widget(QtWidgets.QCheckBox, name).setChecked(True)
    keep("loft", _task_panel())
    click_named("OK")


def _task_panel():
    """What is in the Tasks tab."""
    panels = [
        each
        for each in FreeCADGui.getMainWindow().findChildren(QtWidgets.QWidget)
        if each.metaObject().className() == "Gui::TaskView::TaskView" and each.isVisible()
    ]
    return panels[0]


def _quarter(item):
    """The name of the curved face over positive x and y."""
    curved = {
        f"Face{number}": face.CenterOfMass
        for number, face in enumerate(item.Shape.Faces, 1)
        if face.Surface.TypeId == "Part::GeomBSplineSurface"
    }
    (name,) = [name for name, centre in curved.items() if centre.x > 1 and centre.y > 1]
    return name


@step
def job_is_made():
    FreeCADGui.activateWorkbench("CAMWorkbench")
    settle()
    timer, asked = agree()
    press("CAM_Job", document().Objects[-1])
    timer.stop()
    panel = job().ViewObject.Proxy.taskPanel
    form = panel.form
    form.setCurrentIndex(tab_of(form, "Tools"))
    table = form.toolControllerList
    for column, text in ((2, "1800 mm/min"), (3, "600 mm/min"), (4, "12000")):
        table.item(0, column).setText(text)
    widen(form)
    table.resizeColumnsToContents()
    keep("tools", form, 240)
    form.setCurrentIndex(tab_of(form, "Output"))
    form.postProcessor.setCurrentIndex(form.postProcessor.findText("hexapod_pmac"))
    form.postProcessorArguments.setText(ARGUMENTS)
    form.postProcessorArguments.editingFinished.emit()
    keep("output", form)
    panel.accept()
    settle()
    controller, arguments = job().Tools.Group[0], job().PostProcessorArgs
    controller.Tool.Diameter = 16
    document().recompute()
    _type_gauge_length()
    return {
        "asked": asked,
        "post": [job().PostProcessor, arguments],
        "gauge length": controller.GaugeLength.Value,
        "speeds": [controller.HorizFeed.Value, controller.VertFeed.Value, controller.SpindleSpeed],
        "tool": [controller.ToolNumber, controller.SpindleDir, controller.Tool.Diameter.Value],
    }


def _type_gauge_length():
    """In the post panel, which keeps it and posts nothing."""
    from pkm_post.freecad_gui.gauge_table import GaugeTable

    press("PKM_Post", job())
    form = widget(QtWidgets.QWidget, "PkmPostPanel")
    (gauges,) = [each for each in form.findChildren(QtWidgets.QWidget) if isinstance(each, GaugeTable)]
    (field,) = gauges.fields.values()
    field.setText("120 mm")
    field.editingFinished.emit()
    settle()
    keep("gauge", gauges)
    click_named("Apply")
    click_named("Close")


@step
def quarter_is_covered():
    (part,) = job().Model.Group
    select(part, _quarter(part))
    press("PKM_SurfaceFinish")
    settle()
    (operation,) = job().Operations.Group
    view = operation.ViewObject.Proxy
    until(lambda: view.panel is not None)  # CAM opens it from the event loop
    panel = view.panel
    page = panel.featurePages[-1]
    fields = page.form.fields
    fields["Order"].setCurrentIndex(fields["Order"].findText("Zigzag"))
    values = {"Stepover": 20.0, "ChordTolerance": 0.05, "AxisTolerance": 1.0, "Lead": 0.0, "Tilt": 59.0}
    for name, value in values.items():
        fields[name].setProperty("rawValue", value)
    page.pageGetFields()
    keep("surface_finish", page.form)
    panel.accept()
    settle()
    operation.Label = "Quadrant 1"
    document().recompute()
    return {
        "faces": [name for _, names in operation.Base for name in names],
        "valid": operation.isValid(),
        "chosen": [operation.Order, operation.Stepover.Value, operation.Tilt.Value],
        "passes": operation.PassCount,
        "commands": len(operation.Path.Commands),
    }


@step
def the_other_quadrants_are_copies():
    from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

    first, reported = job().Operations.Group[0], {}
    for label, command, choice in (
        ("Quadrant 4", "PKM_Mirror", "XZ"),
        ("Quadrant 2", "PKM_Mirror", "YZ"),
        ("Quadrant 3", "PKM_Rotate", "Z"),
    ):
        press(command, first)
        panel = SymmetryPanel.opened
        place = panel.form.findChildren(QtWidgets.QComboBox)[0]
        place.setCurrentIndex(place.findText(choice))
        panel.compute()
        reported[label] = panel.report.text()
        if label == "Quadrant 4":
            keep("mirror", panel.form)
        panel.accept()
        settle()
        job().Operations.Group[-1].Label = label
    for item in (job().Stock, job().Tools.Group[0].Tool):
        item.ViewObject.Visibility = False
    keep_view("quadrants")
    return reported


@step
def machine_stands_around_it():
    press("PKM_Machine", job())
    machine = document().getObject("Machine")
    machine.Tip = FreeCAD.Vector(0, 0, 130)
    document().recompute()
    keep_view("machine", STANDING_UP)
    return {"out of limits": list(machine.OutOfLimits), "offset": list(machine.WorkOffset.Base)}


@step
def reach_is_checked():
    machine = document().getObject("Machine")
    press("PKM_Reach", job())
    found = document().getObject("Reach")
    found.ViewObject.Proxy.doubleClicked(found.ViewObject)
    settle()
    table = widget(QtWidgets.QTableWidget, "PkmReachTable")
    row = list(found.Checks).index("base joints")
    table.cellClicked.emit(row, 0)
    keep("reach_table", table.parentWidget())
    machine.ViewObject.Visibility = False
    keep_view("reach")
    machine.ViewObject.Visibility = True
    click_named("Close")
    found.Active = False
    return {"reachable": found.Reachable, "checks": len(found.Checks), "violations": list(found.Violations)}


@step
def motion_is_played():
    player = simulate(job())
    made = document().getObject("Simulation")
    player.widget().slider.setValue(20_000)  # ms
    keep("player", player.widget())
    seconds = player.seconds
    player.close()
    made.Active = False
    settle()
    return {"followable": made.Followable, "seconds": seconds, "duration": made.Duration.getValueAs("s").Value}


@step
def program_is_posted():
    from pkm_post.freecad_gui.post_fields import PostChoices
    from pkm_post.freecad_gui.post_outcome import PostOutcome

    document().save()
    press("PKM_Post", job())
    form = widget(QtWidgets.QWidget, "PkmPostPanel")
    (choices,) = [each for each in form.findChildren(QtWidgets.QWidget) if isinstance(each, PostChoices)]
    (outcome,) = [each for each in form.findChildren(QtWidgets.QWidget) if isinstance(each, PostOutcome)]
    folder = choices.folder.text()
    choices.folder.setText("tapered_column")  # in the picture no folder of this computer
    keep("post", choices)
    choices.folder.setText(folder)
    (post,) = [each for each in form.findChildren(QtWidgets.QPushButton) if each.text() == "Post"]
    click(post)
    until(post.isEnabled, 90)
    # Warnings of the stock that CAM assumes make the panel long: the picture leaves out its lower end, to stay small.
    keep("certificate", outcome, round(0.85 * _content(outcome)))
    report = json.loads((FOLDER / f"{NAME}-report.json").read_text(encoding="utf-8"))
    verdict = outcome.verdict.text()
    FreeCADGui.Control.closeDialog()
    settle()
    document().save()
    return {
        "folder": folder == str(FOLDER),
        "verdict": verdict,
        "files": sorted(file.name for file in FOLDER.glob(f"{NAME}*")),
        "certificate": report["certificate"],
    }


main(are_drawn=True)
