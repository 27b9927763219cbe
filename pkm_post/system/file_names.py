# SPDX-License-Identifier: LGPL-2.1-or-later
"""File names: which ones the system would take for something else than a file of that name.

Windows opens a device, an alternate stream or a file of another name, and reports nothing. [Microsoft Learn, Naming
Files, Paths, and Namespaces]
"""

from __future__ import annotations

import re
import sys

_DEVICE = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[0-9\u00b9\u00b2\u00b3]) *(\..*)?", re.IGNORECASE)
_CHARACTERS = re.compile(r'[<>:"|?*\\\x00-\x1f]')


def unusable_name(name: str, system: str = sys.platform) -> str:
    """Why a file cannot have this name; empty if it can.

    Args:
        name: without folder.
        system: as ``sys.platform``.
    """
    if system != "win32":
        return ""
    if _DEVICE.fullmatch(name):
        return f"Windows keeps the name {name!r} for a device"
    character = _CHARACTERS.search(name)
    if character:
        return f"Windows does not allow {character.group()!r} in {name!r}"
    return f"Windows drops the end of {name!r}" if name.endswith((".", " ")) else ""


class UnusableNameError(OSError):
    """A file cannot have the name that was chosen for it."""


def require_usable(name: str, system: str = sys.platform) -> None:
    """Check a name before a file of this name is opened.

    Raises:
        UnusableNameError: the system would not make a file of this name.
    """
    fault = unusable_name(name, system)
    if fault:
        raise UnusableNameError(fault)
