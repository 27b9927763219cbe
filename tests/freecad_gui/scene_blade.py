# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steps of docs/tutorial-blade.md in their order, through the buttons and panels that it names.

What comes of each step is written down, and a picture of it is kept. With the folder docs/pictures in PKM_PICTURES the
test of this scene puts them there.
"""

import FreeCAD
import FreeCADGui
from gui import FOLDER, agree, click_named, main, press, select, settle, simulate, step, tab_of, until, widget
from pivy import coin  # noqa: F401  the camera of a view is an object of it
from PySide import QtGui, QtWidgets

NAME = "blade"
ARGUMENTS = "--machine example_6tps --work-offset G54"
SIZE = (900, 600)
FROM_ABOVE = FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 35) * FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 55)
CHOSEN = (("Stepover", 2.0), ("ChordTolerance", 0.05), ("AxisTolerance", 1.0))
ARCS = ((60.0, 0.0, -30.0, 0.0, 0.0), (80.0, -22.0, 30.0, 8.0, -10.0))
"""Radius, z, y, turn about y in degrees, and x of the two edges."""


def document():
    return FreeCAD.ActiveDocument


def job():
    return document().getObject("Job")


def keep(name, part):
    """Keep a picture of a part of the window."""
    settle()
    _save(name, part.grab().toImage())


def keep_view(name):
    """Keep a picture of what the 3D view shows, around the blade."""
    view = FreeCADGui.activeView()
    view.setAnimationEnabled(False)
    view.setCameraOrientation(FROM_ABOVE)
    camera = view.getCameraNode()
    settle()
    box = job().Stock.Shape.BoundBox if job() else document().Objects[-1].Shape.BoundBox
    direction = FROM_ABOVE.multVec(FreeCAD.Vector(0, 0, -1))
    camera.position = tuple(box.Center - direction * 4 * box.DiagonalLength)
    camera.focalDistance = 4 * box.DiagonalLength
    if hasattr(camera, "height"):
        camera.height = 1.3 * box.DiagonalLength
    settle()
    target = str(FOLDER / f"blade_{name}.png")
    view.saveImage(target, *SIZE, "White")
    _save(name, QtGui.QImage(target))


def _save(name, image):
    """As small as it can be without loss."""
    image.convertToFormat(QtGui.QImage.Format.Format_RGB32).save(str(FOLDER / f"blade_{name}.png"), "PNG", 0)


@step
def face_is_modelled():
    # Edit > Preferences > General > Units: Metric small parts & CNC
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units").SetInt("UserSchema", 6)
    FreeCAD.Units.setSchema(6)
    FreeCADGui.activateWorkbench("PartWorkbench")
    press("Std_New")
    made = FreeCAD.ActiveDocument
    made.saveAs(str(FOLDER / f"{NAME}.FCStd"))
    press("Part_Primitives")
    kinds = widget(QtWidgets.QComboBox, "PrimitiveTypeCB")
    kinds.setCurrentIndex(kinds.findText("Circle"))
    kinds.activated.emit(kinds.currentIndex())
    settle()
    for _ in ARCS:
        click_named("Create")
    click_named("Close")
    for arc, (radius, z, y, turn, x) in zip(made.Objects, ARCS, strict=True):
        arc.Radius, arc.Angle1, arc.Angle2 = radius, 70, 110
        upright = FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 90)
        arc.Placement = FreeCAD.Placement(
            FreeCAD.Vector(x, y, z), FreeCAD.Rotation(FreeCAD.Vector(0, 1, 0), turn) * upright
        )
    made.recompute()
    press("Part_Loft")
    tree = widget(QtWidgets.QTreeWidget, "availableTreeWidget")
    while tree.topLevelItemCount():
        tree.setCurrentItem(tree.topLevelItem(0))
        settle()
        widget(QtWidgets.QPushButton, "addButton").click()
        settle()
    widget(QtWidgets.QCheckBox, "checkSolid").setChecked(False)
    widget(QtWidgets.QCheckBox, "checkRuledSurface").setChecked(True)
    click_named("OK")
    press("Part_Extrude", made.Objects[-1])
    widget(QtWidgets.QRadioButton, "rbDirModeCustom").setChecked(True)
    settle()
    for name, value in (("dirX", 0.0), ("dirY", 0.0), ("dirZ", -1.0)):
        widget(QtWidgets.QDoubleSpinBox, name).setValue(value)
    widget(QtWidgets.QWidget, "spinLenFwd").setProperty("rawValue", 40.0)
    widget(QtWidgets.QCheckBox, "chkSolid").setChecked(True)
    click_named("OK")
    made.recompute()
    solid = made.Objects[-1]
    keep_view("solid")
    return {
        "volume": solid.Shape.Volume,
        "faces": len(solid.Shape.Faces),
        "face": _upper(solid),
        "closed": solid.Shape.isClosed(),
    }


def _upper(item):
    """The name of the uppermost face."""
    faces = item.Shape.Faces
    return f"Face{1 + max(range(len(faces)), key=lambda row: faces[row].CenterOfMass.z)}"


@step
def job_is_made():
    FreeCADGui.activateWorkbench("CAMWorkbench")
    settle()
    timer, _ = agree()
    press("CAM_Job", document().Objects[-1])
    timer.stop()
    panel = job().ViewObject.Proxy.taskPanel
    form = panel.form
    form.setCurrentIndex(tab_of(form, "Tools"))
    for column, text in ((2, "1800 mm/min"), (3, "600 mm/min"), (4, "12000")):
        form.toolControllerList.item(0, column).setText(text)
    form.setCurrentIndex(tab_of(form, "Output"))
    form.postProcessor.setCurrentIndex(form.postProcessor.findText("hexapod_pmac"))
    form.postProcessorArguments.setText(ARGUMENTS)
    form.postProcessorArguments.editingFinished.emit()
    panel.accept()
    settle()
    controller = job().Tools.Group[0]
    controller.Tool.Diameter, controller.Tool.ShankDiameter = 10, 10
    document().recompute()
    press("PKM_Post", job())
    from pkm_post.freecad_gui.gauge_table import GaugeTable

    form = widget(QtWidgets.QWidget, "PkmPostPanel")
    (gauges,) = [each for each in form.findChildren(QtWidgets.QWidget) if isinstance(each, GaugeTable)]
    (field,) = gauges.fields.values()
    field.setText("120 mm")
    field.editingFinished.emit()
    settle()
    click_named("Apply")
    click_named("Close")
    return {"post": [job().PostProcessor, job().PostProcessorArgs], "gauge length": controller.GaugeLength.Value}


@step
def face_is_finished():
    (part,) = job().Model.Group
    select(part, _upper(part))
    press("PKM_SurfaceFinish")
    settle()
    (operation,) = job().Operations.Group
    view = operation.ViewObject.Proxy
    until(lambda: view.panel is not None)  # CAM opens it from the event loop
    page = view.panel.featurePages[-1]
    fields = page.form.fields
    fields["Order"].setCurrentIndex(fields["Order"].findText("Zigzag"))
    for name, value in CHOSEN:
        fields[name].setProperty("rawValue", value)
    page.pageGetFields()
    view.panel.accept()
    settle()
    operation.Label = "Blade"
    document().recompute()
    return {
        "valid": operation.isValid(),
        "faces": [name for _, names in operation.Base for name in names],
        "passes": operation.PassCount,
        "chosen": [operation.Lead.Value, operation.ConeLimit.Value, operation.CheckSpacing.Value],
        "gouge": operation.MaximumGouge,
        "tilted": max(1.0 - c.Parameters.get("K", 1.0) for c in operation.Path.Commands),
    }


@step
def chips_are_made():
    press("PKM_Machine", job())
    player = simulate(job())
    content = player.widget()
    page = content.material
    page.resolution.setCurrentIndex(page.resolution.findData("medium"))
    whole = page.material.replay.stock.volume
    content.show_page(page)
    half = player.simulation.duration / 2
    content.timeline.wanted.emit(half)
    until(lambda: page.is_current, 120)
    document().getObject("Machine").ViewObject.Visibility = True
    keep_view("chips")
    middle = page.material.replay.stock.volume
    page.compared.setChecked(True)
    player.go_to(player.simulation.duration)
    until(lambda: page.is_current, 120)
    page.measure()
    found = page.material.compared()
    content.view.components["tool"].setCurrentIndex(2)
    content.view.components["platform"].setCurrentIndex(2)
    content.view.components["struts"].setCurrentIndex(2)
    keep_view("compared")
    keep("material", page)
    stock, numbers = page.material.replay.stock, page.numbers.text().splitlines()
    player.close()
    settle()
    return {
        "followable": document().getObject("Simulation").Followable, "whole": whole, "middle": middle,
        "after": stock.volume, "step": stock.grid.step, "deepest": found.deepest, "gouged": found.gouged,
        "numbers": numbers, "above": _above_the_face(),
    }  # fmt: skip


def _above_the_face():
    """Volume of the stock that is above the face."""
    (part,) = job().Model.Group
    face, box = part.Shape.getElement(_upper(part)), job().Stock.Shape
    room = box.BoundBox.ZMax - face.BoundBox.ZMin + 1
    return box.common(face.extrude(FreeCAD.Vector(0, 0, room))).Volume


main()
