# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read: verify a FreeCAD document on disk and list its content."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path

from pkm_post.system.document_file.archive import DOCUMENT, whole_archive
from pkm_post.system.document_file.content import DocumentContent, read_content
from pkm_post.system.document_file.damaged import content_is_damaged

_PIECE = 1 << 16


def read_document(file: Path) -> DocumentContent:
    """Verify a document and list its content.

    Args:
        file: path of the document.

    Raises:
        OSError: the file cannot be read.
        Damaged: it is not a document, or not a complete one.
    """
    with file.open("rb") as stream, whole_archive(stream) as archive:
        content = read_content(_pieces(archive))
        for name in content.members:
            if name not in archive.NameToInfo:
                raise content_is_damaged(f"{name} is listed, and is not in the archive")
        return content


def _pieces(archive: zipfile.ZipFile) -> Iterator[bytes]:
    with archive.open(DOCUMENT) as content:
        while piece := content.read(_PIECE):
            yield piece
