# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document damage: what keeps a document in FreeCAD from being the one that was saved.

A file or a document enters; what is wrong leaves. FreeCAD opens a file that was cut off or changed without an error,
and takes the paths that it cannot read as empty. So its file is checked before it is opened, and again where a job of
an open document is read: there the file still is what was opened, until it is saved.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path as FilePath
from typing import Any

from pkm_post.document_file import Damaged, DocumentContent, read_document
from pkm_post.model import Diagnostic, Place, Refused


def intact(file: FilePath) -> DocumentContent:
    """What a document lists, when its file was checked.

    Raises:
        Refused: it cannot be read, or is damaged: J101, J129, J130.
    """
    try:
        return read_document(file)
    except OSError as fault:
        raise Refused([Diagnostic("J101", Place(str(file)), str(fault))]) from fault
    except Damaged as damaged:
        raise Refused([Diagnostic(damaged.code, Place(str(file)), damaged.found)]) from damaged


def check_read(document: Any, content: DocumentContent) -> None:
    """Compare the operations of a document that was just opened with those that its file lists.

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
    """What is wrong with the file of an open document; one that was never saved, or is gone, has none."""
    file = FilePath(document.FileName)
    if not document.FileName or not file.is_file():
        return ()
    status = file.stat()
    return _faults_of(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=16)
def _faults_of(file: FilePath, changed: int, size: int) -> tuple[Diagnostic, ...]:
    """The same, once for each state of a file: document objects ask whenever they are computed."""
    try:
        intact(file)
    except Refused as refused:
        return refused.diagnostics
    return ()
