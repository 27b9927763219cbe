# SPDX-License-Identifier: LGPL-2.1-or-later
"""Context menu: our entries in the menu of a tree object, beside FreeCAD's own.

Takes a menu and adds entries. Commands of the workbench look and act like their buttons; for an object of a job, they
apply to the job.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
from PySide import QtGui

from pkm_post.freecad_app.document import transaction
from pkm_post.freecad_gui.command import run_on
from pkm_post.freecad_gui.icons import ICONS

translate = FreeCAD.Qt.translate


def add_entry(menu: Any, text: str, call: Callable[[], Any], icon: str = "") -> Any:
    """Add an entry.

    Args:
        text: label, translated.
        call: action of the entry.
        icon: file name in resources/icons.
    """
    action = QtGui.QAction(text, menu)
    if icon:
        action.setIcon(QtGui.QIcon(str(ICONS / icon)))
    action.triggered.connect(lambda checked=False: call())
    menu.addAction(action)
    return action


def add_commands(menu: Any, item: Any, *names: str) -> None:
    """Add commands of the workbench that apply to an object; none if there is no object.

    Args:
        item: an operation or a job; None for none.
        names: names of the commands.
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
    """Add the entry that toggles the property ``Active`` of an object, as one undo step."""
    action = add_entry(menu, translate("ContextMenu", "Active"), lambda: _switch(obj))
    action.setCheckable(True)
    action.setChecked(obj.Active)


def _runner(name: str, item: Any) -> Callable[[], None]:
    return lambda: run_on(name, item)


def _switch(obj: Any) -> None:
    document = obj.Document
    with transaction(document, translate("ContextMenu", "Switch on or off")):
        obj.Active = not obj.Active
    document.recompute()
