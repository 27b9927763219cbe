# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry fields: vectors, quantities and lists of angles as fields of the symmetry panel.

Values are in mm and degrees; the user types in the selected display units.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_SIDES = {
    "Not stated": QT_TRANSLATE_NOOP("SymmetryPanel", "As stated by the original"),
    "Left": QT_TRANSLATE_NOOP("SymmetryPanel", "Left of the original's path"),
    "Right": QT_TRANSLATE_NOOP("SymmetryPanel", "Right of the original's path"),
}
"""Displayed names of the choices of MaterialSide."""


def text_of(side: str) -> str:
    """The displayed name of a choice of MaterialSide."""
    return str(translate("SymmetryPanel", _SIDES[side]))


def property_tip(obj: Any, name: str) -> str:
    """The description of a property, as the tooltip of its field."""
    return str(translate("App::Property", obj.getDocumentationOfProperty(name)))


def quantity(unit: str, changed: Callable[..., None]) -> Any:
    """A field with a unit, or for a plain number; it reports edits."""
    field = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
    field.setProperty("unit", unit)
    field.shown = 0.0, ""
    field.editingFinished.connect(changed)
    return field


def show_value(field: Any, value: float) -> None:
    """Show a number in such a field, which may have fewer decimals."""
    field.setProperty("rawValue", value)
    field.shown = value, field.property("text")


def value_of(field: Any) -> float:
    """The number of a field: that shown, with all of its decimals, until the user types another."""
    value, text = field.shown
    return float(value if field.property("text") == text else field.property("rawValue"))


_LEAST = 86
"""px: least width of a vector field for most numbers; FreeCAD's own hint has room for many more digits."""


class Three(QtWidgets.QWidget):
    """Three fields for a vector."""

    def __init__(self, unit: str, changed: Callable[..., None]) -> None:
        super().__init__()
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self.fields = [quantity(unit, changed) for _ in range(3)]
        for field in self.fields:
            field.setMinimumWidth(_LEAST)
            layout.addWidget(field, 1)

    def show_values(self, values: Iterable[float], enabled: bool) -> None:
        """Show a vector, and whether it can be edited."""
        for field, value in zip(self.fields, values, strict=True):
            show_value(field, value)
        self.setEnabled(enabled)

    def vector(self) -> FreeCAD.Vector:
        """The displayed vector."""
        return FreeCAD.Vector(*map(value_of, self.fields))


def angles_of(text: str, before: Sequence[float]) -> list[float]:
    """Parse a typed list of angles in degrees, with or without units; returns the previous angles if it is invalid."""
    try:
        quantities = [FreeCAD.Units.Quantity(part) for part in text.split(";") if part.strip()]
    except (ValueError, ArithmeticError):
        return list(before)
    plain = FreeCAD.Units.Quantity("1").Unit
    if any(each.Unit not in (plain, FreeCAD.Units.Angle) for each in quantities):
        return list(before)
    return [each.Value for each in quantities]


def angles_text(angles: Sequence[float]) -> str:
    """Angles in degrees as an editable list."""
    return "; ".join(f"{angle:.10g}" for angle in angles)
