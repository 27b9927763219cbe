# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments: user options, for the command line and for one text as in jobs and macros.

Input: an argparse parser, which gets the arguments, or a text quoted as in a shell. Output: parsed arguments, in the
units of the user: mm, degrees, m/min. ``conversion`` makes options of them.
"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterable
from typing import NoReturn

from pkm_post.options.argument_table import ARGUMENTS
from pkm_post.options.layers import add_recorded

READING_STEP = "reading"
"""Name of the progress step before those of the pipeline."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the arguments common to all entry points of PKM Post."""
    _add(parser, ARGUMENTS)


def add_machine(parser: argparse.ArgumentParser) -> None:
    """Add the machine argument."""
    _add(parser, ("--machine",))


def add_part_program(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for facts that a part program does not state itself."""
    _add(
        parser,
        (
            "--tool",
            "--tool-table",
            "--unit",
            "--feed",
            "--flavour",
            "--machine-zero",
            "--origin",
            "--subprograms",
            "--block-delete",
            "--leave-out",
            "--contour-data",
            "--wear",
            "--cl-dialect",
            "--cycle-values",
            "--cycle-kinds",
            "--goto-values",
            "--allow-open-end",
        ),
    )


def _add(parser: argparse.ArgumentParser, flags: Iterable[str]) -> None:
    for flag in flags:
        add_recorded(parser, flag, **ARGUMENTS[flag])


class TextParser(argparse.ArgumentParser):
    """A parser that raises ``ValueError`` instead of printing its usage and exiting."""

    def error(self, message: str) -> NoReturn:
        """Handle a parse error of argparse."""
        raise ValueError(message)


def text_parser(name: str = "options", description: str = "") -> TextParser:
    """Parser of the common options, without abbreviations and built-in help."""
    parser = TextParser(prog=name, description=description, add_help=False, allow_abbrev=False, usage=argparse.SUPPRESS)
    vars(parser)["color"] = False  # Python 3.14 would colour the help on a terminal
    add_options(parser)
    return parser


def parse_text(text: str, parser: TextParser | None = None) -> argparse.Namespace:
    """Parse options from a text; all others keep their defaults.

    Raises:
        ValueError: the text is invalid.
    """
    try:
        return (parser or text_parser()).parse_args(shlex.split(text))
    except ValueError as fault:
        raise ValueError(f"{fault} in {text!r}") from fault


PARITIES = {"none": "N", "odd": "O", "even": "E"}
"""Parities of a serial line, with their names in pyserial."""
START_TOLERANCE_MM = 0.05
"""Largest distance of each strut and of the tool tip to the start of a program: the following errors of standing
struts."""
MANUAL_MOVE_PROGRAM = 999
"""Program number of a manual move; jobs use others."""
PLAYER_PROGRAM = 998
"""Program number of the player."""
APPROACH_MM_S = 10.0
"""Tip speed of the planned approach to the start of a program; for a turn in place, degrees per second."""
