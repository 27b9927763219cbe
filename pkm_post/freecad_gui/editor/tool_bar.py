# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool bar: the editor's actions as buttons and shortcuts.

Takes the editor; returns its bar. The shortcuts apply while the editor has the focus: elsewhere the same keys are
FreeCAD's.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

if TYPE_CHECKING:
    from pkm_post.freecad_gui.editor.dock import ProgramEditor

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_KEYS = QtGui.QKeySequence.StandardKey
_NO_KEY = _KEYS.UnknownKey

_BUTTONS: tuple[tuple[str, str, Any, Callable[[ProgramEditor], Any]], ...] = (
    (QT_TRANSLATE_NOOP("PKM_Editor", "Open"), QT_TRANSLATE_NOOP("PKM_Editor", "Open a part program"),
     _KEYS.Open, lambda editor: editor.ask_and_open()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Save"), QT_TRANSLATE_NOOP("PKM_Editor", "Save the part program"),
     _KEYS.Save, lambda editor: editor.save()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Save as"), QT_TRANSLATE_NOOP("PKM_Editor", "Save under another name"),
     _KEYS.SaveAs, lambda editor: editor.save_as()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Find"), QT_TRANSLATE_NOOP("PKM_Editor", "Find and replace"),
     _KEYS.Find, lambda editor: editor.body.find_bar.begin()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Renumber"), QT_TRANSLATE_NOOP("PKM_Editor", "Give each block a line number"),
     _NO_KEY, lambda editor: editor.body.renumber()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Decode"), QT_TRANSLATE_NOOP("PKM_Editor", "Make it an operation of a CAM job"),
     _NO_KEY, lambda editor: editor.decode()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Post"), QT_TRANSLATE_NOOP("PKM_Editor", "Write a certified motion program"),
     _NO_KEY, lambda editor: editor.post()),
)  # fmt: skip
"""Text, tooltip, shortcut and action of each button."""
_SHORTCUTS: tuple[tuple[Any, Callable[[ProgramEditor], Any]], ...] = (
    (_KEYS.FindNext, lambda editor: editor.body.find_bar.find_next()),
    (_KEYS.FindPrevious, lambda editor: editor.body.find_bar.find_previous()),
    (_KEYS.Replace, lambda editor: editor.body.find_bar.begin()),
)
"""Actions without a button."""


def tool_bar(editor: ProgramEditor, parent: QtWidgets.QWidget) -> QtWidgets.QToolBar:
    """Create the bar of an editor that has its body; this also adds the actions to the editor.

    Args:
        editor: target of the actions.
        parent: parent widget of the bar.
    """
    bar = QtWidgets.QToolBar(parent)
    for text, tip, key, call in _BUTTONS:
        action = bar.addAction(translate("PKM_Editor", text))
        _add(editor, action, key, call)
        said, shortcut = translate("PKM_Editor", tip), action.shortcut().toString()
        action.setToolTip(f"{said} ({shortcut})" if shortcut else said)
    for key, call in _SHORTCUTS:
        _add(editor, QtGui.QAction(editor), key, call)
    bar.addWidget(editor.body.reading)
    return bar


def _add(editor: ProgramEditor, action: QtGui.QAction, key: Any, call: Callable[[ProgramEditor], Any]) -> None:
    action.setShortcut(QtGui.QKeySequence(key))
    action.setShortcutContext(QtCore.Qt.ShortcutContext.WidgetWithChildrenShortcut)
    action.triggered.connect(lambda checked=False: call(editor))
    editor.addAction(action)
