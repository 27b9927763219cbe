# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reasons: why the operating system refused a file, in plain words that windows translate.

Input: the exception. Output: its reason, with the name of a file that the message does not name already.
"""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from pkm_post.model import Diagnostic


def reason_of(fault: Exception, known: str | Path = "") -> str:
    """Why the operating system refused a file.

    Args:
        fault: an OSError; the text of any other exception is its reason.
        known: the file that the message names already.
    """
    from pkm_post.model import Phrase

    if not isinstance(fault, OSError):
        return str(fault)
    words = {
        errno.EACCES: Phrase("access is denied"),
        errno.EEXIST: Phrase("it is a file, not a folder"),  # only folders are made where nothing may be
        errno.EISDIR: Phrase("it is a folder, not a file"),
        errno.ENOENT: Phrase("there is no such file or folder"),
        errno.ENOSPC: Phrase("the disk is full"),
        errno.ENOTDIR: Phrase("there is a file where a folder is named"),
        errno.EPERM: Phrase("access is denied"),
        errno.EROFS: Phrase("the disk is read-only"),
    }
    is_usual = fault.strerror == os.strerror(fault.errno or 0)  # Windows says more, as of a file that is open elsewhere
    reason = (words.get(fault.errno or 0) if is_usual else None) or fault.strerror or str(fault)
    named = fault.filename is not None and str(fault.filename) != str(known)
    return Phrase("{file}: {reason}", file=fault.filename, reason=reason) if named else reason


def read_fault(file: str | Path, fault: Exception) -> Diagnostic:
    """The diagnostic of a file that cannot be read, F103."""
    from pkm_post.model import Diagnostic, Place

    return Diagnostic("F103", Place(str(file)), reason_of(fault, file))
