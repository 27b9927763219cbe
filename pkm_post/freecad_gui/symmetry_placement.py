# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry placement: the fields for the plane of a mirror or the axis of a rotation.

Takes the object; its point, direction and picked element follow the fields. The plane or axis is one of the document's,
picked in the 3D view, or typed in.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import FreeCAD
from PySide import QtWidgets

from pkm_post.freecad_app.frames import axis_of, plane_of
from pkm_post.freecad_gui.symmetry_fields import Three, property_tip

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP


@dataclass(frozen=True)
class SymmetryReference:
    """The reference of a mirror or a rotation.

    Attributes:
        direction: property with the normal or the axis.
        link: property with the picked element.
        read: returns point and direction of the picked element.
        label: of the choice.
        choices: texts and directions.
        hint: pickable elements.
    """

    direction: str
    link: str
    read: Callable[[Any], Any]
    label: str
    choices: tuple[tuple[str, tuple[float, float, float]], ...]
    hint: str


PLANE = SymmetryReference(
    "Normal",
    "Plane",
    plane_of,
    QT_TRANSLATE_NOOP("SymmetryPanel", "Plane"),
    (
        (QT_TRANSLATE_NOOP("SymmetryPanel", "XY"), (0.0, 0.0, 1.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "XZ"), (0.0, 1.0, 0.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "YZ"), (1.0, 0.0, 0.0)),
    ),
    QT_TRANSLATE_NOOP("SymmetryPanel", "Pick a flat face or a datum plane"),
)
AXIS = SymmetryReference(
    "Axis",
    "Line",
    axis_of,
    QT_TRANSLATE_NOOP("SymmetryPanel", "Axis"),
    (
        (QT_TRANSLATE_NOOP("SymmetryPanel", "X"), (1.0, 0.0, 0.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "Y"), (0.0, 1.0, 0.0)),
        (QT_TRANSLATE_NOOP("SymmetryPanel", "Z"), (0.0, 0.0, 1.0)),
    ),
    QT_TRANSLATE_NOOP("SymmetryPanel", "Pick an edge, a round face or a datum line"),
)


translate = FreeCAD.Qt.translate


class SymmetryPlace:
    """Rows of a form.

    Attributes:
        reference: a plane or an axis.
    """

    def __init__(
        self, obj: Any, form: QtWidgets.QFormLayout, typed: Callable[..., None], chosen: Callable[[], None]
    ) -> None:
        """Add the rows.

        Args:
            form: gets the rows.
            typed: called after typed input.
            chosen: called when the object has another plane or axis.
        """
        self._obj, self._changed = obj, chosen
        self.reference = PLANE if hasattr(obj, PLANE.direction) else AXIS
        self._pick_index = len(self.reference.choices)
        self.choice, self.picked = QtWidgets.QComboBox(), QtWidgets.QLabel(wordWrap=True)
        self.direction, self.point = Three("", typed), Three("mm", typed)
        picked, by_hand = translate("SymmetryPanel", "Picked"), translate("SymmetryPanel", "Typed in")
        self.choice.addItems(
            [*(translate("SymmetryPanel", text) for text, _ in self.reference.choices), picked, by_hand]
        )
        self.choice.currentIndexChanged.connect(self.choose)
        tips = ((self.reference.link, self.choice), (self.reference.direction, self.direction), ("Point", self.point))
        for name, field in tips:
            field.setToolTip(property_tip(obj, name))
        form.addRow(translate("SymmetryPanel", self.reference.label), self.choice)
        form.addRow(self.picked)
        form.addRow(translate("SymmetryPanel", "Direction"), self.direction)
        form.addRow(translate("SymmetryPanel", "Point"), self.point)

    def show(self) -> None:
        """Show the properties."""
        self.choice.setCurrentIndex(self._chosen())
        self._show_values()

    def follow(self) -> None:
        """Show the result of a pick; other fields may be in use."""
        if self._link():
            self._show_values()

    def values(self) -> dict[str, Any]:
        """The properties edited here."""
        values = {}
        if self.direction.isEnabled() and self.direction.vector().Length > 0:
            values[self.reference.direction] = self.direction.vector()
        if self.point.isEnabled():
            values["Point"] = self.point.vector()
        return values

    def choose(self, index: int) -> None:
        """Take the selected plane or axis, or wait for a pick."""
        if index != self._pick_index:
            setattr(self._obj, self.reference.link, None)
        if index < self._pick_index:
            setattr(self._obj, self.reference.direction, FreeCAD.Vector(*self.reference.choices[index][1]))
        self._show_values()
        self._changed()

    def pick(self, item: Any, element: str) -> None:
        """Take the picked element, if one is awaited."""
        if self.choice.currentIndex() != self._pick_index or item.Document != self._obj.Document:
            return
        if self._obj == item or self._obj in item.OutListRecursive:
            self._show_status(translate("SymmetryPanel", "It depends on this operation"))
            return
        link = (item, [element])
        try:
            self.reference.read(link)
        except ValueError as unfit:
            self._show_status(str(unfit))
            return
        setattr(self._obj, self.reference.link, link)
        self._show_status(self._pick_text())
        self._changed()

    def _link(self) -> Any:
        return getattr(self._obj, self.reference.link)

    def _chosen(self) -> int:
        """The displayed choice: a picked or typed reference stays that choice, whatever its direction."""
        if self._link():
            return self._pick_index
        if self.choice.currentIndex() >= self._pick_index:
            return int(self.choice.currentIndex())
        direction = tuple(getattr(self._obj, self.reference.direction))
        known: list[tuple[float, ...]] = [each for _, each in self.reference.choices]
        return known.index(direction) if direction in known else len(known) + 1

    def _show_values(self) -> None:
        """Show direction and point, which of them are editable, and the picked element."""
        chosen = self.choice.currentIndex()
        self._show_status(self._pick_text())
        self.direction.show_values(getattr(self._obj, self.reference.direction), enabled=chosen == self._pick_index + 1)
        self.point.show_values(self._obj.Point, enabled=chosen != self._pick_index)

    def _show_status(self, text: str) -> None:
        """Show the picked element, or a hint on pickable ones."""
        self.picked.setText(text)
        self.picked.setVisible(bool(text))

    def _pick_text(self) -> str:
        link = self._link()
        if link:
            return " ".join([link[0].Label, *link[1]]).strip()
        return translate("SymmetryPanel", self.reference.hint) if self.choice.currentIndex() == self._pick_index else ""
