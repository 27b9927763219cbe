# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry fields: fields of the symmetry panel, and the report of an operation in sentences.

Values are in mm and degrees; the user types and reads in the selected display units.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

from pkm_post.freecad_app.symmetry_report import Family, family_of
from pkm_post.freecad_app.user_units import decimal_point, local
from pkm_post.freecad_gui.post_fields import show, value_of
from pkm_post.freecad_gui.quantities import angle_text, length_text

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
    field.typed_in, field.shown = unit, (0.0, "")
    field.editingFinished.connect(changed)
    return field


def show_value(field: Any, value: float) -> None:
    """Show a number in such a field, which may have fewer decimals."""
    show(field, FreeCAD.Units.Quantity(f"{value:.17g} {field.typed_in}"), value, field.typed_in)


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
    if text == angles_text(before):
        return list(before)  # with the digits that the text hides
    text = text.replace(decimal_point(), ".")
    if "," in text:  # FreeCAD reads 90,180 as 90.18
        return list(before)
    try:
        quantities = [FreeCAD.Units.Quantity(part) for part in text.split(";") if part.strip()]
    except (ValueError, ArithmeticError):
        return list(before)
    plain = FreeCAD.Units.Quantity("1").Unit
    if any(each.Unit not in (plain, FreeCAD.Units.Angle) or not math.isfinite(each.Value) for each in quantities):
        return list(before)
    return [each.Value for each in quantities]


def angles_text(angles: Sequence[float]) -> str:
    """Angles in degrees as an editable list."""
    return "; ".join(local(f"{angle:.10g}") for angle in angles)


_CUTS = {
    "Climb": QT_TRANSLATE_NOOP("SymmetryPanel", "climb milling"),
    "Conventional": QT_TRANSLATE_NOOP("SymmetryPanel", "conventional milling"),
    "Both": QT_TRANSLATE_NOOP("SymmetryPanel", "climb and conventional milling"),
    "Unknown": QT_TRANSLATE_NOOP("SymmetryPanel", "not known"),
}


def report_lines(obj: Any) -> list[str]:
    """The report lines of the copies: how they cut, where they are, how they meet.

    Args:
        obj: the operation, computed.
    """
    if not obj.isValid():
        return [obj.getStatusString()]
    if obj.Base is None or not obj.Active:
        return [translate("SymmetryPanel", "Nothing is copied")]
    own = _mirror(obj) if hasattr(obj, "Normal") else _turns(obj)
    joints = _joints(obj.Joints, obj.JointDistance.Value, obj.JointTurn.Value)
    return [*_cuts(obj), *own, *joints, *_family(obj, family_of(obj))]


def _cuts(obj: Any) -> list[str]:
    if obj.CutOfBase == "Unknown":
        return [translate("SymmetryPanel", "Climb or conventional is unknown: state the side of the material")]
    texts = translate("SymmetryPanel", "Original: {}"), translate("SymmetryPanel", "Copies: {}")
    cuts = obj.CutOfBase, obj.CutOfCopies
    return [text.format(translate("SymmetryPanel", _CUTS[cut])) for text, cut in zip(texts, cuts, strict=True)]


def _mirror(obj: Any) -> list[str]:
    lines = []
    if obj.ReversedPasses:
        text = translate("SymmetryPanel", "Reversed passes: {}")
        lines.append(text.format(obj.ReversedPasses))
    if obj.SwappedArcs:
        lines.append(translate("SymmetryPanel", "Arcs with reversed sense: {}").format(obj.SwappedArcs))
    if obj.GapToBase.Value:
        text = translate("SymmetryPanel", "Between original and copy: {}")
        lines.append(text.format(length_text(obj.GapToBase.Value)))
    if obj.OverlapWithBase.Value:
        text = translate("SymmetryPanel", "Both cut over a width of {}")
        lines.append(text.format(length_text(obj.OverlapWithBase.Value)))
    return lines


def _turns(obj: Any) -> list[str]:
    text = translate("SymmetryPanel", "Original and copies: {}")
    return [text.format(_covered(obj.Covered.Value, obj.Overlap.Value, obj.Gap.Value, obj.Tiles))]


def _covered(covered: float, overlap: float, gap: float, tiles: bool) -> str:
    """Angles in degrees, in a sentence."""
    if tiles:
        return str(translate("SymmetryPanel", "full circle, no overlap"))
    text = translate("SymmetryPanel", "{} covered, {} covered twice, widest gap {}")
    return str(text.format(*map(angle_text, (covered, overlap, gap))))


def _joints(count: int, distance: float, turn: float) -> list[str]:
    if not count:
        return [
            translate("SymmetryPanel", "No path of one ends where a path of another begins: the tool is lifted between"
                      " them. For one continuous path, end the passes of the original at the plane or at the edges of"
                      " its sector.")
        ]  # fmt: skip
    text = translate("SymmetryPanel", "Where they meet ({}): tips {} apart, tool axes by {}")
    return [text.format(count, length_text(distance), angle_text(turn))]


def _family(obj: Any, family: Family) -> list[str]:
    """The job as a whole, if the original has more copies than these and they lie around an axis."""
    own = 1 + (len(obj.Angles) or obj.Copies if hasattr(obj, "Angles") else 1)
    if family.coverage is None or family.members == own:
        return []
    found = family.coverage
    covered, overlap, gap = (math.degrees(each) for each in (found.covered, found.overlap, found.gap))
    coverage = _covered(covered, overlap, gap, found.tiles)
    text = translate("SymmetryPanel", "{} with all its copies in the job, {} in number: {}")
    lines = [text.format(family.label, family.members, coverage)]
    if family.joints:
        distance = max(each.distance for each in family.joints)
        turn = math.degrees(max(each.turn for each in family.joints))
        lines += _joints(len(family.joints), distance, turn)
    return lines
