# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stops: continue after an M0 or M1, where the program ends until the operator starts it again.

The controller's state is the same at a stop as after the end or an abort: no program runs. ``R`` would continue from
wherever the program is, and after an abort that is in the middle of a move. So nothing is resumed: the part after the
stop is loaded as a separate program, under the job's number, and started like any other if the struts stand where the
program stopped. Events at that knot before the stop were already carried out and are left out.

Enters: the program and the number of a stop. Leaves: a job that begins after it, and the state after the start.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.control.link.faults import NotReadyError
from pkm_post.control.link.job import Job, read_job
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Array, Status
from pkm_post.control.numerical_control.execute import execute
from pkm_post.model import EventKind, Machine, StrutMotion
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PmacSettings, parted, program_text


@dataclass(frozen=True)
class Stop:
    """An M0 or M1 with moves after it.

    Attributes:
        number: of the stop in its program, from 1.
        event: index among the events of the motion.
        length: (6,) strut lengths at it, mm.
    """

    number: int
    event: int
    length: Array


def stops_of(job: Job) -> tuple[Stop, ...]:
    """The stops of a program; one at its very end does not count, as no move follows."""
    events, last = job.motion.events, len(job.motion) - 1
    places = [index for index, each in enumerate(events) if each.kind is EventKind.STOP and each.row < last]
    return tuple(Stop(number, index, job.motion.length[events[index].row]) for number, index in enumerate(places, 1))


def job_behind(job: Job, stop: Stop, settings: PmacSettings) -> Job:
    """The part of a program after a stop, under the number of the job.

    Args:
        job: the program.
        stop: one of ``stops_of``.
        settings: of the controller it was written for.
    """
    row = job.motion.events[stop.event].row
    rest = replace(job.motion, events=job.motion.events[stop.event + 1 :])
    motion = parted(rest, [row])[-1] if row else rest
    return job_of(motion, replace(settings, program=job.program.number), f"behind stop {stop.number}")


def job_of(motion: StrutMotion, settings: PmacSettings, name: str) -> Job:
    """Turn part of a program into a program.

    Args:
        motion: of the part.
        settings: of the controller, with its program number.
        name: for diagnostics.

    Raises:
        ValueError: its text does not reproduce its motion.
    """
    job, faults = read_job(program_text(motion, settings, [name]), settings, name)
    if job is None or not same(job.motion, motion):
        raise ValueError(f"{name}: expected a text that gives its motion back, got {faults}")
    return job


def same(one: StrutMotion, other: StrutMotion) -> bool:
    """Whether two motions are identical to the last digit."""
    return one.events == other.events and all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("time_ms", "length", "speed")
    )


def go_on(
    session: Session, machine: Machine, settings: PmacSettings, job: Job, number: int, near: float = START_TOLERANCE_MM
) -> Status:
    """Load the part of a program after a stop and start it.

    Args:
        session: an open session.
        machine: the machine.
        settings: of its controller.
        job: the program that has stopped.
        number: of the stop, from 1. It is stated, not inferred from the strut lengths: several stops may share a
            position, and a program that was never started may begin there.
        near: largest distance of each strut from it, mm.

    Raises:
        NotReadyError: the stop does not exist, or the struts do not stand at it; or as ``execute.execute``.
        DownloadError: the download failed; nothing was started.
    """
    stops = stops_of(job)
    if not 1 <= number <= len(stops):
        told = f"the program has {len(stops)} stops (M0, M1) with moves after them: there is none with number {number}"
        raise NotReadyError([told])
    return execute(session, machine, settings, job_behind(job, stops[number - 1], settings), near)
