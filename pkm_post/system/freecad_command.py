# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD command: find FreeCADCmd, FreeCAD's program without a window.

Input: the environment of the process and the system. Output: the beginning of a command line, or the reason for none.
The environment variable FREECADCMD takes precedence, then the path, then the install locations of FreeCAD's own bundles
for Windows, macOS and Linux, the highest version first.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

VARIABLE = "FREECADCMD"
_NAMES = ("freecadcmd", "FreeCADCmd", "freecad.cmd")
"""Names on the path: of distributions and FreeCAD's bundles, of older builds, and of the snap."""
_IN_APPIMAGE = "freecadcmd"
"""The first argument of a FreeCAD AppImage selects the program inside it."""
_APPIMAGE = ".appimage"
_LOCATIONS: dict[str, tuple[tuple[str, str], ...]] = {
    "win32": (
        ("ProgramFiles", "FreeCAD*/bin/freecadcmd.exe"),
        ("LOCALAPPDATA", "Programs/FreeCAD*/bin/freecadcmd.exe"),
    ),
    "darwin": (
        ("", "/Applications/FreeCAD*.app/Contents/Resources/bin/freecadcmd"),
        ("HOME", "Applications/FreeCAD*.app/Contents/Resources/bin/freecadcmd"),
    ),
    "linux": (
        ("HOME", "Applications/FreeCAD*.AppImage"),
        ("HOME", ".local/bin/FreeCAD*.AppImage"),
        ("", "/opt/FreeCAD*.AppImage"),
        ("", "/snap/bin/freecad.cmd"),
    ),
}
"""By system: a variable with a folder, and a pattern below it [FreeCAD, package/rattler-build]."""


class FreeCADCommand(NamedTuple):
    """The command that starts FreeCADCmd.

    Attributes:
        words: the command line without arguments; empty if there is none.
        missing: the reason if there is none.
    """

    words: tuple[str, ...]
    missing: str = ""


def freecad_command(environment: Mapping[str, str] = os.environ, system: str = sys.platform) -> FreeCADCommand:
    """Find FreeCADCmd.

    Args:
        system: as ``sys.platform``.
    """
    chosen = environment.get(VARIABLE, "").strip()
    if chosen:
        return _chosen(chosen, environment, system)
    path = environment.get("PATH")
    for name in _NAMES:
        found = shutil.which(name, path=path)
        if found:
            return FreeCADCommand((found,))
    for file in _installed(environment, system):
        return FreeCADCommand(_with_program(str(file)))
    return FreeCADCommand((), f"there is none on the path{_searched(environment, system)}")


def _chosen(text: str, environment: Mapping[str, str], system: str) -> FreeCADCommand:
    """The command that the variable names: a file, which may have blanks in its path, or a command with arguments."""
    if os.path.exists(text):
        return FreeCADCommand(_with_program(text))
    try:
        words = _split(text, system)
    except ValueError as fault:
        return FreeCADCommand((), f"{VARIABLE} is {text!r}: {fault}")
    program = shutil.which(words[0], path=environment.get("PATH")) or words[0]
    if not os.path.exists(program):
        return FreeCADCommand((), f"{VARIABLE} names {words[0]}, and there is no such file")
    return FreeCADCommand((program, *words[1:]) if words[1:] else _with_program(program))


def _split(text: str, system: str) -> list[str]:
    """The words of a command line; on Windows, backslashes separate folders."""
    if system != "win32":
        return shlex.split(text)
    return [word.strip('"') for word in shlex.split(text, posix=False)]


def _with_program(file: str) -> tuple[str, ...]:
    """The file, followed by the program name for an AppImage."""
    return (file, _IN_APPIMAGE) if file.lower().endswith(_APPIMAGE) else (file,)


def _installed(environment: Mapping[str, str], system: str) -> Iterator[Path]:
    """Yield the installed FreeCADs, in each place the highest version first."""
    for folder, pattern in _locations(environment, system):
        yield from sorted(folder.glob(pattern), key=_version, reverse=True)


def _locations(environment: Mapping[str, str], system: str) -> Iterator[tuple[Path, str]]:
    for variable, pattern in _LOCATIONS.get(system, ()):
        folder = environment.get(variable, "") if variable else "/"
        if folder:
            yield Path(folder), pattern.lstrip("/")


def _version(file: Path) -> list[int]:
    """The numbers in its path, for comparison: 1.10 is above 1.9."""
    return [int(digits) for digits in re.findall(r"\d+", str(file))]


def _searched(environment: Mapping[str, str], system: str) -> str:
    places = [str(folder / pattern) for folder, pattern in _locations(environment, system)]
    return f", nor in {', '.join(places)}" if places else ""
