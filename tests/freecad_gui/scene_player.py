# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pages of the player: material that tools take, readout, program and timeline, in a wide dock and a narrow one."""

import importlib

import FreeCAD
import FreeCADGui
import numpy as np
from gui import FOLDER, main, picture_of_all, player_dock, press, settle, simulate, step, until
from pivy import coin
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.axis_vectors import tool_axes
from pkm_post.freecad_gui.quantities import time_text

SLOT = [
    "G0 X-15 Y10 Z40 I0 J0 K1",
    "G0 X-15 Y10 Z14 I0 J0.5 K0.8660254037844386",
    "G1 X35 Y10 Z14 I0 J0.5 K0.8660254037844386 F20",
    "G0 X35 Y10 Z40 I0 J0 K1",
]
"""A groove along the top of the block of 20 mm, the tool tilted by 30 degrees across it."""
SHIBOKEN = importlib.import_module("shiboken6") if QtCore.qVersion() >= "6" else None


@step
def player_opens_with_its_pages():
    from cam_jobs import add_operation, add_tool_controller, job_in_reach

    document = FreeCAD.newDocument("chips")
    job = job_in_reach(document)
    job.PostProcessorArgs = "--machine example_6tps --work-offset=0,0,250"
    job.Stock.ExtXneg = job.Stock.ExtXpos = job.Stock.ExtYneg = job.Stock.ExtYpos = 0
    job.Stock.ExtZneg = job.Stock.ExtZpos = 0
    tool = job.Tools.Group[0].Tool
    tool.Diameter, tool.CuttingEdgeHeight, tool.ShankDiameter = 10, 40, 10
    add_operation(job, SLOT, "Groove")
    other = add_operation(job, ["G0 X0 Y0 Z40", "G1 X5 Y0 Z30 F20"], "Above")
    other.ToolController = add_tool_controller(job, 2)
    document.recompute()
    press("PKM_Machine", job)
    simulate(job)
    content = _content()
    return {
        "tabs": [content.lists.tabText(number) for number in range(content.lists.count())],
        "bands": [band.text for band in content.timeline.operations],
        "tools": [band.text for band in content.timeline.tools],
        "rows": [_row(number) for number in range(content.listing.model().rowCount())],
        "material": [content.material.resolution.itemText(n) for n in range(content.material.resolution.count())],
    }


@step
def material_is_taken_and_comes_back():
    player, page = player_dock(), _content().material
    covered = FreeCAD.getDocument("chips").getObject("Job").Model.Group[0].ViewObject
    covered.Visibility = True
    page.resolution.setCurrentIndex(page.resolution.findData("medium"))
    whole = page.material.replay.stock.volume
    player.go_to(player.simulation.duration)
    until(lambda: page.is_current, 120)
    cut = page.material.replay.stock.volume
    page.compared.setChecked(True)
    page.measure()
    compared = page.numbers.text().splitlines()
    saved = picture_of_all("material.png")
    found = page.material.compared()
    player.go_to(0.0)
    until(lambda: page.is_current, 120)
    back = page.material.replay.stock.volume
    hidden = covered.SwitchNode.whichChild.getValue() == -1
    kept = covered.Visibility  # which a document saved now has
    page.resolution.setCurrentIndex(0)
    return {
        "whole": whole, "cut": cut, "back": back, "lines": compared, "saved": saved,
        "gouged": found.gouged, "deepest": found.deepest, "left": found.left, "hidden": hidden,
        "kept": kept, "shown": covered.SwitchNode.whichChild.getValue() >= 0,
    }  # fmt: skip


@step
def readout_and_program_go_together():
    player, content = player_dock(), _content()
    rows = [_row(number) for number in range(content.listing.model().rowCount())]
    row = next(number for number, text in enumerate(rows) if "G1 " in text)
    content.listing.clicked.emit(content.listing.model().index(row, 0))
    begins = player.seconds
    player.go_to(begins + 1.0)
    marked = content.listing.currentIndex().row()
    texts = [field.text() for field in content.readout.fields]
    tip, axis, *_ = player.simulation.pose_at(np.array([player.seconds]))
    return {
        "begins": begins, "row": row, "marked": marked, "texts": texts,
        "before": player.simulation.block_before(begins + 1e-6),
        "tip": (tip[0] - [0, 0, 250]).tolist(), "axis": axis[0].tolist(),
        "lengths": player.simulation.struts_at(np.array([player.seconds]))[0][0].tolist(),
        "left": player.simulation.duration - player.seconds,
    }  # fmt: skip


@step
def readout_follows_the_units_of_the_user():
    player, content = player_dock(), _content()
    before = FreeCAD.Units.getSchema()
    FreeCAD.Units.setSchema(3)  # imperial decimal
    player.go_to(player.seconds)
    texts = [field.text() for field in content.readout.fields]
    FreeCAD.Units.setSchema(before)
    player.go_to(player.seconds)
    return {"texts": texts, "times": [time_text(seconds) for seconds in (59.94, 59.96, 3599.97)]}


@step
def timeline_goes_to_a_click():
    player, content = player_dock(), _content()
    content.timeline.wanted.emit(content.timeline.operations[-1].start)
    at = player.seconds
    text = content.timeline.text_at(content.timeline.operations[-1].start + 0.1)
    return {"at": at, "start": content.timeline.operations[-1].start, "text": text}


@step
def view_is_chosen():
    player, page = player_dock(), _content().view
    scene = page._scene
    reported = {}
    for name, choice in page.components.items():
        reported[name] = []
        for row in range(choice.count()):
            choice.setCurrentIndex(row)
            shown = scene._switches[name].whichChild.getValue() == coin.SO_SWITCH_ALL
            reported[name].append([shown, *_transparencies(scene._switches[name])])
        choice.setCurrentIndex(0)
    page.every.setValue(2)
    ends = tool_axes(player.simulation.trajectory, 2, 15.0)
    reported["axes"] = [page._axes.getNumChildren(), len(ends[0]), len(player.simulation.trajectory)]
    camera = FreeCADGui.activeView().getCameraNode()
    player.go_to(1.0)
    page.follows.setChecked(True)
    before, tip = _position(camera), page._tip
    player.go_to(2.0)
    reported["followed"] = bool(np.allclose(_position(camera) - before, page._tip - tip, atol=1e-3))
    page.follows.setChecked(False)
    page.section.setChecked(True)
    reported["section"] = FreeCADGui.activeView().hasClippingPlane()
    page.section.setChecked(False)
    reported["whole"] = not FreeCADGui.activeView().hasClippingPlane()
    page.every.setValue(0)
    reported["no axes"] = page._axes.getNumChildren() == 0
    reported["preference"] = _chosen_in_preferences(page, 3), _chosen_in_preferences(page, 0)
    return reported


def _chosen_in_preferences(page, every):
    """What the page of the player shows before and after the page of preferences is stored, and what is drawn then."""
    from pkm_post.freecad_gui.preferences import PostPreferences

    preferences, before = PostPreferences(), page.every.value()
    preferences.loadSettings()
    stored = preferences.every.value()
    preferences.every.setValue(every)
    unsaved = page.every.value()
    preferences.saveSettings()
    return [stored == before == unsaved, page.every.value(), page._axes.getNumChildren()]


def _position(camera):
    return np.array(camera.position.getValue().getValue())


def _transparencies(node):
    search = coin.SoSearchAction()
    search.setType(coin.SoMaterial.getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    search.apply(node)
    paths = search.getPaths()
    found = {round(paths[n].getTail().transparency.getValues(0)[0], 3) for n in range(paths.getLength())}
    return sorted(found)


@step
def bodies_that_come_too_close_are_red():
    player = player_dock()
    scene = player._machine.scene
    scene.mark({"strut 2", "shank of T1"})
    scene.show(player.simulation.pose_at(np.array([player.seconds])))
    red = [number for number, strut in enumerate(scene._struts, start=1) if _colour(strut._tube) == [0.85, 0.1, 0.1]]
    tool = _colour(scene._gold)
    player.go_to(player.seconds)
    return {"red": red, "tool": tool, "after": [_colour(scene._struts[1]._tube), _colour(scene._gold)]}


def _colour(look):
    return [round(value, 2) for value in look.diffuseColor.getValues(0)[0].getValue()]


@step
def film_has_a_caption():
    player, frames = player_dock(), FOLDER / "film"
    frames.mkdir()
    player.controls.factor.setCurrentText("10x")
    page = _content().material
    page.resolution.setCurrentIndex(page.resolution.findData("coarse"))
    written = player.recording(4, 320, 240).write_pictures(frames)
    images = [QtGui.QImage(str(file)) for file in sorted(frames.glob("*.png"))]
    strips = [image.copy(0, image.height() - 16, image.width(), 16) for image in images]
    dark = QtGui.QColor("#2e3436").rgb()
    light = [sum(QtGui.qGray(strip.pixel(x, 8)) > 128 for x in range(strip.width())) for strip in strips]
    page.resolution.setCurrentIndex(0)
    return {
        "written": written,
        "ground": all(strip.pixel(0, 0) == dark for strip in strips),
        "light": light,
        "differ": strips[0] != strips[-1],
    }


@step
def narrow_dock_hides_nothing():
    player, content = player_dock(), _content()
    window = FreeCADGui.getMainWindow()
    window.removeDockWidget(player)
    window.addDockWidget(QtCore.Qt.DockWidgetArea.RightDockWidgetArea, player)
    player.show()
    window.resizeDocks([player], [380], QtCore.Qt.Orientation.Horizontal)
    settle()
    buttons = content.controls.findChildren(QtWidgets.QAbstractButton)
    outside = [
        button.toolTip() or button.text()
        for button in buttons
        if button.mapTo(content, QtCore.QPoint(button.width(), 0)).x() > content.width()
    ]
    return {"width": content.width(), "outside": outside, "saved": picture_of_all("narrow.png")}


@step
def player_closes_beside_stale_wrappers():
    player_dock().close()
    settle()
    stale, taken = {}, 0
    for _ in range(10):  # its buttons may miss all of these addresses
        stale = _stale_wrappers(QtWidgets.QToolButton)
        player = simulate(FreeCAD.ActiveDocument.getObject("Simulation"))
        buttons = player.findChildren(QtWidgets.QToolButton) if stale else []
        taken += sum(SHIBOKEN.getCppPointer(each)[0] in stale for each in buttons)
        del buttons
        player.close()
        settle()
        if taken or not stale:
            break
    return {"qt": QtCore.qVersion(), "stale": len(stale), "taken": taken, "closed": player_dock() is None}


@step
def fault_pages_close_beside_stale_wrappers():
    """Several: the one label of a page may miss all of these addresses."""
    from pkm_post.freecad_gui.fault_links import NAME, open_fault

    stale = _stale_wrappers(QtWidgets.QLabel)
    for _ in range(5):
        open_fault("J112").close()
        settle()
    pages = FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialog, NAME)
    visible = sum(page.isVisible() for page in pages)  # Qt 5 deletes them later
    return {"qt": QtCore.qVersion(), "stale": len(stale), "open": visible}


def _stale_wrappers(kind):
    """Wrappers of widgets that no longer exist, as FreeCAD leaves them, by addresses that new ones get.

    PySide 2 crashes with them.
    """
    if SHIBOKEN is None:
        return {}
    widgets = [kind() for _ in range(300)]
    addresses = {SHIBOKEN.getCppPointer(each)[0] for each in widgets}
    widgets.clear()
    return {each: SHIBOKEN.wrapInstance(each, QtWidgets.QWidget) for each in addresses}


@step
def player_closes():
    FreeCAD.closeDocument("chips")
    settle()
    return {}


def _content():
    return player_dock().widget()


def _row(number):
    model = _content().listing.model()
    return model.data(model.index(number, 0))


main()
