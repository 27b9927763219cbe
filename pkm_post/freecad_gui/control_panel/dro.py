# SPDX-License-Identifier: LGPL-2.1-or-later
"""DRO: the tool position in large digits, and the state of each strut.

Takes a state ten times a second, with a work offset. The large digits are coordinates in the work frame, the small ones
in the machine frame; lengths are in FreeCAD's display unit.
"""

from __future__ import annotations

import math

import FreeCAD
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.control.link import Status
from pkm_post.freecad_app.user_units import local
from pkm_post.freecad_gui.control_panel.buttons import side_by_side
from pkm_post.freecad_gui.control_panel.texts import strut_text
from pkm_post.freecad_gui.theme import theme
from pkm_post.geometry import Array
from pkm_post.toolpath import ToolPose

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_TITLES = (
    QT_TRANSLATE_NOOP("ControlPanel", "Length"),
    QT_TRANSLATE_NOOP("ControlPanel", "Following error"),
    QT_TRANSLATE_NOOP("ControlPanel", "Home"),
    QT_TRANSLATE_NOOP("ControlPanel", "State"),
)
_NOTHING, _BETWEEN = "-", 12
_FARTHEST, _AXIS = "-0000.000 mm", "I -0.000000  J 0.000000  K 0.000000"
"""The longest texts, for which room is reserved."""
_MM_DECIMALS = 3


class PositionDisplay(QtWidgets.QWidget):
    """Tip, axis and spin.

    Attributes:
        work_offset: names of the work offsets of the machine.
        in_work, in_machine: coordinates of the tip, by name.
        axis, tilt: of the tool in the work frame, with the axis in the machine frame as tooltip.
        spin: of the platform.
    """

    def __init__(self) -> None:
        super().__init__()
        self.work_offset = QtWidgets.QComboBox()
        self.work_offset.setToolTip(translate("ControlPanel", "Frame of the large digits, and of lines of G-code"))
        self.in_work, self.in_machine = (
            {name: _digits(_FARTHEST, large=True) for name in "XYZ"},
            {name: _digits(_FARTHEST) for name in "XYZ"},
        )
        self.axis, self.tilt, self.spin = _digits(_AXIS), _digits(), _digits()
        layout = QtWidgets.QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setColumnStretch(1, 1)
        layout.addWidget(self.work_offset, 0, 1)
        machine = QtWidgets.QLabel(translate("ControlPanel", "Machine"))
        layout.addWidget(machine, 0, 2, QtCore.Qt.AlignmentFlag.AlignRight)
        for row, name in enumerate("XYZ", start=1):
            for column, widget in enumerate((QtWidgets.QLabel(name), self.in_work[name], self.in_machine[name])):
                layout.addWidget(widget, row, column)
        layout.addWidget(QtWidgets.QLabel(translate("ControlPanel", "Axis")), 4, 0)
        layout.addWidget(self.axis, 4, 1, 1, 2)
        layout.addWidget(QtWidgets.QLabel(translate("ControlPanel", "Tilt")), 5, 0)
        turned = side_by_side(self.tilt, QtWidgets.QLabel(translate("ControlPanel", "Spin")), self.spin)
        turned.setSpacing(_BETWEEN)
        layout.addLayout(turned, 5, 1, 1, 2)
        layout.setVerticalSpacing(2)

    def refresh(self, pose: ToolPose | None, machine_from_work: Array) -> None:
        """Show a pose, or blanks for None."""
        if pose is None:
            for label in (*self.in_work.values(), *self.in_machine.values(), self.axis, self.tilt, self.spin):
                label.setText(_NOTHING)
            return
        turn, origin = machine_from_work[:3, :3], machine_from_work[:3, 3]
        for labels, tip in ((self.in_work, turn.T @ (pose.tip - origin)), (self.in_machine, pose.tip)):
            for label, value in zip(labels.values(), tip, strict=True):
                label.setText(length_text(float(value)))
        axis = turn.T @ pose.axis
        self.axis.setText(axis_text(axis))
        self.axis.setToolTip(translate("ControlPanel", "In the machine frame: {}").format(axis_text(pose.axis)))
        self.tilt.setText(angle_text(float(np.arctan2(np.hypot(axis[0], axis[1]), axis[2]))))
        self.spin.setText(angle_text(pose.spin))


class StrutTable(QtWidgets.QTableWidget):
    """Length, following error, home and state of the six struts."""

    def __init__(self) -> None:
        super().__init__(6, 4)
        self.setHorizontalHeaderLabels([translate("ControlPanel", title) for title in _TITLES])
        self.setVerticalHeaderLabels([str(number) for number in range(1, 7)])
        self.setEditTriggers(QtWidgets.QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.NoSelection)
        self.setTabKeyNavigation(False)
        self.horizontalHeader().setStretchLastSection(True)
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 4)
        for row in range(6):
            for column in range(4):
                self.setItem(row, column, QtWidgets.QTableWidgetItem(_NOTHING))
        self.setFixedHeight(6 * (self.fontMetrics().height() + 4) + self.horizontalHeader().sizeHint().height() + 4)

    def refresh(self, status: Status | None) -> None:
        """Show a state, or blanks for None."""
        red = QtGui.QBrush(QtGui.QColor(theme().bad))
        for row in range(6):
            texts = (_NOTHING,) * 4 if status is None else _strut_row(status, row)
            for column, text in enumerate(texts):
                self.item(row, column).setText(text)
            bad = status is not None and not status.homed[row]
            self.item(row, 2).setForeground(red if bad else QtGui.QBrush())
            self.item(row, 3).setForeground(red)


def length_text(millimetres: float) -> str:
    """A length in FreeCAD's unit for lengths of 100 mm, with micron resolution in any unit."""
    _, factor, unit = FreeCAD.Units.Quantity("100 mm").getUserPreferred()
    return f"{_fixed(millimetres / factor, _MM_DECIMALS + max(0, round(math.log10(factor))))} {unit}"


def angle_text(radians: float) -> str:
    """An angle in degrees."""
    return f"{_fixed(math.degrees(radians), 3)}°"


def axis_text(axis: Array) -> str:
    """The three components of an axis."""
    return "  ".join(f"{name} {_fixed(float(value), 6)}" for name, value in zip("IJK", axis, strict=True))


def _fixed(value: float, decimals: int) -> str:
    """A number with fixed decimals, and no minus sign on zero."""
    return local(f"{round(value, decimals) + 0.0:.{decimals}f}")


def _strut_row(status: Status, row: int) -> tuple[str, ...]:
    home = translate("ControlPanel", "yes") if status.homed[row] else translate("ControlPanel", "no")
    lengths = length_text(status.length[row]), length_text(status.following_error[row])
    return (*lengths, home, strut_text(status, row))


def _digits(room: str = "", large: bool = False) -> QtWidgets.QLabel:
    """A label for a changing number, with room for a text so that its neighbours stay in place."""
    label, font = QtWidgets.QLabel(_NOTHING), QtGui.QFontDatabase.systemFont(QtGui.QFontDatabase.SystemFont.FixedFont)
    if large:
        font.setPointSizeF(1.8 * font.pointSizeF())
        font.setBold(True)
    label.setFont(font)
    label.setMinimumWidth(label.fontMetrics().horizontalAdvance(room))
    label.setAlignment(QtCore.Qt.AlignmentFlag.AlignRight | QtCore.Qt.AlignmentFlag.AlignVCenter)
    label.setTextInteractionFlags(QtCore.Qt.TextInteractionFlag.TextSelectableByMouse)
    return label
