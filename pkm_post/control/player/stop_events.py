# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stop events: tool change, spindle, coolant and dwell between two parts of a program, while the machine rests.

The codes are those of posted programs, and are sent the same way: as a program that moves the tip by a millionth of a
millimetre, so that it can be certified, listed and started.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.control.link.errors import PmacError
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import AnySettings, Status, settled_status
from pkm_post.control.link.tool_pose import pose_from_home
from pkm_post.control.numerical_control.execute import execute, execute_marked, has_ended, wait_for_rest
from pkm_post.control.numerical_control.manual_moves import stationary_trajectory
from pkm_post.control.numerical_control.plan import MovePlan, planned
from pkm_post.control.player.operator_input import OperatorInput
from pkm_post.control.player.sections import rows_of
from pkm_post.model import EMPTY_SETUP, Event, Machine, Setup, Tolerances, Trajectory, required
from pkm_post.toolpath import ToolPose

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
_POLL_S = 0.05
_SLOWEST, _MORE_S = 0.05, 30.0
"""Timeout of a move: its time at this override, plus this margin."""
_LONGEST_S = 30.0
"""Longest time of the motion beside codes, a millionth of a millimetre; the codes themselves may take any time."""


def pose_before(trajectory: Trajectory, row: int) -> tuple[ToolPose, float]:
    """The tool pose at the start of a row, or at the end of the trajectory; and the gauge length of the tool."""
    lengths = trajectory.tool_length()
    if row < len(trajectory):
        return ToolPose.at_start(rows_of(trajectory, row, row + 1)), float(lengths[row])
    return ToolPose(trajectory.tip[-1], trajectory.axis[-1], float(trajectory.spin[-1])), float(lengths[-1])


@dataclass(frozen=True)
class PlayContext:
    """The program being played, and its machine.

    Attributes:
        setup: part, stock and fixtures, where known.
        operator: orders that are executed while a move by hand runs; None if there are none.
    """

    session: Session
    machine: Machine
    settings: AnySettings
    trajectory: Trajectory
    setup: Setup = EMPTY_SETUP
    operator: OperatorInput | None = None

    def attend(self) -> None:
        """Execute the orders of the operator during a move by hand."""
        if self.operator is not None:
            self.operator.carry_out(self.session, self.settings, by_hand=True)

    def pose(self, tool_length: float) -> ToolPose | None:
        """The pose of the tool at rest; None if it is unknown."""
        return pose_from_home(self.machine, settled_status(self.session, self.settings).commanded, tool_length)

    def drive(self, plan: MovePlan, name: str) -> None:
        """Execute a planned move to its end.

        Raises:
            PmacError: machine or link are not ready, or the move did not end.
        """
        execute(self.session, self.machine, self.settings, plan.job)
        self.wait_for_end(_MORE_S + plan.seconds / _SLOWEST, name)

    def wait_for_end(self, seconds: float, name: str) -> None:
        """Wait for the end of a named move by hand.

        Raises:
            PmacError: as ``wait_for_rest``, or the move did not end.
        """
        status = self.wait_for_rest(seconds)
        if status.running or status.fault_texts():
            raise PmacError(f"{name} did not end: " + "; ".join(status.fault_texts() or ("held",)))

    def wait_for_rest(self, seconds: float) -> Status:
        """The state at the end of a move by hand; a hold of the operator lasts until the resume or the end of the play.

        Raises:
            PmacError: as ``execute.wait_for_rest``.
        """
        while True:
            status = wait_for_rest(self.session, self.settings, seconds, self.attend)
            operator = self.operator
            if not status.held or operator is None or not operator.holds_move or operator.is_over:
                return status
            self.session.sleep(_POLL_S)
            self.attend()


def run_events(task: PlayContext, row: int, events: tuple[Event, ...]) -> None:
    """Execute the events before a row, and wait for their end.

    Raises:
        Refused: the events cannot be planned.
        PmacError: machine or link are not ready, or a fault ends the events.
    """
    machine, settings = task.machine, task.settings
    here, length = pose_before(task.trajectory, row)
    at_rest = tuple(Event(0, each.kind, each.value) for each in events)
    plan = required(*planned(stationary_trajectory(machine, here, length, at_rest), machine, settings, TOLERANCES))
    execute_marked(task.session, machine, settings, plan.job)
    task.wait_for_end(_LONGEST_S, "the codes between two moves")
    if not has_ended(task.session, plan.job):
        raise PmacError("the codes between two moves were ended from elsewhere; continue with --from-line")
