# SPDX-License-Identifier: LGPL-2.1-or-later
"""Staged files: results are written to a private folder and get their final names when all are complete.

Input: the target folder. Output: all files in it, or none. A machine must never receive half a program, nor a program
beside the report of another one.
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

from pkm_post.system.lock import Lock, locked
from pkm_post.system.moved import move

_PREFIX = ".staged-"
_PRIVATE = re.compile(re.escape(_PREFIX) + "[a-z0-9_]{8}")
"""Names of private folders, as ``tempfile.mkdtemp`` makes them."""
_LOCK = _PREFIX + "lock"
"""Lock file of a folder, while a process moves files into it."""
_OWNER = "owner"
"""Lock file of a private folder, held for the life of its process."""
_PATIENCE = 30.0
"""s, timeout for another process to move its files; that takes milliseconds."""
_RESERVE = 4 << 20
"""Bytes that are free again when the private folder is removed: that takes memory, also where all of it is used."""
_PAUSE = 0.005
"""s, between attempts to acquire the lock."""


class BusyError(OSError):
    """Another process has been moving files into a folder for too long."""


@contextmanager
def staged(folder: Path, last: str = "") -> Iterator[Path]:
    """Yield a new private folder inside ``folder``; its files move into ``folder`` when the block ends.

    Guaranteed: a file appears under its final name complete and with its content on disk, never in part. If the block
    raises, or a file cannot be moved, the initial state is restored. Replaced files are removed before any new one
    arrives: even a killed process or a power failure leaves no new file beside an earlier one. Of two processes that
    move files into one folder, the second waits for the first. The private folder is always removed; that of a killed
    process is removed by the next process that writes into ``folder``.

    Not guaranteed: a process killed while it moves files leaves some of them, or some of the earlier ones. Then there
    is no ``last``. A missing ``folder`` is created, and stays.

    Args:
        folder: target folder.
        last: name of a file among them that is removed first and arrives last.

    Raises:
        BusyError: another process is still moving files.
        MixedError: files could not be moved, and not all earlier ones could be restored.
        OSError: a folder cannot be made, the block left more than files, or one cannot be synchronised or moved.
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
    """Yield a new private folder, locked so that others see that its process is alive."""
    with ExitStack() as stack:
        with _lock_of(folder / _LOCK):
            _sweep(folder)
            reserve = [bytearray(_RESERVE)]
            private = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=folder))
            stack.callback(shutil.rmtree, private, ignore_errors=True)  # the next sweep removes what is left
            stack.enter_context(_lock_of(private / _OWNER))
            stack.callback(reserve.clear)
        yield private


def _sweep(folder: Path) -> None:
    """Remove the private folders of ended processes."""
    for name in filter(_PRIVATE.fullmatch, os.listdir(folder)):
        try:
            owner = locked(folder / name / _OWNER)
        except OSError:
            continue  # another user's, or its process is removing it
        if owner is not None:
            owner.release()
            shutil.rmtree(folder / name, ignore_errors=True)


def _lock_of(path: Path) -> Lock:
    """Lock of a path, once the owning process releases it or ends."""
    deadline = time.monotonic() + _PATIENCE
    while (lock := locked(path)) is None:
        if time.monotonic() > deadline:
            raise BusyError(f"another process has been moving files into {path.parent} for {_PATIENCE:g} s")
        time.sleep(_PAUSE)
    return lock


def _synchronise(file: Path) -> None:
    """Wait until the content of a file is on disk; folders cannot be opened this way and are refused."""
    with file.open("r+b") as stream:  # Windows synchronises only files open for writing
        os.fsync(stream.fileno())
