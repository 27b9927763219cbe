# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control: one machine behind one session, for the command line and for a panel.

Every method talks to the controller, waits no longer than its deadlines say, and belongs to one thread; ``worker`` runs
it in one of its own. Plans are made first and executed after that: what the checks refuse never becomes a plan.

Enters: a session, a machine and what is in its spindle. Leaves: states and plans, frozen.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

from pkm_post.controllers.pmac import Settings
from pkm_post.model import Diagnostic, Machine, Trajectory
from pkm_post.model.certificate import Tolerances
from pkm_post.numerical_control import defaults, mdi, moves, stops
from pkm_post.numerical_control import execute as execution
from pkm_post.numerical_control.emergency import emergency_text
from pkm_post.numerical_control.homing import Homing, HomingWatch, Phase, check_trigger, missing_homes, start_homing
from pkm_post.numerical_control.plan import Plan, planned
from pkm_post.numerical_control.single_block import Blocks, Shown
from pkm_post.numerical_control.watchdog import Watchdog
from pkm_post.pmac_link import operate, stopping
from pkm_post.pmac_link.download import Loaded, Progress, download
from pkm_post.pmac_link.faults import CancelledError, LinkLostError, NotOwnerError, NotReadyError, PmacError
from pkm_post.pmac_link.job import Job
from pkm_post.pmac_link.motion import settled_status
from pkm_post.pmac_link.near import NEAR_MM
from pkm_post.pmac_link.ownership import take
from pkm_post.pmac_link.readout import Pose, Readout, standing_pose
from pkm_post.pmac_link.ready import check_setup
from pkm_post.pmac_link.session import Session
from pkm_post.pmac_link.status import Status, read_status

Findings = tuple[Diagnostic, ...]

Done = TypeVar("Done")
_log = logging.getLogger(__name__)

TOLERANCES = Tolerances(1e-3, math.radians(1e-3))
"""Of moves by hand: those that posting has unless the user says otherwise."""


@dataclass(frozen=True)
class State:
    """What there is to show; one reading.

    Attributes:
        status: of struts and program; the last one that was read when the link is lost, None before the first.
        pose: of the tool by the actual lengths; None when there is none, or no strut was ever read.
        lost: why there is no link; empty while there is one.
        emergency: what a person has to do, when the link was lost while the machine may move.
        homing: of a homing that was started here; None when none was.
        block: the block that comes next; None without single block.
    """

    status: Status | None
    pose: Pose | None
    lost: str = ""
    emergency: tuple[str, ...] = ()
    homing: Homing | None = None
    block: Shown | None = None


class NumericalControl:
    """A machine to look at and to operate."""

    def __init__(
        self,
        session: Session,
        machine: Machine,
        settings: Settings,
        tool_length: float,
        number: int = defaults.OWN_PROGRAM,
    ) -> None:
        """Make it; the session connects by itself when it is not open.

        Args:
            session: to the controller.
            machine: the machine.
            settings: of its controller.
            tool_length: gauge length of the tool in the spindle, mm; ``tool_length`` may be changed at any time.
            number: of the program of moves by hand and of single blocks, and of the variable P of their watchdogs.
        """
        self._session, self._machine, self._settings, self._number = session, machine, settings, number
        self._watch: HomingWatch | None = None
        self._blocks: tuple[Blocks, int] | None = None
        self._block: Shown | None = None
        self._last = State(None, None)
        self._may_move = False
        self._watchdog: Watchdog | None = None
        self._is_attended: Callable[[], bool] = lambda: True
        self.tool_length = tool_length

    def give_way_when(self, is_waited_for: Callable[[], bool]) -> None:
        """From now on leave what takes long, and start nothing, while ``is_waited_for`` says that a stop waits."""
        self._session.give_way_when(is_waited_for)

    def attended_while(self, is_attended: Callable[[], bool]) -> None:
        """From now on renew the watchdog of a jog only while ``is_attended`` says that somebody looks on."""
        self._is_attended = is_attended

    @property
    def tool_length(self) -> float:
        """Gauge length of the tool in the spindle, mm."""
        return self._tool_length

    @tool_length.setter
    def tool_length(self, length: float) -> None:
        if not (math.isfinite(length) and length > 0):
            raise ValueError(f"tool_length: expected a length above zero, got {length}")
        self._tool_length = length
        self._readout = Readout(self._machine, length)

    def poll(self) -> State:
        """Read everything once, and renew the watchdog of a jog; a lost link is a state, not an error."""
        try:
            status = read_status(self._session, self._settings)
            self._end_watch(status)
            self.renew()
        except CancelledError:
            return self._last  # a stop is in a hurry; the next reading tells
        except NotOwnerError as fault:
            _log.warning("%s", fault)
            if self._session.keeper is not None:
                self._session.keeper.release()
            return self._last
        except PmacError as fault:
            self._last = State(
                self._last.status, self._last.pose, str(fault), self._emergency(), self._last.homing, self._block
            )
            return self._last
        self._may_move = False
        self._give_back(status)
        homing = None if self._watch is None else self._watch.see(status, self._session.now())
        if homing is not None and homing.phase is not Phase.SEARCHING:
            self._watch = None
        elif homing is None:
            homing = self._last.homing
        self._last = State(status, self._readout.pose(status), homing=homing, block=self._block)
        return self._last

    def plan_jog(self, jog: moves.Jog, feed: float) -> tuple[Plan | None, Findings]:
        """Plan a jog from where the machine stands; ``feed`` in mm/s, of a turn in place in degrees per second.

        Raises:
            NotReadyError: nobody knows where the tool is, or it moves.
        """
        here = self._here()
        plan, told = self._planned(*moves.trajectory_of(jog, self._machine, here, self.tool_length, feed))
        return (None if plan is None else replace(plan, is_jog=True)), told

    def plan_line(self, line: str, reading: mdi.Reading | None = None) -> tuple[Plan | None, Findings]:
        """Plan a line of G-code from where the machine stands.

        Raises:
            NotReadyError: nobody knows where the tool is, or it moves.
        """
        return self._planned(*mdi.line_trajectory(line, self._machine, self._here(), self.tool_length, reading))

    def plan_approach(self, job: Job, feed: float = defaults.APPROACH_MM_S) -> tuple[Plan | None, Findings]:
        """Plan the way from where the machine stands to the start of a program; as ``moves.approach``.

        Raises:
            NotReadyError: nobody knows where the tool is, or it moves; or no pose belongs to the start.
        """
        here, start = self._here(), standing_pose(self._machine, job.first, self.tool_length)
        if start is None:
            raise NotReadyError(["no pose of the platform that small steps from home lead to is that of the start"])
        return self._planned(*moves.approach(self._machine, here, start, self.tool_length, feed))

    def execute(self, plan: Plan, near: float = NEAR_MM) -> Status:
        """Load a plan, list it back and start it; as ``execute.execute``.

        The controller holds a jog by itself when nobody calls ``poll``, ``renew`` or ``wait_for_rest`` any more.
        """
        order = self._session, self._machine, self._settings, plan.job
        if plan.is_jog:
            status, self._watchdog = self._owning("jog", lambda: execution.execute_watched(*order))
        else:
            status = self._owning("run", lambda: execution.execute(*order, near))
        if plan.block and self._blocks is not None:
            self._take_block(self._blocks[0], plan.block + 1)
        return status

    @property
    def silence_s(self) -> float | None:
        """After how many seconds of silence the struts stand, at most, at 100 %; None when no jog is under way."""
        return None if self._watchdog is None else self._watchdog.silence_s

    def renew(self) -> None:
        """Renew the watchdog of a jog, if one is under way and somebody looks on; several times a second."""
        if self._watchdog is not None and self._is_attended():
            self._watchdog.renew(self._session)

    def wait_for_rest(self, seconds: float) -> Status:
        """Watch until the machine rests, and renew the watchdog of a jog; as ``execute.wait_for_rest``."""
        status = execution.wait_for_rest(self._session, self._settings, seconds, self.renew)
        self._end_watch(status)
        return status

    def load(self, job: Job, progress: Progress, is_cancelled: Callable[[], bool]) -> Loaded:
        """Load a program and list it back, when the controller is set up for the machine; as ``download.download``.

        A stop that waits ends it as ``is_cancelled`` does.
        """
        check_setup(self._session, self._settings, self._machine.strut_stroke)
        return download(self._session, job.program, progress, lambda: is_cancelled() or self._session.is_waited_for())

    def start(self, job: Job, near: float = NEAR_MM) -> Status:
        """Start a program that is loaded, from its beginning; as ``operate.run``."""
        order = self._session, self._settings, job.program, job.first, near, self._machine
        return self._owning("run", lambda: operate.run(*order))

    def go_on(self, job: Job, stop: int, near: float = NEAR_MM) -> Status:
        """Go on behind a stop (M0, M1) of a program, numbered from 1, at which it stands; as ``stops.go_on``."""
        return self._owning("run", lambda: stops.go_on(self._session, self._machine, self._settings, job, stop, near))

    def open_blocks(self, blocks: Blocks, at: int = 1) -> int:
        """Take a program for single block; how many blocks it has.

        Args:
            blocks: of the program.
            at: the block that comes next, from 1.

        Raises:
            ValueError: there is no such block.
        """
        if not 1 <= at <= len(blocks):
            raise ValueError(f"at: expected a block from 1 to {len(blocks)}, got {at}")
        self._take_block(blocks, at)
        return len(blocks)

    def plan_step(self) -> tuple[Plan | None, Findings]:
        """Plan the block that comes next, from where it begins; when it is executed, the one behind it comes next.

        Raises:
            ValueError: no program was taken for single block, or all its blocks have run.
        """
        if self._blocks is None or self._blocks[1] > len(self._blocks[0]):
            raise ValueError("plan_step: expected a block that comes next, got none")
        blocks, number = self._blocks
        block = blocks.block(number)
        plan, told = self._planned(block, (), block.tolerances or TOLERANCES)
        return (None if plan is None else replace(plan, block=number)), told

    def hold(self) -> Status:
        """Slow down to rest on the path."""
        return stopping.hold(self._session, self._settings)

    def resume(self) -> Status:
        """Go on after a hold; a jog whose watchdog had ended it goes on as well."""
        self.renew()
        return self._moving(lambda: operate.resume(self._session, self._settings))

    def abort(self, at_once: bool = False) -> Status:
        """End the program: held first unless at once; a homing is no longer watched."""
        self._watch, self._last = None, replace(self._last, homing=None)
        return stopping.abort(self._session, self._settings, at_once)

    def override(self, percent: float) -> Status:
        """Set the override, above 0 and up to 100 %."""
        return operate.override(self._session, self._settings, percent, self.renew)

    def home(self, trigger: str) -> None:
        """Send the line that starts the homing of the machine; ``poll`` watches it then."""
        check_trigger(trigger)
        self._watch = self._owning("home", lambda: start_homing(self._session, self._settings, trigger))

    def _end_watch(self, status: Status) -> None:
        """A program that has ended needs its watchdog no more."""
        if not status.running:
            self._watchdog = None

    def _take_block(self, blocks: Blocks, number: int) -> None:
        """Have a block come next."""
        self._blocks, self._block = (blocks, number), blocks.shown(number)

    def _emergency(self) -> tuple[str, ...]:
        """What to do now that the link is lost; nothing when there never was one."""
        if self._may_move:
            return emergency_text(None)
        return () if self._last.status is None else emergency_text(self._last.status)

    def _owning(self, what: str, order: Callable[[], Done]) -> Done:
        """Carry out what sets the machine in motion; the right to do so is kept until it is seen at rest."""
        keeper = self._session.keeper or take(self._session, what)
        try:
            return self._moving(order)
        except LinkLostError:
            raise  # it may move
        except BaseException:
            keeper.release()
            raise

    def _give_back(self, status: Status) -> None:
        """Let others move a machine that rests."""
        if self._session.keeper is not None and self._watch is None and status.standing and not status.running:
            self._session.keeper.release()

    def _moving(self, order: Callable[[], Done]) -> Done:
        """Carry out what may set the machine in motion; until the next reading it may move."""
        try:
            done = order()
        except LinkLostError:
            self._may_move = True
            raise
        self._may_move = True
        return done

    def _here(self) -> Pose:
        """The pose that the controller wants, of a machine that stands."""
        status = settled_status(self._session, self._settings)
        reasons = [f"strut {strut}: not homed" for strut in missing_homes(status)]
        reasons += ["a program runs, or is held"] if status.running else []
        reasons += [] if status.standing else ["a strut moves"]
        if reasons:
            raise NotReadyError(reasons)
        pose = standing_pose(self._machine, status.commanded, self.tool_length)
        if pose is None:
            raise NotReadyError(["no pose of the platform that small steps from home lead to has these strut lengths"])
        return pose

    def _planned(
        self, trajectory: Trajectory | None, told: Findings, tolerances: Tolerances = TOLERANCES
    ) -> tuple[Plan | None, Findings]:
        if trajectory is None:
            return None, told
        plan, faults = planned(trajectory, self._machine, self._settings, tolerances, self._number)
        return plan, told + faults
