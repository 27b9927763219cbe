# SPDX-License-Identifier: LGPL-2.1-or-later
"""Presets: machine files that ship with the program, found by name.

Input: the user's machine argument, a preset name or a path. Output: the path of the file to read.
"""

from __future__ import annotations

from pathlib import Path

from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Diagnostic, Diagnostics, Machine, Phrase, Place

_PACKAGE = Path(__file__).parents[2]
_IN_A_WHEEL = _PACKAGE / "resources" / "machines"
FOLDER = _IN_A_WHEEL if _IN_A_WHEEL.is_dir() else _PACKAGE.parent / "resources" / "machines"
TEMPLATES = FOLDER / "templates"
SUFFIX = ".toml"


def presets() -> list[str]:
    """Names of the complete machines that ship with the add-on, in alphabetical order."""
    return _names(FOLDER)


def templates() -> list[str]:
    """Names of machines with incomplete data; users copy and complete their files."""
    return _names(TEMPLATES)


def find_machine(name_or_path: str) -> Path | None:
    """Find the machine file.

    Args:
        name_or_path: the name of a preset or template, or a path: anything with a separator or the suffix ``.toml``.

    Returns:
        The path unchanged, whether or not the file exists; for a name the path of the preset or template,
        None if unknown.
    """
    if "/" in name_or_path or "\\" in name_or_path or name_or_path.lower().endswith(SUFFIX):
        return Path(name_or_path)
    folder = next((folder for folder in (FOLDER, TEMPLATES) if name_or_path in _names(folder)), None)
    return folder and folder / f"{name_or_path}{SUFFIX}"


def _names(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob(f"*{SUFFIX}"))


def machine_named(name_or_path: str | Path) -> tuple[Machine | None, Diagnostics]:
    """The machine, or the faults of its name or file.

    Args:
        name_or_path: name of a machine that ships with PKM Post, or path of a machine file.
    """
    path = find_machine(str(name_or_path))
    if path is None:
        return None, (
            Diagnostic("M101", Place(str(name_or_path)), Phrase("no machine of this name comes with PKM Post")),
        )
    return read_machine(path)
