# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post fields: the posting options as fields of a panel: the field types, and the options by row."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.arguments import flags_in, parse_arguments, replace_arguments
from pkm_post.freecad_app.core_texts import finding_text
from pkm_post.machine import machine_named, presets
from pkm_post.model import Place, Refused, required
from pkm_post.options import FIXTURE_OF_THE_JOB, RULES_WITH_HEADING, SIDE_OUTPUTS, SPIN_WORDS

_DECIMALS = 6
_ROUNDING = 1e-9


def editable_box(items: Iterable[str]) -> QtWidgets.QComboBox:
    """An editable combo box."""
    box = QtWidgets.QComboBox()
    box.setEditable(True)
    box.setInsertPolicy(QtWidgets.QComboBox.InsertPolicy.NoInsert)
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.addItems(list(items))
    return box


def narrow_box() -> QtWidgets.QComboBox:
    """A combo box that may be narrower than its widest choice."""
    box = QtWidgets.QComboBox()
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    return box


def quantity_field(unit: str) -> Any:
    """A field for a FreeCAD quantity."""
    field = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
    field.setProperty("unit", unit)
    return field


def show_quantity(field: Any, value: float, unit: str) -> None:
    """Show a number in mm, degrees or mm/s with all of its decimals, at least the user's, as far as they go.

    The field's own unit is its display unit, which may differ from the given one.
    """
    quantity = FreeCAD.Units.Quantity(f"{value:.9g} {unit}")
    quantity.Format = {"Precision": _decimals(quantity)}
    show(field, quantity, value, unit)


def show(field: Any, quantity: Any, value: float, unit: str) -> None:
    """Show a quantity, whose number in the unit is known exactly, also in a field that cannot read its own text.

    Such a field, with 12°20′44″, keeps the number that it had before, so the number is typed first.
    """
    line = field.findChild(QtWidgets.QLineEdit)
    was_blocked = line.blockSignals(False)  # the field follows its line by these
    line.setText(f"{value:.17g} {unit}")
    line.blockSignals(was_blocked)
    field.setProperty("value", quantity)
    field.shown = value, field.property("text")


def value_of(field: Any) -> float:
    """The number of a field, in mm, degrees or mm/s: that shown, with all of its digits, until another is typed."""
    value, text = field.shown
    return float(value if field.property("text") == text else field.property("rawValue"))


def show_choice(field: Any, value: float, unit: str) -> None:
    """Show a free choice: its first digit in the user's unit."""
    quantity = FreeCAD.Units.Quantity(f"{value:.9g} {unit}")
    factor = quantity.getUserPreferred()[1]
    show_quantity(field, float(f"{quantity.Value / factor:.1g}") * factor, unit)


def _decimals(quantity: Any) -> int:
    """The fewest decimals that show a quantity exactly, in its display unit."""
    least = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units").GetInt("Decimals", 2)
    shown = quantity.Value / quantity.getUserPreferred()[1]
    exact = (count for count in range(least, _DECIMALS) if math.isclose(round(shown, count), shown, rel_tol=_ROUNDING))
    return next(exact, max(least, _DECIMALS))


def number_text(field: Any) -> str:
    """The number of a field in mm or degrees, whatever unit it displays."""
    return f"{value_of(field):.9g}"


def tab_through(fields: Sequence[QtWidgets.QWidget]) -> None:
    """Make Tab go from each field to the next; widgets between them follow the last one."""
    for field, following in pairwise(fields):
        QtWidgets.QWidget.setTabOrder(field, following)


def push_button(text: str, action: Callable[[], Any], tip: str = "") -> QtWidgets.QPushButton:
    """A button that Enter in a field does not press."""
    button = QtWidgets.QPushButton(text)
    button.setToolTip(tip)
    button.setAutoDefault(False)
    button.clicked.connect(lambda: action())
    return button


def with_button(field: QtWidgets.QWidget, action: Callable[[], None]) -> QtWidgets.QWidget:
    """A field followed by a button that asks for its value."""
    both, button = QtWidgets.QWidget(), QtWidgets.QToolButton()
    layout = QtWidgets.QHBoxLayout(both)
    layout.setContentsMargins(0, 0, 0, 0)
    button.setText("…")
    button.clicked.connect(lambda: action())
    layout.addWidget(field, 1)
    layout.addWidget(button)
    return both


def below_each_other(fields: Iterable[QtWidgets.QWidget]) -> QtWidgets.QWidget:
    """Several fields in a column."""
    whole = QtWidgets.QWidget()
    layout = QtWidgets.QVBoxLayout(whole)
    layout.setContentsMargins(0, 0, 0, 0)
    for field in fields:
        layout.addWidget(field)
    return whole


translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

FLAGS = ("--machine", "--work-offset", "--tip-tolerance", "--axis-tolerance", "--spin", "--also")
"""The arguments that have fields."""
_SPINS = {
    "zero": QT_TRANSLATE_NOOP("PostChoices", "Shortest rotation from upright"),
    "file": QT_TRANSLATE_NOOP("PostChoices", "As in the part program"),
    "x-in-plane": QT_TRANSLATE_NOOP("PostChoices", "x axis in a vertical plane"),
    "y-in-plane": QT_TRANSLATE_NOOP("PostChoices", "y axis in a vertical plane"),
    "optimise=stroke": QT_TRANSLATE_NOOP("PostChoices", "Most stroke left"),
    "optimise=joints": QT_TRANSLATE_NOOP("PostChoices", "Most swing of the joints left"),
    "optimise=singular": QT_TRANSLATE_NOOP("PostChoices", "Farthest from singular poses"),
    "optimise=weighted": QT_TRANSLATE_NOOP("PostChoices", "Most left of all three"),
}
_ALSO = {
    "csv": QT_TRANSLATE_NOOP("PostChoices", "Table of the strut motion (CSV)"),
    "halstreamer": QT_TRANSLATE_NOOP("PostChoices", "Table for LinuxCNC's halstreamer"),
    "linuxcnc": QT_TRANSLATE_NOOP("PostChoices", "G-code for LinuxCNC's hexapod, not certified"),
    "picture": QT_TRANSLATE_NOOP("PostChoices", "Picture of the report (PNG)"),
    "cartesian": QT_TRANSLATE_NOOP("PostChoices", "Program in X Y Z A B C"),
}


_ROWS = (
    ("machine", QT_TRANSLATE_NOOP("PostChoices", "Machine"), QT_TRANSLATE_NOOP("PostChoices", "A name, or a file")),
    (
        "work_offset",
        QT_TRANSLATE_NOOP("PostChoices", "Work offset"),
        QT_TRANSLATE_NOOP("PostChoices", "Name of a work offset of the machine, or X,Y,Z[,degrees about z] in mm"),
    ),
    (
        "tip_tolerance",
        QT_TRANSLATE_NOOP("PostChoices", "Tip tolerance"),
        QT_TRANSLATE_NOOP("PostChoices", "Largest deviation of the tool tip from the programmed path"),
    ),
    (
        "axis_tolerance",
        QT_TRANSLATE_NOOP("PostChoices", "Axis tolerance"),
        QT_TRANSLATE_NOOP("PostChoices", "Largest deviation of the tool axis from the programmed axis"),
    ),
    (
        "spin",
        QT_TRANSLATE_NOOP("PostChoices", "Spin"),
        QT_TRANSLATE_NOOP("PostChoices", "Rotation of the platform about the tool axis"),
    ),
    (
        "heading",
        QT_TRANSLATE_NOOP("PostChoices", "Heading"),
        QT_TRANSLATE_NOOP("PostChoices", "Direction of the platform's axis with the tool upright"),
    ),
    (
        "also_box",
        QT_TRANSLATE_NOOP("PostChoices", "Also write"),
        QT_TRANSLATE_NOOP("PostChoices", "Additional outputs"),
    ),
    (
        "more",
        QT_TRANSLATE_NOOP("PostChoices", "More arguments"),
        QT_TRANSLATE_NOOP(
            "PostChoices",
            "Arguments that have no field here, such as --surface-speed 120, or --tool-length 1=120 for a part program",
        ),
    ),
    (
        "folder",
        QT_TRANSLATE_NOOP("PostChoices", "Folder"),
        QT_TRANSLATE_NOOP("PostChoices", "Where the files are written"),
    ),
)
"""Attribute, label and tooltip of each field, from top to bottom."""
_BELOW_THEIR_LABELS = ("spin", "also_box")
"""Fields too wide to fit beside a label in a task panel of 380 pixels."""


class PostChoices(QtWidgets.QWidget):
    """The fields, one below the other."""

    changed = QtCore.Signal()
    """A text was typed, or is shown."""

    def __init__(self, text: str, folder: str) -> None:
        super().__init__()
        self.machine, self.work_offset = editable_box(presets()), editable_box(())
        self.tip_tolerance, self.axis_tolerance = quantity_field("mm"), quantity_field("deg")
        self.heading, self.spin = quantity_field("deg"), narrow_box()
        self.also = {name: QtWidgets.QCheckBox(translate("PostChoices", _ALSO[name])) for name in SIDE_OUTPUTS}
        self.also_box = below_each_other(self.also.values())
        self.more, self.folder = QtWidgets.QLineEdit(), QtWidgets.QLineEdit()
        for word in SPIN_WORDS:
            self.spin.addItem(translate("PostChoices", _SPINS[word]), word)
        self.machine.lineEdit().setPlaceholderText(translate("PostChoices", "the example machine, example_6tps"))
        self.work_offset.lineEdit().setPlaceholderText(translate("PostChoices", "the fixture of the job"))
        self.machine.currentTextChanged.connect(self._offer_work_offsets)
        self.spin.currentIndexChanged.connect(self._show_heading)
        self._lay_out()
        self.folder.setText(folder)
        self.show_text(text)
        for line in self.findChildren(QtWidgets.QLineEdit):
            line.textChanged.connect(lambda _text: self.changed.emit())

    def _lay_out(self) -> None:
        layout, askers = QtWidgets.QFormLayout(self), {"machine": self._ask_machine, "folder": self._ask_folder}
        for name, label, tip in _ROWS:
            field = getattr(self, name)
            field.setToolTip(translate("PostChoices", tip))
            row = with_button(field, askers[name]) if name in askers else field
            if name in _BELOW_THEIR_LABELS:
                layout.addRow(QtWidgets.QLabel(translate("PostChoices", label)))
                layout.addRow(row)
            else:
                layout.addRow(translate("PostChoices", label), row)

    def show_text(self, text: str) -> None:
        """Show arguments in the fields; invalid ones stay unchanged, in the line for all others."""
        try:
            chosen, rest = parse_arguments(text, Place("")), replace_arguments(text, dict.fromkeys(FLAGS))
        except Refused:
            chosen, rest = parse_arguments("", Place("")), text
        rule, heading, objective = chosen.spin
        self.machine.setEditText(chosen.machine)
        self._offer_work_offsets(chosen.machine)
        self.work_offset.setEditText(_offset_text(chosen.work_offset))
        show_quantity(self.tip_tolerance, chosen.tip_tolerance, "mm")
        show_quantity(self.axis_tolerance, chosen.axis_tolerance, "deg")
        show_quantity(self.heading, heading, "deg")
        self.spin.setCurrentIndex(self.spin.findData(f"{rule}={objective}" if rule == "optimise" else rule))
        for name, box in self.also.items():
            box.setChecked(name in chosen.also)
        self.more.setText(rest)
        self._show_heading()

    def text(self) -> str:
        """The arguments; one in the line for all others, such as beside a mistake, goes before its field."""
        spin = self.spin.currentData()
        chosen = {
            "--machine": self.machine.currentText().strip() or None,
            "--work-offset": self.work_offset.currentText().strip() or None,
            "--tip-tolerance": number_text(self.tip_tolerance),
            "--axis-tolerance": number_text(self.axis_tolerance),
            "--spin": f"{spin}={number_text(self.heading)}" if spin in RULES_WITH_HEADING else spin,
            "--also": ",".join(name for name, box in self.also.items() if box.isChecked()) or None,
        }
        try:
            typed = flags_in(self.more.text())
            return replace_arguments(self.more.text(), {flag: chosen[flag] for flag in chosen if flag not in typed})
        except ValueError:  # a quotation mark is not closed; the parser reports it
            unnamed = {flag: value for flag, value in chosen.items() if flag not in self.more.text()}
            return f"{replace_arguments('', unnamed)} {self.more.text()}".strip()

    def fault(self) -> str:
        """What is wrong with the arguments; machine files are not looked for: one may be beside a document."""
        try:
            chosen = parse_arguments(self.text(), Place(""))
            if not chosen.machine.endswith(".toml"):
                required(*machine_named(chosen.machine))
        except Refused as refused:
            return "\n".join(map(finding_text, refused.diagnostics))
        return ""

    def _offer_work_offsets(self, machine: str) -> None:
        """Offer the work offsets of the machine; the current input stays."""
        typed = self.work_offset.currentText()
        found, _ = machine_named(machine.strip())
        self.work_offset.clear()
        self.work_offset.addItems(["", *sorted(found.work_offsets)] if found else [""])
        self.work_offset.setEditText(typed)

    def _show_heading(self, *_changed: int) -> None:
        self.heading.setEnabled(self.spin.currentData() in RULES_WITH_HEADING)

    def _ask_machine(self) -> None:
        title, kinds = translate("PostChoices", "Machine file"), translate("PostChoices", "Machine files")
        name = QtWidgets.QFileDialog.getOpenFileName(self, title, "", f"{kinds} (*.toml)")[0]
        if name:
            self.machine.setEditText(name)

    def _ask_folder(self) -> None:
        title = translate("PostChoices", "Folder for the files")
        name = QtWidgets.QFileDialog.getExistingDirectory(self, title, self.folder.text())
        if name:
            self.folder.setText(str(Path(name)))


def _offset_text(offset: Any) -> str:
    if isinstance(offset, str):
        return "" if offset == FIXTURE_OF_THE_JOB else offset
    shown = offset if offset[3] else offset[:3]
    return ",".join(f"{number:.9g}" for number in shown)
