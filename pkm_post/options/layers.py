# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers: the options of a job, overridden one by one by those of a command line.

Input: parsed arguments, each with a record of what was typed. Output: one layer merged over another, and every option
whose value changes. A default overrides nothing.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

NOTHING = "none"
"""Cancels a job's choice, where nothing is the default."""
Given = Mapping[str, Any]
"""Typed values by attribute name."""
NOTHING_GIVEN: Given = MappingProxyType({})


def add_noted(parser: argparse.ArgumentParser, flag: str, action: str = "store", **words: Any) -> None:
    """Add an option that is recorded in ``given`` when typed; a switch gets one with ``--no-`` that cancels it."""
    if action == "store_true":
        parser.add_argument(flag, f"--no-{flag[2:]}", action=_Noted, nargs=0, default=False, **words)
    else:
        parser.add_argument(flag, action=_Noted, **words)


class _Noted(argparse.Action):
    """Store a value as argparse does, and record that it was typed; one with a list default may be repeated."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, value: Any, flag: str | None = None
    ) -> None:
        """Store one option with its value."""
        if isinstance(self.default, list):
            value = [*getattr(namespace, self.dest), value]
        elif self.nargs == 0:
            value = not str(flag).startswith("--no-")
        setattr(namespace, self.dest, value)
        namespace.given = {**given_in(namespace), self.dest: value}


def given_in(namespace: argparse.Namespace) -> Given:
    """Typed values of parsed arguments; the rest of them are defaults."""
    given: Given = getattr(namespace, "given", NOTHING_GIVEN)
    return given


def layered(below: argparse.Namespace, above: Given) -> argparse.Namespace:
    """Merge typed values over parsed arguments; values by tool number are replaced for that tool only."""
    given = {**given_in(below), **{name: _merged(vars(below).get(name), value) for name, value in above.items()}}
    return argparse.Namespace(**(vars(below) | given | {"given": given}))


def _merged(below: Any, above: Any) -> Any:
    return list((dict(below or ()) | dict(above)).items()) if isinstance(above, list) else above


@dataclass(frozen=True)
class Override:
    """An option with a changed value.

    Attributes:
        flag: its name.
        before, after: old and new value, as typed.
    """

    flag: str
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.flag} {self.after} instead of {self.before}"


def overrides(below: Given, above: Given, whole: bool = False) -> Iterator[Override]:
    """Yield the options of one layer that change values of another one.

    Args:
        below: the lower layer.
        above: the layer that takes precedence.
        whole: whether tool values missing in ``above`` are cancelled.
    """
    for name, value in above.items():
        if name not in below:
            continue
        if isinstance(value, list):
            yield from _by_tool(name, dict(below[name]), dict(value), whole)
        elif shown(name, value) != shown(name, below[name]):
            yield Override(flag_of(name), shown(name, below[name]), shown(name, value))


def _by_tool(name: str, before: dict[int, Any], after: dict[int, Any], whole: bool) -> Iterator[Override]:
    """Yield the tools whose value changes."""
    for number, value in before.items():
        said = shown(name, (number, value))
        taken_back = NOTHING if whole else said
        says = shown(name, (number, after[number])) if number in after else taken_back
        if says != said:
            yield Override(flag_of(name), said, says)


def flag_of(name: str) -> str:
    """Option name of an attribute."""
    return _FLAGS.get(name, "--" + name.replace("_", "-"))


_FLAGS = {"tools": "--tool"}
"""Options whose attribute has another name."""


def shown(name: str, value: Any) -> str:
    """Format a value as typed after its option; for a repeated option, that of one tool."""
    return _SHOWN.get(name, _plain)(value)


def _plain(value: Any) -> str:
    if value is None or value == ():
        return NOTHING
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, tuple):
        return ",".join(map(_plain, value))
    return f"{value + 0.0:.12g}" if isinstance(value, float) else str(value)


def _by_number(entry: tuple[int, Any]) -> str:
    """Format the value of a tool; an unknown corner radius is left out."""
    number, said = entry
    known = [each for each in (said if isinstance(said, tuple) else [said]) if each is not None]
    return f"{number}={','.join(map(_plain, known))}"


def _spin(value: tuple[str, float, str]) -> str:
    rule, heading, objective = value
    if rule == "optimise":
        return f"{rule}={objective}"
    return f"{rule}={_plain(heading)}" if rule.endswith("-in-plane") else rule


_SHOWN: dict[str, Callable[[Any], str]] = {
    "spin": _spin,
    **dict.fromkeys(("tool_length", "tools", "actual_tool", "wear"), _by_number),
    "fixture": lambda entry: str(entry[0]),
}
"""Formats of values that are not shown as they are."""
