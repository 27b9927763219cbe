# SPDX-License-Identifier: LGPL-2.1-or-later
"""Retract: lift the tool along its axis while a play is stopped, and return before the play continues.

Both are manual moves, planned, certified and checked for reach. The return is straight down the axis or, if the tool
was moved meanwhile, an approach.

Input: a machine at rest, mm. Output: the machine at rest above its path, and later back on it.
"""

from __future__ import annotations

import logging

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.tool_pose import UNKNOWN_POSE
from pkm_post.control.numerical_control.manual_moves import (
    CartesianJog,
    approach_trajectory,
    jog_trajectory,
    straight_trajectory,
)
from pkm_post.control.numerical_control.plan import planned
from pkm_post.control.player.stop_events import TOLERANCES, PlayContext
from pkm_post.geometry import norm
from pkm_post.model import Amount, Diagnostics, Phrase, Refused, Trajectory, errors
from pkm_post.options import APPROACH_MM_S, START_TOLERANCE_MM
from pkm_post.toolpath import ToolPose

_log = logging.getLogger(__name__)


class Retract:
    """A retract from the path and the return to it."""

    def __init__(self, task: PlayContext) -> None:
        self._task = task
        self._from: ToolPose | None = None

    def lift(self, distance: float, tool_length: float) -> None:
        """Lift the tool along its axis; if that is impossible, log it without moving.

        Args:
            distance: mm.
            tool_length: gauge length of the tool in the spindle, mm.

        Raises:
            PmacError: machine or link are not ready, or the move did not end.
        """
        here = self._task.pose(tool_length)
        if here is None:
            _log.warning("%s", Phrase("no retract: {}", UNKNOWN_POSE))
            return
        x, y, z = (distance * here.axis).tolist()
        made = jog_trajectory(CartesianJog((x, y, z)), self._task.machine, here, tool_length, APPROACH_MM_S)
        found = self._done(*made)
        for each in found:
            _log.warning("%s", Phrase("no retract: {}", each))
        if not found:
            self._from = self._from or here
            way = Amount(distance + float((here.tip - self._from.tip) @ here.axis), "mm")
            _log.info("%s", Phrase("the tool is {} above its path; it returns before the play continues", way))

    def back(self, tool_length: float) -> None:
        """Return to the path, if the tool is off it.

        Raises:
            Refused: the return cannot be planned; the tool stays in place.
            PmacError: as ``lift``.
        """
        if self._from is None:
            return
        here = self._task.pose(tool_length)
        if here is None:
            raise NotReadyError([UNKNOWN_POSE])
        way = here.tip - self._from.tip
        beside = norm(way - (way @ self._from.axis) * self._from.axis)
        leads = straight_trajectory if beside < START_TOLERANCE_MM else approach_trajectory
        found = self._done(*leads(self._task.machine, here, self._from, tool_length, APPROACH_MM_S))
        if found:
            raise Refused(found)
        self._from = None

    def _done(self, way: Trajectory | None, diagnostics: Diagnostics) -> Diagnostics:
        """Plan and execute a move; return the reasons against it."""
        task, plan = self._task, None
        if way is not None:
            plan, found = planned(way, task.machine, task.settings, TOLERANCES)
            diagnostics += found
        if plan is None:
            return errors(diagnostics)
        task.drive(plan, "the retract")
        return ()
