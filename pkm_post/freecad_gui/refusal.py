# SPDX-License-Identifier: LGPL-2.1-or-later
"""Refusal: a window that lists why CAM's Post Process wrote nothing.

Takes a job and diagnostics. A click on a row selects the operation, shows its command, marks the point, and draws the
machine there. If another place of the workpiece may help, the window offers to search for one. It does not block
FreeCAD, closes with its job, and is replaced by that of the next refusal.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

from pkm_post.freecad_gui.finding_view import FindingView
from pkm_post.freecad_gui.observers import DeletionWatch, keep_wrappers
from pkm_post.freecad_gui.place_row import PlaceRow, take_place
from pkm_post.freecad_gui.post_outcome import PostOutcome
from pkm_post.model import Diagnostic
from pkm_post.posting import may_be_mended

translate = FreeCAD.Qt.translate

NAME = "PkmRefusal"


class RefusalDialog(QtWidgets.QDialog):
    """The window."""

    def __init__(self, job: Any, diagnostics: Sequence[Diagnostic]) -> None:
        super().__init__(FreeCADGui.getMainWindow())
        self._job = job
        self.setObjectName(NAME)
        self.setWindowTitle(translate("PostOutcome", "{}: not posted").format(job.Label))
        self.outcome, self.place = PostOutcome(), PlaceRow(job)
        self.place.setVisible(may_be_mended(diagnostics))
        self.place.taken.connect(self._take_place)
        self.outcome.show_refused(diagnostics)
        self._view = FindingView(job)
        self.outcome.chosen.connect(self._view.show)
        buttons = QtWidgets.QDialogButtonBox(QtWidgets.QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self.outcome)
        layout.addWidget(self.place)
        layout.addWidget(buttons)
        self._watch = DeletionWatch(self.reject, job.Document.Name, job.Name)
        self.finished.connect(lambda _result: self._end())

    def _take_place(self) -> None:
        assert self.place.found is not None
        take_place(self._job, self.place.found)
        self.accept()

    def _end(self) -> None:
        self.place.end()
        self._view.end()
        self._watch.end()
        keep_wrappers(self)
        self.deleteLater()


def show_refusal(job: Any, diagnostics: Sequence[Diagnostic]) -> None:
    """Show the reasons, in place of those of an earlier refusal."""
    for earlier in FreeCADGui.getMainWindow().findChildren(QtWidgets.QDialog, NAME):
        earlier.reject()
    RefusalDialog(job, diagnostics).show()
