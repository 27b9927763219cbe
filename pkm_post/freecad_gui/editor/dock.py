# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dock: the part program editor as a dock, one per main window.

Takes a file, or that of a program object; saves the edited text, decodes it into a job, or posts it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import exception_text, shown
from pkm_post.freecad_app.document import is_program
from pkm_post.freecad_gui.editor import program_link
from pkm_post.freecad_gui.editor.editor_widget import EditorWidget, FileDrop
from pkm_post.freecad_gui.editor.posting import Posting
from pkm_post.freecad_gui.observers import docked
from pkm_post.model import Refused
from pkm_post.reading import SUFFIXES, VERSIONED, TextFile, is_part_program
from pkm_post.system import memory_guard, reason_of, staged

translate = FreeCAD.Qt.translate

NAME = "PKM_Editor"


class ProgramEditor(QtWidgets.QDockWidget):
    """The editor.

    Attributes:
        body: the text and its feedback.
        posting: creates motion programs.
    """

    def __init__(self, window: QtWidgets.QMainWindow) -> None:
        super().__init__(window)
        self.setObjectName(NAME)
        self._content = TextFile()
        inside = QtWidgets.QWidget(self)
        self.widget, self.posting = EditorWidget(inside), Posting(self)
        layout = QtWidgets.QVBoxLayout(inside)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(tool_bar(self, inside))
        layout.addWidget(self.widget)
        self.setWidget(inside)
        self._document = self.widget.text.document()
        self._document.modificationChanged.connect(self._name_window)
        window.installEventFilter(self)
        drop = FileDrop(self, self, self.widget.text, self.widget.text.viewport())
        # children get drags first; queued, since a dialog would block the source of the drag
        drop.dropped.connect(self.open_file, QtCore.Qt.ConnectionType.QueuedConnection)
        self._name_window()

    def ask_and_open(self) -> None:
        """Open a file that the user chooses."""
        name = QtWidgets.QFileDialog.getOpenFileName(
            self, translate("PKM_Editor", "Open"), self._folder(), _name_filter()
        )[0]
        if name:
            self.open_file(Path(name))

    def open_file(self, file: Path) -> bool:
        """Edit a file; return whether it was opened."""
        if not self._may_leave():
            return False
        try:
            self._content = TextFile.decode(file.read_bytes())
        except OSError as fault:
            QtWidgets.QMessageBox.warning(self, translate("PKM_Editor", "Open"), shown(reason_of(fault)))
            return False
        self.widget.text.edits.load(self._content.text)
        self.widget.open_file(file.absolute())
        self._name_window()
        return True

    def save(self) -> bool:
        """Write the text to its file, and update its object; return whether it was written."""
        return self.save_as() if self.widget.file is None else self._write(self.widget.file)

    def save_as(self) -> bool:
        """Write the text to a file that the user chooses; return whether it was written."""
        name = QtWidgets.QFileDialog.getSaveFileName(
            self, translate("PKM_Editor", "Save"), self._folder(), _name_filter()
        )[0]
        if not name:
            return False
        return self._write(Path(name) if is_part_program(Path(name)) else Path(f"{name}.ngc"))

    def _write(self, file: Path) -> bool:
        self.widget.text.edits.finish()
        try:
            with staged(file.parent) as folder:
                (folder / file.name).write_bytes(self._content.encode(self.widget.text.toPlainText()))
        except OSError as fault:
            QtWidgets.QMessageBox.warning(self, translate("PKM_Editor", "Save"), shown(reason_of(fault)))
            return False
        if file != self.widget.file:
            self.widget.set_file(file.absolute())
        self._document.setModified(False)
        self._name_window()
        self.widget.follow()
        return True

    def decode(self) -> Any:
        """Convert the program to an operation of a CAM job; return the operation, or None on failure."""
        title = translate("PKM_Editor", "Decode into a job")
        job = program_link.chosen_job(self, title)
        if job is None:
            QtWidgets.QMessageBox.warning(
                self, title, translate("PKM_Editor", "No CAM job of the active document was chosen.")
            )
        elif self._saved():
            try:
                with memory_guard(str(self.widget.file)):
                    return program_link.decode_file(self.widget.file, self.widget.reading.chosen(), job)
            except Refused as refused:
                QtWidgets.QMessageBox.warning(self, title, exception_text(refused))
        return None

    def post(self) -> None:
        """Write a certified motion program beside the file."""
        if self._saved():
            self.posting.ask_and_post(self.widget.file, self.widget.reading.chosen())

    def eventFilter(self, watched: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Called by Qt: FreeCAD does not exit while changes would be lost."""
        if event.type() == QtCore.QEvent.Type.Close and watched is self.parent() and not self._may_leave():
            event.ignore()
            return True
        return False

    def _saved(self) -> bool:
        is_saved = self.widget.file is not None and not self._document.isModified()
        return is_saved or self.save()

    def _may_leave(self) -> bool:
        """Whether the text is saved or the user discards it."""
        if not self._document.isModified():
            return True
        buttons = QtWidgets.QMessageBox.StandardButton
        question = translate("PKM_Editor", "Save the changes of the part program?")
        choice = buttons.Save | buttons.Discard | buttons.Cancel
        answer = QtWidgets.QMessageBox.question(self, self.windowTitle(), question, choice)
        return self.save() if answer == buttons.Save else answer == buttons.Discard

    def _folder(self) -> str:
        return str(self.widget.file.parent) if self.widget.file else ""

    def _name_window(self, *changed: bool) -> None:
        star = " *" if self._document.isModified() else ""
        self.setWindowTitle(f"{Path(self.widget.name()).name}{star} - PKM Post")


def open_editor(item: Any = None) -> ProgramEditor:
    """Show the editor of the main window, with the file of a program object if one is given."""
    editor: ProgramEditor = docked(ProgramEditor, NAME)
    if item is not None and is_program(item) and editor.widget.file != Path(item.File):
        editor.open_file(Path(item.File))
    return editor


def _name_filter() -> str:
    kind = translate("PKM_Editor", "Part programs")  # lupdate does not read f-strings
    return f"{kind} ({' '.join(f'*{suffix}' for suffix in (*SUFFIXES, f'{VERSIONED}.*'))})"


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
     _KEYS.Find, lambda editor: editor.widget.find_bar.begin()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Renumber"), QT_TRANSLATE_NOOP("PKM_Editor", "Give each block a line number"),
     _NO_KEY, lambda editor: editor.widget.renumber()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Decode"), QT_TRANSLATE_NOOP("PKM_Editor", "Make it an operation of a CAM job"),
     _NO_KEY, lambda editor: editor.decode()),
    (QT_TRANSLATE_NOOP("PKM_Editor", "Post"), QT_TRANSLATE_NOOP("PKM_Editor", "Write a certified motion program"),
     _NO_KEY, lambda editor: editor.post()),
)  # fmt: skip
"""Text, tooltip, shortcut and action of each button."""
_SHORTCUTS: tuple[tuple[Any, Callable[[ProgramEditor], Any]], ...] = (
    (_KEYS.FindNext, lambda editor: editor.widget.find_bar.find_next()),
    (_KEYS.FindPrevious, lambda editor: editor.widget.find_bar.find_previous()),
    (_KEYS.Replace, lambda editor: editor.widget.find_bar.begin()),
)
"""Actions without a button."""


def tool_bar(editor: ProgramEditor, parent: QtWidgets.QWidget) -> QtWidgets.QToolBar:
    """Create the bar of an editor that has its body; this also adds the actions to the editor.

    Args:
        editor: target of the actions.
    """
    bar = QtWidgets.QToolBar(parent)
    for text, tip, key, call in _BUTTONS:
        action = bar.addAction(translate("PKM_Editor", text))
        _add(editor, action, key, call)
        tip, shortcut = translate("PKM_Editor", tip), action.shortcut().toString()
        action.setToolTip(f"{tip} ({shortcut})" if shortcut else tip)
    for key, call in _SHORTCUTS:
        _add(editor, QtGui.QAction(editor), key, call)
    bar.addWidget(editor.widget.reading)
    return bar


def _add(editor: ProgramEditor, action: QtGui.QAction, key: Any, call: Callable[[ProgramEditor], Any]) -> None:
    action.setShortcut(QtGui.QKeySequence(key))
    action.setShortcutContext(QtCore.Qt.ShortcutContext.WidgetWithChildrenShortcut)
    action.triggered.connect(lambda checked=False: call(editor))
    editor.addAction(action)
