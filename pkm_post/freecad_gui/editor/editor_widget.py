# SPDX-License-Identifier: LGPL-2.1-or-later
"""Editor widget: the text of a part program with live feedback.

Takes a text, its file name and its reading options; shows the faults, the contents of the program, and the block under
the cursor on the path of its program object.
"""

from __future__ import annotations

import re
from pathlib import Path

import FreeCAD
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.program_object import reading_of
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.editor import program_link
from pkm_post.freecad_gui.editor.checking import Checker, Findings, marks_of
from pkm_post.freecad_gui.editor.find_bar import FindBar
from pkm_post.freecad_gui.editor.posting import ReadingFields
from pkm_post.freecad_gui.editor.program_link import ShownBlock
from pkm_post.freecad_gui.editor.text_view import TextView
from pkm_post.model import Program
from pkm_post.reading import (
    CheckedText,
    Language,
    ReadingOptions,
    is_part_program,
    jump_by_number,
    language_of,
    renumbered,
    shown_language,
    tip_paths_of_line,
)

translate = FreeCAD.Qt.translate

_NEW = "new.ngc"
"""The name of a text without a file, which makes it G-code."""
_HEAD = 65536
"""Number of leading characters from which to recognise the language."""
_NUMBERED = re.compile(r"^[ \t]*(?:/[ \t]*(?:[1-9](?![\d.])[ \t]*)?)*N\d", re.M)
"""The start of a block that ``renumbered`` has numbered."""


class EditorWidget(QtWidgets.QWidget):
    """The text and its feedback.

    Attributes:
        file: source of the text; None for a new one.
        program: the parsed program while it is up to date.
    """

    def __init__(self, parent: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        self.file: Path | None = None
        self.program: Program | None = None
        self._shown = ShownBlock()
        self.text, self.findings, self.size = TextView(self), Findings(self), QtWidgets.QLabel(self)
        self.find_bar = FindBar(self.text, self)
        self.reading = ReadingFields(self)
        self._progress = QtWidgets.QProgressBar(self)
        self._progress.hide()
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for widget in (self.find_bar, self.text, self._progress, self.size, self.findings):
            layout.addWidget(widget)
        self.checker = Checker(self._text_to_check, self)
        self.checker.checked.connect(self._show_status)
        self.checker.missing.connect(self.size.setText)
        self.findings.chosen.connect(self._jump)
        self.find_bar.replaced.connect(self._show_replaced)
        self.text.edits.progressed.connect(self._show_progress)
        self.text.textChanged.connect(self._changed)
        self.text.cursorPositionChanged.connect(self._show_block)
        self.reading.changed.connect(self._read_otherwise)

    def name(self) -> str:
        """The name of the file, or its placeholder."""
        return str(self.file or _NEW)

    def language(self) -> Language:
        """The language by the file name: Siemens counts as G-code."""
        return language_of(self.name())

    def _shown_language(self) -> Language:
        """The language for syntax colours."""
        head = self.text.toPlainText()[:_HEAD].encode("utf-8", "surrogatepass")
        return shown_language(self.name(), head, self.reading.chosen().flavour)

    def open_file(self, file: Path) -> None:
        """Attach newly loaded text to its file, and read it as its object does.

        Without an object, only what the fields show of G-code stays from the text before: its other options would act
        unseen, such as origins and block delete.
        """
        obj, before = program_link.object_of(file), self.reading.chosen()
        kept = ReadingOptions(before.axis_words, flavour=before.flavour, dwell_unit=before.dwell_unit)
        self.reading.show_reading(kept if obj is None else reading_of(obj))
        self.set_file(file)

    def set_file(self, file: Path) -> None:
        """Attach the text to another file; its reading options stay."""
        self.file = file
        self.text.set_language(self._shown_language())
        self.reading.offer_for(self.language())
        self.checker.request()

    def follow(self) -> None:
        """The file was saved: make its object read it again."""
        obj = program_link.object_of(self.file)
        if obj is not None:
            program_link.bring_up_to_date(obj, self.reading.chosen())

    def renumber(self) -> None:
        """Number all blocks; CL data has no line numbers."""
        if self.language() is not Language.GCODE:
            return
        line = jump_by_number(self.text.toPlainText())
        if line is not None:
            text = translate("PKM_Editor", "Not renumbered: line {} jumps to a block by its number")
            self.size.setText(text.format(line))
            self._jump(line, 1)
            return
        first = step = 10

        def changed(lines: str) -> str:
            nonlocal first
            text = renumbered(lines, first, step)
            first += step * len(_NUMBERED.findall(text))
            return text

        self.text.edits.change(changed)

    def busy(self) -> bool:
        """Whether the text is being changed, or a check is pending."""
        return self.text.edits.busy() or self.checker.busy()

    def _text_to_check(self) -> tuple[str, str, ReadingOptions]:
        return self.text.toPlainText(), self.name(), self.reading.chosen()

    def _changed(self) -> None:
        self.program = None
        self._show_block()
        self.checker.request()

    def _read_otherwise(self) -> None:
        self.checker.request()
        obj = program_link.object_of(self.file)
        if obj is not None and reading_of(obj) != self.reading.chosen():
            program_link.bring_up_to_date(obj, self.reading.chosen())

    def _show_progress(self, share: float) -> None:
        self._progress.setVisible(share < 1)
        self._progress.setValue(round(100 * share))

    def _show_replaced(self, count: int) -> None:
        self.size.setText(translate("PKM_Editor", "{} replaced").format(count))

    def _show_status(self, checked: CheckedText) -> None:
        self.program, size = checked.program, checked.size
        self.findings.show_all(checked.diagnostics)
        lines, language = self.text.toPlainText().split("\n"), self._shown_language()
        self.text.set_language(language)
        self.text.set_marks(marks_of(checked.diagnostics, lines, language))
        text = translate("PKM_Editor", "{} blocks, {} arcs, {}")
        self.size.setText("" if size is None else text.format(size.blocks, size.arcs, amount_text(size.length, "mm")))
        self._show_block()

    def _jump(self, line: int, column: int) -> None:
        self.text.jump(line, column)
        self.text.setFocus()

    def _show_block(self) -> None:
        ways = [] if self.program is None else tip_paths_of_line(self.program, self.text.current_line())
        self._shown.show(program_link.scene_of(program_link.object_of(self.file)), ways)


_DRAGGED = (QtCore.QEvent.Type.DragEnter, QtCore.QEvent.Type.DragMove)


class FileDrop(QtCore.QObject):
    """Accepts part programs dropped on widgets. Dropped text is handled as usual, other files by the main window."""

    dropped = QtCore.Signal(object)
    """The path of the first file."""

    def __init__(self, parent: QtCore.QObject, *widgets: QtWidgets.QWidget) -> None:
        super().__init__(parent)
        for widget in widgets:
            widget.setAcceptDrops(True)
            widget.installEventFilter(self)

    def eventFilter(self, watched: QtCore.QObject, event: QtCore.QEvent) -> bool:
        """Called by Qt."""
        is_drop = event.type() == QtCore.QEvent.Type.Drop
        if not is_drop and event.type() not in _DRAGGED:
            return False
        if not event.mimeData().hasUrls():
            return False
        file = _part_program(event.mimeData())
        if file is None:  # a text widget would insert the file name; FreeCAD's window may handle it
            event.ignore()
            return True
        event.setDropAction(QtCore.Qt.DropAction.CopyAction)
        event.accept()
        if is_drop:
            self.dropped.emit(file)
        return True


def _part_program(data: QtCore.QMimeData) -> Path | None:
    """The first part program among the dragged files."""
    files = (Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile())
    return next((file for file in files if is_part_program(file)), None)
