# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arguments: user options, for the command line and for one text as in jobs and macros.

Input: an argparse parser, which gets the arguments, or a text quoted as in a shell. Output: parsed arguments, in the
units of the user: mm, degrees, m/min. ``conversion`` makes options of them.
"""

from __future__ import annotations

import argparse
import re
import shlex
import sys
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

from pkm_post.options.argument_table import ARGUMENTS
from pkm_post.options.argument_types import UnexpectedError
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
            "--delete-switches",
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


_UNKNOWN, _MISSING, _NOT_VALID = "U101", "U102", "U103"
_REQUIRED = re.compile(r"(?:the following arguments are|(one of) the arguments) (?:required: )?(.*?)(?: is required)?")
_NO_VALUE = re.compile(r"argument (\S+): expected (?:one|at least one|\d+) arguments?")
_SIGNED = re.compile(r"-[\d.]")


class UsageParser(argparse.ArgumentParser):
    """A parser that gives each usage fault a code, and names the nearest argument. Subclasses report it."""

    _words: Sequence[str] = ()

    def refuse(self, code: str, found: str) -> NoReturn:
        """Report the fault of a rule."""
        raise NotImplementedError

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse, and refuse what is left over; argparse calls it for the parser of a command, too."""
        self._words = sys.argv[1:] if args is None else args
        if nul := [repr(word) for word in self._words if "\0" in word]:
            self.refuse(_NOT_VALID, f"{', '.join(nul)}: expected no character NUL, which no name of a file has")
        found, left = super().parse_known_args(args, namespace)
        self._refuse_unknown(left)
        return found, left

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            name = "/".join(action.option_strings) or action.metavar or action.dest
            names = [*map(str, action.choices)]
            found = f"{name}: expected one of {', '.join(names)}, got {value!r}{nearest(value, names)}"
            self.refuse(_UNKNOWN if action.nargs == argparse.PARSER else _NOT_VALID, found)

    def error(self, message: str) -> NoReturn:
        """Refuse what argparse has found in words of its own."""
        if message.startswith("ambiguous option: "):
            self.refuse(_UNKNOWN, message.removeprefix("ambiguous option: ").replace("could match", "may be"))
        if missing := _REQUIRED.fullmatch(message):
            self._refuse_unknown(filter(self._is_unknown, self._words))
            self.refuse(_MISSING, " ".join(filter(None, missing.groups())))
        if flag := _NO_VALUE.fullmatch(message):
            self.refuse(_MISSING, f"the value of {flag[1]}{self._behind_equals(flag[1])}")
        found = message.removeprefix("argument ").replace("ignored explicit argument", "expected no value, got")
        self.refuse(_NOT_VALID, found)

    def _refuse_unknown(self, words: Iterable[str]) -> None:
        named = [word + nearest(word.partition("=")[0], self._option_string_actions) for word in words]
        if named:
            self.refuse(_UNKNOWN, "; ".join(named))

    def _is_unknown(self, word: str) -> bool:
        name = word.partition("=")[0]
        known = any(option.startswith(name) for option in self._option_string_actions)
        return name.startswith("--") and not known

    def _behind_equals(self, flag: str) -> str:
        """How to write a value that begins with a minus sign, if one follows the option."""
        values = (value for name, value in zip(self._words, self._words[1:], strict=False) if name == flag)
        return next((f"; write {flag}={value}" for value in values if _SIGNED.match(value)), "")


def nearest(word: object, names: Iterable[str]) -> str:
    """The names that are like a word, to be appended to a message; empty if there are none."""
    import difflib

    found = difflib.get_close_matches(str(word), list(names), n=2)
    return f", perhaps {' or '.join(found)}" if found else ""


class TextParser(UsageParser):
    """A parser that raises ``ValueError`` instead of exiting."""

    def refuse(self, code: str, found: str) -> NoReturn:
        """Raise what was found, as a phrase for windows."""
        from pkm_post.model import Phrase

        if code == _UNKNOWN:
            raise ValueError(Phrase("unknown: {}", found))
        raise ValueError(Phrase("missing: {}", found) if code == _MISSING else found)

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        from pkm_post.model import Phrase

        try:
            return super()._get_value(action, arg_string)
        except argparse.ArgumentError as fault:
            why = fault.__context__
            if not isinstance(why, UnexpectedError):
                raise
            option, expected = "/".join(action.option_strings), Phrase(why.expected, *why.values)
            found = Phrase(
                "{option}: expected {expected}, got {text!r}", option=option, expected=expected, text=why.text
            )
        self.refuse(_NOT_VALID, found)


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
    from pkm_post.model import Phrase

    try:
        words = shlex.split(text)
    except ValueError as fault:
        raise ValueError(Phrase("a quotation mark is not closed in {text!r}", text=text)) from fault
    try:
        return (parser or text_parser()).parse_args(words)
    except ValueError as fault:
        raise ValueError(Phrase("{fault} in {text!r}", fault=fault.args[0], text=text)) from fault


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
