# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: ``python3 -m pkm_post post part.FCStd --machine example_6tps --out DIR`` and its like.

Exit code 0 when all was done, 1 when the input was refused, 2 when the arguments make no sense. A FreeCAD document
can be read by FreeCAD alone: outside of it the command starts FreeCADCmd and runs itself inside.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pkm_post
from pkm_post.options import add_options, options_from, tool_lengths_from

_ADDON = Path(__file__).resolve().parents[1]


def main(arguments: Sequence[str]) -> int:
    """Run one command and return its exit code."""
    namespace = _parser().parse_args(arguments)
    code: int = namespace.run(namespace, arguments)
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m pkm_post", description=pkm_post.__doc__)
    parser.add_argument("--version", action="version", version=f"PKM Post {pkm_post.__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    post = commands.add_parser("post", help="turn FreeCAD documents with CAM jobs into certified motion programs")
    post.add_argument("files", nargs="+", type=Path, metavar="FILE.FCStd")
    post.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="folder for the results (default: here)")
    post.add_argument("--job", metavar="NAME", help="post this job of the document only, by name or label")
    add_options(post)
    post.set_defaults(run=_post)

    machine = commands.add_parser("machine", help="list and check machine files")
    actions = machine.add_subparsers(required=True, metavar="ACTION")
    listing = actions.add_parser("list", help="name the machines that come with PKM Post")
    listing.set_defaults(run=_machine_list)
    check = actions.add_parser("check", help="say whether a machine file is complete and makes sense")
    check.add_argument("file", metavar="NAME_OR_FILE")
    check.set_defaults(run=_machine_check)
    return parser


def _post(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    if "FreeCAD" not in sys.modules:
        return _inside_freecad(arguments)
    from pkm_post.freecad_app.post_job import post_document
    from pkm_post.model import Refused

    for file in namespace.files:
        try:
            results = post_document(
                file,
                machine=namespace.machine,
                out=namespace.out,
                options=options_from(namespace),
                tool_lengths=tool_lengths_from(namespace),
                job_name=namespace.job,
                log=print,
            )
        except Refused as refused:
            print(refused, file=sys.stderr)
            return 1
        for result in results:
            for diagnostic in result.diagnostics:
                print(diagnostic, file=sys.stderr)
            for path in result.files:
                print(path)
    return 0


def _inside_freecad(arguments: Sequence[str]) -> int:
    """Run the same command inside FreeCADCmd, with this add-on loaded."""
    freecad = _freecad_command()
    if not freecad:
        print("FreeCAD 1.0 or newer is needed: install it, or name its FreeCADCmd in $FREECADCMD", file=sys.stderr)
        return 1
    frame, module = _ADDON / "tools" / "run_script.py", _ADDON / "pkm_post" / "__main__.py"
    command = [*freecad, "-M", str(_ADDON), str(frame), "--", str(module), *arguments]
    return subprocess.run(command, check=False).returncode


def _freecad_command() -> list[str]:
    """How FreeCADCmd is started: as the user says, by the finder that comes with the add-on, or from the path."""
    if os.environ.get("FREECADCMD"):
        return [os.environ["FREECADCMD"]]
    finder = _ADDON / "tools" / "freecad"
    if finder.exists() and shutil.which("bash"):
        return [str(finder)]
    found = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    return [found] if found else []


def _machine_list(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine_file import presets

    print("\n".join(presets()))
    return 0


def _machine_check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.machine_file import find_machine, read_machine

    path = find_machine(namespace.file)
    machine, diagnostics = read_machine(path or Path(namespace.file))
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)
    if machine is None:
        return 1
    print(f"{machine.name}: complete, work offsets {', '.join(sorted(machine.work_offsets)) or 'none'}")
    return 0
