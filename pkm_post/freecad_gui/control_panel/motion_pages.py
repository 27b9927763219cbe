# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion pages: jogging the tool or one strut by a step, and homing.

Takes steps and speeds as quantities; a click plans a move of the console. Directions are in {M}.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import FreeCAD
from PySide import QtWidgets

from pkm_post.control.numerical_control import (
    SIMULATED_HOMING,
    CartesianJog,
    ControlState,
    Interlock,
    Jog,
    MovePlan,
    OperatorCommand,
    StrutJog,
    blocking_interlock,
    check_trigger,
)
from pkm_post.freecad_app.core_texts import exception_text
from pkm_post.freecad_gui.control_panel.buttons import OrderButton, refresh_all
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.texts import homing_text
from pkm_post.freecad_gui.post_fields import quantity_field, show_choice
from pkm_post.freecad_gui.preferences import GROUP
from pkm_post.options import LONGEST_JOG

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

_TOOL = (
    (QT_TRANSLATE_NOOP("ControlPanel", "X"), QT_TRANSLATE_NOOP("ControlPanel", "The tip along X of the machine")),
    (QT_TRANSLATE_NOOP("ControlPanel", "Y"), QT_TRANSLATE_NOOP("ControlPanel", "The tip along Y of the machine")),
    (QT_TRANSLATE_NOOP("ControlPanel", "Z"), QT_TRANSLATE_NOOP("ControlPanel", "The tip along Z of the machine")),
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Tilt X"),
        QT_TRANSLATE_NOOP("ControlPanel", "Tilt of the tool axis about X of the machine; the tip stays"),
    ),
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Tilt Y"),
        QT_TRANSLATE_NOOP("ControlPanel", "Tilt of the tool axis about Y of the machine; the tip stays"),
    ),
    (
        QT_TRANSLATE_NOOP("ControlPanel", "Spin"),
        QT_TRANSLATE_NOOP("ControlPanel", "Rotation of the platform about the tool axis; the tip stays"),
    ),
)
"""Label and tooltip of each of the six axes of a tool jog: three lengths, three angles."""
_LENGTHS = 3
_FIELDS = (
    ("step", QT_TRANSLATE_NOOP("ControlPanel", "Step"), 1.0, "mm", LONGEST_JOG),
    ("turn", QT_TRANSLATE_NOOP("ControlPanel", "Turn"), 1.0, "deg", 360.0),
    ("speed", QT_TRANSLATE_NOOP("ControlPanel", "Speed"), 5.0, "mm/s", math.inf),
)
"""Name, label, initial value, unit and most of each field; ``pmac jog`` has the same limits."""
_FIELD_WIDTH, _SPEED_WIDTH, _JOG_WIDTH = 92, 128, 36
"""Minimum, px: FreeCAD's own hints have room for many more digits."""
_TURNING_AT_FIRST, _TURNING_MOST = 2.0, 90.0


class JogPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        step, turn, speed, turning: step of lengths and of angles, speed of the tip and of rotations.
        strut: the number of the strut for single-strut jogs.
        buttons: by name and direction, such as ``("X", 1)`` and ``("strut", -1)``.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console = console
        self.step, self.turn, self.speed = (quantity_field(unit) for _, _, _, unit, _ in _FIELDS)
        self.turning, self.strut = QtWidgets.QDoubleSpinBox(), QtWidgets.QComboBox()
        self.turning.setRange(0.01, _TURNING_MOST)
        self.turning.setValue(_TURNING_AT_FIRST)
        self.turning.setSuffix(" °/s")
        self.strut.addItems([str(number) for number in range(1, 7)])
        self.buttons: dict[tuple[str, int], OrderButton] = {}
        for field in (self.step, self.turn, self.speed, self.turning):
            field.setMinimumWidth(_FIELD_WIDTH)
        self.speed.setMinimumWidth(_SPEED_WIDTH)
        layout, both = QtWidgets.QVBoxLayout(self), QtWidgets.QHBoxLayout()
        both.addLayout(self._fields(), 1)
        both.addLayout(self._grid(), 1)
        layout.addLayout(both)
        layout.addStretch(1)  # a higher page in the stack must not pull the rows apart

    def _fields(self) -> QtWidgets.QFormLayout:
        form = QtWidgets.QFormLayout()
        form.setRowWrapPolicy(QtWidgets.QFormLayout.RowWrapPolicy.WrapLongRows)
        for name, label, value, unit, most in _FIELDS:
            getattr(self, name).setProperty("minimum", 0.0)
            getattr(self, name).setProperty("maximum", most)
            show_choice(getattr(self, name), value, unit)
            form.addRow(translate("ControlPanel", label), getattr(self, name))
        form.addRow(translate("ControlPanel", "Turning"), self.turning)
        form.addRow(translate("ControlPanel", "Strut"), self.strut)
        return form

    def _grid(self) -> QtWidgets.QGridLayout:
        grid = QtWidgets.QGridLayout()
        for row, (label, tip) in enumerate(_TOOL):
            make = lambda sign, row=row: self._of_tool(row, sign)  # noqa: E731 - one for each row
            self._add_row(grid, row, label, translate("ControlPanel", label), translate("ControlPanel", tip), make)
        tip = translate("ControlPanel", "One strut alone; the platform moves with it")
        self._add_row(grid, len(_TOOL), "strut", translate("ControlPanel", "Strut"), tip, self._of_strut)
        grid.setVerticalSpacing(2)
        for column in (1, 2):
            grid.setColumnStretch(column, 1)  # buttons take the spare width, so each label stays beside its own
        return grid

    def _add_row(
        self, grid: QtWidgets.QGridLayout, row: int, name: str, label: str, tip: str, make: Callable[[int], Jog]
    ) -> None:
        grid.addWidget(QtWidgets.QLabel(label), row, 0)
        for column, (sign, text) in enumerate(((-1, "−"), (1, "+")), start=1):
            button = OrderButton(text, tip, OperatorCommand.JOG, lambda sign=sign: self._jog(make(sign), name))
            button.setStyleSheet(f"QPushButton {{ min-width: {_JOG_WIDTH}px; }}")
            self.buttons[name, sign] = button
            grid.addWidget(button, row, column)

    def refresh(self, _state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible."""
        refresh_all(self.buttons.values(), found)

    def _of_tool(self, row: int, sign: int) -> Jog:
        values = [0.0] * len(_TOOL)
        size = self.step.property("rawValue") if row < _LENGTHS else math.radians(self.turn.property("rawValue"))
        values[row] = sign * size
        return CartesianJog((values[0], values[1], values[2]), (values[3], values[4]), values[5])

    def _of_strut(self, sign: int) -> Jog:
        return StrutJog(int(self.strut.currentText()), sign * self.step.property("rawValue"))

    def _jog(self, jog: Jog, name: str) -> None:
        turns = isinstance(jog, CartesianJog) and not any(jog.shift)
        feed = self.turning.value() if turns else self.speed.property("rawValue")
        if feed <= 0.0:
            self._console.message.emit(translate("ControlPanel", "Not sent: the speed must be above zero"), True)
            return
        self._console.move(lambda control: control.plan_jog(jog, feed), self._planned)

    def _planned(self, plan: MovePlan | None) -> None:
        if plan is None:
            self._console.message.emit(translate("ControlPanel", "Not sent: the jog is refused"), True)


_ENTRY = "ControlHoming"


class HomingPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        trigger: the input line.
    """

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console, self._shown = console, False
        self.trigger, self.status = QtWidgets.QLineEdit(), QtWidgets.QLabel()
        self.trigger.setPlaceholderText("ENABLE PLC 3")
        self.status.setWordWrap(True)
        self.home = OrderButton(
            translate("ControlPanel", "Home"),
            translate("ControlPanel", "Start the homing of the machine, and watch it"),
            OperatorCommand.HOME,
            self._ask_and_home,
        )
        text = translate(
            "ControlPanel",
            "Line that starts the homing of this machine, as specified by its builder, such as ENABLE PLC 3",
        )
        label = QtWidgets.QLabel(text)
        label.setWordWrap(True)
        layout = QtWidgets.QVBoxLayout(self)
        for widget in (label, self.trigger, self.home, self.status):
            layout.addWidget(widget)
        layout.addStretch(1)

    def refresh(self, state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible, and show homing progress."""
        self.home.refresh(found)
        self.status.setText("" if state.homing is None else homing_text(state.homing))
        connection = self._console.connection
        if (connection is not None) != self._shown:
            self._shown = connection is not None
            if connection is not None:
                self.trigger.setText(
                    SIMULATED_HOMING if connection.simulated else FreeCAD.ParamGet(GROUP).GetString(_ENTRY, "")
                )

    def _ask_and_home(self) -> None:
        trigger, connection = self.trigger.text().strip(), self._console.connection
        try:
            check_trigger(trigger)
        except ValueError as fault:  # invalid user input
            self._console.message.emit(exception_text(fault), True)
            return
        if not self._is_sure(trigger) or blocking_interlock(OperatorCommand.HOME, self._console.found()) is not None:
            return  # the state may have changed while the dialog was open
        if connection is not None and not connection.simulated:
            FreeCAD.ParamGet(GROUP).SetString(_ENTRY, trigger)
        self._console.home(trigger)

    def _is_sure(self, trigger: str) -> bool:
        text = translate(
            "ControlPanel",
            "The machine moves by itself now, and Hold does not stop it: have the emergency stop at hand.\n"
            "Is the way of all struts, of the platform and of the tool free?",
        )
        buttons = QtWidgets.QMessageBox.StandardButton
        question = f"{text}\n\n{trigger}"
        title = translate("ControlPanel", "Home the machine")
        answer = QtWidgets.QMessageBox.question(self, title, question, buttons.Ok | buttons.Cancel, buttons.Cancel)
        return answer == buttons.Ok
