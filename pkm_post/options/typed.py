# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed: options as one text, quoted as in a shell, as in jobs and macros."""

from __future__ import annotations

import argparse
import shlex
from typing import NoReturn

from pkm_post.options.arguments import add_options


class TextParser(argparse.ArgumentParser):
    """Raise a ``ValueError`` where a program of its own would print its usage and exit."""

    def error(self, message: str) -> NoReturn:
        """Handle a parse error of argparse."""
        raise ValueError(message)


def text_parser(name: str = "options", description: str = "") -> TextParser:
    """Parser of the common options, without abbreviations and built-in help."""
    parser = TextParser(prog=name, description=description, add_help=False, allow_abbrev=False, usage=argparse.SUPPRESS)
    vars(parser)["color"] = False  # Python 3.14 would colour the help on a terminal
    add_options(parser)
    return parser


def typed(text: str, parser: TextParser | None = None) -> argparse.Namespace:
    """Parse options from a text; the others have their defaults.

    Raises:
        ValueError: the text is invalid.
    """
    try:
        return (parser or text_parser()).parse_args(shlex.split(text))
    except ValueError as fault:
        raise ValueError(f"{fault} in {text!r}") from fault
