# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read programs, machines and options; errors are raised and warnings issued."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pkm_post.machine import find_machine as machine_path
from pkm_post.machine import machine_named
from pkm_post.model import Diagnostic, Machine, Program, Refused, errors
from pkm_post.options import Options, options_from, parse_text
from pkm_post.posting import (
    prepared_file,
)
from pkm_post.reading import AS_WRITTEN, ReadingOptions

Source = Any
"""Path of a part program, or a CAM job (a document object)."""
_EXAMPLE = "example_6tps"
NO_LENGTHS: Mapping[int, float] = {}
_DEFAULT = "--work-offset G54"
Value = TypeVar("Value")


class DiagnosticWarning(UserWarning):
    """A diagnostic that does not stop the work."""


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

    Example:
        >>> program = pkm.read("part.ngc", tool_lengths={1: 120.0})
        >>> len(program), sorted(program.tools)
        (5, [1])
    """
    if is_path(source):
        prepared = prepared_file(Path(source), None, None, tool_lengths, reading, arguments)
    else:
        from pkm_post.freecad_app import post_job

        prepared = post_job.prepared(source, tool_lengths, arguments)
    return sound_value(prepared.program, prepared.found)


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


def find_machine(name: str) -> Path:
    """Path of a machine file, to copy and edit.

    Args:
        name: name of a machine that comes with PKM Post, or path of a machine file.

    Raises:
        Refused: the file does not exist.

    Example:
        >>> pkm.find_machine("example_6tps").name
        'example_6tps.toml'
    """
    path = machine_path(name)
    if path is None:
        raise Refused(machine_named(name)[1])
    return path


def read_options(arguments: str) -> Options:
    """Parse options written as on the command line.

    Raises:
        ValueError: an option is unknown or its value invalid.

    Example:
        >>> pkm.read_options("--work-offset=0,0,150 --tip-tolerance 0.002").tip_tolerance
        0.002
    """
    return options_from(parse_text(f"{_DEFAULT} {arguments}"))


def is_path(source: Source) -> bool:
    """Whether a source is a file rather than a CAM job."""
    return isinstance(source, str | Path)


def sound_value(value: Value | None, diagnostics: Iterable[Diagnostic]) -> Value:
    """Return the value; issue the warnings.

    Raises:
        Refused: there is no value, or there are errors.
    """
    listed = tuple(diagnostics)
    if value is None or errors(listed):
        raise Refused(listed)
    for diagnostic in listed:
        warnings.warn(str(diagnostic), DiagnosticWarning, stacklevel=3)
    return value
