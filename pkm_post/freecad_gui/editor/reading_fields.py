# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading fields: options that a part program does not state itself, chosen beside its text.

Shows a reading; returns the chosen one. G-code and CL data leave different options open, and only the fields of the
current language are offered.
"""

from __future__ import annotations

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.reading import AXIS_WORDS, DIALECTS, DWELL_UNITS, UNITS, Language, ReadingOptions

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_CONTOUR_DATA: dict[str | None, str] = {
    None: QT_TRANSLATE_NOOP("PKM_Editor", "CUTCOM as the file says"),
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
        self.cl_dialect = QtWidgets.QComboBox(self)
        self.allow_open_end = QtWidgets.QCheckBox(translate("PKM_Editor", "Open end allowed"), self)
        # Seldom needed, and chosen in the properties of the program object: here only stored.
        self._cycle_values: tuple[str, ...] = ()
        self.axis_words.addItems(list(AXIS_WORDS))
        self.dwell_unit.addItems(list(DWELL_UNITS))
        self.unit.addItem(translate("PKM_Editor", "Unit as the file says"), None)
        for name in UNITS:
            self.unit.addItem(name, name)
        for choice, text in _CONTOUR_DATA.items():
            self.contour_data.addItem(translate("PKM_Editor", text), choice)
        self.cl_dialect.addItem(translate("PKM_Editor", "CAM system as the file says"), None)
        for name, dialect in DIALECTS.items():
            self.cl_dialect.addItem(dialect.title, name)
        self.axis_words.setToolTip(translate("PKM_Editor", "How the G-code says the tool axis"))
        self.dwell_unit.setToolTip(translate("PKM_Editor", "The unit of dwells of the G-code"))
        self.unit.setToolTip(translate("PKM_Editor", "The unit of length of the part program"))
        self.contour_data.setToolTip(
            translate("PKM_Editor", "What the points of CL data under CUTCOM are: tool centre or part contour")
        )
        self.cl_dialect.setToolTip(translate("PKM_Editor", "The CAM system that wrote the CL data"))
        self.allow_open_end.setToolTip(
            translate("PKM_Editor", "Take a program that neither M2, M30 or % nor FINI or END-OF-PATH ends")
        )
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for field in (self.axis_words, self.dwell_unit, self.unit, self.contour_data, self.cl_dialect):
            layout.addWidget(field)
            field.currentIndexChanged.connect(lambda index: self.changed.emit())
        layout.addWidget(self.allow_open_end)
        self.allow_open_end.toggled.connect(lambda is_on: self.changed.emit())
        self.offer_for(Language.GCODE)

    def offer_for(self, language: Language) -> None:
        """Show the fields that apply to a language."""
        for field in (self.axis_words, self.dwell_unit):
            field.setVisible(language is Language.GCODE)
        for field in (self.contour_data, self.cl_dialect):
            field.setVisible(language is not Language.GCODE)

    def chosen(self) -> ReadingOptions:
        """The chosen options."""
        return ReadingOptions(
            self.axis_words.currentText(),
            dwell_unit=self.dwell_unit.currentText(),
            unit=self.unit.currentData(),
            contour_data=self.contour_data.currentData(),
            cl_dialect=self.cl_dialect.currentData(),
            cycle_values=self._cycle_values,
            allow_open_end=self.allow_open_end.isChecked(),
        )

    def show_reading(self, reading: ReadingOptions) -> None:
        """Show a reading, which does not count as a change."""
        blocker = QtCore.QSignalBlocker(self)
        self.axis_words.setCurrentText(reading.axis_words)
        self.dwell_unit.setCurrentText(reading.dwell_unit)
        self.unit.setCurrentIndex(self.unit.findData(reading.unit))
        self.contour_data.setCurrentIndex(self.contour_data.findData(reading.contour_data))
        self.cl_dialect.setCurrentIndex(self.cl_dialect.findData(reading.cl_dialect))
        self.allow_open_end.setChecked(reading.allow_open_end)
        self._cycle_values = reading.cycle_values
        blocker.unblock()
