# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC actions: the actions of the command ``pmac`` on a connected controller; each returns its exit code."""

from __future__ import annotations

import argparse
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from pkm_post.cli.inputs import tool_length_of
from pkm_post.cli.pmac_manual import watched
from pkm_post.cli.pmac_stop import (
    Actions,
    JobTarget,
    ProgramTarget,
    Target,
    abort,
    held_at_the_end,
    hold,
    print_state,
    signals_interrupt,
)

if TYPE_CHECKING:
    from pkm_post.control.link import Session

_IDENTITY = ("TYPE", "VER", "CID", "SIZE", "I42", "I68")
_IDENTITY_OF_POWER_PMAC = ("CID", "Sys.MaxCoords")
_CLEAR_SCREEN = "\x1b[H\x1b[J"
_QUESTION = (
    r"#\d+[?PVF]|&\d+(?:\?\??|PR|%)|\?{1,3}|[PVF%]|PR|SIZE|TYPE|VER(?:SION)?|CID|[IPQ]\d+(?:\.\.\d+)?|(?:&\d+)?#\d+->"
)
_STOP = r"(?:&\d+)?[HA]|#\d+K|P8187\.\.8191=0"
_LISTING = r"LIST (?:PC|PE|(?:PROG|PLC) ?\d+(?:,\d*){0,2})"
"""Nothing may follow: a controller also executes the second command of ``LIST PC #1J+``."""
_NEEDS_NO_OWNERSHIP = re.compile(
    rf"(?:{_QUESTION}|{_STOP})(?: (?:{_QUESTION}|{_STOP}))*|{_LISTING}|[\w.]+\[[\w.\[\]]+", re.IGNORECASE
)
"""Terminal lines that only query, stop, or clear the variables of the machine's owner."""


def probe(session: Session, target: Target | None, namespace: argparse.Namespace) -> int:
    """Print the controller type; raise on settings that do not match the machine."""
    from pkm_post.control.link import RefusedError, check_setup

    is_power = namespace.port.is_power
    for query in _IDENTITY_OF_POWER_PMAC if is_power else _IDENTITY:
        try:
            print(f"{query}: {' '.join(session.query(query)).removeprefix(f'{query}=')}")
        except RefusedError as refused:
            print(f"{query}: {refused}")
    _print_motion(session, target)
    if target is not None:
        check_setup(session, target.settings, target.machine.strut_stroke)
        print(f"set up for {target.machine.name}")
    return 0


def _print_motion(session: Session, target: Target | None) -> None:
    """Print whether the machine moves; approximate without a machine, as coordinate system and scale are unknown."""
    from pkm_post.control.link import activity_text, is_busy, settled_status

    if target is not None:
        print(activity_text(settled_status(session, target.settings)))
    else:
        print("a program runs, or a motor moves" if is_busy(session) else "no program runs, and no motor moves")


def download(session: Session, target: ProgramTarget, namespace: argparse.Namespace) -> int:
    """Load the program, list it back and compare; a program of tip and axis checks the set-up itself by its guard."""
    from pkm_post.control.link import check_setup, download

    if target.is_of_struts:
        check_setup(session, target.settings, target.machine.strut_stroke)
    loaded = download(session, target.program, _shown("{} of {} lines"))
    if not target.is_of_struts:
        print("of tip and axis: start it at the controller, with the kinematics; its guard ends it without them")
    print(f"program {loaded.program}: {loaded.lines} lines, listed back as sent, SHA-256 {loaded.digest}")
    return 0


def _shown(text: str) -> Callable[..., None]:
    """Progress that rewrites one line of a terminal with numbers of lines: first those done, last their total."""

    def show(*lines: int) -> None:
        if sys.stderr.isatty():
            end = "\n" if lines[0] == lines[-1] else ""
            print(f"\r{text.format(*lines)}", end=end, file=sys.stderr, flush=True)

    return show


def start(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Start the program from its beginning, and watch it."""
    from pkm_post.control.link import check_setup, start_program

    check_setup(session, target.settings, target.machine.strut_stroke)
    job = target.job
    with held_at_the_end(session, target.settings):
        status = start_program(session, target.settings, job.program, job.first, namespace.near, target.machine)
        return watched(session, target, namespace, status)


def resume(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Resume after a hold."""
    from pkm_post.control.link import resume_program, watch_resumed

    return print_state(watch_resumed(session, target.settings, resume_program(session, target.settings)))


def status(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Print the state once."""
    from pkm_post.control.link import read_status

    return print_state(read_status(session, target.settings))


def monitor(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Print pose and state until the user interrupts."""
    from pkm_post.control.link import ToolPoseReadout, pose_text, read_status, state_text

    readout = ToolPoseReadout(target.machine, tool_length_of(namespace, target.machine))
    before = _CLEAR_SCREEN if sys.stdout.isatty() else ""
    began = due = time.monotonic()
    try:
        while namespace.seconds is None or due - began <= namespace.seconds:
            status = read_status(session, target.settings)
            print(f"{before}{pose_text(readout.pose(status))}\n{state_text(status)}\n", flush=True)
            due = max(due + 1 / namespace.rate, time.monotonic())
            time.sleep(max(due - time.monotonic(), 0))
    except KeyboardInterrupt:
        pass  # the regular end
    return 0


def terminal(session: Session, target: Target | None, namespace: argparse.Namespace) -> int:
    """Send each line once; all but known queries and stops need the right to move the machine."""
    from pkm_post.control.link import NotOwnerError, PmacError, claim

    refused = False
    for line in sys.stdin:
        if not line.strip():
            continue
        try:
            if session.keeper is None and not _NEEDS_NO_OWNERSHIP.fullmatch(line.strip()):
                claim(session, "terminal")
            print("\n".join(session.command(line.strip())) or "done", flush=True)
        except (PmacError, ValueError) as fault:
            refused |= isinstance(fault, NotOwnerError)
            print(fault, flush=True)
    return int(refused)


ROTARY_WORDS = 2600
"""Default size of the rotary buffer: 200 lines of 13 words."""


def stream(session: Session, target: JobTarget, namespace: argparse.Namespace) -> int:
    """Run the program from the rotary buffer."""
    from pkm_post.control.link import check_setup, stream

    check_setup(session, target.settings, target.machine.strut_stroke)
    job = target.job
    progress = _shown("{0} of {2} lines released, {1} sent")
    with signals_interrupt(), _interrupted_once() as is_cancelled:
        done = stream(
            session,
            target.settings,
            job.program,
            job.first,
            namespace.rotary,
            namespace.near,
            progress,
            is_cancelled,
            target.machine,
        )
    print(f"{done.lines} lines carried out in {done.segments} segments, SHA-256 {done.digest}")
    if done.resumptions:
        print(f"the link failed {done.resumptions} times; each time the program continued from a rest")
    return 0


@contextmanager
def _interrupted_once() -> Iterator[Callable[[], bool]]:
    """Yield whether the user has pressed Ctrl-C; the second time raises KeyboardInterrupt."""
    pressed: list[int] = []

    def press(number: int, frame: FrameType | None) -> None:
        if pressed and callable(before):
            before(number, frame)
            return
        pressed.append(number)
        print("\nthe machine stops where it rests next; Ctrl-C again stops it now", file=sys.stderr, flush=True)

    before = signal.signal(signal.SIGINT, press)
    try:
        yield lambda: bool(pressed)
    finally:
        signal.signal(signal.SIGINT, before)


ACTIONS: Actions = {
    "probe": (probe, "identify the controller, and check its set-up for the machine", ()),
    "download": (download, "load a program, list it back and compare", ("machine", "program")),
    "run": (start, "start a loaded program from its beginning", ("machine", "program")),
    "stream": (stream, "run a program too large to load, while sending it", ("machine", "program")),
    "hold": (hold, "slow the program down to rest on its path", ("machine",)),
    "resume": (resume, "continue after a hold", ("machine",)),
    "abort": (abort, "end the program: hold, then abort", ("machine",)),
    "status": (status, "show struts, following errors and faults", ("machine",)),
    "monitor": (monitor, "show them with the tool pose, repeatedly", ("machine",)),
    "terminal": (terminal, "send lines from standard input, each once", ()),
}

NOT_OF_POWER_PMAC = {"stream": "it is for the rotary buffer of a Turbo PMAC"}
"""Reasons why actions do not apply to a Power PMAC."""
