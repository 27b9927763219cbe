# SPDX-License-Identifier: LGPL-2.1-or-later
"""File names: names that the system does not take literally, and too long paths.

Windows may silently open a device, an alternate stream or a file of another name. It limits paths to
259 characters, unless they are prefixed or long paths are enabled. [Microsoft Learn, Naming Files, Paths, and
Namespaces; Maximum Path Length Limitation]
"""

from __future__ import annotations

import ntpath
import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path

if sys.platform == "win32":
    import ctypes

    def has_long_paths() -> bool:
        """Whether this process may use paths of any length."""
        switched_on = getattr(ctypes.WinDLL("ntdll"), "RtlAreLongPathsEnabled", None)  # not before Windows 10
        return switched_on is not None and bool(switched_on() & 0xFF)
else:

    def has_long_paths() -> bool:
        """Whether this process may use paths of any length."""
        return True


_LONGEST_PATH, _LONGEST_FOLDER = 259, 247
_PREFIX, _PREFIX_OF_SHARES = "\\\\?\\", "\\\\?\\UNC\\"
_DEVICE = re.compile(r"(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[0-9\u00b9\u00b2\u00b3]) *(\..*)?", re.IGNORECASE)
_CHARACTERS = re.compile(r'[<>:"|?*\\\x00-\x1f]')


def unusable_name(name: str, system: str = sys.platform) -> str:
    """The reason why a file cannot have this name; empty if it can.

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


def unusable_path(path: str, long_paths: bool | None = None) -> str:
    """The reason why other programs could not open this path; empty if they can.

    Args:
        path: absolute.
        long_paths: whether paths of any length may be used; None to find out.
    """
    if len(path) <= _LONGEST_PATH or (has_long_paths() if long_paths is None else long_paths):
        return ""
    return f"Windows takes paths of {_LONGEST_PATH} characters, and this one has {len(path)}: {path}"


def prefixed(folder: str, longest_name: int) -> str:
    """A Windows folder with a prefix, if files below it need one to be opened.

    Args:
        folder: absolute.
        longest_name: characters of the longest path below it.
    """
    folder = ntpath.normpath(folder)  # with the prefix, nothing in a path is interpreted
    if folder.startswith(_PREFIX) or len(folder) + 1 + longest_name <= _LONGEST_FOLDER:
        return folder
    return _PREFIX_OF_SHARES + folder[2:] if folder.startswith("\\\\") else _PREFIX + folder


class UnusableNameError(OSError):
    """A file cannot have the chosen name."""


def require_usable(name: str, system: str = sys.platform) -> None:
    """Check a name before a file of this name is opened.

    Raises:
        UnusableNameError: the system does not allow the name.
    """
    fault = unusable_name(name, system)
    if fault:
        raise UnusableNameError(fault)


class ReplacedSourceError(OSError):
    """A result would replace a file that it is made from."""


def require_other(out: Path, sources: Iterable[Path]) -> None:
    """Check a result before it is written.

    Args:
        out: path of the result.
        sources: files that it is made from.

    Raises:
        ReplacedSourceError: the result is one of them, by whatever name.
    """
    for source in sources:
        if os.path.exists(out) and os.path.exists(source) and os.path.samefile(out, source):
            raise ReplacedSourceError(f"the result is made from {source}")


def require_short(path: str) -> None:
    """Check the path of a result.

    Raises:
        UnusableNameError: other programs could not open the file.
    """
    fault = unusable_path(path)
    if fault:
        raise UnusableNameError(fault)
