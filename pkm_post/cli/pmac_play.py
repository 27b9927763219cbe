# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC play: the action play of the command ``pmac``, with orders from the standard input while it plays."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.pmac_stop import held_at_the_end
from pkm_post.options import between, count, positive, whole

if TYPE_CHECKING:
    from pkm_post.cli.pmac_stop import Target
    from pkm_post.control.link import Session
    from pkm_post.control.player import Player, PlayOptions, PlayResult, PlayState
    from pkm_post.model import Trajectory

    Action = Callable[[Session, Any, argparse.Namespace], int]

_HIGHEST_PERCENT = 150.0
_HIGHEST_PROGRAM = 999
_FIRST_VARIABLES = whole(1, 7000)
_SHOW_S = 1.0
_ORDERS = "override PERCENT, hold, resume, single on, single off, start, end"
_WAITS = "waits"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the action."""
    from pkm_post.options import PLAYER_PROGRAM

    parser.add_argument("trajectory", type=Path, metavar="FILE.pkmt", help="the trajectory that was posted")
    percent = between(0, _HIGHEST_PERCENT)
    parser.add_argument(
        "--override", type=percent, default=100.0, metavar="PERCENT", help="of the feed, 0 to 150 (%(default)s)"
    )
    parser.add_argument("--single-block", action="store_true", help="rest at the end of each line, and wait for start")
    parser.add_argument("--optional-stop", action="store_true", help="stop at M1")
    help_text = "feed of all moves but rapid ones, without spindle, coolant and dwells"
    parser.add_argument("--dry-run", type=positive, metavar="MM/MIN", help=help_text)
    parser.add_argument("--from-line", type=count, metavar="N", help="begin at this line of the source")
    parser.add_argument("--operation", default="", metavar="NAME", help="operation that --from-line belongs to")
    parser.add_argument("--approach", action="store_true", help="go to the beginning first, from where the tool is")
    help_text = "number of the program in the controller that runs the list of points (%(default)s)"
    parser.add_argument(
        "--number", type=whole(1, _HIGHEST_PROGRAM), default=PLAYER_PROGRAM, metavar="PROG", help=help_text
    )
    help_text = "first P-variable of that list; it takes those up to P8186 (%(default)s)"
    parser.add_argument("--variables", type=_FIRST_VARIABLES, default=1000, metavar="N", help=help_text)


def play(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Play a trajectory, with orders from the standard input."""
    from pkm_post.control.player import Player, read_playable
    from pkm_post.model import Refused

    trajectory, tolerances, diagnostics = read_playable(namespace.trajectory, target.machine)
    _print_faults(diagnostics)
    if trajectory is None or tolerances is None:
        return 1
    choices = _choices(trajectory, namespace)
    if choices is None:
        return 1
    shown = _Shown(session.now)
    player = Player(session, target.machine, target.settings, trajectory, tolerances, choices, shown.show)
    shown.listen(player)
    try:
        with held_at_the_end(session, target.settings):
            return _print_result(player.play())
    except Refused as refused:
        _print_faults(refused.diagnostics)
        return 1


def _choices(trajectory: Trajectory, namespace: argparse.Namespace) -> PlayOptions | None:
    from pkm_post.control.link import NotReadyError
    from pkm_post.control.player import PlayOptions, first_row
    from pkm_post.options import MANUAL_MOVE_PROGRAM

    if namespace.number == MANUAL_MOVE_PROGRAM:
        raise NotReadyError([f"program {namespace.number} is that of moves by hand: choose another --number"])
    row: int | None = 0
    if namespace.from_line is not None:
        row, diagnostics = first_row(trajectory, namespace.from_line, namespace.operation, namespace.trajectory)
        _print_faults(diagnostics)
    if row is None:
        return None
    return PlayOptions(
        override=namespace.override / 100,
        single_block=namespace.single_block,
        optional_stop=namespace.optional_stop,
        dry_feed=None if namespace.dry_run is None else namespace.dry_run / 60,
        first_row=row,
        approach=namespace.approach,
        first_variable=namespace.variables,
        program=namespace.number,
    )


def _print_faults(diagnostics: tuple[Any, ...]) -> None:
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)


def _print_result(done: PlayResult) -> int:
    log = done.log
    words = "the program has ended" if done.finished else "ended by the operator"
    print(f"{words}; {log.seconds:.1f} s of motion, certified in {log.motions} pieces")
    if done.stops:
        print(f"it came to rest {done.stops} times because nothing more had come in time")
    if done.losses:
        print(f"the link was lost {done.losses} times and came back")
    for finding in log.findings:
        if finding.unit and finding.limit:
            bound = "at least" if finding.is_least else "allowed"
            print(f"{finding.name}: {finding.value:.6g} {finding.unit}, {bound} {finding.limit:.6g}")
    return 0 if done.finished else 1


@dataclass
class _Shown:
    """What is printed of the states, and the orders that are read meanwhile."""

    now: Callable[[], float]
    due: float = 0.0
    phase: str = ""
    player: Player | None = None
    is_input_over: threading.Event = field(default_factory=threading.Event)

    def listen(self, player: Player) -> None:
        """Read orders in a thread that ends with the process."""
        self.player = player
        threading.Thread(target=self._read, daemon=True).start()

    def show(self, state: PlayState) -> None:
        """Print a state where its phase is another, and every second; without input questions go unanswered."""
        from pkm_post.control.player import Order

        if state.phase != self.phase or self.now() >= self.due:
            print(state, flush=True)
            if state.phase.startswith(_WAITS) and state.phase != self.phase:
                print("start goes on, end ends here", flush=True)
            self.phase, self.due = state.phase, self.now() + _SHOW_S
        if self.is_input_over.is_set() and state.phase.startswith(_WAITS) and self.player is not None:
            self.player.order(Order("end"))

    def _read(self) -> None:
        from pkm_post.control.player import Order

        assert self.player is not None
        for line in sys.stdin:
            order = order_of(line)
            if order is not None:
                self.player.order(Order(*order))
            elif line.strip():
                print(f"expected one of {_ORDERS}", file=sys.stderr, flush=True)
        self.is_input_over.set()


def order_of(line: str) -> tuple[Any, float] | None:
    """The order that a line gives, or None."""
    word, _, rest = line.strip().lower().partition(" ")
    if word in ("hold", "resume", "start", "end") and not rest:
        return word, 0.0
    if word == "single" and rest in ("on", "off"):
        return word, float(rest == "on")
    if word == "override":
        try:
            percent = float(rest)
        except ValueError:
            return None
        return (word, percent / 100) if 0 <= percent <= _HIGHEST_PERCENT else None
    return None


ACTIONS: dict[str, tuple[Action, str, tuple[str, ...]]] = {
    "play": (play, "play a trajectory while it is planned, at any override, from any line", ("machine",)),
}
"""Same form as ``pmac_actions.ACTIONS``."""
