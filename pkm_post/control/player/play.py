# SPDX-License-Identifier: LGPL-2.1-or-later
"""Play: run a trajectory on a controller while it is planned piece by piece.

A thread plans the next piece while the controller runs the earlier ones; the caller keeps the knot list ahead of it
(``run_to_rest``). The list always ends in a stop on the path. So a late computer, a dead link, an uncertified piece and
an override of 0 all end in that stop, from which the motion can continue.

Input: a session, a machine, a trajectory, orders of an operator. Output: states for display, and a log.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, replace

from pkm_post.control.link.download import download
from pkm_post.control.link.errors import CancelledError, LinkLostError, OverrideError, PmacError
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.run import check_override, set_feed_override, start_program
from pkm_post.control.link.session import Session
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.status import AnySettings, Status, read_status
from pkm_post.control.player.block_skip import chosen_parts
from pkm_post.control.player.certificate_log import CertificateLog
from pkm_post.control.player.certified_motion import MotionState
from pkm_post.control.player.knot_list import Layout, resident_program
from pkm_post.control.player.list_feed import ListFeed, ListPoint
from pkm_post.control.player.operator_input import OperatorInput
from pkm_post.control.player.orders import HELD_BACK, WAITS, Ahead, Order, PathProgress, PlayOptions, PlayState
from pkm_post.control.player.pieces import PiecePlanner
from pkm_post.control.player.retract import Retract
from pkm_post.control.player.run_to_rest import RunToRest, Timing
from pkm_post.control.player.sections import TrajectoryPart
from pkm_post.control.player.start_line import go_to_row
from pkm_post.control.player.stop_events import PlayContext, run_events
from pkm_post.model import EventKind, Machine, Phrase, Tolerances, Trajectory
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.planning import limits_jerk

_POLL_S = 0.02
_THREADS = 2
"""One plans pieces, the other the path of the next section."""
_MOST_RATE = 200.0
"""1/s: points of the plan; the list has room for some seconds."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class PlayResult:
    """Result of a play.

    Attributes:
        log: certificate of the played motion.
        stops: number of stops because the next piece came too late.
        losses: number of times the link was lost and came back.
        finished: whether the program ran to its end; the operator may end it earlier.
    """

    log: CertificateLog
    stops: int
    losses: int
    finished: bool


@dataclass(frozen=True)
class Callbacks:
    """Functions that the thread that plays calls; no-ops by default.

    Attributes:
        show: called with the state of the play several times a second.
        see: called with each status read.
        lose: called with the reason while there is no link.
        give_way: executes waiting stops (``Session.preempt_when``); returns whether to continue afterwards.
    """

    show: Callable[[PlayState], None] = lambda state: None
    see: Callable[[Status], None] = lambda status: None
    lose: Callable[[str], None] = lambda reason: None
    give_way: Callable[[], bool] = lambda: False


class Player:
    """Plays one trajectory.

    Attributes:
        log: the certificate of the played motion.
    """

    def __init__(
        self,
        session: Session,
        machine: Machine,
        settings: AnySettings,
        trajectory: Trajectory,
        tolerances: Tolerances,
        choices: PlayOptions | None = None,
        callbacks: Callbacks | None = None,
        planning: Executor | None = None,
    ) -> None:
        """Prepare; only ``play`` moves the machine.

        Args:
            planning: executor for planning; by default own threads.
        """
        self._session, self._machine, self._settings = session, machine, settings
        self._choices = choices or PlayOptions()
        self._whole, self._tolerances, skipped = self._choices.applied_to(trajectory), tolerances, self._choices.skipped
        self._skipped = None if skipped is None else self._choices.applied_to(skipped)
        self._operator, self._timing = OperatorInput(self._choices, limits_jerk(machine)), Timing()
        self._follow(self._whole)
        self._planning_machine = replace(machine, block_rate=min(machine.block_rate, _MOST_RATE))
        self._callbacks, self._planning = callbacks or Callbacks(), planning
        self._layout = Layout(self._choices.first_variable)
        self._feed = ListFeed(session, settings, self._layout)
        self._program = resident_program(self._layout, settings, self._choices.program)
        self._run: RunToRest | None = None
        self._stops, self._losses, self._is_waiting = 0, 0, False
        self._lost_at: float | None = None
        self._point: ListPoint | None = None
        self._row = self._choices.first_row
        self._retract = Retract(self._task)
        self.log = CertificateLog()

    def order(self, order: Order) -> None:
        """Give an order, from any thread."""
        self._operator.order(order)

    def play(self) -> PlayResult:
        """Play the trajectory to its end, or until the operator ends it.

        Raises:
            NotReadyError: the machine is not ready, or not at the start of the trajectory.
            Refused: a piece is not certified; the machine stops on the path.
            CancelledError: a stop came during the approach or the execution of codes, or the
                host ends the play; the list ends in a stop.
            PmacError: the controller or the link failed; the list ends in a stop.
        """
        session, settings = self._session, self._settings
        with owned(session, "play"):
            check_setup(session, settings, self._machine.strut_stroke)
            download(session, self._program)
            set_feed_override(session, settings, 100)
            self._begin()
            own = self._planning or ThreadPoolExecutor(_THREADS)
            try:
                row, skips = self._choices.first_row, lambda: self._operator.block_skip
                for trajectory, part in chosen_parts(self._whole, self._skipped, row, skips):
                    if trajectory is not self._trajectory:
                        self._follow(trajectory)
                    if not self._operator.is_over:
                        self._between(part)
                    if part.end > part.first and not self._operator.is_over:
                        self._play_part(part, own)
            finally:
                if self._planning is None:
                    own.shutdown(wait=False, cancel_futures=True)  # a stop must not wait for a plan
        return PlayResult(self.log, self._stops, self._losses, not self._operator.is_over)

    def _follow(self, trajectory: Trajectory) -> None:
        """Switch to the rows of another posting."""
        self._trajectory, self._way = trajectory, PathProgress(trajectory)
        setup, operator = self._choices.setup, self._operator
        self._task = PlayContext(self._session, self._machine, self._settings, trajectory, setup, operator)

    def _begin(self) -> None:
        """For a start inside the program, go there once the operator has loaded the tool."""
        row = self._choices.first_row
        if row or self._choices.approach:
            tool = self._trajectory.tools[int(self._trajectory.tool[row])]
            self._wait(f"T{tool.number}, {tool.length:g} mm long, in the spindle", row)
            if not self._operator.is_over:
                go_to_row(self._task, row, repeat_codes=self._choices.repeat_codes)

    def _between(self, part: TrajectoryPart) -> None:
        """Execute the events before a part; stops wait for the operator."""
        events = list(part.events)
        while events and not self._operator.is_over:
            at = next((n for n, each in enumerate(events) if each.kind is EventKind.STOP), len(events))
            if at:
                self._wait_if_held_back(part.first)
            if at and not self._operator.is_over:
                run_events(self._task, part.first, tuple(events[:at]))
            if at < len(events) and not events[at].value:
                self._wait("M0", part.first)
            elif at < len(events) and self._operator.optional_stop:
                self._wait("M1", part.first, until=lambda: not self._operator.optional_stop)
            events = events[at + 1 :]

    def _play_part(self, part: TrajectoryPart, planning: Executor) -> None:
        planner = PiecePlanner(
            self._trajectory, part, self._machine, self._settings, self._tolerances, self._planning_machine
        )
        self._feed.current = self._point = None  # of the part before, perhaps with another tool
        self._row = part.first
        operator, at, is_end = self._operator, planner.start(), False
        while not is_end and not operator.is_over:
            if operator.single_block:
                self._wait("single block")
            if operator.override == 0:
                what = HELD_BACK if operator.is_held_back else "override 0"
                self._wait(what, until=lambda: operator.override > 0)
            if operator.override > 0 and not operator.is_over:
                self._feed.clear()
                self._run = RunToRest(self._session, self._feed, planner, at, operator, planning)
                at, is_end = self._run_to_rest(self._run)

    def _run_to_rest(self, run: RunToRest) -> tuple[MotionState, bool]:
        """Run to the next rest; return its state, and whether the part ends there."""
        while True:
            status = self._look(run.is_started)
            if run.is_started and status is not None and not status.running and status.standing:
                run.time_late_piece(self._timing)
                self._stops += run.was_late()
                return run.rest(lambda: self._way.text(self._feed.current), status.fault_texts())
            if run.is_void():
                return run.begin, False
            try:
                run.steer()
                run.plan(self._timing)
                run.send(self._timing)
                if not run.is_started:
                    self._wait_if_held_back()
                if run.may_start(self._timing.lead_s):
                    self._start(run)
            except LinkLostError as lost:
                self._lose(lost)
            except CancelledError:
                continue  # a waiting stop is executed first
            self._session.sleep(_POLL_S)

    def _start(self, run: RunToRest) -> None:
        """Start the resident program at the start of the run."""
        order = self._session, self._settings, self._program, run.begin.length
        start_program(*order, START_TOLERANCE_MM, self._machine)
        run.is_started = True

    def _look(self, is_started: bool) -> Status | None:
        """Execute stops and orders, and read the state of the machine; None if unreadable.

        Raises:
            CancelledError: the host ends the play.
            PmacError: another client has set an override above 100 %, and the machine is held.
        """
        was_stopped = self._session.stop_pending()
        if was_stopped and not self._callbacks.give_way():
            raise CancelledError("the play was ended; what the controller has leads to a stop on the path")
        self._operator.is_held_back |= was_stopped
        try:
            self._operator.carry_out(self._session, self._settings)
            status = read_status(self._session, self._settings)
            if is_started:
                self._check_override(status)
                for motion in self._feed.poll():
                    self.log.add(motion)
            else:
                self._operator.look_elsewhere(self._session)
        except LinkLostError as lost:
            self._lose(lost)
            return None
        except CancelledError:
            return None
        self._callbacks.see(status)
        self._operator.is_held_back &= not status.held
        if self._lost_at is not None:
            self._losses, self._lost_at = self._losses + 1, None
            _log.warning("%s", Phrase("the link is back"))
        if not self._is_waiting:
            self._callbacks.show(self._state("held" if status.held else "runs" if status.running else "rests"))
        return status

    def _check_override(self, status: Status) -> None:
        """Hold the machine on its path at an override for which no piece is certified.

        Raises:
            PmacError: the override is above 100 %.
        """
        self.log.override = max(self.log.override, status.override)
        try:
            check_override(self._session, self._settings, status, self._way.text(self._feed.current))
        except OverrideError as fault:
            raise PmacError(f"{fault}; continue with --from-line") from fault

    def _lose(self, lost: LinkLostError) -> None:
        """Note that the link is lost.

        Raises:
            LinkLostError: the loss lasts too long.
        """
        now = self._session.now()
        if self._lost_at is None:
            self._lost_at = now
            _log.warning("%s", Phrase("the link is lost; the machine comes to rest on the path: {}", lost))
        if now - self._lost_at > self._choices.patience_s:
            raise lost
        self._callbacks.lose(str(lost))
        self._callbacks.show(self._state("no link"))
        self._session.sleep(_POLL_S)

    def _wait(self, what: str, row: int | None = None, until: Callable[[], bool] = lambda: False) -> None:
        """Wait until the operator starts or ends, or a condition holds."""
        operator = self._operator
        self._is_waiting = True
        self._look(False)
        operator.may_start, operator.retract_mm = False, 0.0  # orders given before it waits are not for this wait
        while not operator.is_over and (operator.is_held_elsewhere or not (operator.may_start or until())):
            self._look(False)
            if operator.retract_mm:
                self._retract.lift(operator.retract_mm, self._tool_length(row))
                operator.retract_mm = 0.0
            self._callbacks.show(self._state(WAITS + (HELD_BACK if operator.is_held_elsewhere else what), row))
            self._session.sleep(_POLL_S)
        if not operator.is_over:
            self._retract.back(self._tool_length(row))
        self._is_waiting = False
        operator.is_held_back &= not operator.may_start

    def _tool_length(self, row: int | None) -> float:
        """Gauge length of the tool in the spindle before a row, or at the current point, mm."""
        if row is None:
            row = self._row if self._point is None else int(self._point.motion.row[self._point.knot])
        return float(self._trajectory.tool_length()[min(row, len(self._trajectory) - 1)])

    def _wait_if_held_back(self, row: int | None = None) -> None:
        """If a hold came when nothing ran, here or from another client, wait for the resume."""
        operator = self._operator
        operator.look_elsewhere(self._session)
        if operator.is_held_back:
            self._wait(HELD_BACK, row, lambda: not operator.is_held_back)

    def _state(self, phase: str, row: int | None = None) -> PlayState:
        reached = 0.0 if self._run is None else self._run.reached
        self._point = self._feed.current or self._point  # an empty list has no position
        if row is None and self._point is None:
            row = self._row
        ahead = Ahead(self._feed.ahead_ms, self._feed.last, self._timing.slower)
        return self._way.state(self._point, phase, self._operator.override, reached, ahead, row)
