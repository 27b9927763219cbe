# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moved: the files of one result take the place of those of an earlier one, and never stand beside them.

Enters: a private folder with new files, the folder that they belong in, and one for what they replace. Leaves: the new
files in their folder, or the earlier ones as they were.

First all earlier files go aside, then all new ones come. A process that is killed at any moment leaves earlier files or
new files, perhaps not all of them, but no mixture.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path

Move = tuple[Path, Path]
"""From where, and to where."""


class MixedError(OSError):
    """Files could not be moved, and not all of those that had been there could be put back."""


def move(new: Path, folder: Path, aside: Path, last: str) -> None:
    """Move all files of a folder into another one, and those that they replace into a third one.

    After a failure, an interrupt of the user too, all is as it was.

    Args:
        new: has the files to be moved, no folders.
        folder: gets them.
        aside: gets what had their names; it is empty.
        last: the file that says that the others belong together, if there is one: it goes first and comes last.

    Raises:
        OSError: a file cannot be moved.
        MixedError: nor can all be put back.
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
    """All moves in their order; names are on disk before others follow that must not be there without them."""
    for name in reversed(names):
        if os.path.lexists(folder / name):
            yield folder / name, aside / name
    synchronise_names(folder)
    for name in names:
        if name == last:
            synchronise_names(folder)
        yield new / name, folder / name


def _undo(begun: list[Move], last: str, fault: BaseException) -> None:
    """Move back what was moved; ``last`` does not come back where another file did not."""
    stuck: list[str] = []
    for source, target in reversed(begun):
        if stuck and source.name == last:
            continue
        try:
            if not os.path.lexists(source):  # the last of them may not have been moved
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
    """Wait until the names in a folder are on disk; Windows cannot open folders and stores names by itself."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
