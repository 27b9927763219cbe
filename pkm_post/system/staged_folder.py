# SPDX-License-Identifier: LGPL-2.1-or-later
"""Staged folder: a tree of files that appears as a whole, under an unused name.

Input: the name. Output: the tree, or nothing.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_PREFIX = ".staged-folder-"


class FolderExistsError(OSError):
    """The name is in use."""


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
    private = Path(tempfile.mkdtemp(prefix=_PREFIX, dir=folder.parent))
    try:
        private.chmod(0o755)
        yield private
        private.rename(folder)
    finally:
        shutil.rmtree(private, ignore_errors=True)
