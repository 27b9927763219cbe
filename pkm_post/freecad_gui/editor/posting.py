# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting: the file of an editor becomes a certified motion program, beside the window.

The arguments are those of the post-processor ``hexapod_pmac``. They are asked for and kept in the preferences.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.arguments import parsed
from pkm_post.freecad_gui.editor.task import Task
from pkm_post.model import Place, Refused
from pkm_post.options import options_from, tool_lengths_from
from pkm_post.post_file import post_file
from pkm_post.sources import Reading

translate = FreeCAD.Qt.translate

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/PKM"
_ENTRY, _AT_FIRST = "EditorArguments", "--machine example_6tps --work-offset G54 --tool-length 1=120"


class Posting(QtCore.QObject):
    """One run at a time, with a progress bar while it lasts and a message at its end."""

    ended = QtCore.Signal()

    def __init__(self, window: QtWidgets.QWidget) -> None:
        super().__init__(window)
        self._window = window
        self._title = translate("PKM_Editor", "Post program")
        self._task: Task | None = None
        self._progress: Any = None

    def ask_and_post(self, file: Path, axis_words: str) -> None:
        """Ask for the arguments and post a file into its folder."""
        kept = FreeCAD.ParamGet(PREFERENCES).GetString(_ENTRY, _AT_FIRST)
        label = translate("PKM_Editor", "Arguments, as those of hexapod_pmac:")
        mode = QtWidgets.QLineEdit.EchoMode.Normal
        text, wanted = QtWidgets.QInputDialog.getText(self._window, self._title, label, mode, kept)
        if wanted:
            FreeCAD.ParamGet(PREFERENCES).SetString(_ENTRY, text)
            self.post(file, axis_words, text)

    def post(self, file: Path, axis_words: str, arguments: str) -> None:
        """Post a file into its folder; ``ended`` tells when its files are there, or why they are not was told."""
        if self._task is not None:
            return
        try:
            chosen = parsed(arguments, Place(str(file)))
        except Refused as refused:
            QtWidgets.QMessageBox.warning(self._window, self._title, str(refused))
            self.ended.emit()
            return
        options, lengths = options_from(chosen), tool_lengths_from(chosen)
        call = partial(post_file, file, chosen.machine, file.parent, options, lengths, Reading(axis_words))
        self._progress = QtWidgets.QProgressDialog(self._title, "", 0, 0, self._window)
        self._progress.setCancelButton(None)
        self._progress.setWindowModality(QtCore.Qt.WindowModality.WindowModal)
        self._progress.setMinimumDuration(0)
        self._progress.show()
        self._task = Task(call, self)
        self._task.finished.connect(self._end)
        self._task.start()

    def _end(self) -> None:
        task, self._task = self._task, None
        self._progress.reset()
        self._progress.deleteLater()
        try:
            posted = task.value()
        except Refused as refused:
            QtWidgets.QMessageBox.warning(self._window, self._title, str(refused))
        else:
            written = "\n".join(str(path) for path in (*posted.files, *posted.diagnostics))
            told = translate("PKM_Editor", "Certified and written:")
            QtWidgets.QMessageBox.information(self._window, self._title, f"{told}\n{written}")
        finally:
            task.deleteLater()
            self.ended.emit()
