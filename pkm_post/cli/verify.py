# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``verify``: whether a motion program matches a trajectory file."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pkm_post.options import add_machine


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    verifying = commands.add_parser("verify", help="say whether a motion program still does what was posted")
    verifying.add_argument("program", type=Path, metavar="PROGRAM.pmc")
    verifying.add_argument("--against", type=Path, required=True, metavar="FILE.pkmt", help="its trajectory file")
    verifying.add_argument("--json", action="store_true", help="write the whole report as JSON")
    add_machine(verifying)
    verifying.set_defaults(run=_verify)


def _verify(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import machine_named
    from pkm_post.model import Refused
    from pkm_post.posting import verify

    machine, faults = machine_named(namespace.machine)
    for fault in faults:
        print(fault, file=sys.stderr)
    if machine is None:
        return 1
    try:
        report, warnings = verify(namespace.program, namespace.against, machine)
    except Refused as refused:
        print(refused, file=sys.stderr)
        return 1
    for warning in warnings:
        print(warning, file=sys.stderr)
    if namespace.json:
        print(json.dumps(report, indent=2))
    else:
        for finding in report["certificate"]["findings"]:
            print(f"{finding['what']}: {finding['value']:g} of {finding['limit']:g} {finding['unit']}".rstrip())
        print(*report["certificate"]["meaning"], f"{namespace.program}: the certificate holds", sep="\n")
    return 0
