# SPDX-License-Identifier: LGPL-2.1-or-later
"""Argument fields: the arguments of CAM jobs as fields of a form, and the text of the filled fields.

Input: a parser with the options of a job. Output: a row for each argument. A field that is left empty gives no
argument, so a lower layer decides.
"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from pkm_post.options.layers import InputKind, inapplicable_options


@dataclass(frozen=True)
class ArgumentField:
    """An argument as a field of a form.

    Attributes:
        name: attribute of the parsed argument.
        flag: the argument as typed.
        help: its help text.
        choices: possible values; empty if any text may be entered.
        is_switch: whether it has no value.
        is_repeated: whether the field may hold several values, separated by blanks.
    """

    name: str
    flag: str
    help: str
    choices: tuple[str, ...] = ()
    is_switch: bool = False
    is_repeated: bool = False


def argument_fields(parser: argparse.ArgumentParser) -> Iterator[ArgumentField]:
    """Yield the arguments of a parser that apply to CAM jobs, in order."""
    for action in parser._actions:
        if not inapplicable_options([action.dest], {InputKind.JOB}):
            yield ArgumentField(
                action.dest,
                action.option_strings[0],
                str(action.help) % {"default": action.default},
                tuple(action.choices or ()),
                action.nargs == 0,
                isinstance(action.default, list),
            )


def text_of_fields(fields: Iterable[ArgumentField], filled: Mapping[str, Any]) -> str:
    """The filled fields as one text, quoted as in a shell.

    Args:
        filled: their values by name; None, an empty text and False count as not filled.

    Raises:
        ValueError: the quotes in a field with several values do not close.
    """
    words: list[str] = []
    for field in fields:
        value = filled.get(field.name)
        if not value:
            continue
        values = shlex.split(str(value)) if field.is_repeated else [str(value)]
        words += [field.flag] if field.is_switch else [f"{field.flag}={each}" for each in values]
    return shlex.join(words)
