# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers: the options of a job, overridden one by one by those of a command line, and the inputs they apply to.

Input: parsed arguments, with the values that were given explicitly, and kinds of files. Output: one layer merged over
another, every option whose value changes, and messages on options that do not apply. A default overrides nothing. An
option that applies to none of the inputs is refused, not ignored.
"""

from __future__ import annotations

import argparse
import enum
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

NOTHING = "none"
"""Word that cancels a job's choice of an option without a default."""
ArgumentValues = Mapping[str, Any]
"""Explicitly given values by attribute name."""
NO_VALUES: ArgumentValues = MappingProxyType({})


def add_recorded(parser: argparse.ArgumentParser, flag: str, action: str = "store", **words: Any) -> None:
    """Add an option that is recorded in ``given`` when it is given; a switch gets a ``--no-`` form that cancels it."""
    if action == "store_true":
        parser.add_argument(flag, f"--no-{flag[2:]}", action=_RecordedAction, nargs=0, default=False, **words)
    else:
        parser.add_argument(flag, action=_RecordedAction, **words)


class _RecordedAction(argparse.Action):
    """Store a value as argparse does, and record it as given; an option with a list default may be repeated."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, value: Any, flag: str | None = None
    ) -> None:
        """Store one option with its value."""
        if isinstance(self.default, list):
            value = [*getattr(namespace, self.dest), value]
        elif self.nargs == 0:
            value = not str(flag).startswith("--no-")
        setattr(namespace, self.dest, value)
        namespace.given = {**explicit_values(namespace), self.dest: value}


def explicit_values(namespace: argparse.Namespace) -> ArgumentValues:
    """Explicitly given values of parsed arguments; the others are defaults."""
    given: ArgumentValues = getattr(namespace, "given", NO_VALUES)
    return given


def overridden(below: argparse.Namespace, above: ArgumentValues) -> argparse.Namespace:
    """Parsed arguments with some values replaced; values by tool number are replaced for that tool only."""
    given = {**explicit_values(below), **{name: _merged(vars(below).get(name), value) for name, value in above.items()}}
    return argparse.Namespace(**(vars(below) | given | {"given": given}))


def _merged(below: Any, above: Any) -> Any:
    return list((dict(below or ()) | dict(above)).items()) if isinstance(above, list) else above


@dataclass(frozen=True)
class Override:
    """An option with a changed value.

    Attributes:
        before, after: old and new value, as after the option.
    """

    flag: str
    before: str
    after: str

    def __str__(self) -> str:
        return f"{self.flag} {self.after} instead of {self.before}"


def overrides(below: ArgumentValues, above: ArgumentValues, whole: bool = False) -> Iterator[Override]:
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
        elif format_value(name, value) != format_value(name, below[name]):
            yield Override(flag_of(name), format_value(name, below[name]), format_value(name, value))


def _by_tool(name: str, before: dict[int, Any], after: dict[int, Any], whole: bool) -> Iterator[Override]:
    """Yield the tools whose value changes."""
    for number, value in before.items():
        old = format_value(name, (number, value))
        cancelled = NOTHING if whole else old
        new = format_value(name, (number, after[number])) if number in after else cancelled
        if new != old:
            yield Override(flag_of(name), old, new)


def flag_of(name: str) -> str:
    """Option name of an attribute."""
    return _FLAGS.get(name, "--" + name.replace("_", "-"))


_FLAGS = {"tools": "--tool"}
"""Options whose attribute has another name."""


def format_value(name: str, value: Any) -> str:
    """Format a value as it is written after its option; for a repeated option, that of one tool."""
    return _FORMATS.get(name, _plain)(value)


def _plain(value: Any) -> str:
    if value is None or value == ():
        return NOTHING
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, tuple):
        return ",".join(map(_plain, value))
    return f"{value + 0.0:.12g}" if isinstance(value, float) else str(value)


def _by_number(entry: tuple[int | str, Any]) -> str:
    """Format the value of a tool or a work offset; an unknown corner radius is left out."""
    number, value = entry
    known = [each for each in (value if isinstance(value, tuple) else [value]) if each is not None]
    return f"{number}={','.join(map(_plain, known))}"


def _start_line(value: tuple[int, str] | None) -> str:
    if value is None:
        return NOTHING
    line, operation = value
    return f"{operation}:{line}" if operation else str(line)


def _spin(value: tuple[str, float, str]) -> str:
    rule, heading, objective = value
    if rule == "optimise":
        return f"{rule}={objective}"
    return f"{rule}={_plain(heading)}" if rule.endswith("-in-plane") else rule


_FORMATS: dict[str, Callable[[Any], str]] = {
    "spin": _spin,
    "from_line": _start_line,
    **dict.fromkeys(("tool_length", "tools", "actual_tool", "wear", "origin"), _by_number),
    **dict.fromkeys(("fixture", "subprograms"), lambda entry: str(entry[0])),
    "cycle_kinds": lambda pairs: ",".join(map("=".join, pairs)) or NOTHING,
}
"""Formats of values that ``_plain`` does not format."""


class InputKind(enum.Enum):
    """Kind of input that options are given for."""

    GCODE = "G-code"
    CLDATA = "CL data"
    JOB = "CAM jobs"


_PART_PROGRAMS = (InputKind.GCODE, InputKind.CLDATA)
_KINDS: dict[str, tuple[InputKind, ...]] = {
    "axis_words": (InputKind.GCODE,),
    "dwell_unit": (InputKind.GCODE,),
    "flavour": (InputKind.GCODE,),
    "machine_zero": _PART_PROGRAMS,
    "leave_out": (InputKind.GCODE,),
    "origin": (InputKind.GCODE, InputKind.JOB),
    "subprograms": (InputKind.GCODE,),
    "block_delete": (InputKind.GCODE,),
    "delete_switches": (InputKind.GCODE,),
    "contour_data": (InputKind.CLDATA,),
    "cl_dialect": (InputKind.CLDATA,),
    "cycle_values": (InputKind.CLDATA,),
    "cycle_kinds": (InputKind.CLDATA,),
    "goto_values": (InputKind.CLDATA,),
    "tools": _PART_PROGRAMS,
    "tool_table": _PART_PROGRAMS,
    "unit": _PART_PROGRAMS,
    "feed": _PART_PROGRAMS,
    "allow_open_end": _PART_PROGRAMS,
    "side": _PART_PROGRAMS,
    "wear": _PART_PROGRAMS,  # for G-code, L432 names the alternative
    "job": (InputKind.JOB,),
}
"""Kinds of input of an option, by attribute; all others apply to every input."""


def input_kind(file: Path) -> InputKind:
    """Kind of a file by its suffix; anything but a part program is a document with jobs."""
    from pkm_post.reading import Language, is_part_program, language_of

    if not is_part_program(file):
        return InputKind.JOB
    return InputKind.GCODE if language_of(file) is Language.GCODE else InputKind.CLDATA


def inapplicable_options(names: Iterable[str], kinds: Collection[InputKind]) -> list[str]:
    """Messages on the options that apply to none of the inputs."""
    return [
        f"{flag_of(name)} is for {' and '.join(each.value for each in _KINDS[name])}"
        for name in names
        if name in _KINDS and not set(_KINDS[name]) & set(kinds)
    ]


def applicable_values(given: ArgumentValues, kind: InputKind) -> ArgumentValues:
    """Options that apply to an input: with several files, an option may apply to some of them only."""
    return {name: value for name, value in given.items() if kind in _KINDS.get(name, InputKind)}
