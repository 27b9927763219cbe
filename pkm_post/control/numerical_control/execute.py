# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execute: load a plan under its own program number, verify its listing, and start it from its first point.

Input: a session and a plan; only planning with its checks creates one. Output: the state after the start.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pkm_post.control.link import run as operate
from pkm_post.control.link.download import download
from pkm_post.control.link.errors import NotReadyError, PmacError
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.program import PmacJob, read_job
from pkm_post.control.link.queries import read_number
from pkm_post.control.link.run import check_override, check_start
from pkm_post.control.link.session import Session
from pkm_post.control.link.setup_check import check_setup
from pkm_post.control.link.status import AnySettings, Status, read_status
from pkm_post.control.numerical_control.watchdog import Watchdog, watchdog_of
from pkm_post.model import Array, EventKind, Machine, StrutMotion
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PowerPmacSettings, pmac, power_pmac, split_motion

_POLL_S = 0.05


def execute(
    session: Session, machine: Machine, settings: AnySettings, job: PmacJob, start_tolerance: float = START_TOLERANCE_MM
) -> Status:
    """Load a program and start it.

    Args:
        job: of a plan, or a single block of a program.
        start_tolerance: largest distance of each strut from its first point, mm.

    Raises:
        NotReadyError: setup or machine are not ready; nothing was loaded or started.
        DownloadError: the download failed; nothing was started.
        CancelledError: a stop came first; nothing was started.
        NotOwnerError: another client owns the machine; nothing was loaded.
    """
    with owned(session, "jog"):
        check_start(read_status(session, settings), job.first, start_tolerance, machine)
        check_setup(session, settings, machine.strut_stroke)
        download(session, job.program, is_cancelled=session.stop_pending)
        return operate.start_program(session, settings, job.program, job.first, start_tolerance, machine)


def execute_watched(
    session: Session, machine: Machine, settings: AnySettings, job: PmacJob, silence_s: float
) -> tuple[Status, Watchdog]:
    """Load a program with a watchdog and start it; unless renewed, the watchdog holds it. Otherwise as ``execute``.

    Args:
        job: of a plan.
        silence_s: longest time from silence to standstill, s.
    """
    watchdog = watchdog_of(settings, job.program, silence_s)
    return execute(session, machine, settings, replace(job, program=watchdog.program)), watchdog


def execute_marked(
    session: Session, machine: Machine, settings: AnySettings, job: PmacJob, start_tolerance: float = START_TOLERANCE_MM
) -> Status:
    """As ``execute``, with a last line that sets the P-variable with its number: an abort does not get there."""
    program = job.program
    session.query(f"P{program.number}=0")  # harmless if repeated
    lines = (*program.lines, f"P{program.number}=1")
    return execute(session, machine, settings, replace(job, program=replace(program, lines=lines)), start_tolerance)


def has_ended(session: Session, job: PmacJob) -> bool:
    """Whether a marked job has run to its end; no other state of a controller differs after an abort."""
    return read_number(session, f"P{job.program.number}") == 1


def wait_for_rest(
    session: Session, settings: AnySettings, seconds: float, meanwhile: Callable[[], None] = lambda: None
) -> Status:
    """Poll until no program runs and the struts are at rest.

    Args:
        seconds: timeout of the motion; a program at rest in a feed hold also ends the wait. While the struts stand, its
            codes wait, perhaps for a person who changes a tool, and only the link must live.
        meanwhile: called after each reading.

    Raises:
        PmacError: timeout, or an override above that of the plan; then the machine is held.
    """
    left, before = seconds, session.now()
    while True:
        status = read_status(session, settings)
        check_override(session, settings, status)
        if status.standing and (status.held or not status.running):
            return status
        now = session.now()
        left, before = left - (0.0 if status.standing else now - before), now
        if left < 0:
            raise PmacError(
                f"the machine does not come to rest within {seconds:g} s; HOLD IT, OR USE THE EMERGENCY STOP"
            )
        meanwhile()
        session.sleep(_POLL_S)


def target_deviation(status: Status, lengths: Array) -> float:
    """Largest deviation of a commanded strut length from its target, mm.

    Args:
        status: of struts at standstill.
        lengths: (6,) final lengths of a program, mm.
    """
    return float(np.abs(status.commanded - lengths).max())


@dataclass(frozen=True)
class ProgramStop:
    """An M0 or M1 that moves follow.

    Attributes:
        number: of the stop in its program, from 1.
        event: index among the events of the motion.
        length: (6,) strut lengths at the stop, mm.
    """

    number: int
    event: int
    length: Array


def program_stops(job: PmacJob) -> tuple[ProgramStop, ...]:
    """The stops of a program; one at the end does not count, as no move follows."""
    events, last = job.motion.events, len(job.motion) - 1
    places = [index for index, each in enumerate(events) if each.kind is EventKind.STOP and each.row < last]
    return tuple(
        ProgramStop(number, index, job.motion.length[events[index].row]) for number, index in enumerate(places, 1)
    )


def remaining_job(job: PmacJob, stop: ProgramStop, settings: AnySettings) -> PmacJob:
    """The part of a program after a stop, under the number of the job.

    Args:
        stop: one of ``program_stops``.
        settings: of the controller it was written for.
    """
    row = job.motion.events[stop.event].row
    rest = replace(job.motion, events=job.motion.events[stop.event + 1 :])
    motion = split_motion(rest, [row])[-1] if row else rest
    return job_of(motion, replace(settings, program=job.program.number), f"after stop {stop.number}")


def job_of(motion: StrutMotion, settings: AnySettings, name: str) -> PmacJob:
    """Turn part of a program into a program.

    Args:
        motion: of the part.
        settings: of the controller, with its program number.
        name: for diagnostics.

    Raises:
        ValueError: its text does not reproduce its motion.
    """
    kind: Any = power_pmac if isinstance(settings, PowerPmacSettings) else pmac
    job, faults = read_job(kind.program_text(motion, settings, [name]), settings, name)
    if job is None or not same_motion(job.motion, motion):
        raise ValueError(f"{name}: expected a text that gives its motion back, got {faults}")
    return job


def same_motion(one: StrutMotion, other: StrutMotion) -> bool:
    """Whether two motions are identical to the last digit."""
    pairs = [(getattr(one, name), getattr(other, name)) for name in ("time_ms", "length", "speed")]
    pairs += [(getattr(one.turns, name), getattr(other.turns, name)) for name in ("knot", "angle", "speed")]
    return one.events == other.events and all(np.array_equal(*pair) for pair in pairs)


def continue_after_stop(
    session: Session,
    machine: Machine,
    settings: AnySettings,
    job: PmacJob,
    number: int,
    start_tolerance: float = START_TOLERANCE_MM,
) -> Status:
    """Load the part of a program after a stop and start it.

    Args:
        job: the program that has stopped.
        number: of the stop, from 1. It cannot be inferred from the strut lengths: several stops may share a
            position, and the program may start there.
        start_tolerance: largest distance of each strut from the stop, mm.

    Raises:
        NotReadyError: the stop does not exist, or the struts are not at it; or as ``execute.execute``.
        DownloadError: the download failed; nothing was started.
    """
    stops = program_stops(job)
    if not 1 <= number <= len(stops):
        reason = f"the program has {len(stops)} stops (M0, M1) with moves after them: there is no stop {number}"
        raise NotReadyError([reason])
    return execute(session, machine, settings, remaining_job(job, stops[number - 1], settings), start_tolerance)
