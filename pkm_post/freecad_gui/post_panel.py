# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post panel: converts a CAM job to a certified motion program, in the background.

Takes a job; stores the choices in the document. The job is read in the GUI thread, as documents require, and
posted in another thread.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.document_checks import require_computed
from pkm_post.freecad_app.job_settings import settings_of
from pkm_post.freecad_app.job_setup import prepared_job
from pkm_post.freecad_app.job_study import collisions_of
from pkm_post.freecad_app.progress import Stopped
from pkm_post.freecad_app.sanity import remember_output
from pkm_post.freecad_app.window import show_verdict
from pkm_post.freecad_gui.background import BackgroundCall
from pkm_post.freecad_gui.command import run_on
from pkm_post.freecad_gui.finding_view import FindingView
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.job_choices import JobChoices
from pkm_post.freecad_gui.observers import DeletionWatch, OnceClosed, is_panel_open, show_panel
from pkm_post.freecad_gui.place_row import PlaceRow, take_place
from pkm_post.freecad_gui.post_fields import push_button
from pkm_post.freecad_gui.post_outcome import PostOutcome, step_text
from pkm_post.model import Refused
from pkm_post.options import READING_STEP
from pkm_post.posting import Prepared, may_be_mended
from pkm_post.system import memory_guard

translate = FreeCAD.Qt.translate

NAME = "PkmPostPanel"
_APPLY = QtWidgets.QDialogButtonBox.StandardButton.Apply
_BUTTONS_IN_A_ROW = 2
"""So that a task panel of 380 pixels shows all of them."""
_PER_MILLE = 1000


class PostPanel:
    """The task panel."""

    def __init__(self, job: Any) -> None:
        self.job, self._task, self._target = job, None, Path()
        self.form = QtWidgets.QWidget()
        self.form.setObjectName(NAME)
        self.form.setWindowTitle(translate("PostPanel", "Post to a hexapod"))
        self.form.setWindowIcon(QtGui.QIcon(str(ICONS / "pkm_post.svg")))
        self.choices = JobChoices(job)
        self.outcome, self.bar, self.step = PostOutcome(), QtWidgets.QProgressBar(), QtWidgets.QLabel()
        self.place = PlaceRow(job)
        self.place.taken.connect(self._take_place)
        self.bar.setRange(0, _PER_MILLE)
        self._view = FindingView(job)
        self.outcome.chosen.connect(self._view.show)
        tip = translate("PostPanel", "Write the certified motion program and its accompanying files")
        self.post = push_button(translate("PostPanel", "Post"), self.begin, tip)
        tip = translate("PostPanel", "Stop after the current step, and write nothing")
        self.stop = push_button(translate("PostPanel", "Cancel"), self.cancel, tip)
        tip = translate("PostPanel", "Show the files that were written")
        self.folder = push_button(translate("PostPanel", "Open folder"), self._open_folder, tip)
        tip = translate("PostPanel", "Play the planned motion of the job")
        self.simulate = push_button(translate("PostPanel", "Simulate"), self._simulate, tip)
        self._used_at_rest = [self.choices, self.post, self.simulate]
        self._lay_out()
        self._show_running(False)
        self._watch = DeletionWatch(self.reject, job.Document.Name, job.Name)
        self._close = OnceClosed(self.form, self._release)

    def _lay_out(self) -> None:
        layout, buttons = QtWidgets.QVBoxLayout(self.form), QtWidgets.QGridLayout()
        for number, button in enumerate((self.post, self.stop, self.folder, self.simulate)):
            buttons.addWidget(button, *divmod(number, _BUTTONS_IN_A_ROW))
        layout.addLayout(buttons)
        for part in (self.step, self.bar, self.outcome, self.place, self.choices):
            layout.addWidget(part)
        layout.addStretch()

    def begin(self) -> None:
        """Store the choices, read the job, and start posting it."""
        self._show_running(True)
        self._show_progress(READING_STEP, 0.0)
        QtWidgets.QApplication.processEvents(QtCore.QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)
        try:
            with memory_guard(self.job.Label):
                read = self._read()
        except BaseException as fault:
            self._show_end(fault)
            if not isinstance(fault, Refused):
                raise
            return
        show_verdict(self.job, None)
        task = BackgroundCall(lambda: read.post(self._target, progress=task.report, search=collisions_of), self.form)
        self._task = task
        task.progressed.connect(self._show_progress)
        task.finished.connect(self._end)
        task.start()

    def _read(self) -> Prepared:
        """Read the job and its machine, after storing the choices."""
        self.choices.keep()
        self._target = self.choices.program()
        require_computed(self.job.Document)
        return prepared_job(self.job, settings_of(self.job))

    def _store_choices(self) -> bool:
        """Store the choices in the document without posting; if they are invalid, show why."""
        try:
            self.choices.keep()
        except Refused as refused:
            self._show_end(refused)
            return False
        self.job.Document.recompute()
        return True

    def cancel(self) -> None:
        """Stop after the current step; nothing is then written."""
        if self._task is not None:
            self._task.stop()
            self.stop.setEnabled(False)
            self.step.setText(translate("PostPanel", "Stopping after this step"))

    def _end(self) -> None:
        task, self._task = self._task, None
        task.deleteLater()
        try:
            posted = task.value()
        except BaseException as fault:
            self._show_end(fault)
            if not isinstance(fault, Refused | Stopped):
                raise
        else:
            self._show_running(False)
            self.folder.setEnabled(True)
            remember_output(self.job, posted.program)
            show_verdict(self.job, posted.diagnostics)
            self.outcome.show_posted(posted)

    def _show_end(self, fault: BaseException) -> None:
        """Show that nothing was written, and why."""
        self._show_running(False)
        if isinstance(fault, Refused):
            self.outcome.show_refused(fault.diagnostics)
            show_verdict(self.job, fault.diagnostics)
            self.place.setVisible(may_be_mended(fault.diagnostics))
        elif isinstance(fault, Stopped):
            self.outcome.show_nothing(translate("PostPanel", "Stopped. Nothing was written."))
        else:
            self.outcome.show_nothing(translate("PostPanel", "Internal error; see the Report view."))

    def _show_running(self, runs: bool) -> None:
        for part in self._used_at_rest:
            part.setEnabled(not runs)
        self.stop.setEnabled(runs)
        self.folder.setEnabled(False)
        self.bar.setVisible(runs)
        self.step.setVisible(runs)
        self.place.end()
        self.place.hide()
        if runs:
            self.outcome.show_nothing("")

    def _show_progress(self, step: str, share: float) -> None:
        self.bar.setValue(round(share * _PER_MILLE))
        if self.stop.isEnabled():
            self.step.setText(step_text(step))

    def _take_place(self) -> None:
        """Store the found place, and show it in the fields."""
        assert self.place.found is not None
        take_place(self.job, self.place.found)
        self.choices.show_job()
        self.place.hide()
        self.outcome.show_nothing(translate("PostPanel", "Stored in the document. Nothing was posted."))

    def _open_folder(self) -> None:
        QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(str(self._target.parent)))

    def _simulate(self) -> None:
        """Store the choices, and run the command, which reports on its own why there is nothing to play."""
        if not self._store_choices():
            return
        run_on("PKM_Simulate", self.job)

    def getStandardButtons(self) -> Any:
        """Apply, which stores the choices without posting, and Close."""
        return _APPLY | QtWidgets.QDialogButtonBox.StandardButton.Close

    def modifyStandardButtons(self, box: Any) -> None:
        """Connect the button that FreeCAD created."""
        button = box.button(_APPLY)
        button.setToolTip(translate("PostPanel", "Store the choices in the document without posting"))
        button.clicked.connect(lambda: self._apply())
        self._used_at_rest.append(button)

    def _apply(self) -> None:
        """Store the choices, for reach, simulation and operations that need the machine or a gauge length."""
        if self._store_choices():
            self.outcome.show_nothing(translate("PostPanel", "Stored in the document. Nothing was posted."))

    def reject(self) -> bool:
        """Close the panel, after stopping any posting."""
        self._close()
        FreeCADGui.Control.closeDialog()
        return True

    def _release(self) -> None:
        """Stop any posting, and following the document."""
        self._watch.end()
        self.place.end()
        self._view.end()
        self.choices.end()
        if self._task is not None:
            self._task.finished.disconnect(self._end)  # the display no longer exists
            self._task.finish()


def open_panel(job: Any) -> PostPanel | None:
    """Show the panel for a job; None if another task panel is open."""
    if is_panel_open(translate("PostPanel", "Post to a hexapod")):
        return None
    panel = PostPanel(job)
    show_panel(panel)
    return panel
