# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read programs, machines and options; errors are raised and warnings issued."""

from __future__ import annotations

import argparse
import functools
import inspect
import operator
import os
import types
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, get_args, get_origin, get_type_hints

from pkm_post.machine import find_machine as machine_path
from pkm_post.machine import machine_named
from pkm_post.model import Diagnostic, Machine, Program, Refused, errors
from pkm_post.options import Options, explicit_values, options_from, overridden, parse_text, tool_length
from pkm_post.posting import prepared_file
from pkm_post.reading import AS_WRITTEN, ReadingOptions

Source = Any
"""Path of a part program, or a CAM job (a document object)."""
_EXAMPLE = "example_6tps"
NO_LENGTHS: Mapping[int, float] = {}
_DEFAULT = "--work-offset G54"
Value = TypeVar("Value")
Arguments = ParamSpec("Arguments")
_MAKERS = {
    "Program": "read", "Trajectory": "place", "Plan": "plan", "Machine": "read_machine", "Options": "read_options",
}  # fmt: skip


class DiagnosticWarning(UserWarning):
    """A diagnostic that does not stop the work."""


def typed(function: Callable[Arguments, Value]) -> Callable[Arguments, Value]:
    """Check the arguments of a function against its annotations, so that a wrong one is named where it is passed.

    Raises:
        TypeError: of the function made: an argument is of another type.
    """
    signature = inspect.signature(function)
    allowed = {name: _classes(hint) for name, hint in get_type_hints(function).items()}

    @functools.wraps(function)
    def checked(*arguments: Arguments.args, **named: Arguments.kwargs) -> Value:
        for name, value in signature.bind(*arguments, **named).arguments.items():
            if not isinstance(value, allowed[name]):
                raise TypeError(f"{function.__name__}: {name}: {_mismatch(allowed[name], value)}")
        return function(*arguments, **named)

    return checked


def _classes(hint: Any) -> tuple[type, ...]:
    """The classes of an annotation, without their parameters."""
    parts = get_args(hint) if isinstance(hint, types.UnionType) else (hint,)
    return tuple(object if part is Any else get_origin(part) or part for part in parts)


def _mismatch(allowed: tuple[type, ...], value: object) -> str:
    names = ["None" if each is types.NoneType else each.__name__ for each in allowed]
    makers = [f"pkm.{_MAKERS[name]}" for name in names if name in _MAKERS]
    shown = f" {value!r:.60}" if isinstance(value, str | bytes | int | float) else ""
    made = f", as made by {' or '.join(makers)}" if makers else ""
    return f"expected {' or '.join(names)}{made}, got {type(value).__name__}{shown}"


@typed
def read(
    source: Source,
    tool_lengths: Mapping[int, float] = NO_LENGTHS,
    reading: ReadingOptions = AS_WRITTEN,
    arguments: str = "",
) -> Program:
    """Read a part program or a CAM job.

    Args:
        source: path of G-code or CL data, or a CAM job.
        tool_lengths: gauge lengths by tool number, mm; they override those of the source.
        reading: facts that a part program does not state itself, such as its unit.
        arguments: options as on the command line.

    Returns:
        The program: tool tips and tool axes in the work frame, events by row.

    Raises:
        Refused: the source has errors.
        ValueError: the suffix of the file is unknown, or a tool length is not above 0.

    Example:
        >>> program = pkm.read("part.ngc", tool_lengths={1: 120.0})
        >>> len(program), sorted(program.tools)
        (5, [1])
    """
    lengths = sound_lengths(tool_lengths)
    if is_path(source):
        prepared = prepared_file(Path(source), None, None, lengths, reading, arguments)
    else:
        from pkm_post.freecad_app import post_job

        prepared = post_job.prepared(source, lengths, arguments)
    return sound_value(prepared.program, prepared.found)


@typed
def read_machine(name: str | Path = _EXAMPLE) -> Machine:
    """Read a machine file.

    Args:
        name: name of a machine that comes with PKM Post, or path of a machine file.

    Raises:
        Refused: the file does not exist or has errors.

    Example:
        >>> pkm.read_machine("example_6tps").strut_stroke
        (750.0, 1250.0)
    """
    return sound_value(*machine_named(str(name)))


@typed
def find_machine(name: str | Path) -> Path:
    """Path of a machine file, to copy and edit.

    Args:
        name: name of a machine that comes with PKM Post, or path of a machine file.

    Raises:
        Refused: the file does not exist.

    Example:
        >>> pkm.find_machine("example_6tps").name
        'example_6tps.toml'
    """
    path = machine_path(str(name))
    if path is None or not os.path.isfile(path):
        raise Refused(machine_named(name)[1])
    return path


@typed
def read_options(arguments: str) -> Options:
    """Parse options written as on the command line.

    Raises:
        ValueError: an option is unknown or its value invalid.

    Example:
        >>> pkm.read_options("--work-offset=0,0,150 --tip-tolerance 0.002").tip_tolerance
        0.002
    """
    return options_from(overridden(parse_text(_DEFAULT), explicit_values(parse_text(arguments))))


def is_path(source: Source) -> bool:
    """Whether a source is a file rather than a CAM job.

    Raises:
        TypeError: it is neither.
    """
    if not isinstance(source, str | Path) and not hasattr(source, "PostProcessor"):
        raise TypeError(f"source: expected the path of a file or a CAM job, got {type(source).__name__}")
    return isinstance(source, str | Path)


def sound_lengths(lengths: Mapping[int, float]) -> dict[int, float]:
    """Gauge lengths by tool number, checked as those of a command line.

    Raises:
        ValueError: one of them is none.
    """
    try:
        return {operator.index(number): tool_length(str(float(length))) for number, length in lengths.items()}
    except (TypeError, ValueError, argparse.ArgumentTypeError) as fault:
        found = f"tool_lengths: expected mm by tool number, as {{1: 120.0}}, got {dict(lengths)!r:.80}: {fault}"
        raise ValueError(found) from None


def sound_value(value: Value | None, diagnostics: Iterable[Diagnostic]) -> Value:
    """Return the value; issue the warnings.

    Raises:
        Refused: there is no value, or there are errors.
    """
    listed = tuple(diagnostics)
    if value is None or errors(listed):
        raise Refused(listed)
    for diagnostic in listed:
        warnings.warn(str(diagnostic), DiagnosticWarning, stacklevel=4)  # of who called what ``typed`` made
    return value
