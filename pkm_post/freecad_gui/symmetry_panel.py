# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry panel: reference and cut direction of a mirrored or rotated operation, and the report of its copies.

Takes the object; its properties follow the fields, with a recompute shortly after. A plane or axis is selected, typed
in, or picked in the 3D view. Accepting commits the transaction, rejecting aborts it, which also removes a new
object.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.post_fields import value_of
from pkm_post.freecad_gui.symmetry_fields import (
    angles_of,
    angles_text,
    property_tip,
    quantity,
    report_lines,
    show_value,
    text_of,
)
from pkm_post.freecad_gui.symmetry_placement import PLANE, SymmetryPlace

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

translate = FreeCAD.Qt.translate

_A_MOMENT = 300
"""ms from the last change to the recompute of the copies."""


class SymmetryPanel:
    """The task panel.

    Attributes:
        form: the widget, with the fields as attributes of the panel.
        place: the fields for the plane or the axis.
    """

    opened: ClassVar[SymmetryPanel | None] = None

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        if not obj.Document.HasPendingTransaction:  # a command leaves the transaction of a new object open
            self.begin()
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(obj.ViewObject.Proxy.getIcon()))
        self._fields = QtWidgets.QFormLayout(self.form)
        self._later = QtCore.QTimer(self.form, singleShot=True, interval=_A_MOMENT)
        self._later.timeout.connect(self.compute)
        self.place = SymmetryPlace(obj, self._fields, self.apply, self._later.start)
        if self.place.reference is PLANE:
            self._add_climb()
        else:
            self._add_turns()
        self._add_side()
        self.report = QtWidgets.QLabel(wordWrap=True, textInteractionFlags=_SELECTABLE)
        self._fields.addRow(self.report)
        self.show()
        FreeCADGui.Selection.addObserver(self)
        SymmetryPanel.opened = self

    def begin(self) -> None:
        """Begin an undo step."""
        self.obj.Document.openTransaction(translate("SymmetryPanel", "Edit symmetric operation"))

    def _add_climb(self) -> None:
        self.keep_climb = QtWidgets.QCheckBox(translate("SymmetryPanel", "Keep climb milling: reverse the passes"))
        self.keep_climb.setToolTip(property_tip(self.obj, "KeepClimb"))
        self.keep_climb.toggled.connect(self.apply)
        self._fields.addRow(self.keep_climb)

    def _add_turns(self) -> None:
        self.angle, self.copies = quantity("deg", self.apply), QtWidgets.QSpinBox(minimum=1, maximum=9999)
        self.copies.valueChanged.connect(self.apply)
        self.angles = QtWidgets.QLineEdit()
        self.angles.setPlaceholderText(translate("SymmetryPanel", "such as 90; 180; 270, in place of the two above"))
        self.angles.editingFinished.connect(self._take_angles)
        for name, field in (("Angle", self.angle), ("Copies", self.copies), ("Angles", self.angles)):
            field.setToolTip(property_tip(self.obj, name))
        self._fields.addRow(translate("SymmetryPanel", "Angle"), self.angle)
        self._fields.addRow(translate("SymmetryPanel", "Copies"), self.copies)
        self._fields.addRow(translate("SymmetryPanel", "Angles"), self.angles)

    def _add_side(self) -> None:
        self.side = QtWidgets.QComboBox()
        self.side.addItems([text_of(name) for name in self.obj.getEnumerationsOfProperty("MaterialSide")])
        self.side.setToolTip(property_tip(self.obj, "MaterialSide"))
        self.side.currentIndexChanged.connect(self.apply)
        self._fields.addRow(translate("SymmetryPanel", "Material"), self.side)

    def show(self) -> None:
        """Show the properties, and the report."""
        obj = self.obj
        blockers = [QtCore.QSignalBlocker(field) for field in self.form.findChildren(QtWidgets.QWidget)]
        self.place.show()
        if self.place.reference is PLANE:
            self.keep_climb.setChecked(obj.KeepClimb)
        else:
            show_value(self.angle, obj.Angle.Value)
            self.copies.setValue(obj.Copies)
            self.angles.setText(angles_text(obj.Angles))
        self.side.setCurrentIndex(obj.getEnumerationsOfProperty("MaterialSide").index(obj.MaterialSide))
        self.report.setText("\n".join(report_lines(obj)))
        del blockers

    def addSelection(self, document: str, name: str, element: str, _point: Any) -> None:
        """Take an element picked in the 3D view or in the tree while the panel waits for it."""
        self.place.pick(FreeCAD.getDocument(document).getObject(name), element)

    def apply(self, *_: Any) -> None:
        """Set the properties that differ from the fields."""
        sides = self.obj.getEnumerationsOfProperty("MaterialSide")
        values: dict[str, Any] = {"MaterialSide": sides[self.side.currentIndex()]}
        values |= self.place.values()
        if self.place.reference is PLANE:
            values["KeepClimb"] = self.keep_climb.isChecked()
        else:
            values |= {"Angle": FreeCAD.Units.Quantity(value_of(self.angle), FreeCAD.Units.Angle)}
            values |= {"Copies": self.copies.value(), "Angles": angles_of(self.angles.text(), list(self.obj.Angles))}
        for name, value in values.items():
            if getattr(self.obj, name) != value:
                setattr(self.obj, name, value)
                self._later.start()

    def _take_angles(self) -> None:
        """Take the typed angles, and show how they were understood."""
        self.apply()
        self.angles.setText(angles_text(self.obj.Angles))

    def compute(self) -> None:
        """Recompute the copies, and show the report."""
        if self.obj.Document.Recomputing:  # timers fire even during its progress bar
            self._later.start()
            return
        self._later.stop()
        self.obj.Document.recompute()
        self.report.setText("\n".join(report_lines(self.obj)))
        self.place.follow()

    def accept(self) -> bool:
        """Keep everything, as one undo step."""
        self.apply()
        self.obj.Document.recompute()
        self._close(self.obj.Document.commitTransaction)
        return True

    def reject(self) -> bool:
        """Restore the previous state."""
        self._close(self.obj.Document.abortTransaction)
        return True

    def release(self) -> None:
        """Stop recomputing, and ignore picks."""
        self._later.stop()
        if SymmetryPanel.opened is self:
            FreeCADGui.Selection.removeObserver(self)
            SymmetryPanel.opened = None

    def _close(self, end: Callable[[], None]) -> None:
        self.release()
        document = self.obj.Document
        end()  # first: leaving the edit mode would commit
        FreeCADGui.getDocument(document.Name).resetEdit()
        document.recompute()


_SELECTABLE = QtCore.Qt.TextInteractionFlag.TextSelectableByMouse
