# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``post``: FreeCAD documents, G-code and CL data become certified motion programs."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inside_freecad import is_inside, run_inside
from pkm_post.cli.reading import add_reading, reading_from
from pkm_post.options import add_options, options_from, tool_lengths_from

if TYPE_CHECKING:
    from pkm_post.pipeline import Posted


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    text = "turn FreeCAD documents with CAM jobs, G-code and CL data into certified motion programs"
    post = commands.add_parser("post", help=text)
    post.add_argument("files", nargs="+", type=Path, metavar="FILE")
    post.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="folder for the results (default: here)")
    post.add_argument("--job", metavar="NAME", help="post this job of the document only, by name or label")
    add_options(post)
    add_reading(post)
    post.set_defaults(run=_post)


def _post(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.model import Refused
    from pkm_post.sources import is_part_program

    twice = [stem for stem, count in Counter(file.stem for file in namespace.files).items() if count > 1]
    if twice:
        print(f"several files would be posted as {', '.join(twice)}: post them to different folders", file=sys.stderr)
        return 2
    if not is_inside() and not all(map(is_part_program, namespace.files)):
        return run_inside(arguments)
    for file in namespace.files:
        post = _part_program if is_part_program(file) else _document
        try:
            results = post(file, namespace)
        except Refused as refused:
            print(refused, file=sys.stderr)
            return 1
        for result in results:
            _tell(result)
    return 0


def _part_program(file: Path, namespace: argparse.Namespace) -> tuple[Posted, ...]:
    from pkm_post.post_file import post_file

    posted = post_file(
        file,
        namespace.machine,
        namespace.out,
        options=options_from(namespace),
        tool_lengths=tool_lengths_from(namespace),
        reading=reading_from(namespace),
        log=print,
    )
    return (posted,)


def _document(file: Path, namespace: argparse.Namespace) -> tuple[Posted, ...]:
    from pkm_post.freecad_app.post_job import post_document

    return post_document(
        file,
        machine=namespace.machine,
        out=namespace.out,
        options=options_from(namespace),
        tool_lengths=tool_lengths_from(namespace),
        job_name=namespace.job,
        log=print,
    )


def _tell(posted: Posted) -> None:
    for diagnostic in posted.diagnostics:
        print(diagnostic, file=sys.stderr)
    for path in posted.files:
        print(path)
