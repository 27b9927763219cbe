# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document damage: detects differences between a document in FreeCAD and the saved one.

Takes a file or a document; returns its faults. FreeCAD opens a truncated or modified file without an error and replaces
unreadable paths with empty ones. The file is therefore checked before it is opened, and again when a job of an open
document is read: until it is saved, the file is still the one that was opened.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path as FilePath
from typing import Any

from pkm_post.model import Diagnostic, Place, Refused
from pkm_post.system import DamagedDocument, DocumentContent, read_document


def intact(file: FilePath) -> DocumentContent:
    """Contents listed in a document, after checking its file.

    Raises:
        Refused: it cannot be read, or is damaged: J101, J129, J130.
    """
    try:
        return read_document(file)
    except OSError as fault:
        raise Refused([Diagnostic("J101", Place(str(file)), str(fault))]) from fault
    except DamagedDocument as damaged:
        raise Refused([Diagnostic(damaged.code, Place(str(file)), damaged.found)]) from damaged


def check_read(document: Any, content: DocumentContent) -> None:
    """Compare the operations of a newly opened document with those listed in its file.

    Raises:
        Refused: some are missing, J131.
    """
    place, faults = Place(document.FileName), []
    for job in content.jobs:
        found = document.getObject(job.name)
        read = [each.Name for each in found.Operations.Group] if hasattr(found, "Operations") else []
        if read != list(job.operations):
            missing = ", ".join(sorted(set(job.operations) - set(read))) or "none is missing, the order is another"
            told = f"{len(read)} of {len(job.operations)} operations of {job.label}: {missing}"
            faults.append(Diagnostic("J131", place, told))
    if faults:
        raise Refused(faults)


def file_faults(document: Any) -> tuple[Diagnostic, ...]:
    """Faults in the file of an open document; none if it was never saved or no longer exists."""
    file = FilePath(document.FileName)
    if not document.FileName or not file.is_file():
        return ()
    status = file.stat()
    return _faults_of(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=16)
def _faults_of(file: FilePath, changed: int, size: int) -> tuple[Diagnostic, ...]:
    """The same, cached by file state: document objects ask at every recompute."""
    try:
        intact(file)
    except Refused as refused:
        return refused.diagnostics
    return ()
