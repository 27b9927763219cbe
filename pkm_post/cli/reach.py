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
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import MACHINE, add_files, add_reading, print_misplaced, programs_of, read_machine, results_in
from pkm_post.cli.processes import needs_freecad, run_inside, wrong_usage
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
    reaching.add_argument(
        "--place",
        nargs="?",
        const="xyzc",
        default="",
        type=_freedoms,
        metavar="FREEDOMS",
        help="search for a better work offset: x, y, z shift and a, b, c rotate the part (xyzc without a value)",
    )
    _add_study(reaching, _reach)

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
    stiff.add_argument(
        "--step", type=between(1, 1000), default=25.0, metavar="MM", help="spacing on the table (default: %(default)s)"
    )
    stiff.add_argument("--out", type=Path, metavar="DIR", help="write both maps as CSV, and the table as a picture")
    _add_study(stiff, _stiffness)


def _add_study(parser: argparse.ArgumentParser, run: Callable[[argparse.Namespace, Sequence[str]], int]) -> None:
    """Add what the studies of programs have in common."""
    parser.add_argument("--job", metavar="NAME", help="only this job of the document, by name or label")
    parser.add_argument("--json", action="store_true", help="write JSON instead of text")
    add_options(parser)
    add_reading(parser)
    parser.set_defaults(run=run)


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
    from pkm_post.system import threads

    if math.prod(map(len, (namespace.x, namespace.y, namespace.z))) > _MAX_POINTS:
        expected = f"expected --x, --y and --z with at most {_MAX_POINTS} places together"
        return wrong_usage("U103", "reach-map", expected)
    machine = read_machine(namespace.machine)
    grid = np.meshgrid(namespace.x, namespace.y, namespace.z, indexing="ij")
    places = np.column_stack([column.ravel() for column in grid])
    with ThreadPoolExecutor(min(threads(), 8)) as executor:
        tilts = reach_map(machine, places, namespace.length, math.radians(namespace.widest), executor=executor)
    stem = f"{Path(namespace.machine).stem}-reach"
    with results_in(namespace.out) as folder:
        (folder / f"{stem}.csv").write_text(tilts.as_csv(), encoding="ascii", newline="\n")
        print_diagnostics(draw_reach(folder / f"{stem}.png", machine.name, tilts.tip, tilts.cone))
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
        _write(studies, namespace.out)
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


def _write(studies: Sequence[StiffnessStudy], out: Path) -> None:
    """Write the maps, and print the names of the files."""
    from pkm_post.options import job_stem
    from pkm_post.report import draw_levels

    with results_in(out) as folder:
        for number, study in enumerate(studies, start=1):
            stem = job_stem(Path(study.trajectory.source).stem, str(number), len(studies))
            for name, found in (("stiffness", study.job), ("stiffness-table", study.table)):
                (folder / f"{stem}-{name}.csv").write_text(found.as_csv(), encoding="ascii", newline="\n")
            picture, title = folder / f"{stem}-stiffness-table.png", f"Stiffness of {study.machine}"
            tip, least = study.table.tip, study.table.least / 1000.0
            print_diagnostics(draw_levels(picture, title, "in the softest direction, N/um", tip, least))
