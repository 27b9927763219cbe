# SPDX-License-Identifier: LGPL-2.1-or-later
"""Posting: converts the file of an editor to a certified motion program, in the background.

The user's choices come from the fields of the post panel, and are stored in the preferences.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.arguments import parse_arguments
from pkm_post.freecad_app.core_texts import exception_text, fault_text
from pkm_post.freecad_app.progress import Stopped
from pkm_post.freecad_gui.background import BackgroundCall
from pkm_post.freecad_gui.observers import keep_wrappers
from pkm_post.freecad_gui.post_fields import PostChoices
from pkm_post.freecad_gui.post_outcome import step_text
from pkm_post.freecad_gui.preferences import GROUP, default_arguments
from pkm_post.model import Place, Refused
from pkm_post.options import explicit_values
from pkm_post.posting import post_file
from pkm_post.reading import (
    AS_WRITTEN,
    AXIS_WORDS,
    DIALECTS,
    DWELL_UNITS,
    FLAVOUR_NAMES,
    UNITS,
    Language,
    ReadingOptions,
)

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
        self._task: BackgroundCall | None = None
        self._progress: Any = None

    def ask_and_post(self, file: Path, reading: ReadingOptions) -> None:
        """Show the fields of the post panel, and post a file into its folder."""
        kept = FreeCAD.ParamGet(GROUP).GetString(_ENTRY, default_arguments() or _AT_FIRST)
        dialog = _Dialog(PostChoices(kept, str(file.parent)), self._title, self._window)
        if dialog.is_accepted():
            text, folder = dialog.fields.text(), dialog.fields.folder.text().strip()
            FreeCAD.ParamGet(GROUP).SetString(_ENTRY, text)
            self.post(file, reading, text, Path(folder or file.parent))
        keep_wrappers(dialog)
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
            QtWidgets.QMessageBox.warning(self._window, self._title, exception_text(refused))
            self.ended.emit()
            return
        out, given = folder or file.parent, explicit_values(chosen)
        call = partial(post_file, file, out=out, reading=reading, arguments=given)
        task = BackgroundCall(lambda: call(progress=task.report), self)
        self._task, self._progress = task, self._bar(task)
        task.finished.connect(self._end)
        task.start()

    def _bar(self, task: BackgroundCall) -> Any:
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
            QtWidgets.QMessageBox.warning(self._window, self._title, exception_text(refused))
        except Stopped:
            text = translate("PKM_Editor", "Stopped. Nothing was written.")
            QtWidgets.QMessageBox.information(self._window, self._title, text)
        else:
            text = translate("PKM_Editor", "Certified and written:")
            lines = (text, *map(str, posted.files), *map(fault_text, posted.diagnostics))
            QtWidgets.QMessageBox.information(self._window, self._title, "\n".join(lines))
        finally:
            task.deleteLater()
            self.ended.emit()


class _Dialog(QtWidgets.QDialog):
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


QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_CONTOUR_DATA: dict[str | None, str] = {
    None: QT_TRANSLATE_NOOP("PKM_Editor", "CUTCOM as in the file"),
    "centre": QT_TRANSLATE_NOOP("PKM_Editor", "CUTCOM on the tool centre"),
    "contour": QT_TRANSLATE_NOOP("PKM_Editor", "CUTCOM on the contour"),
}


class ReadingFields(QtWidgets.QWidget):
    """The fields, side by side."""

    changed = QtCore.Signal()

    def __init__(self, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self.axis_words, self.dwell_unit = QtWidgets.QComboBox(self), QtWidgets.QComboBox(self)
        self.unit, self.contour_data = QtWidgets.QComboBox(self), QtWidgets.QComboBox(self)
        self.cl_dialect, self.flavour = QtWidgets.QComboBox(self), QtWidgets.QComboBox(self)
        self.allow_open_end = QtWidgets.QCheckBox(translate("PKM_Editor", "Open end allowed"), self)
        # Rare ones are set in the properties of the program object, and only stored here.
        self._shown = AS_WRITTEN
        self.axis_words.addItems(list(AXIS_WORDS))
        self.flavour.addItem(translate("PKM_Editor", "Flavour as in the file"), None)
        for name in FLAVOUR_NAMES:
            self.flavour.addItem(name, name)
        self.dwell_unit.addItem(translate("PKM_Editor", "Dwells as in the flavour"), None)
        for name in DWELL_UNITS:
            self.dwell_unit.addItem(name, name)
        self.unit.addItem(translate("PKM_Editor", "Unit as in the file"), None)
        for name in UNITS:
            self.unit.addItem(name, name)
        for choice, text in _CONTOUR_DATA.items():
            self.contour_data.addItem(translate("PKM_Editor", text), choice)
        self.cl_dialect.addItem(translate("PKM_Editor", "CAM system as in the file"), None)
        for name, dialect in DIALECTS.items():
            self.cl_dialect.addItem(dialect.title, name)
        self.axis_words.setToolTip(translate("PKM_Editor", "Tool axis words of the G-code"))
        self.flavour.setToolTip(translate("PKM_Editor", "Dialect of the G-code"))
        self.dwell_unit.setToolTip(translate("PKM_Editor", "The unit of dwells of the G-code"))
        self.unit.setToolTip(translate("PKM_Editor", "The unit of length of the part program"))
        self.contour_data.setToolTip(
            translate("PKM_Editor", "Meaning of the points of CL data under CUTCOM: tool centre or part contour")
        )
        self.cl_dialect.setToolTip(translate("PKM_Editor", "The CAM system that wrote the CL data"))
        self.allow_open_end.setToolTip(
            translate("PKM_Editor", "Accept a program without an end (M2, M30, %, FINI or END-OF-PATH)")
        )
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        gcode, cl_data = (self.axis_words, self.flavour, self.dwell_unit), (self.contour_data, self.cl_dialect)
        for field in (*gcode, self.unit, *cl_data):
            layout.addWidget(field)
            field.currentIndexChanged.connect(lambda index: self.changed.emit())
        layout.addWidget(self.allow_open_end)
        self.allow_open_end.toggled.connect(lambda is_on: self.changed.emit())
        self.offer_for(Language.GCODE)

    def offer_for(self, language: Language) -> None:
        """Show the fields that apply to a language."""
        for field in (self.axis_words, self.flavour, self.dwell_unit):
            field.setVisible(language is Language.GCODE)
        for field in (self.contour_data, self.cl_dialect):
            field.setVisible(language is not Language.GCODE)

    def chosen(self) -> ReadingOptions:
        """The chosen options."""
        return replace(
            self._shown,
            axis_words=self.axis_words.currentText(),
            flavour=self.flavour.currentData(),
            dwell_unit=self.dwell_unit.currentData(),
            unit=self.unit.currentData(),
            contour_data=self.contour_data.currentData(),
            cl_dialect=self.cl_dialect.currentData(),
            allow_open_end=self.allow_open_end.isChecked(),
        )

    def show_reading(self, reading: ReadingOptions) -> None:
        """Show options, without counting it as a change."""
        blocker = QtCore.QSignalBlocker(self)
        self.axis_words.setCurrentText(reading.axis_words)
        self.flavour.setCurrentIndex(self.flavour.findData(reading.flavour))
        self.dwell_unit.setCurrentIndex(self.dwell_unit.findData(reading.dwell_unit))
        self.unit.setCurrentIndex(self.unit.findData(reading.unit))
        self.contour_data.setCurrentIndex(self.contour_data.findData(reading.contour_data))
        self.cl_dialect.setCurrentIndex(self.cl_dialect.findData(reading.cl_dialect))
        self.allow_open_end.setChecked(reading.allow_open_end)
        self._shown = reading
        blocker.unblock()
