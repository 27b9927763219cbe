# SPDX-License-Identifier: LGPL-2.1-or-later
"""MDI page: typed lines of G-code, with a history.

Takes a line; shows its end point and duration, and executes it on request.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.control.numerical_control import (
    ControlState,
    Interlock,
    MdiSettings,
    MovePlan,
    OperatorCommand,
    blocking_interlock,
)
from pkm_post.freecad_gui.control_panel.buttons import OrderButton, refresh_all, side_by_side
from pkm_post.freecad_gui.control_panel.console import Console
from pkm_post.freecad_gui.control_panel.dro import angle_text, length_text
from pkm_post.freecad_gui.post_fields import narrow_box
from pkm_post.freecad_gui.quantities import seconds_text
from pkm_post.reading import AXIS_WORDS

translate = FreeCAD.Qt.translate

_KEPT = 100


class HistoryLine(QtWidgets.QLineEdit):
    """A line; the up and down keys recall earlier input.

    Attributes:
        history: earlier input, the newest last.
    """

    def __init__(self) -> None:
        super().__init__()
        self.history: list[str] = []
        self._place = 0

    def remember(self, text: str) -> None:
        """Add a line to the history."""
        self.history = [*(each for each in self.history if each != text), text][-_KEPT:]
        self._place = len(self.history)

    def keyPressEvent(self, event: Any) -> None:
        """Called by Qt."""
        steps = {QtCore.Qt.Key.Key_Up: -1, QtCore.Qt.Key.Key_Down: 1}
        step = next((step for key, step in steps.items() if event.key() == key), 0)
        if not step:
            super().keyPressEvent(event)
            return
        self._place = min(max(self._place + step, 0), len(self.history))
        self.setText(self.history[self._place] if self._place < len(self.history) else "")


class MdiPage(QtWidgets.QWidget):
    """The page.

    Attributes:
        axis_words: form of the tool axis in the input.
        outcome: end point of the line.
    """

    def __init__(self, console: Console, work_offset: QtWidgets.QComboBox) -> None:
        super().__init__()
        self._console, self._work_offset = console, work_offset
        self.line, self.axis_words, self.outcome = HistoryLine(), narrow_box(), QtWidgets.QLabel()
        self.line.setPlaceholderText("G1 X10 F300")
        self.line.returnPressed.connect(self._enter)
        self.axis_words.addItems(list(AXIS_WORDS))
        self.axis_words.setCurrentText("none")
        self.axis_words.setToolTip(translate("ControlPanel", "Tool axis words of the line; none keeps the axis"))
        self.outcome.setWordWrap(True)
        self.check = OrderButton(
            translate("ControlPanel", "Check"),
            translate("ControlPanel", "Plan the line, and send nothing"),
            OperatorCommand.LINE,
            lambda: self._plan(sends=False),
        )
        self.run = OrderButton(
            translate("ControlPanel", "Run"),
            translate("ControlPanel", "Plan the line and, if it passes all checks, execute it"),
            OperatorCommand.LINE,
            lambda: self._plan(sends=True),
        )
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self.line)
        layout.addLayout(side_by_side(self.axis_words, self.check, self.run))
        layout.addWidget(self.outcome)
        layout.addStretch(1)

    def refresh(self, _state: ControlState, found: frozenset[Interlock]) -> None:
        """Enable what is possible."""
        refresh_all((self.check, self.run), found)

    def _enter(self) -> None:
        if blocking_interlock(OperatorCommand.LINE, self._console.found()) is None:
            self._plan(sends=True)

    def _plan(self, sends: bool) -> None:
        line = " ".join(self.line.text().split())  # pasted text may contain several lines
        if not line:
            return
        self.line.remember(line)
        self.outcome.setText("")
        reading = MdiSettings(self._work_offset.currentText(), self.axis_words.currentText())
        self._console.move(lambda control: control.plan_line(line, reading), self._planned, sends)

    def _planned(self, plan: MovePlan | None) -> None:
        if plan is None:
            self.outcome.setText(translate("ControlPanel", "Refused; nothing was sent"))
            return
        tip = ", ".join(f"{name} {length_text(float(value))}" for name, value in zip("XYZ", plan.end.tip, strict=True))
        axis = " ".join(f"{name}{value:z.5f}" for name, value in zip("IJK", plan.end.axis, strict=True))
        text = translate("ControlPanel", "To {}, axis {}, spin {} in the machine frame; {}")
        self.outcome.setText(text.format(tip, axis, angle_text(plan.end.spin), seconds_text(plan.seconds)))
