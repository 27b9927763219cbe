# SPDX-License-Identifier: LGPL-2.1-or-later
"""Staged files: results are written aside and get their final names when all of them are complete.

Enters: the folder the results belong in. Leaves: the files in it, or none of them. A machine must never be given half
a program, nor a program beside the report of another one.
"""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from pkm_post.files.lock import Lock, locked
from pkm_post.files.moved import move

_PREFIX = ".staged-"
_PRIVATE = re.compile(re.escape(_PREFIX) + "[a-z0-9_]{8}")
"""The names of private folders, as ``tempfile.mkdtemp`` makes them."""
_LOCK = _PREFIX + "lock"
"""Of a folder, while a process moves files into it."""
_OWNER = "owner"
"""Of a private folder, locked as long as its process lives."""
_PATIENCE = 30.0
"""s, for another process to move its files; that takes milliseconds."""
_PAUSE = 0.005
"""s, until the lock is tried again."""


class BusyError(OSError):
    """Another process has been moving files into a folder for too long."""


@contextmanager
def staged(folder: Path, last: str = "") -> Iterator[Path]:
    """Yield a fresh private folder inside ``folder``; what is written there moves into ``folder`` when the block ends.

    Promised: a file appears under its final name complete and with its content on disk, never in part. When the block
    raises, or a file cannot be moved, everything is as it was before. What is replaced goes before anything comes: also
    a process that is killed, or a failure of power, leaves no new file beside an earlier one. Of two processes that
    move files into one folder the second waits for the first. The private folder is removed in every case; that of a
    process that was killed is removed by the next that writes into ``folder``.

    Not promised: a process that is killed while it moves files leaves some of them, or some of the earlier ones. Then
    there is no ``last``. ``folder`` itself is made when it is missing, and stays.

    Args:
        folder: where the files belong.
        last: the name of a file among them that is removed first and comes last.

    Raises:
        BusyError: another process does not end moving files.
        MixedError: files could not be moved, and not all that had been there could be put back.
        OSError: a folder cannot be made, what the block left is not all files, or one cannot be synchronised or moved.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with _private(folder) as private:
        new, aside = private / "new", private / "aside"
        new.mkdir()
        aside.mkdir()
        yield new
        for name in sorted(os.listdir(new)):
            _synchronise(new / name)
        with _lock_of(folder / _LOCK):
            move(new, folder, aside, last)


@contextmanager
def _private(folder: Path) -> Iterator[Path]:
    """A fresh private folder, which others can see is of a living process."""
    with ExitStack() as stack:
        with _lock_of(folder / _LOCK):
            _sweep(folder)
            private = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=folder))
            stack.callback(shutil.rmtree, private, ignore_errors=True)  # the next sweep has what this cannot remove
            stack.enter_context(_lock_of(private / _OWNER))
        yield private


def _sweep(folder: Path) -> None:
    """Remove the private folders of processes that have ended."""
    for name in filter(_PRIVATE.fullmatch, os.listdir(folder)):
        try:
            owner = locked(folder / name / _OWNER)
        except OSError:
            continue  # another user's, or its process is removing it
        if owner is not None:
            owner.release()
            shutil.rmtree(folder / name, ignore_errors=True)


def _lock_of(path: Path) -> Lock:
    """The lock of a path, when the process that has it gives it back or ends."""
    deadline = time.monotonic() + _PATIENCE
    while (lock := locked(path)) is None:
        if time.monotonic() > deadline:
            raise BusyError(f"another process has been moving files into {path.parent} for {_PATIENCE:g} s")
        time.sleep(_PAUSE)
    return lock


def _synchronise(file: Path) -> None:
    """Wait until the content of a file is on disk; a folder cannot be opened so and is refused."""
    with file.open("r+b") as stream:  # Windows synchronises only what is open for writing
        os.fsync(stream.fileno())
