# SPDX-License-Identifier: LGPL-2.1-or-later
"""Named: resolve a machine by preset name or file path."""

from __future__ import annotations

from pathlib import Path

from pkm_post.machine.description.presets import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Diagnostic, Machine, Place


def machine_named(name_or_path: str | Path) -> tuple[Machine | None, tuple[Diagnostic, ...]]:
    """The machine, or the faults of its name or file.

    Args:
        name_or_path: name of a machine that ships with PKM Post, or path of a machine file.
    """
    path = find_machine(str(name_or_path))
    if path is None:
        return None, (Diagnostic("M101", Place(str(name_or_path)), "no machine of this name comes with PKM Post"),)
    return read_machine(path)
