# SPDX-License-Identifier: LGPL-2.1-or-later
"""Context menu: what the menu of an object in the tree has beside FreeCAD's own entries.

A menu enters and gets more entries. Commands of the workbench look and do as their buttons; for an object that belongs
to a job, they are done to the job.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtGui

from pkm_post.freecad_app.transaction import transaction
from pkm_post.freecad_gui.workbench import ICONS

translate = FreeCAD.Qt.translate


def add_entry(menu: Any, text: str, call: Callable[[], Any], icon: str = "") -> Any:
    """Add an entry.

    Args:
        menu: gets it.
        text: what it says, translated.
        call: what it does.
        icon: file name in resources/icons.
    """
    action = QtGui.QAction(text, menu)
    if icon:
        action.setIcon(QtGui.QIcon(str(ICONS / icon)))
    action.triggered.connect(lambda checked=False: call())
    menu.addAction(action)
    return action


def add_commands(menu: Any, item: Any, *names: str) -> None:
    """Add commands of the workbench, to be done to an object; none if there is no such object.

    Args:
        menu: gets them.
        item: an operation or a job; None for none.
        names: of the commands.
    """
    from pkm_post.freecad_gui.commands import COMMANDS

    if item is None:
        return
    known = {command.name: command for command in COMMANDS}
    for name in names:
        command = known[name]
        add_entry(menu, translate(name, command.text), _runner(name, item), command.icon).setStatusTip(
            translate(name, command.tip)
        )


def add_switch(menu: Any, obj: Any) -> None:
    """Add the entry that switches an object on and off, as its property ``Active`` does, in one step to undo."""
    action = add_entry(menu, translate("ContextMenu", "Active"), lambda: _switch(obj))
    action.setCheckable(True)
    action.setChecked(obj.Active)


def _runner(name: str, item: Any) -> Callable[[], None]:
    return lambda: _run(name, item)


def _run(name: str, item: Any) -> None:
    """As the button does: commands are for what is selected."""
    FreeCAD.setActiveDocument(item.Document.Name)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(item)
    FreeCADGui.runCommand(name, 0)


def _switch(obj: Any) -> None:
    document = obj.Document
    with transaction(document, translate("ContextMenu", "Switch on or off")):
        obj.Active = not obj.Active
    document.recompute()
