# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lock files: exclusive ownership by one process of this computer, with a record of the owner in the file.

The system holds the lock and releases it when the process ends in any manner. The content of an unlocked file is
meaningless. Input: a path and a record. Output: a lock, or the record of the owning process.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from pathlib import Path
from typing import Any, Self

if sys.platform == "win32":
    import msvcrt

    _LOCKED_BYTE = 1 << 30
    """Other processes cannot read a locked byte: this one is far beyond the record."""

    def _lock(descriptor: int) -> None:
        os.lseek(descriptor, _LOCKED_BYTE, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _lock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


_ALL_USERS = 0o666
_MOST_BYTES = 4096

OwnerRecord = dict[str, Any]


class Lock:
    """A lock that this process holds."""

    def __init__(self, path: Path, descriptor: int) -> None:
        self._path, self._descriptor = path, descriptor

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.release()

    def describe(self, record: OwnerRecord) -> None:
        """Write the record of the owner, for other processes."""
        os.ftruncate(self._descriptor, 0)
        os.lseek(self._descriptor, 0, os.SEEK_SET)
        os.write(self._descriptor, json.dumps(record).encode()[:_MOST_BYTES])

    def release(self) -> None:
        """Release the lock. The file is removed first, so that a waiting process sees that its file is stale."""
        if sys.platform == "win32":  # an open file cannot be removed there: it stays for waiting processes
            os.close(self._descriptor)
            self._remove()
        else:
            self._remove()
            os.close(self._descriptor)

    def _remove(self) -> None:
        with contextlib.suppress(PermissionError):  # open on Windows, or owned by another user in a folder such as /tmp
            self._path.unlink(missing_ok=True)


def try_lock(path: Path) -> Lock | None:
    """Acquire the lock of a path; None when another process holds it.

    Raises:
        OSError: the file cannot be written, or the file system has no locks.
    """
    while True:
        descriptor = _opened(path)
        try:
            _lock(descriptor)
        except (BlockingIOError, PermissionError):  # POSIX and Windows: another process holds it
            os.close(descriptor)
            return None
        except OSError:
            os.close(descriptor)
            raise
        if _is_at(path, descriptor):
            return Lock(path, descriptor)
        os.close(descriptor)


def lock_owner(path: Path) -> OwnerRecord:
    """The record that the owning process wrote; empty if there is none."""
    try:
        record = json.loads(path.read_bytes()[:_MOST_BYTES])
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) else {}


def _opened(path: Path) -> int:
    """Open the file for every user of the computer: a system may refuse to create another user's existing file."""
    flags = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
    while True:
        with contextlib.suppress(FileNotFoundError):
            return os.open(path, flags)
        with contextlib.suppress(FileExistsError):
            descriptor = os.open(path, flags | os.O_CREAT | os.O_EXCL, _ALL_USERS)
            if hasattr(os, "fchmod"):
                os.fchmod(descriptor, _ALL_USERS)
            return descriptor


def _is_at(path: Path, descriptor: int) -> bool:
    try:
        there = os.stat(path)
    except FileNotFoundError:
        return False
    return os.path.samestat(there, os.fstat(descriptor))
