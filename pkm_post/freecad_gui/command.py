# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command: FreeCAD's command interface, and the ways in which our commands run.

A command that changes a document runs in one transaction, so that one undo reverts it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

from pkm_post.freecad_app.core_texts import exception_text, fault_text
from pkm_post.freecad_app.document import job_for, transaction
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.observers import is_panel_open
from pkm_post.model import Refused
from pkm_post.system import MEMORY_FAULTS, memory_diagnostic

translate = FreeCAD.Qt.translate

PAGES = Path(__file__).parents[2] / "docs"
"""FreeCAD's Help opens files, so the pages are those of the installed version and need no network."""


@contextmanager
def show_faults(title: str) -> Iterator[None]:
    """Show a refusal, or a lack of memory, of an action in a window; other exceptions propagate."""
    try:
        yield
    except Refused as refused:
        QtWidgets.QMessageBox.warning(FreeCADGui.getMainWindow(), title, exception_text(refused))
    except MEMORY_FAULTS as fault:
        diagnostic = memory_diagnostic(fault, title)
        if diagnostic is None:
            raise
        QtWidgets.QMessageBox.warning(FreeCADGui.getMainWindow(), title, fault_text(diagnostic))


def run_on(name: str, item: FreeCAD.DocumentObject) -> None:
    """Run a command as its button does: it applies to the selection in the active document."""
    FreeCADGui.setActiveDocument(item.Document.Name)  # brings its view to the front
    FreeCAD.setActiveDocument(item.Document.Name)
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(item)
    FreeCADGui.runCommand(name, 0)


Subject = Callable[[Sequence[FreeCAD.DocumentObject]], FreeCAD.DocumentObject | None]
"""From the selected objects to the one that a command applies to, or None."""


def exactly_one(accepts: Callable[[FreeCAD.DocumentObject], bool]) -> Subject:
    """A subject that is the only selected object, if the command accepts it."""
    return lambda items: items[0] if len(items) == 1 and accepts(items[0]) else None


def job_or(accepts: Callable[[FreeCAD.DocumentObject], bool] = lambda item: False) -> Subject:
    """A subject that is the only selected object, if the command accepts it, else the job of the selection."""
    return lambda items: exactly_one(accepts)(items) or job_for(items, FreeCAD.ActiveDocument)


@dataclass(frozen=True)
class Command:
    """A command with FreeCAD's interface.

    Attributes:
        name: its name in FreeCAD.
        icon: file name in resources/icons.
        text: menu text.
        tip: its function in one sentence.
        subject: maps a selection to the object to act on, such as its job; None if there is none.
        action: applies the command to that object.
        keys: keyboard shortcut; all begin with P, K, since CAM uses P and one more key.
        page: the file in docs that F1 opens.
        alone: whether it also runs without an object; the action then gets None.
        computes: whether to recompute the document; an operation with a panel waits for the user's Apply.
    """

    name: str
    icon: str
    text: str
    tip: str
    subject: Subject
    action: Callable[[FreeCAD.DocumentObject], None]
    keys: str
    page: str = "workbench.md"
    alone: bool = False
    computes: bool = True

    def GetResources(self) -> dict[str, str]:
        """Texts, icon and shortcut. FreeCAD itself translates the texts, again after a change of language."""
        return {
            "Pixmap": str(ICONS / self.icon),
            "MenuText": self.text,
            "ToolTip": self.tip,
            "StatusTip": self.tip,
            "Accel": self.keys,
            "WhatsThis": str(PAGES / self.page),
        }

    def IsActive(self) -> bool:
        """Whether the selection has a subject, or none is needed."""
        if FreeCAD.ActiveDocument is None:
            return False
        return self.alone or self._selected() is not None

    def _selected(self) -> FreeCAD.DocumentObject | None:
        return self.subject(FreeCADGui.Selection.getSelection())

    def Activated(self) -> None:
        """Run the command; a fault restores the previous state."""
        subject = self._selected()
        document = subject.Document if subject else FreeCAD.ActiveDocument
        with show_faults(translate(self.name, self.text)):
            with transaction(document, translate(self.name, self.text)):
                self.action(subject)
            if self.computes:
                document.recompute()


@dataclass(frozen=True)
class WindowCommand(Command):
    """A command that opens a window: it needs no document and changes none. Its action gets the selection.

    Attributes:
        beside: whether it also runs while a task panel is open; FreeCAD disables the other commands then.
    """

    beside: bool = True

    def GetResources(self) -> dict[str, str]:
        """Also the type of the command."""
        return super().GetResources() | ({"CmdType": "ForEdit"} if self.beside else {})

    def IsActive(self) -> bool:
        """Always."""
        return True

    def Activated(self) -> None:
        """Open the window."""
        with show_faults(translate(self.name, self.text)):
            self.action(next(iter(FreeCADGui.Selection.getSelection()), None))


@dataclass(frozen=True)
class JobPanelCommand(Command):
    """A command that opens the panel of a job; the panel has undo steps of its own.

    FreeCAD leaves the transaction of a command open while a panel is: later changes would join it.
    """

    def Activated(self) -> None:
        """Recompute if needed, and open the panel."""
        subject = self._selected()
        with show_faults(translate(self.name, self.text)):
            self.action(subject)
            if self.computes:
                subject.Document.recompute()


@dataclass(frozen=True)
class PanelCommand(Command):
    """A command that opens a panel for its new object; the panel ends the transaction, so both are one undo step."""

    def Activated(self) -> None:
        """Add the object and open its panel; a fault restores the previous state."""
        subject, editing = self._selected(), FreeCADGui.editDocument()  # closing a panel may change the selection
        if editing is not None:
            editing.resetEdit()  # now: later it would commit the transaction of the new object
        if is_panel_open(translate(self.name, self.text)):
            return
        document, before = subject.Document, set(subject.Document.Objects)
        with show_faults(translate(self.name, self.text)):
            self._add(subject, document, before)

    def _add(
        self, subject: FreeCAD.DocumentObject, document: FreeCAD.Document, before: set[FreeCAD.DocumentObject]
    ) -> None:
        document.openTransaction(translate(self.name, self.text))
        try:
            self.action(subject)
            document.recompute()
            (made,) = set(document.Objects) - before
            FreeCADGui.getDocument(document.Name).setEdit(made.ViewObject, 0)
        except BaseException:
            document.abortTransaction()
            raise
