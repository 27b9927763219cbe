# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inputs: the machine and the part programs of a command line, and their reading options.

Each function converts arguments of ``argparse``. NumPy is imported only where it is needed: a command that runs again
inside FreeCAD starts without it.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from pkm_post.cli.processes import DOCUMENTS, diagnostic_text
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import applicable_values, explicit_values, inapplicable_options, input_kind, part_program_from

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic, Machine
    from pkm_post.posting import Prepared
    from pkm_post.reading import ReadingOptions

Value = TypeVar("Value")

NO_AXIS_WORDS = "none"
"""The default: the tool axis is vertical."""
_FOR_SOME_FILES = {"axis_words": NO_AXIS_WORDS, "dwell_unit": None, "job": None}
"""Arguments that apply to some files only and are not among ``options``, with their defaults."""
MACHINE = "machine shipped with PKM Post, or path of a machine file"
"""Help of NAME_OR_FILE."""


def add_files(parser: argparse.ArgumentParser) -> None:
    """Add the files of a command that reads documents and part programs."""
    help_text = "FreeCAD document with CAM jobs, G-code or CL data"
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help=help_text)


def add_reading(parser: argparse.ArgumentParser) -> None:
    """Add the arguments on a part program's dialect; tool dimensions are among ``options``."""
    parser.add_argument(
        "--axis-words",
        type=axis_words,
        default=NO_AXIS_WORDS,
        metavar="WORDS",
        help="tool axis words of the G-code: vector (I J K after G43.5), AC, BC or AB (rotary words after G43.4), RPY"
        " (A B C of LinuxCNC's hexapod), or none, the default",
    )
    parser.add_argument(
        "--dwell-unit",
        choices=("s", "ms"),
        help="unit of dwell times in G-code, P of G4, G82, G86 and G89 (default: that of its flavour, s for rs274, ms"
        " for fanuc); CAM jobs and CL data use s",
    )


def reading_from(namespace: argparse.Namespace) -> ReadingOptions:
    """Reading options of the part programs."""
    return replace(part_program_from(namespace, namespace.axis_words), dwell_unit=namespace.dwell_unit)


def misplaced(namespace: argparse.Namespace, files: Sequence[Path], documents: Sequence[str] = DOCUMENTS) -> list[str]:
    """Diagnostics of the files that are not read, or of the options that apply to none of the files."""
    try:
        from pkm_post.model import Diagnostic, Place
    except ImportError:  # no NumPy, or one for another Python: this command reruns inside FreeCAD, and checks there
        return []

    if unread := list(_unread(files, documents)):
        return unread
    chosen = (name for name, default in _FOR_SOME_FILES.items() if getattr(namespace, name, default) != default)
    place = Place(str(files[0]) if len(files) == 1 else "arguments")
    messages = inapplicable_options((*explicit_values(namespace), *chosen), {input_kind(file) for file in files})
    return [str(Diagnostic("L442", place, message)) for message in messages]


def _unread(files: Sequence[Path], documents: Sequence[str]) -> Iterator[str]:
    """Yield the diagnostics of files that are neither documents nor part programs by their names."""
    from pkm_post.reading import SUFFIXES, is_part_program

    lower = [suffix.lower() for suffix in documents]
    for file in files:
        if os.path.isdir(file):
            yield diagnostic_text("F103", str(file), "it is a folder")
        elif file.suffix.lower() not in lower and not is_part_program(file):
            yield diagnostic_text("F122", str(file), f"expected one of {', '.join((*documents, *SUFFIXES))}")


def print_misplaced(namespace: argparse.Namespace, files: Sequence[Path], documents: Sequence[str] = DOCUMENTS) -> bool:
    """Print the diagnostics of ``misplaced``; return whether there are any."""
    faults = misplaced(namespace, files, documents)
    print_diagnostics(faults)
    return bool(faults)


def programs_of(file: Path, namespace: argparse.Namespace) -> Iterator[Prepared]:
    """Yield the programs of a file: that of a part program, or those of the jobs of a document."""
    from pkm_post.posting import prepared_file
    from pkm_post.reading import is_part_program

    given = applicable_values(explicit_values(namespace), input_kind(file))
    if is_part_program(file):
        yield prepared_file(file, reading=reading_from(namespace), arguments=given)
    else:
        require_document(file)
        from pkm_post.freecad_app.post_job import read_document

        yield from read_document(file, given, namespace.job)


def require_document(file: Path) -> None:
    """Raise ``Refused`` if there is no such document; FreeCAD need not be started to say so."""
    from pkm_post.model import Diagnostic, Place, Refused

    if not os.path.exists(file):
        raise Refused([Diagnostic("J101", Place(str(file)), "there is no file of this name")])


def sound(value: Value | None, diagnostics: Sequence[Diagnostic]) -> Value:
    """Print the warnings about a value and return it; raise ``Refused`` if there is none."""
    from pkm_post.model import required

    value = required(value, diagnostics)
    print_diagnostics(diagnostics)
    return value


def read_machine(name: str) -> Machine:
    """The machine with this name or file."""
    from pkm_post.machine import machine_named

    return sound(*machine_named(name))


def tool_length_of(namespace: argparse.Namespace, machine: Machine) -> float:
    """The given gauge length, or that of the rest pose, mm."""
    return float(machine.rest_tool_length if namespace.tool_length is None else namespace.tool_length)


@contextmanager
def results_in(out: Path) -> Iterator[Path]:
    """Yield a private folder, whose files appear together in the folder ``out``; print their names.

    Raises:
        Refused: they cannot be written.
    """
    from pkm_post.model import Refused
    from pkm_post.system import staged, write_fault

    try:
        with staged(out) as folder:
            yield folder
            names = sorted(path.name for path in folder.iterdir())
    except OSError as fault:
        raise Refused([write_fault(out, fault)]) from fault
    print(*(out / name for name in names), sep="\n")


def one_of(allowed: Collection[str], text: str) -> str:
    """An allowed word."""
    if text not in allowed:
        raise argparse.ArgumentTypeError(f"expected one of {', '.join(allowed)}, got {text!r}")
    return text


def axis_words(text: str) -> str:
    """Notation of the tool axis; ``argparse`` also converts the default, possibly without NumPy."""
    if text == NO_AXIS_WORDS:
        return text
    from pkm_post.reading import AXIS_WORDS

    return one_of(AXIS_WORDS, text)
