# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post fields: the field types for the posting options."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

_DECIMALS = 6


def editable_box(items: Iterable[str]) -> QtWidgets.QComboBox:
    """An editable combo box."""
    box = QtWidgets.QComboBox()
    box.setEditable(True)
    box.setInsertPolicy(QtWidgets.QComboBox.InsertPolicy.NoInsert)
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.addItems(list(items))
    return box


def quantity_field(unit: str) -> Any:
    """A field for a FreeCAD quantity."""
    field = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
    field.setProperty("unit", unit)
    return field


def show_quantity(field: Any, value: float, unit: str) -> None:
    """Show a number with decimals for thousandths at least: a field drops digits that it does not show.

    The field's own unit is its display unit, which may be another unit of its kind.
    """
    quantity = FreeCAD.Units.Quantity(f"{value:.9g} {unit}")
    quantity.Format = {"Precision": _DECIMALS}
    field.setProperty("value", quantity)


def number_text(field: Any) -> str:
    """The number of a field in mm or degrees, whatever unit it displays."""
    return f"{field.property('rawValue'):.9g}"


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
