# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge table: the tool controllers of a job, each with a field for its gauge length.

Takes a job; returns gauge lengths in mm for the tool controllers with edited fields. Lengths that posting would refuse
are reported below the table in posting's own words. The table follows the document: changes there, including undo,
override unsaved input for the same tool.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.core_texts import fault_text
from pkm_post.freecad_app.gauge_lengths import ToolRow, format_length, parse_length, tool_rows
from pkm_post.freecad_app.user_units import decimal_point
from pkm_post.freecad_gui.observers import ChangeWatch
from pkm_post.freecad_gui.post_fields import tab_through
from pkm_post.model import Amount, Phrase, Refused
from pkm_post.options import LONGEST_TOOL

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_COLUMNS = (
    (QT_TRANSLATE_NOOP("GaugeTable", "No."), QT_TRANSLATE_NOOP("GaugeTable", "Number of the tool")),
    (QT_TRANSLATE_NOOP("GaugeTable", "Tool"), QT_TRANSLATE_NOOP("GaugeTable", "Tool controller of the job")),
    (
        QT_TRANSLATE_NOOP("GaugeTable", "Bit"),
        QT_TRANSLATE_NOOP(
            "GaugeTable",
            "Length of the tool bit alone, to compare. It is no gauge length: part of the bit is in its holder,"
            " and the holder counts.",
        ),
    ),
    (
        QT_TRANSLATE_NOOP("GaugeTable", "Gauge length"),
        QT_TRANSLATE_NOOP("GaugeTable", "From the spindle nose to the tip, measured with the tool in its holder"),
    ),
)
"""Header and tooltip of each column."""
_LENGTH = len(_COLUMNS) - 1
_WATCHED = ("GaugeLength", "ToolNumber", "Label", "Tool", "Length", "Group", "Active", "ToolController", "Base")
_BIT_DIGITS = 5
_MOST_ROWS = 6
"""Largest number of visible rows."""


class GaugeTable(QtWidgets.QGroupBox):
    """The table, and messages on its rows below it."""

    def __init__(self, job: Any) -> None:
        super().__init__(translate("GaugeTable", "Gauge lengths"))
        self.table, self.notes = QtWidgets.QTableWidget(0, len(_COLUMNS)), QtWidgets.QLabel()
        self._job, self._by_argument = job, dict[int, float]()
        self._rows: tuple[ToolRow, ...] = ()
        self.fields: dict[str, LengthField] = {}
        self._set_up()
        self._show(tool_rows(job))
        self._watch = ChangeWatch(self.follow, job.Document.Name, _WATCHED)

    def _set_up(self) -> None:
        self.table.setHorizontalHeaderLabels([translate("GaugeTable", head) for head, _ in _COLUMNS])
        for column, (_, tip) in enumerate(_COLUMNS):
            self.table.horizontalHeaderItem(column).setToolTip(translate("GaugeTable", tip))
        self.table.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.NoSelection)
        self.table.setTabKeyNavigation(False)  # Tab goes from field to field, not from cell to cell
        self.table.verticalHeader().hide()
        sizes = QtWidgets.QHeaderView.ResizeMode
        for column, size in enumerate((sizes.ResizeToContents, sizes.Stretch, sizes.ResizeToContents, sizes.Stretch)):
            self.table.horizontalHeader().setSectionResizeMode(column, size)
        self.notes.setWordWrap(True)
        self.notes.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self.table)
        layout.addWidget(self.notes)

    def end(self) -> None:
        """Stop following the document."""
        self._watch.end()

    def follow(self) -> None:
        """Show the job's values; input is kept for tools whose values in the document are unchanged."""
        rows = tool_rows(self._job)
        if rows != self._rows:
            self._show(rows)

    def _show(self, rows: tuple[ToolRow, ...]) -> None:
        kept = {row.name: self.fields[row.name].text() for row in rows if self._is_as_before(row)}
        self._rows, self.fields = rows, {row.name: LengthField(row.length) for row in rows}
        self.table.setRowCount(len(rows))
        for number, row in enumerate(rows):
            self._fill(number, row)
        tab_through(list(self.fields.values()))
        for name, text in kept.items():
            self.fields[name].setText(text)
        self._fit()
        self._show_status()

    def _is_as_before(self, row: ToolRow) -> bool:
        return any((row.name, row.length) == (before.name, before.length) for before in self._rows)

    def _fill(self, number: int, row: ToolRow) -> None:
        bit = format_length(row.bit_length, decimal_point(), _BIT_DIGITS) if row.bit_length else ""
        for column, text in enumerate((str(row.number), row.label, bit)):
            item = QtWidgets.QTableWidgetItem(text)
            item.setToolTip(text if column < _LENGTH - 1 else translate("GaugeTable", _COLUMNS[column][1]))
            self.table.setItem(number, column, item)
        field = self.fields[row.name]
        field.setToolTip(translate("GaugeTable", _COLUMNS[_LENGTH][1]))
        field.textChanged.connect(self._show_status)
        self.table.setCellWidget(number, _LENGTH, field)

    def _fit(self) -> None:
        """Fit the height to the rows, up to a limit."""
        row = self.table.verticalHeader().defaultSectionSize()
        head = self.table.horizontalHeader().sizeHint().height()
        frame = 2 * self.table.frameWidth()
        self.table.setFixedHeight(head + frame + row * min(max(len(self._rows), 1), _MOST_ROWS))

    def show_arguments(self, lengths: Mapping[int, float]) -> None:
        """Show which gauge lengths the arguments define: these override the fields.

        Args:
            lengths: mm, by tool number.
        """
        self._by_argument = dict(lengths)
        self._show_status()

    def _show_status(self, *_: Any) -> None:
        """Report the fault of each row, or the argument that overrides it."""
        notes = []
        for row in self._rows:
            fault = self._fault(row)
            self.fields[row.name].show_fault(fault)
            notes += [each for each in (fault, self._goes_before(row)) if each]
        self.notes.setText("\n".join(notes))
        self.notes.setVisible(bool(notes))

    def _fault(self, row: ToolRow) -> str:
        mm = self.fields[row.name].length()
        if mm is None:
            return fault_text(row.missing_length(self._typed(row)))
        if not mm and row.in_use and row.number not in self._by_argument:
            return fault_text(row.missing_length())
        return ""

    def _goes_before(self, row: ToolRow) -> str:
        if row.number not in self._by_argument:
            return ""
        text = translate("GaugeTable", "T{}: {} of --tool-length in More arguments takes precedence over the field.")
        return text.format(row.number, format_length(self._by_argument[row.number], decimal_point()))

    def _typed(self, row: ToolRow) -> str:
        typed, most = self.fields[row.name].text(), Amount(LONGEST_TOOL, "mm", "g")
        return Phrase("{!r} is not a length above zero, up to {}", typed, most)

    def lengths(self) -> dict[str, float]:
        """The edited gauge lengths, in mm by the names of the tool controllers; 0 for a cleared one.

        Raises:
            Refused: the input is invalid, J113.
        """
        lengths = {row: self.fields[row.name].length() for row in self._rows}
        faults = [row.missing_length(self._typed(row)) for row, mm in lengths.items() if mm is None]
        if faults:
            raise Refused(faults)
        return {row.name: mm for row, mm in lengths.items() if mm is not None and mm != row.length}


class LengthField(QtWidgets.QLineEdit):
    """The line, with a warning icon on invalid input.

    Args:
        mm: initial value; 0 for no length.
    """

    def __init__(self, mm: float) -> None:
        super().__init__()
        sign = self.style().standardIcon(QtWidgets.QStyle.StandardPixmap.SP_MessageBoxCritical)
        self._sign = self.addAction(sign, QtWidgets.QLineEdit.ActionPosition.TrailingPosition)
        self._point = decimal_point()
        self.setPlaceholderText(translate("LengthField", "unknown"))
        self.show_length(mm)
        self.show_fault("")
        self.editingFinished.connect(self._tidy)

    def length(self) -> float | None:
        """The value, mm; 0 for no length, None if it is invalid. An unedited value is exact."""
        if self.text() == self._shown:
            return self._mm
        return parse_length(self.text(), self._point) if self.text().strip() else 0.0

    def show_fault(self, text: str) -> None:
        """Show a fault and its text; an empty text clears it."""
        self._sign.setVisible(bool(text))
        self._sign.setToolTip(text)

    def _tidy(self, *_: Any) -> None:
        """Show the parsed value with its unit."""
        mm = self.length()
        if mm is not None:
            self.show_length(mm)

    def show_length(self, mm: float) -> None:
        """Show a length from its first digit on; 0 for none."""
        self._mm, self._shown = mm, format_length(mm, self._point) if mm else ""
        self.setText(self._shown)
        self.setCursorPosition(0)
