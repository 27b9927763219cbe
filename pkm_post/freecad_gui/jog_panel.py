# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jog panel: jogs the machine of a document, and shows at once whether the pose is in reach.

Takes a machine object; changes its tip, tool axis and spin, by typed values or by steps. The pose is in the work frame.
Accepting keeps it as one undo step, cancelling reverts it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np
from PySide import QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import shown
from pkm_post.freecad_app.machine_object import go_home, machine_of, pose_of, violated_limits
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.observers import ChangeWatch
from pkm_post.freecad_gui.post_fields import push_button, quantity_field, show_choice, show_quantity, tab_through
from pkm_post.freecad_gui.verdict import Verdict
from pkm_post.geometry import Array

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

AXES = (
    (QT_TRANSLATE_NOOP("JogPanel", "X"), "mm"),
    (QT_TRANSLATE_NOOP("JogPanel", "Y"), "mm"),
    (QT_TRANSLATE_NOOP("JogPanel", "Z"), "mm"),
    (QT_TRANSLATE_NOOP("JogPanel", "Tilt about X"), "deg"),
    (QT_TRANSLATE_NOOP("JogPanel", "Tilt about Y"), "deg"),
    (QT_TRANSLATE_NOOP("JogPanel", "Spin"), "deg"),
)
"""Label and unit of each axis: translation of the tip, tilt of the tool axis about the tip, spin."""
_STEPS = {"mm": 10.0, "deg": 5.0}
"""Initial steps."""
_MOST_TILT = 89.0
_SHOWN = ("Tip", "ToolAxis", "Spin", "OutOfLimits", "Strut1")
"""Properties that others change as well, as in the property view; a recompute ends with the last ones."""
NAME = "PkmJogPanel"
_NARROW = "QPushButton { min-width: 36px; }"
"""FreeCAD's themes make buttons too wide for two beside a field in a task panel of 380 pixels."""


class JogPanel:
    """The task panel.

    Attributes:
        verdict: whether the pose is in reach.
        fields: the value of each of ``AXES``.
        buttons: two for each: back and forth.
        steps: fields of the steps, by unit.
        home: moves to the home pose.
    """

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self.begin()
        self.form = QtWidgets.QWidget()
        self.form.setObjectName(NAME)
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(str(ICONS / "machine.svg")))
        self.verdict, self.margins = Verdict(), QtWidgets.QLabel()
        self.margins.setWordWrap(True)
        self.fields = [quantity_field(unit) for _, unit in AXES]
        self.steps = {unit: quantity_field(unit) for unit in _STEPS}
        self.buttons = [
            tuple(push_button(text, partial(self.step, row, sign)) for text, sign in _WAYS) for row in range(6)
        ]
        for button in itertools.chain.from_iterable(self.buttons):
            button.setStyleSheet(_NARROW)
        self.home = push_button(translate("JogPanel", "Home"), self.go_home)
        self._lay_out()
        for unit, step in _STEPS.items():
            show_choice(self.steps[unit], step, unit)
        for field in self.fields:
            field.editingFinished.connect(self.take)
        self.show()
        self._watch: ChangeWatch | None = ChangeWatch(self.show, obj.Document.Name, _SHOWN)

    def begin(self) -> None:
        """Begin an undo step."""
        self.obj.Document.openTransaction(translate("JogPanel", "Jog the machine"))

    def _lay_out(self) -> None:
        layout, grid = QtWidgets.QVBoxLayout(self.form), QtWidgets.QGridLayout()
        for row, ((label, _), field, (back, forth)) in enumerate(zip(AXES, self.fields, self.buttons, strict=True)):
            for column, part in enumerate((QtWidgets.QLabel(translate("JogPanel", label)), back, field, forth)):
                grid.addWidget(part, row, column)
        grid.setColumnStretch(2, 1)
        texts = {"mm": translate("JogPanel", "Step"), "deg": translate("JogPanel", "Turn by")}
        for row, (unit, field) in enumerate(self.steps.items(), len(AXES)):
            grid.addWidget(QtWidgets.QLabel(texts[unit]), row, 0)
            grid.addWidget(field, row, 2)
        layout.addWidget(self.verdict)
        layout.addLayout(grid)
        layout.addWidget(self.home)
        layout.addWidget(self.margins)
        layout.addStretch()
        tab_through([*self.fields, *self.steps.values()])

    def values(self) -> Array:
        """The pose in the order of ``AXES``, in mm and degrees."""
        return np.array([*self.obj.Tip, *tilts_of(np.array(self.obj.ToolAxis)), self.obj.Spin.Value])

    def move_to(self, values: Array) -> None:
        """Move to a pose in the order of ``AXES``; recompute only the machine, and its job on acceptance."""
        obj = self.obj
        obj.Tip = FreeCAD.Vector(*values[:3].tolist())
        obj.ToolAxis = FreeCAD.Vector(*axis_of_tilts(*np.clip(values[3:5], -_MOST_TILT, _MOST_TILT)).tolist())
        obj.Spin = float(values[5])
        obj.recompute()
        self.show()

    def step(self, row: int, sign: float) -> None:
        """Move along one of ``AXES`` by its step, with a sign."""
        values = self.values()
        values[row] += sign * float(self.steps[AXES[row][1]].property("rawValue"))
        self.move_to(values)

    def take(self) -> None:
        """Move to the typed values; an unedited value keeps the digits that its field hides."""
        typed = np.array([float(field.property("rawValue")) for field in self.fields])
        before = self.values()
        changed = np.abs(typed - self._shown) > 0.0
        if changed.any():
            self.move_to(np.where(changed, typed, before))

    def go_home(self) -> None:
        """Move to the home pose of the machine."""
        go_home(self.obj, machine_of(self.obj))
        self.obj.recompute()
        self.show()

    def show(self) -> None:
        """Show the pose, and the verdict of the machine on it."""
        for field, (_, unit), value in zip(self.fields, AXES, self.values(), strict=True):
            field.blockSignals(True)
            show_quantity(field, round(float(value), 6) + 0.0, unit)
            field.blockSignals(False)
        self._shown = np.array([float(field.property("rawValue")) for field in self.fields])
        obj = self.obj
        if not obj.isValid():
            self.verdict.say(obj.getStatusString(), False)
        elif obj.OutOfLimits:
            limits = [shown(each) for each in violated_limits(machine_of(obj), pose_of(obj))]
            self.verdict.say("\n".join([translate("JogPanel", "The machine cannot reach this pose"), *limits]), False)
        else:
            self.verdict.say(translate("JogPanel", "The machine can reach this pose"), True)
        left = translate("JogPanel", "Left: {} of a stroke, {} of a joint. Struts: {}")
        struts = ", ".join(amount_text(getattr(obj, f"Strut{number}").Value, "mm") for number in range(1, 7))
        stroke, joint = amount_text(obj.StrokeMargin.Value, "mm"), amount_text(obj.JointMargin.Value, "deg")
        self.margins.setText(left.format(stroke, joint, struts))

    def accept(self) -> bool:
        """Keep the pose, and recompute the objects that depend on the machine."""
        self._close(self.obj.Document.commitTransaction)
        return True

    def reject(self) -> bool:
        """Restore the previous pose."""
        self._close(self.obj.Document.abortTransaction)
        return True

    def release(self) -> None:
        """Stop following the machine."""
        if self._watch is not None:
            self._watch.end()
            self._watch = None

    def _close(self, end: Callable[[], None]) -> None:
        document = self.obj.Document
        end()  # first: leaving the edit mode would commit
        FreeCADGui.getDocument(document.Name).resetEdit()
        document.recompute()


_WAYS = (("−", -1.0), ("+", 1.0))


def axis_of_tilts(about_x: float, about_y: float) -> Array:
    """The axis, (3,), of an upright tool after rotations about x, then about y; degrees."""
    x, y = math.radians(about_x), math.radians(about_y)
    return np.array([math.cos(x) * math.sin(y), -math.sin(x), math.cos(x) * math.cos(y)])


def tilts_of(axis: Array) -> tuple[float, float]:
    """The rotations about x, then about y, in degrees, from an upright tool to an axis of any length, (3,)."""
    x, y, z = axis / np.linalg.norm(axis)
    return math.degrees(math.asin(max(-1.0, min(1.0, -y)))), math.degrees(math.atan2(x, z))
