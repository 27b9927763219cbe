# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``machine list``, ``machine check`` and ``machine calibrate``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pkm_post.cli.terminal import print_diagnostics


def add_commands(commands: Any) -> None:
    """Add the commands to a parser."""
    machine = commands.add_parser("machine", help="list, check and calibrate machine files")
    actions = machine.add_subparsers(required=True, metavar="ACTION")
    listing = actions.add_parser("list", help="name the machines that come with PKM Post")
    listing.set_defaults(run=_list)
    checking = actions.add_parser("check", help="say whether a machine file is complete and makes sense")
    checking.add_argument("file", metavar="NAME_OR_FILE")
    checking.set_defaults(run=_check)
    calibrating = actions.add_parser("calibrate", help="find the joints of a machine from measured poses")
    calibrating.add_argument("file", metavar="NAME_OR_FILE")
    calibrating.add_argument("measurements", type=Path, metavar="MEASUREMENTS.csv", help="see docs/machine-file.md")
    calibrating.add_argument("--out", required=True, type=Path, metavar="NEW.toml", help="the machine file to write")
    calibrating.set_defaults(run=_calibrate)


def _list(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import presets, templates

    print("\n".join([*presets(), *(f"{name} (template, to be copied and filled in)" for name in templates())]))
    return 0


def _check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import machine_named
    from pkm_post.model import errors
    from pkm_post.posting import format_table, machine_faults, machine_summary

    machine, diagnostics = machine_named(namespace.file)
    if machine is not None:
        diagnostics = machine_faults(machine, namespace.file)
    print_diagnostics(diagnostics)
    if machine is None or errors(diagnostics):
        return 1
    print(f"{machine.name}: complete")
    print(format_table(machine_summary(machine)))
    return 0


def _calibrate(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine import calibrate_file

    report, diagnostics = calibrate_file(namespace.file, namespace.measurements, namespace.out)
    print_diagnostics(diagnostics)
    if report is None:
        return 1
    print(report)
    print(namespace.out)
    return 0
