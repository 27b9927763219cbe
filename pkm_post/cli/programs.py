# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``check``, ``convert``, ``verify`` and ``cartesian``: examine programs, or write them in another form.

``check`` and ``convert`` read part programs; ``verify`` compares a motion program with its trajectory file.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pkm_post.cli.inputs import add_reading, one_of, print_misplaced, read_machine, reading_from
from pkm_post.cli.terminal import print_diagnostics
from pkm_post.options import add_machine, add_part_program, between, whole

if TYPE_CHECKING:
    from pkm_post.model import Finding


def add_commands(commands: Any) -> None:
    """Add the commands to a parser."""
    checking = commands.add_parser("check", help="list the faults of part programs, and summarise their contents")
    checking.add_argument("files", nargs="+", type=Path, metavar="FILE", help="G-code or CL data")
    form = checking.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="write JSON instead of text")
    form.add_argument("--listing", action="store_true", help="write every line with its findings beneath it")
    add_reading(checking)
    add_part_program(checking)
    checking.set_defaults(run=_check)

    converting = commands.add_parser("convert", help="write a part program in another form of G-code")
    converting.add_argument("file", type=Path, metavar="FILE", help="G-code or CL data")
    forms = "gcode:vector, gcode:AC, gcode:BC, gcode:linuxcnc or gcode:3axis"
    converting.add_argument("--to", required=True, type=_target, metavar="FORM", help=forms)
    converting.add_argument("--out", required=True, type=Path, metavar="FILE", help="the file to write")
    converting.add_argument("--inch", action="store_true", help="write inches (G20)")
    add_reading(converting)
    add_part_program(converting)
    converting.set_defaults(run=_convert)

    verifying = commands.add_parser("verify", help="check that a motion program still follows the posted path")
    help_text = "the program, or the first of its parts"
    verifying.add_argument("program", type=Path, metavar="PROGRAM.pmc", help=help_text)
    verifying.add_argument("--against", type=Path, required=True, metavar="FILE.pkmt", help="its trajectory file")
    verifying.add_argument("--json", action="store_true", help="write the whole report as JSON")
    add_machine(verifying)
    verifying.set_defaults(run=_verify)

    turning = commands.add_parser("cartesian", help="write a posted program in X Y Z A B C, for kinematics in a PMAC")
    turning.add_argument("program", type=Path, metavar="PROGRAM.pmc", help=help_text)
    turning.add_argument("--against", type=Path, required=True, metavar="FILE.pkmt", help="its trajectory file")
    turning.add_argument("--out", type=Path, required=True, metavar="FILE", help="the file to write")
    for name, what in (("tool", "the gauge length in Q50"), ("origin", "each of Q51 to Q53")):
        help_text = f"permitted change of {what} at the machine; certified at all corners (%(default)s)"
        turning.add_argument(f"--{name}-range", type=between(0, 100), default=0.0, metavar="MM", help=help_text)
    help_text = "Coord[].SegMoveTime of a Power PMAC: whole ms, 0 without segmentation (%(default)s)"
    turning.add_argument("--segment-time", type=whole(0, 100), default=0, metavar="MS", help=help_text)
    add_machine(turning)
    turning.set_defaults(run=_cartesian)


def _target(text: str) -> str:
    from pkm_post.writing import TARGETS

    return one_of(TARGETS, text)


def _check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.reading import check_file, checks_as_json, checks_as_text, listing_lines

    if print_misplaced(namespace, namespace.files, documents=()):
        return 2
    results = [check_file(file, reading_from(namespace)) for file in namespace.files]
    if namespace.listing:
        sys.stdout.writelines(f"{line}\n" for result in results for line in listing_lines(result))
    else:
        print(checks_as_json(results) if namespace.json else checks_as_text(results))
    return 0 if all(result.is_clean for result in results) else 1


def _convert(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.model import errors
    from pkm_post.writing import convert

    if print_misplaced(namespace, [namespace.file], documents=()):
        return 2
    reading = reading_from(namespace)
    diagnostics = convert(namespace.file, namespace.to, namespace.out, reading, inch=namespace.inch)
    print_diagnostics(diagnostics)
    if errors(diagnostics):
        return 1
    print(namespace.out)
    return 0


def _verify(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.posting import verify

    machine = read_machine(namespace.machine)
    certificate, report, warnings = verify(namespace.program, namespace.against, machine)
    print_diagnostics(warnings)
    if namespace.json:
        print(json.dumps(report, indent=2))
    else:
        print(*map(_finding_line, certificate.findings), sep="\n")
        print(*report["certificate"]["meaning"], f"{namespace.program}: the certificate holds", sep="\n")
    return 0


def _finding_line(finding: Finding) -> str:
    bound = ", at least" if finding.is_least else " of"
    return f"{finding.name}: {finding.value:g}{bound} {finding.limit:g} {finding.unit}".rstrip()


_PLAYED = {
    "turbo_pmac": "played with kinematics in doubles, where the controller has 36 bits; no segmentation in PVT mode",
    "power_pmac": "played with kinematics in doubles, as in the controller; segments of {} ms, 0 for none",
}


def _cartesian(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.posting import Allowance, cartesian_program

    machine = read_machine(namespace.machine)
    allowance = Allowance(round(namespace.tool_range, 3), round(namespace.origin_range, 3))
    files = namespace.program, namespace.against, machine, namespace.out
    made = cartesian_program(*files, allowance, namespace.segment_time)
    print(*map(_finding_line, made.certificate.findings), sep="\n")
    print(f"struts at most {made.off:.2e} mm from those of {namespace.program} at its points")
    print(_PLAYED[machine.controller["kind"]].format(namespace.segment_time))
    print(*made.files, sep="\n")
    return 0
