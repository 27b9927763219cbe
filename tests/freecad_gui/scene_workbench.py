# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench in the window: its buttons, its place in CAM's menu, what its commands are for."""

import FreeCADGui
from gui import main, new_document, picture, select, settle, step
from PySide import QtWidgets


@step
def workbench_has_its_commands():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    settle()
    window = FreeCADGui.getMainWindow()
    bars = [bar for bar in window.findChildren(QtWidgets.QToolBar) if bar.windowTitle() == "PKM Post"]
    actions = [action for bar in bars for action in bar.actions() if not action.isSeparator()]
    return {
        "listed": "PkmPostWorkbench" in FreeCADGui.listWorkbenches(),
        "buttons": [action.text() for action in actions],
        "icons": [not action.icon().isNull() for action in actions],
    }


@step
def commands_have_pages():
    return {name: FreeCADGui.Command.get(name).getInfo()["whatsThis"] for name in FreeCADGui.listCommands()
            if name.startswith("PKM_")}  # fmt: skip


@step
def commands_know_what_they_are_for():
    document = new_document("gui")
    job, operation = document.getObject("Job"), document.getObject("Custom")
    active = {}
    original = job.Proxy.baseObject(job, job.Model.Group[0])
    items = {"job": job, "operation": operation, "controller": job.Tools.Group[0], "part": original, "stock": job.Stock}
    for name, item in items.items():
        select(item)
        active[name] = _active()
    FreeCADGui.Selection.clearSelection()
    active["nothing"] = _active()
    other = document.copyObject(job, True)
    document.recompute()
    active["nothing, two jobs"] = _active()
    select(operation)
    active["operation, two jobs"] = _active()
    FreeCADGui.Selection.addSelection(other)
    active["of both jobs"] = _active()
    return active


def _active():
    return [FreeCADGui.Command.get(f"PKM_{name}").isActive() for name in ("Mirror", "Rotate", "Post", "SurfaceFinish")]


@step
def cam_menu_has_the_commands():
    FreeCADGui.activateWorkbench("CAMWorkbench")
    settle()
    FreeCADGui.activateWorkbench("PartDesignWorkbench")
    FreeCADGui.activateWorkbench("CAMWorkbench")  # again: they must be there once
    settle()
    menus = FreeCADGui.getMainWindow().menuBar().actions()
    ours = [action.menu() for action in menus if action.menu() and action.text().replace("&", "") == "PKM Post"]
    bars = [bar for bar in FreeCADGui.getMainWindow().findChildren(QtWidgets.QToolBar)
            if bar.objectName() == "PKM Post" and bar.isVisible()]  # fmt: skip
    return {
        "menus": [[_text(action) for action in menu.actions()] for menu in ours],
        "bars": [[_text(action) for action in bar.actions()] for bar in bars],
        "cam": any(action.text().replace("&", "") == "CAM" for action in menus),
    }


def _text(action):
    return "-" if action.isSeparator() else action.text().replace("&", "")


@step
def menus_have_entries():
    """The path of each entry of the menus that the tutorials name, as they write it."""
    found = []
    for workbench, names in (("PartWorkbench", ("Part",)), ("CAMWorkbench", ("CAM", "PKM Post"))):
        FreeCADGui.activateWorkbench(workbench)
        settle()
        entries = FreeCADGui.getMainWindow().menuBar().actions()
        for entry in entries:
            if _text(entry) in names:
                found += _paths(entry)
    return found


def _paths(entry):
    """The path of an entry, or those of all entries of a menu and the menus in it."""
    if entry.menu() is None:
        return [_text(entry)]
    below = entry.menu().actions()
    return [f"{_text(entry)} > {path}" for each in below for path in _paths(each)]


@step
def window_is_drawn():
    FreeCADGui.activateWorkbench("PkmPostWorkbench")
    FreeCADGui.SendMsgToActiveView("ViewFit")
    return {"saved": picture("window.png")}


main()
