# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``machine list`` and ``machine check``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Any


def add_commands(commands: Any) -> None:
    """Add the commands to a parser."""
    machine = commands.add_parser("machine", help="list and check machine files")
    actions = machine.add_subparsers(required=True, metavar="ACTION")
    listing = actions.add_parser("list", help="name the machines that come with PKM Post")
    listing.set_defaults(run=_list)
    checking = actions.add_parser("check", help="say whether a machine file is complete and makes sense")
    checking.add_argument("file", metavar="NAME_OR_FILE")
    checking.set_defaults(run=_check)


def _list(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine_file import presets

    print("\n".join(presets()))
    return 0


def _check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine_file import machine_named

    machine, diagnostics = machine_named(namespace.file)
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)
    if machine is None:
        return 1
    print(f"{machine.name}: complete, work offsets {', '.join(sorted(machine.work_offsets)) or 'none'}")
    return 0
