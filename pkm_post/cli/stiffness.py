# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``stiffness``: stiffness of the tool tip along programs, and over the whole table."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import add_files, add_reading, print_misplaced, programs_of
from pkm_post.cli.processes import needs_freecad, run_inside
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import add_options, solid_files, validated
from pkm_post.options import number as any_number

if TYPE_CHECKING:
    from pkm_post.posting import Prepared, StiffnessStudy

_step = validated(any_number, lambda mm: 1.0 <= mm <= 1000.0, "a distance from 1 to 1000 mm")


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    parser = commands.add_parser("stiffness", help="how stiff the tool is held along programs and over the table")
    add_files(parser)
    parser.add_argument("--job", metavar="NAME", help="this job of the document only, by name or label")
    parser.add_argument(
        "--step", type=_step, default=25.0, metavar="MM", help="distance of places on the table (default: %(default)s)"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write both maps as CSV, and the table as a picture")
    parser.add_argument("--json", action="store_true", help="write JSON instead of text")
    add_options(parser)
    add_reading(parser)
    parser.set_defaults(run=_stiffness)


def _stiffness(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    if print_misplaced(namespace, namespace.files):
        return 2
    if needs_freecad(namespace.files, solid_files(namespace)):
        return run_inside(arguments)
    from pkm_post.model import Refused

    found: list[StiffnessStudy | None] = []
    for file in namespace.files:
        try:
            found += [_studied(program, namespace) for program in programs_of(file, namespace)]
        except Refused as refused:
            print_diagnostics(refused.diagnostics)
            found.append(None)
    studies = [study for study in found if study is not None]
    failed = len(studies) < len(found)
    if namespace.json:
        print(json.dumps([study.as_dict() for study in studies], indent=2))
    else:
        print("\n".join(study.text() for study in studies))
    if namespace.out is not None and studies:
        failed |= not _written(studies, namespace.out)
    return int(failed)


def _studied(program: Prepared, namespace: argparse.Namespace) -> StiffnessStudy | None:
    """The study of a program; None after its faults are printed: other jobs of its document need not be refused."""
    from pkm_post.model import Refused
    from pkm_post.posting import stiffness_study

    try:
        trajectory, found = program.placed()
    except Refused as refused:
        print_diagnostics(refused.diagnostics)
        return None
    study, faults = stiffness_study(trajectory, program.sound[1], namespace.step)
    print_diagnostics((*found, *faults))
    return study


def _written(studies: Sequence[StiffnessStudy], out: Path) -> bool:
    """Write the maps, print the names of the files, and return whether that succeeded."""
    from pkm_post.options import job_stem
    from pkm_post.report import draw_levels
    from pkm_post.system import staged, write_fault

    try:
        with staged(out) as folder:
            for number, study in enumerate(studies, start=1):
                stem = job_stem(Path(study.trajectory.source).stem, str(number), len(studies))
                for name, found in (("stiffness", study.job), ("stiffness-table", study.table)):
                    (folder / f"{stem}-{name}.csv").write_text(found.as_csv(), encoding="ascii", newline="\n")
                print_diagnostics(
                    draw_levels(
                        folder / f"{stem}-stiffness-table.png",
                        f"Stiffness of {study.machine}",
                        "in the softest direction, N/um",
                        study.table.tip,
                        study.table.least / 1000.0,
                    )
                )
            names = sorted(path.name for path in folder.iterdir())
    except OSError as fault:
        print_diagnostics([write_fault(out, fault)])
        return False
    print(*(out / name for name in names), sep="\n")
    return True
