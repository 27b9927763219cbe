# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments of the manual control actions: lengths in mm, angles in degrees, feeds in mm/min."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from pkm_post.cli.inputs import NO_AXIS_WORDS, axis_words
from pkm_post.options import LONGEST_TOOL, above_zero, between, count, positive, tool_length, whole

_HIGHEST_PROGRAM = 999
"""Numbers from 1000 on are the subprograms of the codes."""
_percent = above_zero(100)
_way = between(-LONGEST_TOOL, LONGEST_TOOL)
_turn = between(-360, 360)


def add_own(parser: argparse.ArgumentParser, name: str) -> None:
    """Add the arguments of an action."""
    if name in _OWN:
        _OWN[name](parser)


def _add_home(parser: argparse.ArgumentParser) -> None:
    told = "line that starts the homing of this machine, as its builder says, such as 'ENABLE PLC 3'"
    parser.add_argument("--trigger", type=_trigger, metavar="LINE", help=f"{told} (only tell which struts have homes)")


def _add_jog(parser: argparse.ArgumentParser) -> None:
    for name in ("x", "y", "z"):
        parser.add_argument(f"--{name}", type=_way, default=0.0, metavar="MM", help=f"the tip along {name.upper()}")
    for name in ("x", "y"):
        told = f"the tool axis about {name.upper()}, the tip stands"
        parser.add_argument(f"--tilt-{name}", type=_turn, default=0.0, metavar="DEG", help=told)
    parser.add_argument("--spin", type=_turn, default=0.0, metavar="DEG", help="the platform about the tool axis")
    parser.add_argument("--strut", type=int, choices=range(1, 7), help="one strut instead of the tool")
    parser.add_argument("--by", type=_way, default=0.0, metavar="MM", help="how much longer that strut becomes")
    told = "of the tip; of a turn in place in degrees per minute (%(default)s)"
    parser.add_argument("--feed", type=positive, default=300.0, metavar="MM/MIN", help=told)
    _add_by_hand(parser)


def _add_mdi(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("line", metavar="LINE", help="a line of G-code; it stands by itself")
    parser.add_argument("--work-offset", default="G54", metavar="NAME", help="frame of the line (%(default)s)")
    told = "how the line says the tool axis; none leaves it as it is (%(default)s)"
    parser.add_argument("--axis-words", type=axis_words, default=NO_AXIS_WORDS, metavar="WORDS", help=told)
    _add_by_hand(parser)


def _add_approach(parser: argparse.ArgumentParser) -> None:
    from pkm_post.options import APPROACH_MM_S

    told = "of the tip; of a turn in place in degrees per minute (%(default)s)"
    parser.add_argument("--feed", type=positive, default=60 * APPROACH_MM_S, metavar="MM/MIN", help=told)
    _add_by_hand(parser)


def _add_by_hand(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--tool-length", type=tool_length, metavar="MM", help="gauge length (that of the rest pose)")
    parser.add_argument("--check", action="store_true", help="plan and check it, and send nothing")
    _add_number(parser)


def _add_step(parser: argparse.ArgumentParser) -> None:
    from pkm_post.options import START_TOLERANCE_MM

    parser.add_argument("--block", type=count, default=1, metavar="N", help="begin at this block (%(default)s)")
    near = "how far each strut and the tip may be from where the first block begins (%(default)s)"
    parser.add_argument("--near", type=positive, default=START_TOLERANCE_MM, metavar="MM", help=near)
    parser.set_defaults(tool_length=None, check=False)
    _add_number(parser)


def _add_continue(parser: argparse.ArgumentParser) -> None:
    from pkm_post.options import START_TOLERANCE_MM

    told = "which stop of the program it stands at, from 1"
    parser.add_argument("--stop", type=count, required=True, metavar="N", help=told)
    near = "how far each strut may be from where it stopped (%(default)s)"
    parser.add_argument("--near", type=positive, default=START_TOLERANCE_MM, metavar="MM", help=near)


def _add_number(parser: argparse.ArgumentParser) -> None:
    from pkm_post.options import MANUAL_MOVE_PROGRAM

    told = "number of the program in the controller that is used for it (%(default)s)"
    parser.add_argument(
        "--number", type=whole(1, _HIGHEST_PROGRAM), default=MANUAL_MOVE_PROGRAM, metavar="PROG", help=told
    )


def _add_override(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("percent", type=_percent, metavar="PERCENT", help="a number above 0 and up to 100")


def _trigger(text: str) -> str:
    from pkm_post.control import check_trigger

    try:
        check_trigger(text)
    except ValueError as fault:
        raise argparse.ArgumentTypeError(str(fault)) from None
    return text


_OWN: dict[str, Callable[[argparse.ArgumentParser], None]] = {
    "home": _add_home,
    "jog": _add_jog,
    "mdi": _add_mdi,
    "approach": _add_approach,
    "step": _add_step,
    "continue": _add_continue,
    "override": _add_override,
}
