# SPDX-License-Identifier: LGPL-2.1-or-later
"""Staged files: results are written aside and get their final names when all of them are complete.

Enters: the folder the results belong in. Leaves: the files in it, or none of them. A machine must never be given half
a program, nor a program beside the report of another one.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Yield a fresh private folder inside ``folder``; what is written there moves into ``folder`` when the block ends.

    Promised: a file appears under its final name complete and with its content on disk, never in part. When the block
    raises, nothing appears. When a file cannot be moved, those that were moved before it and are new in ``folder`` are
    removed again. The private folder is removed in every case.

    Not promised: a file that replaced one of the same name stays when a later file cannot be moved, as the old content
    is gone. A reader that looks while the files are moved, name by name in sorted order, sees some old and some new
    ones. A process that is killed leaves its private folder, named ``.staged-`` and some letters. ``folder`` itself is
    made when it is missing, and stays.

    Args:
        folder: where the files belong.

    Raises:
        OSError: a folder cannot be made, what the block left is not all files, or one cannot be synchronised or moved.
    """
    folder.mkdir(parents=True, exist_ok=True)
    private = Path(tempfile.mkdtemp(prefix=".staged-", dir=folder))
    try:
        yield private
        names = sorted(os.listdir(private))
        for name in names:
            _synchronise(private / name)
        _move(names, private, folder)
    finally:
        shutil.rmtree(private)


def _synchronise(file: Path) -> None:
    """Wait until the content of a file is on disk; a folder cannot be opened so and is refused."""
    with file.open("r+b") as stream:  # Windows synchronises only what is open for writing
        os.fsync(stream.fileno())


def _move(names: list[str], source: Path, target: Path) -> None:
    """Move files by name from one folder to another; after a failure, remove again those that are new there."""
    with ExitStack() as undo:
        for name in names:
            is_new = not os.path.lexists(target / name)
            os.replace(source / name, target / name)
            if is_new:
                undo.callback((target / name).unlink)
        _synchronise_names(target)
        undo.pop_all()


def _synchronise_names(folder: Path) -> None:
    """Wait until the names in a folder are on disk; Windows cannot open folders and stores names by itself."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
