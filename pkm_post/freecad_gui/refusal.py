# SPDX-License-Identifier: LGPL-2.1-or-later
"""Refusal: why CAM's Post Process wrote nothing, as rows in a window of their own.

Takes a job and diagnostics. A click on a row selects the operation and shows its command. The window does not block
FreeCAD, closes with its job, and is replaced by that of the next refusal.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

from pkm_post.freecad_gui.job_choices import show_place
from pkm_post.freecad_gui.observers import DeletionWatch
from pkm_post.freecad_gui.post_outcome import PostOutcome
from pkm_post.model import Diagnostic

translate = FreeCAD.Qt.translate

NAME = "PkmRefusal"


class Refusal(QtWidgets.QDialog):
    """The window."""

    def __init__(self, job: Any, diagnostics: Sequence[Diagnostic]) -> None:
        super().__init__(FreeCADGui.getMainWindow())
        self.setObjectName(NAME)
        self.setWindowTitle(translate("PostOutcome", "{}: not posted").format(job.Label))
        self.outcome = PostOutcome()
        self.outcome.show_refused(diagnostics)
        self.outcome.chosen.connect(lambda operation, line: show_place(job, operation, line))
        buttons = QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self.outcome)
        layout.addWidget(buttons)
        self._watch = DeletionWatch(self.reject, job.Document.Name, job.Name)
        self.finished.connect(lambda _result: self._end())

    def _end(self) -> None:
        self._watch.end()
        self.deleteLater()


def show_refusal(job: Any, diagnostics: Sequence[Diagnostic]) -> None:
    """Show the reasons; those of an earlier refusal go."""
    for earlier in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialog, NAME):
        earlier.reject()
    Refusal(job, diagnostics).show()
