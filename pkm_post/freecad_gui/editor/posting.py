# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting: converts the file of an editor to a certified motion program, beside the window.

The user's choices come from the fields of the post panel, and are stored in the preferences.
"""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.arguments import parse_arguments
from pkm_post.freecad_app.progress import Stopped
from pkm_post.freecad_gui.post_choices import PostChoices
from pkm_post.freecad_gui.post_steps import step_text
from pkm_post.freecad_gui.preferences import GROUP, default_arguments
from pkm_post.freecad_gui.task import Task
from pkm_post.model import Place, Refused
from pkm_post.options import explicit_values, part_program_from
from pkm_post.posting import post_file
from pkm_post.reading import ReadingOptions

translate = FreeCAD.Qt.translate

_PER_MILLE = 1000
_ENTRY, _AT_FIRST = "EditorArguments", "--machine example_6tps --work-offset G54 --tool-length 1=120"


class Posting(QtCore.QObject):
    """One run at a time, with a progress bar during the run and a message at its end."""

    ended = QtCore.Signal()

    def __init__(self, window: QtWidgets.QWidget) -> None:
        super().__init__(window)
        self._window = window
        self._title = translate("PKM_Editor", "Post program")
        self._task: Task | None = None
        self._progress: Any = None

    def ask_and_post(self, file: Path, reading: ReadingOptions) -> None:
        """Show the fields of the post panel, and post a file into its folder."""
        kept = FreeCAD.ParamGet(GROUP).GetString(_ENTRY, default_arguments() or _AT_FIRST)
        dialog = _Dialog(PostChoices(kept, str(file.parent)), self._title, self._window)
        if dialog.is_accepted():
            text, folder = dialog.fields.text(), dialog.fields.folder.text().strip()
            FreeCAD.ParamGet(GROUP).SetString(_ENTRY, text)
            self.post(file, reading, text, Path(folder or file.parent))
        dialog.deleteLater()

    def post(self, file: Path, reading: ReadingOptions, arguments: str, folder: Path | None = None) -> None:
        """Post a file, beside it if no folder is given; its options in the arguments override ``reading``.

        ``ended`` is emitted when its files exist, or after the reason for their absence was reported.
        """
        if self._task is not None:
            return
        try:
            chosen = parse_arguments(arguments, Place(str(file)))
        except Refused as refused:
            QtWidgets.QMessageBox.warning(self._window, self._title, str(refused))
            self.ended.emit()
            return
        out, given = folder or file.parent, explicit_values(chosen)
        call = partial(post_file, file, out=out, reading=_with_typed(reading, chosen), arguments=given)
        task = Task(lambda: call(progress=task.tell), self)
        self._task, self._progress = task, self._bar(task)
        task.finished.connect(self._end)
        task.start()

    def _bar(self, task: Task) -> Any:
        """A window with a progress bar and a button that stops the task."""
        cancel = translate("PKM_Editor", "Cancel")
        bar = QtWidgets.QProgressDialog(self._title, cancel, 0, _PER_MILLE, self._window)
        bar.setWindowModality(QtCore.Qt.WindowModality.WindowModal)
        bar.setMinimumDuration(0)
        bar.setAutoReset(False)
        bar.canceled.connect(task.stop)
        task.progressed.connect(self._show)
        bar.show()
        return bar

    def _show(self, step: str, share: float) -> None:
        self._progress.setLabelText(step_text(step))
        self._progress.setValue(round(share * _PER_MILLE))

    def _end(self) -> None:
        task, self._task = self._task, None
        self._progress.reset()
        self._progress.deleteLater()
        try:
            posted = task.value()
        except Refused as refused:
            QtWidgets.QMessageBox.warning(self._window, self._title, str(refused))
        except Stopped:
            told = translate("PKM_Editor", "Stopped. Nothing was written.")
            QtWidgets.QMessageBox.information(self._window, self._title, told)
        else:
            written = "\n".join(str(path) for path in (*posted.files, *posted.diagnostics))
            told = translate("PKM_Editor", "Certified and written:")
            QtWidgets.QMessageBox.information(self._window, self._title, f"{told}\n{written}")
        finally:
            task.deleteLater()
            self.ended.emit()


def _with_typed(reading: ReadingOptions, chosen: Namespace) -> ReadingOptions:
    """The options chosen beside the text, overridden by those typed as arguments."""
    typed = part_program_from(chosen, reading.axis_words)
    return replace(
        typed,
        dwell_unit=reading.dwell_unit,
        unit=typed.unit or reading.unit,
        contour_data=typed.contour_data or reading.contour_data,
        cl_dialect=typed.cl_dialect or reading.cl_dialect,
        cycle_values=typed.cycle_values or reading.cycle_values,
        allow_open_end=typed.allow_open_end or reading.allow_open_end,
    )


class _Dialog(QtWidgets.QDialog):
    """The fields in a dialog."""

    def __init__(self, fields: PostChoices, title: str, window: QtWidgets.QWidget) -> None:
        super().__init__(window)
        self.fields = fields
        self.setWindowTitle(title)
        button = QtWidgets.QDialogButtonBox.StandardButton
        buttons = QtWidgets.QDialogButtonBox(button.Ok | button.Cancel)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(fields)
        layout.addWidget(buttons)

    def is_accepted(self) -> bool:
        """Show the dialog; return whether the user accepted it."""
        show = getattr(self, "exec", None) or self.exec_  # Qt 6, Qt 5
        return bool(show())
