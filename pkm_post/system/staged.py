# SPDX-License-Identifier: LGPL-2.1-or-later
"""Staged files: results are written to a private folder and get their final names when all are complete.

Input: the target folder, or the name of a new folder. Output: all files in it, or none. A machine must never receive
half a program, nor a program with the report of another one. All earlier files are moved aside before any new one
arrives: a process that is killed leaves earlier files or new files, perhaps not all of them, but no mixture.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from pkm_post.system.file_names import ReplacedSourceError, UnusableNameError, prefixed, require_short
from pkm_post.system.lock import Lock, try_lock
from pkm_post.system.reasons import reason_of

if TYPE_CHECKING:
    from pkm_post.model import Diagnostic


_Move = tuple[Path, Path]
"""Source and destination."""
_PREFIX = ".staged-"
_LONGEST_NAME = 150
"""Characters of the longest path in a folder of results, including the private folder."""
_FOLDER_PREFIX = ".staged-folder-"
_PRIVATE = re.compile(re.escape(_PREFIX) + "[a-z0-9_]{8}")
"""Names of private folders, as ``tempfile.mkdtemp`` makes them."""
_LOCK = _PREFIX + "lock"
"""Lock file of a folder, while a process moves files into it."""
_OWNER = "owner"
"""Lock file of a private folder, held for the life of its process."""
_PATIENCE = 30.0
"""s, timeout for another process to move its files; that takes milliseconds."""
_RESERVE = 4 << 20
"""Bytes reserved for removing the private folder, which takes memory even when none is left."""
_PAUSE = 0.005
"""s, between attempts to acquire the lock, or to move a file that is open."""
_OPEN_ELSEWHERE = (5, 32, 33)
"""Windows errors for a file that another program has open: access denied, sharing violation, lock violation."""
_PATIENCE_WITH_OPEN_FILES = 3.0
"""s, timeout for virus scanners and indexers, which open new files for a moment."""


class FolderExistsError(OSError):
    """The name is in use."""


class BusyError(OSError):
    """Another process has been moving files into a folder for too long."""


class OpenElsewhereError(OSError):
    """Another program has a file open, which Windows then does not move or replace."""


class MixedError(OSError):
    """Files could not be moved, and not all of the earlier ones could be restored."""


@contextmanager
def staged(folder: Path, last: str = "") -> Iterator[Path]:
    """Yield a new private folder inside ``folder``; its files move into ``folder`` when the block ends.

    Guaranteed: a file appears under its final name complete and with its content on disk, never in part. If the block
    raises, or a file cannot be moved, the initial state is restored. Replaced files are removed before any new one
    arrives: even a killed process or a power failure leaves no new file beside an earlier one. Of two processes that
    move files into one folder, the second waits for the first. The private folder is always removed; that of a killed
    process is removed by the next process that writes into ``folder``.

    Not guaranteed: a process killed while it moves files leaves some of them, or some of the earlier ones. Then there
    is no ``last``. A missing ``folder`` is created and remains.

    Args:
        folder: target folder.
        last: name of a file among them that is removed first and arrives last.

    Raises:
        BusyError: another process is still moving files.
        OpenElsewhereError: another program has one of the files open.
        MixedError: files could not be moved, and not all earlier ones could be restored.
        UnusableNameError: the path of a file would be too long for other programs.
        OSError: a folder cannot be made, the block left more than files, or one cannot be synchronised or moved.
    """
    stated, folder = folder.absolute(), _any_length(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with _private(folder) as private:
        new, aside = private / "new", private / "aside"
        new.mkdir()
        aside.mkdir()
        yield new
        for name in sorted(os.listdir(new)):
            require_short(str(stated / name))
            _synchronise(new / name)
        with _lock_of(folder / _LOCK):
            _move_files(new, folder, aside, last)


@contextmanager
def staged_folder(folder: Path) -> Iterator[Path]:
    """Yield a new private folder, which becomes ``folder`` when the block ends; if the block raises, nothing appears.

    Raises:
        FolderExistsError: the name is in use; the existing item is unchanged.
        OSError: a folder cannot be created or renamed.
    """
    if folder.exists():
        raise FolderExistsError(f"{folder} is there already")
    folder.parent.mkdir(parents=True, exist_ok=True)
    private = Path(tempfile.mkdtemp(prefix=_FOLDER_PREFIX, dir=folder.parent))
    try:
        private.chmod(0o755)
        yield private
        private.rename(folder)
    finally:
        shutil.rmtree(private, ignore_errors=True)


def _any_length(folder: Path) -> Path:
    """The folder by a path that stays valid with private names added: on Windows they could make it too long."""
    return Path(prefixed(str(folder.absolute()), _LONGEST_NAME)) if sys.platform == "win32" else folder


@contextmanager
def _private(folder: Path) -> Iterator[Path]:
    """Yield a new private folder, locked so that others see that its process is alive."""
    with ExitStack() as stack:
        with _lock_of(folder / _LOCK):
            _sweep(folder)
            reserve = [bytearray(_RESERVE)]
            private = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=folder))
            stack.callback(shutil.rmtree, private, ignore_errors=True)  # the next sweep removes the rest
            stack.enter_context(_lock_of(private / _OWNER))
            stack.callback(reserve.clear)
        yield private


def _sweep(folder: Path) -> None:
    """Remove the private folders of ended processes."""
    for name in filter(_PRIVATE.fullmatch, os.listdir(folder)):
        try:
            owner = try_lock(folder / name / _OWNER)
        except OSError:
            continue  # another user's, or its process is removing it
        if owner is not None:
            owner.release()
            shutil.rmtree(folder / name, ignore_errors=True)


def _lock_of(path: Path) -> Lock:
    """Lock of a path, once the owning process releases it or ends."""
    deadline = time.monotonic() + _PATIENCE
    while (lock := try_lock(path)) is None:
        if time.monotonic() > deadline:
            raise BusyError(f"another process has been moving files into {path.parent} for {_PATIENCE:g} s")
        time.sleep(_PAUSE)
    return lock


def _synchronise(file: Path) -> None:
    """Wait until the content of a file is on disk; folders cannot be opened this way and are refused."""
    with file.open("r+b") as stream:  # Windows synchronises only files open for writing
        os.fsync(stream.fileno())


def _move_files(new: Path, folder: Path, aside: Path, last: str) -> None:
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
        _require_file(folder / name)
    begun: list[_Move] = []
    try:
        for source, target in _moves(names, new, folder, aside, last):
            begun.append((source, target))
            _move(source, target)
        _synchronise_names(folder)
    except BaseException as fault:
        _undo(begun, last, fault)
        raise


def _move(source: Path, target: Path) -> None:
    """Move a file; wait for programs that have it open for a moment.

    Raises:
        OpenElsewhereError: another program keeps it open.
        OSError: it cannot be moved.
    """
    deadline = time.monotonic() + _PATIENCE_WITH_OPEN_FILES
    while True:
        try:
            os.replace(source, target)
            return
        except PermissionError as fault:
            if getattr(fault, "winerror", None) not in _OPEN_ELSEWHERE:
                raise
            if time.monotonic() > deadline:
                raise OpenElsewhereError(f"{source.name} is open in another program, or protected: {fault}") from fault
            time.sleep(_PAUSE)


def _moves(names: list[str], new: Path, folder: Path, aside: Path, last: str) -> Iterator[_Move]:
    """Yield all moves in order; names reach the disk before moves that depend on them."""
    for name in reversed(names):
        if os.path.lexists(folder / name):
            yield folder / name, aside / name
    _synchronise_names(folder)
    for name in names:
        if name == last:
            _synchronise_names(folder)
        yield new / name, folder / name


def _undo(begun: list[_Move], last: str, fault: BaseException) -> None:
    """Undo the begun moves; ``last`` is not restored if another file was not."""
    stuck: list[str] = []
    for source, target in reversed(begun):
        if stuck and source.name == last:
            continue
        try:
            if not os.path.lexists(source):  # the last move may not have happened
                _move(target, source)
        except OSError:
            stuck.append(source.name)
    if stuck:
        names = ", ".join(dict.fromkeys(stuck))
        raise MixedError(f"{fault}; after that these files could not be restored: {names}") from fault


def _require_file(target: Path) -> None:
    """Refuse to replace a folder, a device such as /dev/null, or a pipe."""
    if target.is_dir() and not target.is_symlink():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))
    if target.exists() and not (target.is_file() or target.is_dir()):
        raise OSError(f"{target} is a device or a pipe, and would be replaced by a file")


def _synchronise_names(folder: Path) -> None:
    """Wait until the names in a folder are on disk; Windows cannot open folders and stores names itself."""
    if os.name == "posix":
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


_CODES = (
    (BusyError, "F109"),
    (MixedError, "F110"),
    (OpenElsewhereError, "F113"),
    (UnusableNameError, "F114"),
    (FolderExistsError, "F119"),
    (ReplacedSourceError, "F120"),
    (OSError, "F101"),
)


def write_fault(path: Path, fault: OSError) -> Diagnostic:
    """Make the diagnostic of a result that could not be written.

    Args:
        path: of the result.
        fault: raised by ``staged`` or by writing into its folder.
    """
    from pkm_post.model import Diagnostic, Place

    code = next(code for kind, code in _CODES if isinstance(fault, kind))
    code = "F114" if fault.errno == errno.ENAMETOOLONG else code
    is_private = _PREFIX in str(fault.filename)  # a name that means nothing to a user
    return Diagnostic(code, Place(str(path)), reason_of(fault, fault.filename if is_private else path))
