# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moved: the files of one result replace those of an earlier one, and the two never mix.

Input: a private folder with new files, their target folder, and a folder for replaced files. Output: the new files in
the target folder, or the earlier ones unchanged.

All earlier files are moved aside before any new one arrives. A process killed at any moment leaves earlier files or new
files, perhaps not all of them, but no mixture.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path

Move = tuple[Path, Path]
"""Source and destination."""


class MixedError(OSError):
    """Files could not be moved, and not all of the earlier ones could be restored."""


def move(new: Path, folder: Path, aside: Path, last: str) -> None:
    """Move all files of a folder into another one, and those that they replace into a third one.

    A failure or a user interrupt restores the initial state.

    Args:
        new: contains the files to move, no folders.
        folder: target folder.
        aside: receives the replaced files; it is empty.
        last: file that marks the set as complete, if there is one: it is removed first and arrives last.

    Raises:
        OSError: a file cannot be moved.
        MixedError: nor can all earlier ones be restored.
    """
    names = sorted(os.listdir(new), key=lambda name: (name == last, name))
    for name in names:
        _refuse_folder(folder / name)
    begun: list[Move] = []
    try:
        for source, target in _moves(names, new, folder, aside, last):
            begun.append((source, target))
            os.replace(source, target)
        synchronise_names(folder)
    except BaseException as fault:
        _undo(begun, last, fault)
        raise


def _moves(names: list[str], new: Path, folder: Path, aside: Path, last: str) -> Iterator[Move]:
    """Yield all moves in order; names reach the disk before moves that depend on them."""
    for name in reversed(names):
        if os.path.lexists(folder / name):
            yield folder / name, aside / name
    synchronise_names(folder)
    for name in names:
        if name == last:
            synchronise_names(folder)
        yield new / name, folder / name


def _undo(begun: list[Move], last: str, fault: BaseException) -> None:
    """Undo the begun moves; ``last`` is not restored if another file was not."""
    stuck: list[str] = []
    for source, target in reversed(begun):
        if stuck and source.name == last:
            continue
        try:
            if not os.path.lexists(source):  # the last move may not have happened
                os.replace(target, source)
        except OSError:
            stuck.append(source.name)
    if stuck:
        names = ", ".join(dict.fromkeys(stuck))
        raise MixedError(f"{fault}; after that these could not be put back: {names}") from fault


def _refuse_folder(target: Path) -> None:
    if target.is_dir() and not target.is_symlink():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))


def synchronise_names(folder: Path) -> None:
    """Wait until the names in a folder are on disk; Windows cannot open folders and stores names itself."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
