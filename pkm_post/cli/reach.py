# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``reach``, ``reach-map`` and ``stiffness``: what a machine can do along programs and over its table.

``reach`` checks whether it can follow a program, and finds a better place for it; ``reach-map`` gives the feasible tool
tilt over the work volume; ``stiffness`` that of the tool tip along programs and over the table.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import MACHINE, add_files, add_reading, print_misplaced, programs_of, read_machine
from pkm_post.cli.processes import diagnostic_text, needs_freecad, run_inside
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import add_options, between, number, offset, positive, solid_files, tool_length, validated

if TYPE_CHECKING:
    from pkm_post.posting import Prepared, StiffnessStudy

_angle = validated(number, lambda degrees: 0 < degrees < 180, "an angle above 0 and below 180")

_MAX_POINTS = 1_000_000
"""A file with this many points has some tens of megabytes."""


def add_commands(commands: Any) -> None:
    """Add the commands to a parser."""
    reaching = commands.add_parser(
        "reach", help="check whether a machine can follow FreeCAD documents and part programs"
    )
    add_files(reaching)
    reaching.add_argument("--job", metavar="NAME", help="only this job of the document, by name or label")
    reaching.add_argument(
        "--place",
        nargs="?",
        const="xyzc",
        default="",
        type=_freedoms,
        metavar="FREEDOMS",
        help="search for a better work offset: x, y, z shift and a, b, c rotate the part (xyzc without a value)",
    )
    reaching.add_argument("--json", action="store_true", help="write JSON instead of text")
    add_options(reaching)
    add_reading(reaching)
    reaching.set_defaults(run=_reach)

    mapping = commands.add_parser("reach-map", help="map the possible tilt of the tool over the work volume")
    mapping.add_argument("machine", metavar="NAME_OR_FILE", help=MACHINE)
    mapping.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="folder for the CSV and the picture")
    mapping.add_argument(
        "--length", type=tool_length, default=120.0, metavar="MM", help="gauge length (default: %(default)s)"
    )
    for name, default in (("x", "-300:300:50"), ("y", "-300:300:50"), ("z", "0:500:100")):
        mapping.add_argument(f"--{name}", type=_range, default=default, metavar="FROM:TO:STEP", help="mm, %(default)s")
    mapping.add_argument("--widest", type=_angle, default=60.0, metavar="DEG", help="largest angle (%(default)s)")
    mapping.set_defaults(run=_map)

    stiff = commands.add_parser("stiffness", help="map the stiffness of the tool tip along programs and over the table")
    add_files(stiff)
    stiff.add_argument("--job", metavar="NAME", help="only this job of the document, by name or label")
    stiff.add_argument(
        "--step",
        type=between(1, 1000),
        default=25.0,
        metavar="MM",
        help="spacing on the table (default: %(default)s)",
    )
    stiff.add_argument("--out", type=Path, metavar="DIR", help="write both maps as CSV, and the table as a picture")
    stiff.add_argument("--json", action="store_true", help="write JSON instead of text")
    add_options(stiff)
    add_reading(stiff)
    stiff.set_defaults(run=_stiffness)


def _freedoms(text: str) -> str:
    if set(text) - set("xyzabc"):
        raise argparse.ArgumentTypeError(f"expected letters of xyzabc, got {text!r}")
    return text


def _reach(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    if print_misplaced(namespace, namespace.files):
        return 2
    if needs_freecad(namespace.files, solid_files(namespace)):
        return run_inside(arguments)
    from pkm_post.model import Refused, errors
    from pkm_post.posting import place_offer, study

    failed, studies = False, []
    for file in namespace.files:
        try:
            programs = list(programs_of(file, namespace))
        except Refused as refused:
            programs, failed = [], True
            print_diagnostics(refused.diagnostics)
        for program in programs:
            diagnostics = program.found
            if not errors(diagnostics):
                result, faults = study(*program.sound, program.options, namespace.place)
                diagnostics += faults
                studies += [result] if result else []
            offer = "" if namespace.place else place_offer(diagnostics, str(file))
            print_diagnostics(each for each in (*diagnostics, offer) if each)
            failed |= bool(errors(diagnostics))
    if namespace.json:
        print(json.dumps([result.as_dict() for result in studies], indent=2))
    else:
        sys.stdout.writelines(f"{result.text()}\n" for result in studies)
    return int(failed)


def _range(text: str) -> list[float]:
    words = text.split(":")
    if len(words) != 3:
        raise argparse.ArgumentTypeError(f"expected FROM:TO:STEP, got {text!r}")
    first, last, step = offset(words[0]), offset(words[1]), positive(words[2])
    steps = (last - first) / step * (1 + 1e-12)
    if not 0 <= steps < _MAX_POINTS:
        raise argparse.ArgumentTypeError(f"expected FROM:TO:STEP with 1 to {_MAX_POINTS} places, got {text!r}")
    return [first + place * step for place in range(math.floor(steps) + 1)]


def _map(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    import numpy as np

    from pkm_post.machine import reach_map
    from pkm_post.report import draw_reach
    from pkm_post.system import staged, threads, write_fault

    if math.prod(map(len, (namespace.x, namespace.y, namespace.z))) > _MAX_POINTS:
        expected = f"expected --x, --y and --z with at most {_MAX_POINTS} places together"
        print_diagnostics([diagnostic_text("U103", "reach-map", expected)])
        return 2
    machine = read_machine(namespace.machine)
    if machine is None:
        return 1
    grid = np.meshgrid(namespace.x, namespace.y, namespace.z, indexing="ij")
    places = np.column_stack([column.ravel() for column in grid])
    with ThreadPoolExecutor(min(threads(), 8)) as executor:
        tilts = reach_map(machine, places, namespace.length, math.radians(namespace.widest), executor=executor)
    stem = f"{Path(namespace.machine).stem}-reach"
    try:
        with staged(namespace.out) as folder:
            (folder / f"{stem}.csv").write_text(tilts.as_csv(), encoding="ascii", newline="\n")
            print_diagnostics(draw_reach(folder / f"{stem}.png", machine.name, tilts.tip, tilts.cone))
            names = sorted(path.name for path in folder.iterdir())
    except OSError as fault:
        print_diagnostics([write_fault(namespace.out, fault)])
        return 1
    for name in names:
        print(namespace.out / name)
    return 0


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
        sys.stdout.writelines(f"{study.text()}\n" for study in studies)
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
