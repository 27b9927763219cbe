# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: ``python3 -m pkm_post post part.FCStd --machine example_6tps --out DIR`` and its like.

Exit code 0 when all was done, 1 when the input was refused, 2 when the arguments make no sense. A FreeCAD document
can be read by FreeCAD alone: outside of it the command starts FreeCADCmd and runs itself inside. Part programs of other
sources are checked and converted without it.
"""

from __future__ import annotations

import argparse
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Collection, Sequence
from pathlib import Path

import pkm_post
from pkm_post.options import add_options, options_from, tool_lengths_from

_ADDON = Path(__file__).resolve().parents[1]
_OPTIONAL = ("lark",)
"""Packages that not every installation has; their doors say what to install."""


def main(arguments: Sequence[str]) -> int:
    """Run one command and return its exit code."""
    namespace = _parser().parse_args(arguments)
    try:
        code: int = namespace.run(namespace, arguments)
    except ImportError as missing:
        if missing.name not in _OPTIONAL:
            raise
        print(missing, file=sys.stderr)
        return 1
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

    checking = commands.add_parser("check", help="say what is wrong with part programs, and what they hold")
    checking.add_argument("files", nargs="+", type=_part_program, metavar="FILE")
    checking.add_argument("--json", action="store_true", help="write JSON instead of text")
    _add_reading(checking)
    checking.set_defaults(run=_check)

    converting = commands.add_parser("convert", help="write a part program in another form of G-code")
    converting.add_argument("file", type=_part_program, metavar="FILE")
    forms = "gcode:vector, gcode:AC, gcode:BC, gcode:linuxcnc or gcode:3axis"
    converting.add_argument("--to", required=True, type=_target, metavar="FORM", help=forms)
    converting.add_argument("--out", required=True, type=Path, metavar="FILE", help="the file to write")
    converting.add_argument("--inch", action="store_true", help="write inches (G20)")
    _add_reading(converting)
    converting.set_defaults(run=_convert)

    machine = commands.add_parser("machine", help="list and check machine files")
    actions = machine.add_subparsers(required=True, metavar="ACTION")
    listing = actions.add_parser("list", help="name the machines that come with PKM Post")
    listing.set_defaults(run=_machine_list)
    machine_check = actions.add_parser("check", help="say whether a machine file is complete and makes sense")
    machine_check.add_argument("file", metavar="NAME_OR_FILE")
    machine_check.set_defaults(run=_machine_check)
    return parser


def _add_reading(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--axis-words",
        type=_axis_words,
        default="none",
        metavar="WORDS",
        help="how the G-code says the tool axis: vector (I J K after G43.5), AC, BC or AB (rotary words after G43.4),"
        " RPY (A B C of LinuxCNC's hexapod), or none, the default",
    )
    parser.add_argument(
        "--tool",
        dest="tools",
        action="append",
        type=_tool_diameter,
        default=[],
        metavar="NUMBER=MM",
        help="diameter of a tool, for G41 and G42; may be repeated",
    )


def _axis_words(text: str) -> str:
    from pkm_post.sources import AXIS_WORDS

    return _one_of(AXIS_WORDS, text)


def _target(text: str) -> str:
    from pkm_post.convert import TARGETS

    return _one_of(TARGETS, text)


def _one_of(allowed: Collection[str], text: str) -> str:
    if text not in allowed:
        raise argparse.ArgumentTypeError(f"expected one of {', '.join(allowed)}, got {text!r}")
    return text


def _part_program(text: str) -> Path:
    from pkm_post.sources import SUFFIXES, is_part_program

    file = Path(text)
    if not file.is_file():
        raise argparse.ArgumentTypeError(f"there is no file {text}")
    if not is_part_program(file):
        raise argparse.ArgumentTypeError(f"expected a file ending in {', '.join(SUFFIXES)}, got {text}")
    return file


def _tool_diameter(text: str) -> tuple[int, float]:
    number, _, diameter = text.partition("=")
    try:
        value = int(number), float(diameter)
    except ValueError:
        value = 0, math.nan
    if not 0 < value[1] < math.inf:
        raise argparse.ArgumentTypeError(f"expected NUMBER=MM, got {text!r}")
    return value


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


def _check(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post import check
    from pkm_post.sources import Reading

    reading = Reading(namespace.axis_words, dict(namespace.tools))
    results = [check.check(file, reading) for file in namespace.files]
    print(check.as_json(results) if namespace.json else check.as_text(results))
    return 0 if all(result.is_clean for result in results) else 1


def _convert(namespace: argparse.Namespace, arguments: Sequence[str]) -> int:
    from pkm_post.convert import convert
    from pkm_post.model.diagnostics import errors
    from pkm_post.sources import Reading

    reading = Reading(namespace.axis_words, dict(namespace.tools))
    diagnostics = convert(namespace.file, namespace.to, namespace.out, reading, inch=namespace.inch)
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)
    if errors(diagnostics):
        return 1
    print(namespace.out)
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
