# SPDX-License-Identifier: LGPL-2.1-or-later
"""Buttons: buttons for orders, which also state why an order is not possible."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from PySide import QtWidgets

from pkm_post.control.numerical_control import Interlock, OperatorCommand, blocking_interlock
from pkm_post.freecad_gui.control_panel.texts import why_text


class OrderButton(QtWidgets.QPushButton):
    """A button for an order; where the order is not possible it is disabled, and its tooltip states why."""

    def __init__(self, text: str, tip: str, order: OperatorCommand, action: Callable[[], Any]) -> None:
        super().__init__(text)
        self._tip, self._order = tip, order
        self._why: Interlock | None = None
        self.setToolTip(tip)
        self.setAutoDefault(False)
        self.clicked.connect(lambda: action())

    def refresh(self, found: frozenset[Interlock]) -> None:
        """Enable or disable the button."""
        why = blocking_interlock(self._order, found)
        self.setEnabled(why is None)
        if why is not self._why:
            self._why = why
            self.setToolTip(self._tip if why is None else f"{self._tip}\n({why_text(why)})")


def refresh_all(buttons: Iterable[OrderButton], found: frozenset[Interlock]) -> None:
    """Enable or disable several buttons."""
    for button in buttons:
        button.refresh(found)


def plain_button(text: str, tip: str, action: Callable[[], Any]) -> QtWidgets.QPushButton:
    """A button without an order to the machine."""
    button = QtWidgets.QPushButton(text)
    button.setToolTip(tip)
    button.setAutoDefault(False)
    button.clicked.connect(lambda: action())
    return button


def side_by_side(*widgets: QtWidgets.QWidget) -> QtWidgets.QHBoxLayout:
    """Widgets in a row."""
    row = QtWidgets.QHBoxLayout()
    for widget in widgets:
        row.addWidget(widget)
    return row
