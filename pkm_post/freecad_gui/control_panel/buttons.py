# SPDX-License-Identifier: LGPL-2.1-or-later
"""Buttons: order buttons and fields that state why they are disabled; rows and lines of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.control.numerical_control import Interlock, OperatorCommand, blocking_interlock
from pkm_post.freecad_gui.control_panel.texts import why_text
from pkm_post.freecad_gui.post_fields import push_button

translate = FreeCAD.Qt.translate

NARROW = "QPushButton { min-width: 0px; }"
"""FreeCAD's themes make buttons so wide that three of them and their margins fill a dock of 380 px."""


class OrderButton(QtWidgets.QPushButton):
    """A button for an order; while the order is blocked it is disabled, and its tooltip states why."""

    def __init__(self, text: str, tip: str, order: OperatorCommand, action: Callable[[], Any]) -> None:
        super().__init__(text)
        self._tip, self._order = tip, order
        self._why: Interlock | None = None
        self.setToolTip(tip)
        self.setAutoDefault(False)
        self.setStyleSheet(NARROW)
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


def set_usable(parts: Iterable[QtWidgets.QWidget], tip: str, why: str = "") -> None:
    """Enable fields, or disable them with the reason as tooltip; an empty reason enables them."""
    text = "\n".join(filter(None, (tip, why and f"({why})")))
    for part in parts:
        part.setEnabled(not why)
        if part.toolTip() != text:
            part.setToolTip(text)


def plain_button(text: str, tip: str, action: Callable[[], Any]) -> QtWidgets.QPushButton:
    """A button that sends no order to the machine."""
    button = push_button(text, action, tip)
    button.setStyleSheet(NARROW)
    return button


def side_by_side(*widgets: QtWidgets.QWidget) -> QtWidgets.QHBoxLayout:
    """Widgets in a row."""
    row = QtWidgets.QHBoxLayout()
    for widget in widgets:
        row.addWidget(widget)
    return row


def line_label() -> QtWidgets.QLabel:
    """A single-line label that fills the width and keeps its height."""
    label = QtWidgets.QLabel()
    label.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Fixed)
    label.setMinimumHeight(label.fontMetrics().height())
    return label


def show_line(label: QtWidgets.QLabel, text: str, tip: str = "") -> None:
    """Show a text, elided to the width; the tooltip has the full text."""
    mode = QtCore.Qt.TextElideMode.ElideRight
    label.setText(label.fontMetrics().elidedText(text, mode, max(label.width(), 1)))
    label.setToolTip(tip or text)


class FilesField(QtWidgets.QWidget):
    """File names, a button to choose them, and one to clear them."""

    changed = QtCore.Signal()

    def __init__(self, title: str, kinds: str, many: bool = False) -> None:
        """Create the field.

        Args:
            title: of the dialog.
            kinds: filter of the dialog.
            many: whether several files can be chosen.
        """
        super().__init__()
        self.files: tuple[str, ...] = ()
        self._title, self._kinds, self._many, self._name = title, kinds, many, line_label()
        self.choose, self.clear = QtWidgets.QToolButton(), QtWidgets.QToolButton()
        for button, text, action in ((self.choose, "…", self._ask), (self.clear, "×", lambda: self.take(()))):
            button.setText(text)
            button.clicked.connect(lambda _on=False, action=action: action())
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._name, 1)
        layout.addWidget(self.choose)
        layout.addWidget(self.clear)
        self.take(())

    def take(self, files: tuple[str, ...]) -> None:
        """Show these files."""
        self.files = files
        self._show()
        self.changed.emit()

    def refresh(self, tip: str, why: str) -> None:
        """Enable the buttons, or disable them with the reason; an empty reason enables them."""
        set_usable((self.choose,), tip, why)
        set_usable((self.clear,), translate("ControlPanel", "No file"), why)

    def resizeEvent(self, event: Any) -> None:
        """Called by Qt: elide the names to the new width."""
        super().resizeEvent(event)
        self._show()

    def _show(self) -> None:
        names = ", ".join(file.replace("\\", "/").rpartition("/")[2] for file in self.files)
        show_line(self._name, names or translate("ControlPanel", "none"), "\n".join(self.files))

    def _ask(self) -> None:
        dialog = QtWidgets.QFileDialog
        if self._many:
            self.take(tuple(dialog.getOpenFileNames(self, self._title, "", self._kinds)[0]) or self.files)
        elif name := dialog.getOpenFileName(self, self._title, "", self._kinds)[0]:
            self.take((name,))
