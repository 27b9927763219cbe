# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finding view: shows the place of a finding: operation, command, the point in the 3D view, and the machine there.

Takes the place and the code of a finding; selects, marks, moves the camera, and draws the machine of the document in
its pose, all from the one study of the job. The document does not change: the machine object keeps its pose, and is
drawn at it again at the end.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from pivy import coin
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.document import document_name
from pkm_post.freecad_app.frames import apply
from pkm_post.freecad_app.job_setup import placed_job
from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_app.reach_object import machine_for
from pkm_post.freecad_gui.job_choices import show_place
from pkm_post.freecad_gui.observers import is_shown, scene_graph_of, view_of
from pkm_post.freecad_gui.shapes import OUT, points_through
from pkm_post.model import Place, Refused

_CLOSE = 300.0
"""mm: largest height of the view at a finding."""


class ShownPose:
    """The displayed pose of a machine object while a panel is open.

    Args:
        machine: the machine object; None draws nothing.
    """

    def __init__(self, machine: Any) -> None:
        self._view = None if machine is None else machine.ViewObject.Proxy

    def show(self, study: JobStudy, row: int) -> None:
        """Draw the machine at a row of the checked path, unless a player or a real machine moves it."""
        view = self._view
        if view is None or view.scene is None or view.mover not in (None, self):
            return
        trajectory, view.mover = study.reach.trajectory, self
        tool = trajectory.tools[int(trajectory.tool[study.reach.segment[row]])]
        view.scene.place(np.linalg.inv(trajectory.machine_from_work))
        view.scene.take_tool(tool.diameter, tool.corner_radius, tool.length)
        view.scene.show(study.pose_at(row))

    def end(self) -> None:
        """Draw the machine at its own pose again."""
        if self._view is not None:
            self._view.release(self)
        self._view = None


def look_at(document: str, point: Any) -> None:
    """Centre the 3D view on a point of the document and zoom in if needed; the orientation stays."""
    view = view_of(document)
    if view is None:
        return
    camera = view.getCameraNode()
    direction = camera.orientation.getValue().multVec(coin.SbVec3f(0.0, 0.0, -1.0))
    distance = camera.focalDistance.getValue()
    if isinstance(camera, coin.SoOrthographicCamera):
        camera.height = min(camera.height.getValue(), _CLOSE)
    else:
        distance = min(distance, _CLOSE / (2.0 * math.tan(camera.heightAngle.getValue() / 2.0)))
        camera.focalDistance = distance
    camera.position = coin.SbVec3f(*point) - direction * distance


_MARK_SIZE = 11.0


class FindingView:
    """The shown finding of a job, while a panel is open."""

    def __init__(self, job: Any) -> None:
        self._job, self._document = job, job.Document.Name
        self._pose = ShownPose(machine_for(job))
        self._study: JobStudy | None = None
        self._mark: Any = None
        self._graph: Any = None

    def show(self, operation: str, line: int, code: str = "") -> None:
        """Show a finding.

        Args:
            operation: name of the operation in the program.
            line: number of the command in it.
            code: of the finding; empty for the end of the command.
        """
        show_place(self._job, operation, line)
        study = self._checked()
        row = None if study is None else study.row_at(Place(document_name(self._job.Document), operation, line), code)
        if study is None or row is None:
            return
        point = apply(np.linalg.inv(study.reach.trajectory.machine_from_work), study.reach.tip[row][None])[0]
        self._strike()
        self._mark = points_through([tuple(point.tolist())], OUT, _MARK_SIZE)
        self._graph = scene_graph_of(self._document)
        self._graph.addChild(self._mark)
        look_at(self._document, point.tolist())
        self._pose.show(study, row)

    def end(self) -> None:
        """Remove the mark, and draw the machine at its own pose again."""
        self._strike()
        if is_shown(self._document):
            self._pose.end()
        self._study = None

    def _checked(self) -> JobStudy | None:
        """The study of the job; None if the job cannot be placed on its machine."""
        QtWidgets.QApplication.setOverrideCursor(QtCore.Qt.CursorShape.WaitCursor)
        try:
            self._study = placed_job(self._job, machine_for(self._job)).study()
        except Refused:
            self._study = None
        finally:
            QtWidgets.QApplication.restoreOverrideCursor()
        return self._study

    def _strike(self) -> None:
        if self._graph is not None:
            self._graph.removeChild(self._mark)
        self._graph = self._mark = None
