# SPDX-License-Identifier: LGPL-2.1-or-later
"""PMAC play: the action play of the command ``pmac``, with orders from the standard input."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.pmac_stop import Actions, held_at_the_end
from pkm_post.cli.processes import diagnostic_text
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import LONGEST_JOG, between, count, numbered, positive, shift, tool_length, whole

if TYPE_CHECKING:
    from pkm_post.cli.pmac_stop import Target
    from pkm_post.control.link import Session
    from pkm_post.control.player import Player, PlayOptions, PlayResult, PlayState
    from pkm_post.model import Diagnostics, Setup, Trajectory

_HIGHEST_PERCENT = 150.0
_HIGHEST_PROGRAM = 999
_FIRST_VARIABLES = whole(1, 7000)
_SHOW_S = 1.0
_SWITCHES = ("single", "optional", "skip")
_ORDERS = f"override PERCENT, hold, resume, {', '.join(_SWITCHES)} with on or off, retract MM, start, end"
_NUMBERS = {"override": (0.01, _HIGHEST_PERCENT), "retract": (1.0, LONGEST_JOG)}
"""Orders with a number: their unit, and the highest number."""
_SOLIDS = {"part": "the finished part", "stock": "the stock before the first operation", "fixture": "a clamp or vice"}
_WAITS = "waits"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the action."""
    from pkm_post.options import PLAYER_PROGRAM

    parser.add_argument("trajectory", type=Path, metavar="FILE.pkmt", help="posted trajectory")
    help_text = "the same program posted with --block-delete; skip on and skip off switch between the two"
    parser.add_argument("--skipped", type=Path, metavar="FILE.pkmt", help=help_text)
    parser.add_argument("--block-skip", action="store_true", help="start with blocks after / skipped")
    percent = between(0, _HIGHEST_PERCENT)
    parser.add_argument(
        "--override", type=percent, default=100.0, metavar="PERCENT", help="feed override, 0 to 150 (%(default)s)"
    )
    parser.add_argument("--single-block", action="store_true", help="stop at the end of each line and wait for start")
    parser.add_argument("--optional-stop", action="store_true", help="start with stops at M1")
    help_text = "feed of all moves except rapids, without spindle, coolant and dwells"
    parser.add_argument("--dry-run", type=positive, metavar="MM/MIN", help=help_text)
    parser.add_argument("--from-line", type=count, metavar="N", help="start at this line of the source")
    parser.add_argument("--operation", default="", metavar="NAME", help="operation of --from-line")
    help_text = "repeat the machine-specific M codes before that line, each once, above its start"
    parser.add_argument("--repeat-codes", action="store_true", help=help_text)
    parser.add_argument("--approach", action="store_true", help="first approach the start from the current position")
    add_solids(parser)
    help_text = "displacement of the work offset in the machine frame since posting, mm, as printed by measure"
    parser.add_argument("--shift", type=shift, default=(0.0, 0.0, 0.0), metavar="DX,DY,DZ", help=help_text)
    help_text = "current gauge length of a tool, if it has changed since posting; may be repeated"
    length = numbered(tool_length, "NUMBER=MM")
    parser.add_argument("--tool-length", type=length, action="append", default=[], metavar="NUMBER=MM", help=help_text)
    help_text = "program number in the controller that plays the list of points (%(default)s)"
    parser.add_argument(
        "--number", type=whole(1, _HIGHEST_PROGRAM), default=PLAYER_PROGRAM, metavar="PROG", help=help_text
    )
    help_text = "first P-variable of that list, which extends to P8186 (%(default)s)"
    parser.add_argument("--variables", type=_FIRST_VARIABLES, default=1000, metavar="N", help=help_text)


def add_solids(parser: argparse.ArgumentParser) -> None:
    """Add the options for the collision check of the approach."""
    for name, what in _SOLIDS.items():
        checked = "to check the approach against, and with changed offsets the program"
        help_text = f"STL or STEP file of {what}, mm in the work frame, {checked}"
        parser.add_argument(
            f"--{name}", metavar="FILE", action="append" if name == "fixture" else "store", help=help_text
        )


def setup_of(namespace: argparse.Namespace) -> tuple[Setup, Diagnostics]:
    """The named part, stock and fixtures, and the faults of their files."""
    from pkm_post.options import MeshFiles, Options
    from pkm_post.posting import effective_setup

    files = MeshFiles(namespace.part, namespace.stock, tuple(namespace.fixture or ()))
    return effective_setup(Options(mesh_files=files), None)


def play(session: Session, target: Target, namespace: argparse.Namespace) -> int:
    """Play a trajectory, with orders from the standard input."""
    from pkm_post.control.player import Callbacks, Player, collisions_at_offsets, read_playable
    from pkm_post.model import errors
    from pkm_post.toolpath import MachineOffsets

    if faults := list(_alone(namespace)):
        print_diagnostics(faults)
        return 2
    offsets = MachineOffsets(namespace.shift, dict(namespace.tool_length))
    trajectory, tolerances, diagnostics = read_playable(namespace.trajectory, target.machine, offsets)
    print_diagnostics(diagnostics)
    if trajectory is None or tolerances is None:
        return 1
    skipped = None
    if namespace.skipped is not None:
        skipped, _, diagnostics = read_playable(namespace.skipped, target.machine, offsets)
        print_diagnostics(diagnostics)
    choices = _choices(trajectory, namespace)
    if choices is None or (skipped is None and namespace.skipped is not None):
        return 1
    choices = replace(choices, skipped=skipped)
    met = [
        collisions_at_offsets(made, target.machine, offsets, choices.setup) for made in (trajectory, skipped) if made
    ]
    print_diagnostics(diagnostics := tuple(each for found in met for each in found))
    if errors(diagnostics):
        return 1
    shown = _Shown(session.now, skips=skipped is not None)
    player = Player(session, target.machine, target.settings, trajectory, tolerances, choices, Callbacks(shown.show))
    shown.listen(player)
    with held_at_the_end(session, target.settings):
        return _print_result(player.play())


def _alone(namespace: argparse.Namespace) -> Iterator[str]:
    """Diagnostics of options that have no effect without others."""
    if namespace.block_skip and namespace.skipped is None:
        yield diagnostic_text("U102", "--block-skip", "--skipped")
    if namespace.from_line is None:
        yield from (
            diagnostic_text("U102", option, "--from-line")
            for option, given in (("--operation", namespace.operation), ("--repeat-codes", namespace.repeat_codes))
            if given
        )


def _choices(trajectory: Trajectory, namespace: argparse.Namespace) -> PlayOptions | None:
    from pkm_post.control.link import NotReadyError
    from pkm_post.control.player import PlayOptions, first_row
    from pkm_post.model import errors
    from pkm_post.options import MANUAL_MOVE_PROGRAM

    if namespace.number == MANUAL_MOVE_PROGRAM:
        raise NotReadyError([f"program {namespace.number} is that of moves by hand: choose another --number"])
    row: int | None = 0
    if namespace.from_line is not None:
        at = namespace.from_line, namespace.operation, namespace.trajectory, namespace.repeat_codes
        row, diagnostics = first_row(trajectory, *at)
        print_diagnostics(diagnostics)
    setup, diagnostics = setup_of(namespace)
    print_diagnostics(diagnostics)
    if row is None or errors(diagnostics):
        return None
    return PlayOptions(
        override=namespace.override / 100,
        single_block=namespace.single_block,
        optional_stop=namespace.optional_stop,
        block_skip=namespace.block_skip,
        dry_feed=None if namespace.dry_run is None else namespace.dry_run / 60,
        first_row=row,
        approach=namespace.approach,
        repeat_codes=namespace.repeat_codes,
        first_variable=namespace.variables,
        program=namespace.number,
        setup=setup,
    )


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
    """Prints the states, and reads orders meanwhile."""

    now: Callable[[], float]
    skips: bool = True
    due: float = 0.0
    phase: str = ""
    player: Player | None = None
    is_input_over: threading.Event = field(default_factory=threading.Event)

    def listen(self, player: Player) -> None:
        """Read orders in a thread that ends with the process."""
        self.player = player
        threading.Thread(target=self._read, daemon=True).start()

    def show(self, state: PlayState) -> None:
        """Print a state on a new phase, and every second; after the end of input, a wait ends the play."""
        from pkm_post.control.player import Order

        if state.phase != self.phase or self.now() >= self.due:
            print(state, flush=True)
            if state.phase.startswith(_WAITS) and state.phase != self.phase:
                print("start continues, end ends here", flush=True)
            self.phase, self.due = state.phase, self.now() + _SHOW_S
        if self.is_input_over.is_set() and state.phase.startswith(_WAITS) and self.player is not None:
            self.player.order(Order("end"))

    def _read(self) -> None:
        from pkm_post.control.player import Order

        assert self.player is not None
        for line in sys.stdin:
            order = order_of(line)
            if order == ("skip", 1.0) and not self.skips:
                print("no block can be skipped without --skipped", file=sys.stderr, flush=True)
            elif order is not None:
                self.player.order(Order(*order))
            elif line.strip():
                print(f"expected one of {_ORDERS}", file=sys.stderr, flush=True)
        self.is_input_over.set()


def order_of(line: str) -> tuple[Any, float] | None:
    """The order of a line, or None."""
    word, _, rest = line.strip().lower().partition(" ")
    if word in ("hold", "resume", "start", "end") and not rest:
        return word, 0.0
    if word in _SWITCHES and rest in ("on", "off"):
        return word, float(rest == "on")
    if word in _NUMBERS:
        unit, most = _NUMBERS[word]
        try:
            number = float(rest)
        except ValueError:
            return None
        return (word, number * unit) if 0 <= number <= most else None
    return None


ACTIONS: Actions = {
    "play": (play, "play a trajectory while planning it, at any override, from any line", ("machine",)),
}
