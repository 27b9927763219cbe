# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long edits: loads a text, or changes all of its lines, in slices, so that the GUI stays responsive.

An edit that is instantaneous in a short text takes a third of a second in one of 100,000 lines. The text is locked
during an edit. Undo and redo treat the edit as one, again in slices.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from PySide import QtCore, QtGui, QtWidgets

_LINES = 1000
"""Lines per slice: some milliseconds of work."""
_BUDGET = 0.02
"""Seconds of work before control returns to the GUI."""


def _nothing() -> None:
    """Default continuation: do nothing."""


@dataclass(frozen=True)
class _Edit:
    """A sliced edit, defined by the number of undo steps before and after it."""

    before: int
    after: int


class LongEdits(QtCore.QObject):
    """The long edits of one text, one at a time."""

    progressed = QtCore.Signal(float)
    """The completed share, 0 to 1."""
    ended = QtCore.Signal()

    def __init__(self, text: QtWidgets.QPlainTextEdit) -> None:
        super().__init__(text)
        self._text, self._document = text, text.document()
        self._work: Iterator[float] | None = None
        self._edits: list[_Edit] = []
        self._turn = QtCore.QTimer(self)
        self._turn.setInterval(0)
        self._turn.timeout.connect(self._go_on)
        self._document.undoCommandAdded.connect(self._forget)

    def busy(self) -> bool:
        """Whether an edit is running."""
        return self._work is not None

    def finish(self) -> None:
        """Complete the edit at once: the whole text is needed."""
        while self.busy():
            self._go_on()

    def load(self, text: str) -> None:
        """Replace the whole text; this cannot be undone."""
        self._edits.clear()
        self._begin(self._loaded(text.split("\n")))

    def change(self, changed: Callable[[str], str], then: Callable[[], None] = _nothing) -> None:
        """Change lines.

        Args:
            changed: maps some lines to as many; called with all lines in order, slice by slice.
            then: called after all changes.
        """
        self._begin(self._changed(changed, then))

    def undo(self) -> None:
        """Undo the last edit."""
        state = self._document.availableUndoSteps()
        edit = next((edit for edit in self._edits if edit.after == state), None)
        if edit is None:
            QtWidgets.QPlainTextEdit.undo(self._text)
        else:
            self._begin(self._moved(self._document.undo, edit.after, edit.before))

    def redo(self) -> None:
        """Redo the last undone edit."""
        state = self._document.availableUndoSteps()
        edit = next((edit for edit in self._edits if edit.before == state), None)
        if edit is None or not self._document.isRedoAvailable():
            QtWidgets.QPlainTextEdit.redo(self._text)
        else:
            self._begin(self._moved(self._document.redo, edit.before, edit.after))

    def _begin(self, work: Iterator[float]) -> None:
        self.finish()
        self._work = work
        self._text.setReadOnly(True)
        self._turn.start()
        self._go_on()

    def _go_on(self) -> None:
        end, share = time.monotonic() + _BUDGET, 0.0
        while self._work is not None and time.monotonic() < end:
            share = next(self._work, 1.0)
            if share >= 1:
                self._work = None
        self.progressed.emit(share)
        if self._work is None:
            self._turn.stop()
            self._text.setReadOnly(False)
            self.ended.emit()

    def _loaded(self, lines: list[str]) -> Iterator[float]:
        self._text.setPlainText("\n".join(lines[:_LINES]))
        self._document.setUndoRedoEnabled(False)
        cursor = QtGui.QTextCursor(self._document)
        for first in range(_LINES, len(lines), _LINES):
            yield first / len(lines)
            cursor.movePosition(QtGui.QTextCursor.MoveOperation.End)
            cursor.insertText("\n" + "\n".join(lines[first : first + _LINES]))
            self._document.setModified(False)
        self._document.setUndoRedoEnabled(True)
        self._document.setModified(False)

    def _changed(self, changed: Callable[[str], str], then: Callable[[], None]) -> Iterator[float]:
        before, count = self._document.availableUndoSteps(), self._document.blockCount()
        for first in range(0, count, _LINES):
            yield first / count
            self._change_slice(first, min(first + _LINES, count), changed)
        after = self._document.availableUndoSteps()
        if after > before:
            self._edits = [*(edit for edit in self._edits if edit.after <= before), _Edit(before, after)]
        then()

    def _change_slice(self, first: int, end: int, changed: Callable[[str], str]) -> None:
        """Change the lines of a slice, from the first to the last that differs."""
        cursor = QtGui.QTextCursor(self._document.findBlockByNumber(first))
        last = self._document.findBlockByNumber(end - 1)
        cursor.setPosition(last.position() + last.length() - 1, QtGui.QTextCursor.MoveMode.KeepAnchor)
        old = cursor.selectedText().replace("\u2029", "\n").split("\n")
        new = changed("\n".join(old)).split("\n")
        others = [row for row, (one, other) in enumerate(zip(old, new, strict=True)) if one != other]
        if others:
            begin, last = others[0], self._document.findBlockByNumber(first + others[-1])
            cursor.setPosition(self._document.findBlockByNumber(first + begin).position())
            cursor.setPosition(last.position() + last.length() - 1, QtGui.QTextCursor.MoveMode.KeepAnchor)
            cursor.insertText("\n".join(new[begin : others[-1] + 1]))

    def _moved(self, step: Callable[[], None], begin: int, end: int) -> Iterator[float]:
        """Undo or redo until the number of undo steps matches one end of an edit."""
        while (state := self._document.availableUndoSteps()) != end:
            yield (state - begin) / (end - begin)
            step()

    def _forget(self) -> None:
        """The text was edited: undone edits cannot be redone."""
        if not self.busy():
            state = self._document.availableUndoSteps()
            self._edits = [edit for edit in self._edits if edit.after < state]
