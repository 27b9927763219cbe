# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control: one machine behind one session, for the command line and for a panel.

Every method talks to the controller, returns within its deadlines, and must be called from one thread; ``worker``
provides one. Plans are made first and executed later: a move that fails its checks never becomes a plan.

Input: a session, a machine and its gauge length. Output: states and plans, frozen.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from pkm_post.control.link import run, stopping
from pkm_post.control.link.download import DownloadResult, Progress, download
from pkm_post.control.link.errors import (
    CancelledError,
    LinkLostError,
    NotOwnerError,
    NotReadyError,
    OverrideError,
    PmacError,
)
from pkm_post.control.link.ownership import claim
from pkm_post.control.link.program import PmacJob
from pkm_post.control.link.session import Session
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.status import AnySettings, Status, read_status
from pkm_post.control.link.tool_pose import ToolPoseReadout, pose_from_home
from pkm_post.control.numerical_control import execute, manual_moves, mdi
from pkm_post.control.numerical_control.control_state import ControlState
from pkm_post.control.numerical_control.homing import (
    HomingPhase,
    HomingWatch,
    check_trigger,
    standing_pose,
    start_homing,
)
from pkm_post.control.numerical_control.plan import MovePlan, planned
from pkm_post.control.numerical_control.rehearsal import Silence, longest_silence
from pkm_post.control.numerical_control.single_block import BlockDisplay, ProgramBlocks
from pkm_post.control.numerical_control.watchdog import Watchdog
from pkm_post.model import Diagnostic, Diagnostics, Machine, Phrase, Place, Tolerances, Trajectory, errors
from pkm_post.options import APPROACH_MM_S, MANUAL_MOVE_PROGRAM, START_TOLERANCE_MM
from pkm_post.toolpath import ToolPose

Done = TypeVar("Done")
_log = logging.getLogger(__name__)

TOLERANCES = Tolerances(1e-3, math.radians(1e-3))
"""Tolerances of manual moves: the posting defaults."""


class NumericalControl:
    """Monitors and operates a machine."""

    def __init__(
        self,
        session: Session,
        machine: Machine,
        settings: AnySettings,
        tool_length: float,
        number: int = MANUAL_MOVE_PROGRAM,
    ) -> None:
        """Create the control; the session connects on first use if it is not open.

        Args:
            session: to the controller.
            tool_length: gauge length of the tool in the spindle, mm; ``tool_length`` can be set at any time.
            number: program number of manual moves and single blocks, and number of the P-variable of their watchdogs.
        """
        self._session, self._machine, self._settings, self._number = session, machine, settings, number
        self._watch: HomingWatch | None = None
        self._blocks: tuple[ProgramBlocks, int] | None = None
        self._block: BlockDisplay | None = None
        self._last = ControlState(None, None)
        self._may_move = False
        self._watchdog: Watchdog | None = None
        self._silence: Silence | None = None
        self._is_operator_present: Callable[[], bool] = lambda: True
        self.tool_length = tool_length

    def preempt_when(self, stop_pending: Callable[[], bool]) -> None:
        """Abandon long operations and start none while ``stop_pending`` is true."""
        self._session.preempt_when(stop_pending)

    def attended_while(self, is_attended: Callable[[], bool]) -> None:
        """Renew the watchdog of a jog only while ``is_attended`` is true, that is, the operator is watching."""
        self._is_operator_present = is_attended

    @property
    def tool_length(self) -> float:
        """Gauge length of the tool in the spindle, mm."""
        return self._tool_length

    @tool_length.setter
    def tool_length(self, length: float) -> None:
        if not (math.isfinite(length) and length > 0):
            raise ValueError(f"tool_length: expected a length above zero, got {length}")
        self._tool_length = length
        self._readout = ToolPoseReadout(self._machine, length)

    def poll(self) -> ControlState:
        """Read the state once and renew the watchdog of a jog; a lost link is a state, not an error."""
        try:
            status = read_status(self._session, self._settings)
            self._drop_watchdog(status)
            self.renew()
            if self._session.keeper is not None:  # others watch what they started themselves
                run.check_override(self._session, self._settings, status)
        except CancelledError:
            return self._last  # a stop has priority; the next reading catches up
        except (NotOwnerError, OverrideError) as fault:
            _log.warning("%s", fault)
            self._last = replace(self._last, note=str(fault))
            if isinstance(fault, NotOwnerError) and self._session.keeper is not None:
                self._session.keeper.release()
            return self._last
        except PmacError as fault:
            self._last = replace(self._last.without_link(str(fault), self._may_move), block=self._block)
            return self._last
        self._may_move = False
        self._release_at_rest(status)
        homing = self._last.homing if self._watch is None else self._watch.see(status, self._session.now())
        if homing is not None and homing.phase is not HomingPhase.SEARCHING:
            self._watch = None
        note = self._last.note if status.running else ""
        self._last = ControlState(status, self._readout.pose(status), homing=homing, block=self._block, note=note)
        return self._last

    def see(self, status: Status) -> ControlState:
        """The state from a status read by an order in progress, such as a play."""
        self._last = replace(self._last, status=status, pose=self._readout.pose(status), lost="", emergency=())
        return self._last

    def lose(self, reason: str) -> ControlState:
        """The state while an order in progress, such as a play, has no link."""
        self._last = self._last.without_link(reason, may_move=True)
        return self._last

    def plan_jog(self, jog: manual_moves.Jog, feed: float) -> tuple[MovePlan | None, Diagnostics]:
        """Plan a jog from the current pose; ``feed`` in mm/s, for a turn in place in degrees per second.

        Raises:
            NotReadyError: the tool pose is unknown, or the machine moves.
        """
        here = self.standing_pose()
        made, faults = manual_moves.jog_trajectory(jog, self._machine, here, self.tool_length, feed)
        plan, diagnostics = self._plan(made, faults)
        if made is not None and any(fault.code.startswith("K1") for fault in errors(diagnostics)):
            diagnostics += (Diagnostic("C228", Place(made.source), Phrase("what is in the way is reported before")),)
        return (None if plan is None else replace(plan, is_jog=True)), diagnostics

    def plan_line(self, line: str, reading: mdi.MdiSettings | None = None) -> tuple[MovePlan | None, Diagnostics]:
        """Plan a line of G-code from the current pose.

        Raises:
            NotReadyError: the tool pose is unknown, or the machine moves.
        """
        here = self.standing_pose()
        return self._plan(*mdi.mdi_trajectory(line, self._machine, here, self.tool_length, reading))

    def plan_approach(
        self,
        job: PmacJob,
        feed: float = APPROACH_MM_S,
        free: float = -math.inf,
        check: Callable[[Trajectory], Diagnostics] = lambda approach: (),
    ) -> tuple[MovePlan | None, Diagnostics]:
        """Plan the approach from the current pose to the start of a program; as ``manual_moves.approach_trajectory``.

        Args:
            feed: mm/s; for a turn in place, degrees per second.
            free: z in {M} above which the approach may cross, mm; unknown by default.
            check: collision check of the approach; an error prevents the plan.

        Raises:
            NotReadyError: the tool pose is unknown, the machine moves, or the start has no pose.
        """
        here, start = self.standing_pose(), pose_from_home(self._machine, job.first, self.tool_length)
        if start is None:
            raise NotReadyError(["no pose of the platform reachable in small steps from home is that of the start"])
        approach, found = manual_moves.approach_trajectory(self._machine, here, start, self.tool_length, feed, free)
        if approach is not None:
            found += check(approach)
        return self._plan(None if errors(found) else approach, found)

    def execute(self, plan: MovePlan, start_tolerance: float = START_TOLERANCE_MM) -> Status:
        """Load a plan, verify its listing and start it; as ``execute.execute``.

        The controller holds a jog by itself unless ``poll``, ``renew`` or ``wait_for_rest`` are called.
        """
        order = self._session, self._machine, self._settings, plan.job
        if plan.is_jog:
            silence = self.longest_silence_s()
            status, self._watchdog = self._with_ownership("jog", lambda: execute.execute_watched(*order, silence))
        else:
            status = self._with_ownership("run", lambda: execute.execute_marked(*order, start_tolerance))
        if plan.block and self._blocks is not None:
            self._set_next_block(self._blocks[0], plan.block + 1)
        return status

    def has_ended(self, plan: MovePlan) -> bool:
        """Whether an executed plan at rest has run to its end; of a jog, its target lengths show it."""
        return plan.is_jog or execute.has_ended(self._session, plan.job)

    @property
    def silence_s(self) -> float | None:
        """Longest time from silence to standstill at 100 %, s; None if no jog is active."""
        return None if self._watchdog is None else self._watchdog.silence_s

    def longest_silence_s(self) -> float:
        """Longest time from silence to standstill of a jog, s; measured on a Power PMAC, as in ``longest_silence``."""
        order = self._session, self._machine, self._settings, self._number, self._silence
        self._silence = self._with_ownership("jog", lambda: longest_silence(*order))
        return self._silence.seconds

    def renew(self) -> None:
        """Renew the watchdog of an active jog while the operator is watching; call several times a second."""
        if self._watchdog is not None and self._is_operator_present():
            self._watchdog.renew(self._session)

    def wait_for_rest(self, seconds: float) -> Status:
        """Poll until the machine rests, and renew the watchdog of a jog; as ``execute.wait_for_rest``."""
        status = execute.wait_for_rest(self._session, self._settings, seconds, self.renew)
        self._drop_watchdog(status)
        return status

    def load(self, job: PmacJob, progress: Progress, is_cancelled: Callable[[], bool]) -> DownloadResult:
        """Check the controller's setup, load a program and verify its listing; as ``download.download``.

        A waiting stop cancels the download.
        """
        check_setup(self._session, self._settings, self._machine.strut_stroke)
        return download(self._session, job.program, progress, lambda: is_cancelled() or self._session.stop_pending())

    def start(self, job: PmacJob, start_tolerance: float = START_TOLERANCE_MM) -> Status:
        """Check the controller's setup and start a loaded program from its beginning; as ``run.start_program``."""
        check_setup(self._session, self._settings, self._machine.strut_stroke)
        order = self._session, self._settings, job.program, job.first, start_tolerance, self._machine
        return self._with_ownership("run", lambda: run.start_program(*order))

    def continue_after_stop(self, job: PmacJob, stop: int, start_tolerance: float = START_TOLERANCE_MM) -> Status:
        """Continue a program after its stop (M0, M1) of this number, from 1; as ``execute.continue_after_stop``."""
        order = self._session, self._machine, self._settings, job, stop, start_tolerance
        return self._with_ownership("run", lambda: execute.continue_after_stop(*order))

    def open_blocks(self, blocks: ProgramBlocks, at: int = 1) -> int:
        """Open a program in single block mode; return its number of blocks.

        Args:
            blocks: of the program.
            at: the next block, from 1.

        Raises:
            ValueError: there is no such block.
        """
        if not 1 <= at <= len(blocks):
            raise ValueError(f"at: expected a block from 1 to {len(blocks)}, got {at}")
        self._set_next_block(blocks, at)
        return len(blocks)

    def plan_step(self) -> tuple[MovePlan | None, Diagnostics]:
        """Plan the next block from its start; executing it advances to the block after it.

        Raises:
            ValueError: no program is open in single block mode, or all its blocks have run.
        """
        if self._blocks is None or self._blocks[1] > len(self._blocks[0]):
            raise ValueError("plan_step: expected a block that comes next, got none")
        blocks, number = self._blocks
        block = blocks.block(number)
        plan, diagnostics = self._plan(block, (), block.tolerances or TOLERANCES)
        return (None if plan is None else replace(plan, block=number)), diagnostics

    def hold(self) -> Status:
        """Feed hold: slow down to rest on the path."""
        return stopping.hold(self._session, self._settings)

    def resume(self) -> Status:
        """Resume after a hold; also a jog held by its watchdog."""
        self.renew()
        return self._execute_motion(lambda: run.resume_program(self._session, self._settings))

    def abort(self, at_once: bool = False) -> Status:
        """Abort the program, after a hold unless ``at_once``, and stop watching a homing."""
        self._watch, self._last = None, replace(self._last, homing=None)
        return stopping.abort(self._session, self._settings, at_once)

    def override(self, percent: float) -> Status:
        """Set the feed override, 0.01 to 100 %."""
        return run.set_feed_override(self._session, self._settings, percent, self.renew)

    def home(self, trigger: str) -> None:
        """Send the line that starts the homing of the machine; ``poll`` then watches it."""
        check_trigger(trigger)
        self._watch = self._with_ownership("home", lambda: start_homing(self._session, self._settings, trigger))

    def _set_next_block(self, blocks: ProgramBlocks, number: int) -> None:
        self._blocks, self._block = (blocks, number), blocks.shown(number)

    def _drop_watchdog(self, status: Status) -> None:
        if not status.running:
            self._watchdog = None

    def _with_ownership(self, what: str, order: Callable[[], Done]) -> Done:
        """Execute an order that moves the machine; keep ownership until the machine is seen at rest."""
        keeper = self._session.keeper or claim(self._session, what)
        try:
            return self._execute_motion(order)
        except LinkLostError:
            raise  # the machine may move
        except BaseException:
            keeper.release()
            raise

    def _release_at_rest(self, status: Status) -> None:
        if self._session.keeper is not None and self._watch is None and status.standing and not status.running:
            self._session.keeper.release()

    def _execute_motion(self, order: Callable[[], Done]) -> Done:
        """Execute an order that may move the machine; it counts as moving until the next reading."""
        try:
            done = order()
        except LinkLostError:
            self._may_move = True
            raise
        self._may_move = True
        return done

    def standing_pose(self) -> ToolPose:
        """The commanded pose of the machine; as ``homing.standing_pose``."""
        return standing_pose(self._session, self._settings, self._machine, self.tool_length)

    def _plan(
        self, trajectory: Trajectory | None, diagnostics: Diagnostics, tolerances: Tolerances = TOLERANCES
    ) -> tuple[MovePlan | None, Diagnostics]:
        if trajectory is None:
            return None, diagnostics
        plan, faults = planned(trajectory, self._machine, self._settings, tolerances, self._number)
        return plan, diagnostics + faults
