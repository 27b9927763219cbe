# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry panel: where a mirrored or turned operation stands, how it is cut, and the report of its copies.

The object enters; its properties change with the fields, and it is computed anew a moment later. A plane or axis is
chosen, typed in, or picked in the 3D view. Accepting commits the transaction, rejecting aborts it: with a new object,
the object goes as well.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.symmetry_fields import Three, angles_of, quantity, text_of, told_angles
from pkm_post.freecad_gui.symmetry_frames import AXIS, PLANE
from pkm_post.freecad_gui.symmetry_text import report_lines

translate = FreeCAD.Qt.translate

_A_MOMENT = 300
"""ms after the last change until the copies are computed anew."""


class SymmetryPanel:
    """The task panel.

    Attributes:
        obj: the mirrored or turned operation.
        form: the widget, with the fields as attributes of the panel.
        opened: the panel that is open.
    """

    opened: ClassVar[SymmetryPanel | None] = None

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self.frame = PLANE if hasattr(obj, PLANE.direction) else AXIS
        if not obj.Document.HasPendingTransaction:  # a command leaves that of a new object open
            obj.Document.openTransaction(translate("SymmetryPanel", "Edit symmetric operation"))
        self.form = QtWidgets.QWidget()
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(obj.ViewObject.Proxy.getIcon()))
        self._fields = QtWidgets.QFormLayout(self.form)
        self._later = QtCore.QTimer(self.form, singleShot=True, interval=_A_MOMENT)
        self._later.timeout.connect(self.compute)
        self._add_frame()
        if self.frame is PLANE:
            self._add_climb()
        else:
            self._add_turns()
        self._add_side()
        self.report = QtWidgets.QLabel(wordWrap=True, textInteractionFlags=_SELECTABLE)
        self._fields.addRow(self.report)
        self.show()
        FreeCADGui.Selection.addObserver(self)
        SymmetryPanel.opened = self

    def _add_frame(self) -> None:
        choices = [translate("SymmetryPanel", text) for text, _ in self.frame.choices]
        picked, typed = translate("SymmetryPanel", "Picked"), translate("SymmetryPanel", "Typed in")
        self.choice = QtWidgets.QComboBox()
        self.choice.addItems([*choices, picked, typed])
        self.choice.currentIndexChanged.connect(self.choose)
        self.picked = QtWidgets.QLabel(wordWrap=True)
        self.direction, self.point = Three("", self.apply), Three("mm", self.apply)
        self._fields.addRow(translate("SymmetryPanel", self.frame.label), self.choice)
        self._fields.addRow(self.picked)
        self._fields.addRow(translate("SymmetryPanel", "Direction"), self.direction)
        self._fields.addRow(translate("SymmetryPanel", "Point"), self.point)

    def _add_climb(self) -> None:
        self.keep_climb = QtWidgets.QCheckBox(
            translate("SymmetryPanel", "Keep climb milling: run passes the other way")
        )
        self.keep_climb.setToolTip(self.obj.getDocumentationOfProperty("KeepClimb"))
        self.keep_climb.toggled.connect(self.apply)
        self._fields.addRow(self.keep_climb)

    def _add_turns(self) -> None:
        self.angle, self.copies = quantity("deg", self.apply), QtWidgets.QSpinBox(minimum=1, maximum=9999)
        self.copies.valueChanged.connect(self.apply)
        self.angles = QtWidgets.QLineEdit()
        self.angles.setPlaceholderText(translate("SymmetryPanel", "such as 90; 180; 270, in place of the two above"))
        self.angles.editingFinished.connect(self.apply)
        self._fields.addRow(translate("SymmetryPanel", "Angle"), self.angle)
        self._fields.addRow(translate("SymmetryPanel", "Copies"), self.copies)
        self._fields.addRow(translate("SymmetryPanel", "Angles"), self.angles)

    def _add_side(self) -> None:
        self.side = QtWidgets.QComboBox()
        self.side.addItems([text_of(name) for name in self.obj.getEnumerationsOfProperty("MaterialSide")])
        self.side.setToolTip(self.obj.getDocumentationOfProperty("MaterialSide"))
        self.side.currentIndexChanged.connect(self.apply)
        self._fields.addRow(translate("SymmetryPanel", "Material"), self.side)

    def show(self) -> None:
        """Show what the properties are, and the report."""
        obj, frame = self.obj, self.frame
        blockers = [QtCore.QSignalBlocker(field) for field in self.form.findChildren(QtWidgets.QWidget)]
        direction = tuple(getattr(obj, frame.direction))
        chosen = self._chosen(direction)
        self.choice.setCurrentIndex(chosen)
        self._show_frame()
        if frame is PLANE:
            self.keep_climb.setChecked(obj.KeepClimb)
        else:
            self.angle.setProperty("rawValue", obj.Angle.Value)
            self.copies.setValue(obj.Copies)
            self.angles.setText(told_angles(obj.Angles))
        self.side.setCurrentIndex(obj.getEnumerationsOfProperty("MaterialSide").index(obj.MaterialSide))
        self.report.setText("\n".join(report_lines(obj)))
        del blockers

    def _show_frame(self) -> None:
        """Show direction and point, what of them can be typed in, and what was picked."""
        chosen = self.choice.currentIndex()
        self._tell(self._told_pick())
        self.direction.show_values(getattr(self.obj, self.frame.direction), enabled=chosen == self._pick_index + 1)
        self.point.show_values(self.obj.Point, enabled=chosen != self._pick_index)

    def _chosen(self, direction: tuple[float, ...]) -> int:
        """Which choice is shown: who picks or types goes on with it, whatever the direction is."""
        if getattr(self.obj, self.frame.link):
            return self._pick_index
        if self.choice.currentIndex() >= self._pick_index:
            return int(self.choice.currentIndex())
        known: list[tuple[float, ...]] = [each for _, each in self.frame.choices]
        return known.index(direction) if direction in known else len(known) + 1

    def _tell(self, text: str) -> None:
        """Say what is picked, or what could be."""
        self.picked.setText(text)
        self.picked.setVisible(bool(text))

    def _told_pick(self) -> str:
        link = getattr(self.obj, self.frame.link)
        if link:
            return " ".join([link[0].Label, *link[1]]).strip()
        return translate("SymmetryPanel", self.frame.hint) if self.choice.currentIndex() == self._pick_index else ""

    @property
    def _pick_index(self) -> int:
        return len(self.frame.choices)

    def choose(self, index: int) -> None:
        """Take the plane or axis that is chosen, or wait for one to be picked."""
        if index != self._pick_index:
            setattr(self.obj, self.frame.link, None)
        if index < self._pick_index:
            setattr(self.obj, self.frame.direction, FreeCAD.Vector(*self.frame.choices[index][1]))
        self._show_frame()
        self._later.start()

    def addSelection(self, document: str, name: str, element: str, _point: Any) -> None:
        """Take what is picked in the 3D view or in the tree while the panel waits for it."""
        item = FreeCAD.getDocument(document).getObject(name)
        if self.choice.currentIndex() != self._pick_index or item.Document != self.obj.Document:
            return
        if self.obj == item or self.obj in item.OutListRecursive:
            self._tell(translate("SymmetryPanel", "It depends on this operation"))
            return
        link = (item, [element])
        try:
            self.frame.read(link)
        except ValueError as unfit:
            self._tell(str(unfit))
            return
        setattr(self.obj, self.frame.link, link)
        self._tell(self._told_pick())
        self._later.start()

    def apply(self, *_: Any) -> None:
        """Set the properties that differ from the fields."""
        sides = self.obj.getEnumerationsOfProperty("MaterialSide")
        values: dict[str, Any] = {"MaterialSide": sides[self.side.currentIndex()]}
        if self.direction.isEnabled() and self.direction.vector().Length > 0:
            values[self.frame.direction] = self.direction.vector()
        if self.point.isEnabled():
            values["Point"] = self.point.vector()
        if self.frame is PLANE:
            values["KeepClimb"] = self.keep_climb.isChecked()
        else:
            values |= {"Angle": FreeCAD.Units.Quantity(self.angle.property("rawValue"), FreeCAD.Units.Angle)}
            values |= {"Copies": self.copies.value(), "Angles": angles_of(self.angles.text(), list(self.obj.Angles))}
        for name, value in values.items():
            if getattr(self.obj, name) != value:
                setattr(self.obj, name, value)
                self._later.start()

    def compute(self) -> None:
        """Compute the copies anew, and show the report."""
        if self.obj.Document.Recomputing:  # its progress bar lets timers go on
            self._later.start()
            return
        self._later.stop()
        self.obj.Document.recompute()
        self.report.setText("\n".join(report_lines(self.obj)))
        if getattr(self.obj, self.frame.link):  # other fields may be being typed in
            self._show_frame()

    def accept(self) -> bool:
        """Keep everything, as one step of undo."""
        self.apply()
        self.obj.Document.recompute()
        self._close(self.obj.Document.commitTransaction)
        return True

    def reject(self) -> bool:
        """Leave everything as it was before."""
        self._close(self.obj.Document.abortTransaction)
        return True

    def _close(self, end: Callable[[], None]) -> None:
        self._later.stop()
        FreeCADGui.Selection.removeObserver(self)
        SymmetryPanel.opened = None
        document = self.obj.Document
        end()  # first: leaving the edit mode would commit
        FreeCADGui.getDocument(document.Name).resetEdit()
        document.recompute()


_SELECTABLE = QtCore.Qt.TextInteractionFlag.TextSelectableByMouse
