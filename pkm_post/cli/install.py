# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``install``: optional packages for this Python, or for FreeCAD's."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pkm_post.cli.processes import is_inside, run_inside, wrong_usage
from pkm_post.system import packages

_BY_NAME = {package: module for module, package in packages.OPTIONAL.items()}


def add_commands(commands: Any) -> None:
    """Add the command to a parser."""
    purposes = ", ".join(f"{packages.OPTIONAL[module]} for {why}" for module, why in packages.PURPOSES.items())
    installing = commands.add_parser("install", help="install optional Python packages", description=f"{purposes}.")
    installing.add_argument(
        "packages", nargs="*", metavar="PACKAGE", help=f"{', '.join(_BY_NAME)} (default: all that are missing)"
    )
    installing.add_argument(
        "--from", dest="wheels", type=Path, metavar="DIR", help="folder with wheels, in place of the package index"
    )
    installing.add_argument("--freecad", action="store_true", help="install for FreeCAD's Python, into its own folder")
    installing.set_defaults(run=_install)


def _install(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    if namespace.freecad and not is_inside():
        return run_inside(arguments)
    unknown = [name for name in namespace.packages if name not in _BY_NAME]
    if unknown:
        expected = f"expected some of {', '.join(_BY_NAME)}, got {', '.join(unknown)}"
        return wrong_usage("U103", "PACKAGE", expected)
    if namespace.wheels is not None and not namespace.wheels.is_dir():
        return wrong_usage("U103", "--from", f"there is no folder {namespace.wheels}")
    modules = [_BY_NAME[name] for name in namespace.packages] or packages.missing()
    if not modules:
        print("nothing is missing")
        return 0
    try:
        print(packages.install(modules, namespace.wheels))
    except packages.NotInstalledError as fault:
        print(fault, file=sys.stderr)
        return 1
    return 0
