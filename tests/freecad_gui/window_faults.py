# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is wrong with the widgets of a window, by what Qt says of them: texts cut off, buttons out of sight, English."""

import re

from PySide import QtCore, QtWidgets

_WORDS = re.compile(r"[A-Za-z]{4,}")
_SAME_EVERYWHERE = re.compile(
    r"^&?(OK|Close|Cancel|Apply)$|PKM Post|^Python$|FreeCAD|--|^[a-z0-9_]+$|^[GMTXNS]\d|\.\w{3,5}$"
    r"|^/|^TC: |^\d+  \(|^ENABLE PLC|^serial:|^tool holder$"
)
"""Buttons that Qt translates or not; names of files, tools and bodies; arguments, words of programs, addresses."""
_CHINESE = re.compile(r"[\u4e00-\u9fff]")
_SLACK = 2
"""px by which a text may be wider than its place: styles round."""


def faults_of(window, language="English"):
    """Lines that say what is wrong in a window, sorted.

    Args:
        window: a widget; hidden parts of it are not looked at.
        language: name that FreeCAD has for the language that was chosen.
    """
    parts = [part for part in (window, *window.findChildren(QtWidgets.QWidget)) if part.isVisible()]
    found = [line for part in parts for line in _cut(part)]
    found += [f"out of sight: {_said(part)}" for part in parts if _is_out_of_sight(part, window)]
    if language.startswith("Chinese"):
        found += [f"not Chinese: {text}" for part in parts for text in _texts(part) if _is_english(text)]
    return sorted(set(found))


def _said(part):
    text = getattr(part, "text", None)
    return f"{part.metaObject().className()} {text() if callable(text) else part.objectName()}"[:90]


def _cut(part):
    """Texts that are wider than their place."""
    is_label = isinstance(part, QtWidgets.QLabel) and not part.wordWrap() and part.text()
    is_button = isinstance(part, (QtWidgets.QPushButton, QtWidgets.QCheckBox, QtWidgets.QRadioButton))
    if (is_label or is_button) and part.sizeHint().width() > part.width() + _SLACK:
        yield f"cut: {_said(part)}: {part.sizeHint().width()} in {part.width()}"
    is_wrapped = isinstance(part, QtWidgets.QLabel) and part.wordWrap() and part.text()
    if is_wrapped and part.heightForWidth(part.width()) > part.height() + _SLACK:
        yield f"cut: {_said(part)}: {part.heightForWidth(part.width())} high in {part.height()}"


def _is_out_of_sight(part, window):
    """Whether a button is outside its parent, and no scroll area brings it into sight."""
    if not isinstance(part, QtWidgets.QAbstractButton) or part is window:
        return False
    parent = part.parentWidget()
    if parent is None or isinstance(parent, (QtWidgets.QAbstractScrollArea, QtWidgets.QTabBar, QtWidgets.QToolBar)):
        return False
    return not parent.rect().adjusted(-_SLACK, -_SLACK, _SLACK, _SLACK).contains(part.geometry())


def _texts(part):
    """The texts that a widget shows, its tool tip among them."""
    for name in ("text", "title", "currentText", "placeholderText", "toolTip"):
        method = getattr(part, name, None)
        if callable(method) and not isinstance(part, (QtWidgets.QPlainTextEdit, QtWidgets.QTextEdit)):
            yield str(method())
    if isinstance(part, QtWidgets.QTabWidget):
        yield from (part.tabText(number) for number in range(part.count()))
    if isinstance(part, QtWidgets.QComboBox) and not part.isEditable():
        yield from (part.itemText(number) for number in range(part.count()))
    if isinstance(part, QtWidgets.QAbstractItemView) and part.model() is not None:
        yield from _items(part.model())


def _items(model):
    role, column_heads = QtCore.Qt.ItemDataRole.DisplayRole, QtCore.Qt.Orientation.Horizontal
    columns = 1 if isinstance(model, QtCore.QAbstractListModel) else model.columnCount()
    for column in range(columns):
        yield str(model.headerData(column, column_heads, role) or "")
        for row in range(min(model.rowCount(), 50)):
            yield str(model.data(model.index(row, column), role) or "")


def _is_english(text):
    return bool(_WORDS.search(text)) and not _CHINESE.search(text) and not _SAME_EVERYWHERE.search(text)
