# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job choices: the user's choices for posting a job, stored in the document.

Takes a job; stores the choices as its arguments, and the gauge lengths in its tool controllers, so that CAM's own post
command gives the same result.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtWidgets

from pkm_post.freecad_app.arguments import job_arguments, own_text, parse_arguments, store_in_job
from pkm_post.freecad_app.document import transaction
from pkm_post.freecad_app.fixtures import operation_named
from pkm_post.freecad_app.gauge_lengths import store_gauge_lengths
from pkm_post.freecad_app.post_job import file_name
from pkm_post.freecad_app.post_processor import program_path
from pkm_post.freecad_gui.gauge_table import GaugeTable
from pkm_post.freecad_gui.post_fields import PostChoices
from pkm_post.freecad_gui.preferences import default_arguments, default_folder
from pkm_post.model import Place, Refused
from pkm_post.options import tool_lengths_from

translate = FreeCAD.Qt.translate


class JobChoices(QtWidgets.QWidget):
    """The fields.

    Attributes:
        arguments: fields of the job's arguments.
        gauges: fields of its gauge lengths.
    """

    def __init__(self, job: Any) -> None:
        super().__init__()
        self._job = job
        self.arguments = PostChoices(own_text(job) or default_arguments(), str(_folder_of(job)))
        self.gauges = GaugeTable(job)
        self.arguments.more.textChanged.connect(self._show_given)
        layout = QtWidgets.QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.arguments)
        layout.addWidget(self.gauges)
        self._show_given()

    def show_job(self) -> None:
        """Show the arguments of the job as they are."""
        self.arguments.show_text(own_text(self._job))

    def end(self) -> None:
        """Stop following the document."""
        self.gauges.end()

    def program(self) -> Path:
        """The path of the motion program."""
        return Path(self.arguments.folder.text().strip() or ".").absolute() / file_name(self._job)

    def keep(self) -> argparse.Namespace:
        """Store the choices in the document, in one undo step.

        Returns:
            The arguments of the job.

        Raises:
            Refused: the choices are invalid, J117 or J113; nothing is stored.
        """
        text, job = self.arguments.text(), self._job
        chosen, lengths = job_arguments(job, text), self.gauges.lengths()
        with transaction(job.Document, translate("PostPanel", "Post to a hexapod")):
            store_in_job(job, text, str(self.program()))
            store_gauge_lengths(job, lengths)
        self.show_job()
        return chosen

    def _show_given(self, *_changed: str) -> None:
        """Show which gauge lengths the arguments define; invalid arguments are reported when they are to be stored."""
        try:
            given = tool_lengths_from(parse_arguments(self.arguments.text(), Place("")))
        except Refused:
            given = {}
        self.gauges.show_arguments(given)


def _folder_of(job: Any) -> Path:
    """The folder of the job's previous output; else that of the preferences, else that of the document."""
    if job.PostProcessorOutputFile:
        return program_path(job).absolute().parent
    return Path(default_folder() or Path(job.Document.FileName or "job.FCStd").absolute().parent)


def show_place(job: Any, label: str, line: int) -> None:
    """Select an operation of a job and show the number of one of its commands.

    Args:
        job: the CAM job; None shows nothing.
        label: name of the operation in the program.
        line: number of the command in it, from 1.
    """
    FreeCADGui.Selection.clearSelection()
    operation = operation_named(job, label) if job else None
    if operation is not None:
        FreeCADGui.Selection.addSelection(operation)
        commands = operation.Path.Commands
        text = commands[line - 1].toGCode() if 0 < line <= len(commands) else ""
        FreeCADGui.getMainWindow().statusBar().showMessage(f"{label}, {line}: {text}")
