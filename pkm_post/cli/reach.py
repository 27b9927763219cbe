# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``reach``: whether a machine can follow a program, and where it could do so better."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inside_freecad import needs_freecad, run_inside
from pkm_post.cli.reading import add_reading, misplaced, reading_from
from pkm_post.options import add_options, applicable_values, explicit_values, input_kind, solid_files

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic
    from pkm_post.posting import Prepared


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    reaching = commands.add_parser("reach", help="say whether a machine can follow FreeCAD documents and part programs")
    reaching.add_argument("files", nargs="+", type=Path, metavar="FILE")
    reaching.add_argument("--job", metavar="NAME", help="this job of the document only, by name or label")
    reaching.add_argument(
        "--place",
        nargs="?",
        const="xyzc",
        default="",
        type=_freedoms,
        metavar="FREEDOMS",
        help="look for a better work offset: x, y, z shift and a, b, c turn the part (xyzc if nothing is said)",
    )
    reaching.add_argument("--json", action="store_true", help="write JSON instead of text")
    add_options(reaching)
    add_reading(reaching)
    reaching.set_defaults(run=_reach)


def _freedoms(text: str) -> str:
    if set(text) - set("xyzabc"):
        raise argparse.ArgumentTypeError(f"expected letters of xyzabc, got {text!r}")
    return text


def _reach(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    faults = misplaced(namespace, namespace.files)
    if faults:
        print(*faults, sep="\n", file=sys.stderr)
        return 2
    if needs_freecad(namespace.files, solid_files(namespace)):
        return run_inside(arguments)
    from pkm_post.model import Refused, errors
    from pkm_post.posting import study

    failed, found = False, []
    for file in namespace.files:
        try:
            programs = list(_programs(file, namespace))
        except Refused as refused:
            programs, failed = [], True
            _tell(refused.diagnostics)
        for prepared in programs:
            told = prepared.found
            if not errors(told):
                made, more = study(*prepared.sound, prepared.options, namespace.place)
                told += more
                found += [made] if made else []
            _tell(told)
            failed |= bool(errors(told))
    if namespace.json:
        print(json.dumps([made.as_dict() for made in found], indent=2))
    else:
        print("\n".join(made.text() for made in found))
    return int(failed)


def _programs(file: Path, namespace: argparse.Namespace) -> Iterator[Prepared]:
    """Yield the programs of a file: that of a part program, or those of the jobs of a document."""
    from pkm_post.posting import prepared_file
    from pkm_post.reading import is_part_program

    given = applicable_values(explicit_values(namespace), input_kind(file))
    if is_part_program(file):
        yield prepared_file(file, reading=reading_from(namespace), arguments=given)
    else:
        from pkm_post.freecad_app.post_job import read_document

        yield from read_document(file, given, namespace.job)


def _tell(diagnostics: Sequence[Diagnostic]) -> None:
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)
