# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``check`` and ``convert``: read part programs, and report on them or write them in another form."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pkm_post.cli.reading import add_reading, misplaced, one_of, part_program, reading_from
from pkm_post.options import add_part_program


def add_commands(commands: Any) -> None:
    """Add the commands to a parser."""
    checking = commands.add_parser("check", help="say what is wrong with part programs, and what they hold")
    checking.add_argument("files", nargs="+", type=part_program, metavar="FILE")
    checking.add_argument("--json", action="store_true", help="write JSON instead of text")
    add_reading(checking)
    add_part_program(checking)
    checking.set_defaults(run=_check)

    converting = commands.add_parser("convert", help="write a part program in another form of G-code")
    converting.add_argument("file", type=part_program, metavar="FILE")
    forms = "gcode:vector, gcode:AC, gcode:BC, gcode:linuxcnc or gcode:3axis"
    converting.add_argument("--to", required=True, type=_target, metavar="FORM", help=forms)
    converting.add_argument("--out", required=True, type=Path, metavar="FILE", help="the file to write")
    converting.add_argument("--inch", action="store_true", help="write inches (G20)")
    add_reading(converting)
    add_part_program(converting)
    converting.set_defaults(run=_convert)


def _target(text: str) -> str:
    from pkm_post.writing import TARGETS

    return one_of(TARGETS, text)


def _tell_misplaced(namespace: argparse.Namespace, files: Sequence[Path]) -> bool:
    """Print the options that do not apply to the files; return whether there are any."""
    faults = misplaced(namespace, files)
    for fault in faults:
        print(fault, file=sys.stderr)
    return bool(faults)


def _check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.reading import check

    if _tell_misplaced(namespace, namespace.files):
        return 2
    results = [check.check(file, reading_from(namespace)) for file in namespace.files]
    print(check.as_json(results) if namespace.json else check.as_text(results))
    return 0 if all(result.is_clean for result in results) else 1


def _convert(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.model import errors
    from pkm_post.writing import convert

    if _tell_misplaced(namespace, [namespace.file]):
        return 2
    reading = reading_from(namespace)
    diagnostics = convert(namespace.file, namespace.to, namespace.out, reading, inch=namespace.inch)
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)
    if errors(diagnostics):
        return 1
    print(namespace.out)
    return 0
