# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed: options as one text, quoted as in a shell, as jobs and macros have them."""

from __future__ import annotations

import argparse
import shlex
from typing import NoReturn

from pkm_post.options.arguments import add_options


class TextParser(argparse.ArgumentParser):
    """Raises a ``ValueError`` where a program of its own would print its usage and end."""

    def error(self, message: str) -> NoReturn:
        """What argparse calls with what it does not understand."""
        raise ValueError(message)


def text_parser(name: str = "options", description: str = "") -> TextParser:
    """A parser of the options of every door, which takes no abbreviations and prints no help by itself."""
    parser = TextParser(prog=name, description=description, add_help=False, allow_abbrev=False, usage=argparse.SUPPRESS)
    vars(parser)["color"] = False  # Python 3.14 would colour the help if there is a terminal
    add_options(parser)
    return parser


def typed(text: str, parser: TextParser | None = None) -> argparse.Namespace:
    """The options that a text says, the others with their defaults.

    Raises:
        ValueError: they are not understood.
    """
    try:
        return (parser or text_parser()).parse_args(shlex.split(text))
    except ValueError as fault:
        raise ValueError(f"{fault} in {text!r}") from fault
