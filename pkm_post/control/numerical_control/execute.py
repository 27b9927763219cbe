# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execute: load a plan under its own program number, verify its listing, and start it from its first point.

Enters: a session and a plan; only planning with its checks creates one. Leaves: the state after the start.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pkm_post.control.link import operate
from pkm_post.control.link.download import download
from pkm_post.control.link.faults import PmacError
from pkm_post.control.link.job import Job
from pkm_post.control.link.ownership import owned
from pkm_post.control.link.ready import check_setup, check_start
from pkm_post.control.link.session import Session
from pkm_post.control.link.status import Array, Status, read_status
from pkm_post.control.numerical_control.watchdog import Watchdog, watchdog_of
from pkm_post.model import Machine
from pkm_post.options import START_TOLERANCE_MM
from pkm_post.writing import PmacSettings

_POLL_S = 0.05


def execute(
    session: Session, machine: Machine, settings: PmacSettings, job: Job, near: float = START_TOLERANCE_MM
) -> Status:
    """Load a program and start it.

    Args:
        session: an open session.
        machine: the machine.
        settings: of its controller.
        job: of a plan, or a single block of a program.
        near: largest distance of each strut from its first point, mm.

    Raises:
        NotReadyError: setup or machine are not ready; nothing was loaded, or nothing was started.
        DownloadError: the download failed; nothing was started.
        CancelledError: a stop came first; nothing was started.
        NotOwnerError: another client owns the machine; nothing was loaded.
    """
    with owned(session, "jog"):
        check_start(read_status(session, settings), job.first, near, machine)
        check_setup(session, settings, machine.strut_stroke)
        download(session, job.program, is_cancelled=session.is_waited_for)
        return operate.run(session, settings, job.program, job.first, near, machine)


def execute_watched(session: Session, machine: Machine, settings: PmacSettings, job: Job) -> tuple[Status, Watchdog]:
    """Load a program with a watchdog and start it; unless renewed, the watchdog holds it. Otherwise as ``execute``."""
    dog = watchdog_of(session, settings, job.program)
    return execute(session, machine, settings, replace(job, program=dog.program)), dog


def wait_for_rest(
    session: Session, settings: PmacSettings, seconds: float, meanwhile: Callable[[], None] = lambda: None
) -> Status:
    """Poll until no program runs and the struts stand.

    Args:
        session: an open session.
        settings: of the controller.
        seconds: timeout; a program at rest in a feed hold also ends the wait.
        meanwhile: called after each reading.

    Raises:
        PmacError: timeout.
    """
    until = session.now() + seconds
    while True:
        status = read_status(session, settings)
        if status.standing and (status.held or not status.running):
            return status
        if session.now() > until:
            raise PmacError(
                f"the machine does not come to rest within {seconds:g} s; HOLD IT, OR USE THE EMERGENCY STOP"
            )
        meanwhile()
        session.sleep(_POLL_S)


def off_target(status: Status, lengths: Array) -> float:
    """Largest deviation of a commanded strut length from its target, mm.

    Args:
        status: of struts at standstill.
        lengths: (6,) final lengths of a program, mm.
    """
    return float(np.abs(status.commanded - lengths).max())
