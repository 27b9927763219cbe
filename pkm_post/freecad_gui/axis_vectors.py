# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axis vectors: the tool axis at every nth block of a path with tilted tools, as lines in the 3D view.

The number n is a preference (``preferences``), shared by the player and Reach.
"""

from __future__ import annotations

import numpy as np
from pivy import coin
from PySide import QtGui

from pkm_post.freecad_app.frames import apply
from pkm_post.freecad_gui.shapes import segments
from pkm_post.freecad_gui.theme import theme
from pkm_post.geometry import Array
from pkm_post.model import Trajectory

_LENGTH = 15.0
"""mm: length of a drawn tool axis."""
_WIDTH = 2.0
"""px."""


def axis_vectors(trajectory: Trajectory, every: int) -> coin.SoSeparator:
    """Lines along the tool axes at the ends of every nth block, in {C}.

    Args:
        trajectory: in {M}.
        every: n, from 1.
    """
    colour = QtGui.QColor(theme().axis).getRgbF()[:3]
    return segments(*tool_axes(trajectory, every, _LENGTH), colour, _WIDTH)


def tool_axes(trajectory: Trajectory, every: int, length: float) -> tuple[Array, Array]:
    """Ends of tool axes at the ends of every nth block, (K, 3) each in {C}.

    Args:
        trajectory: in {M}.
        every: n, from 1.
        length: of a drawn axis, mm.
    """
    work_from_machine = np.linalg.inv(trajectory.machine_from_work)
    tip, axis = trajectory.tip[every - 1 :: every], trajectory.axis[every - 1 :: every]
    return apply(work_from_machine, tip), apply(work_from_machine, tip + length * axis)


def is_tilted(trajectory: Trajectory) -> bool:
    """Whether the tool axis varies along the path: five-axis motion."""
    return bool(np.ptp(trajectory.axis, axis=0).max() > 1e-9)
