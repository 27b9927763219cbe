# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shown pose: a machine of the document, drawn at a pose of a checked path, and the camera on a point.

Takes a study and a row of its path. The document does not change: the machine object keeps its pose, and is drawn at it
again at the end.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from pivy import coin

from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_gui.observers import view_of

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
        """Draw the machine at a row of the checked path."""
        view = self._view
        if view is None or view.scene is None:
            return
        trajectory, view.played = study.reach.trajectory, True
        tool = trajectory.tools[int(trajectory.tool[study.reach.segment[row]])]
        view.scene.place(np.linalg.inv(trajectory.machine_from_work))
        view.scene.take_tool(tool.diameter, tool.corner_radius, tool.length)
        view.scene.show(study.pose_at(row))

    def end(self) -> None:
        """Draw the machine at its own pose again."""
        if self._view is not None and self._view.played:
            self._view.played = False
            self._view.refresh()
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
