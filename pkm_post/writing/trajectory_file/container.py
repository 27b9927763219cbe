# SPDX-License-Identifier: LGPL-2.1-or-later
"""Container: the header and the tables of plain records of a file, or the damage that prevents reading it.

No statement of the file is trusted before it is checked: sizes against the file, tables against its bounds and each
other, the bytes against their checksums. A table is a view into the bytes read, so a false count cannot allocate
memory.
"""

from __future__ import annotations

import os
import stat
import zlib
from itertools import pairwise
from pathlib import Path

import numpy as np

from pkm_post.writing.trajectory_file.layout import ALIGNMENT, HEADER, MAGIC, MAJOR, MINOR, TABLES, Records, offset_of

Content = bytes | memoryview
"""The bytes of a file."""


class DamageError(Exception):
    """The file cannot be read; holds the code and the text of the diagnostic. It is not raised outside this room."""

    def __init__(self, found: str, code: str = "T103") -> None:
        self.code = code
        super().__init__(found)


def bytes_of(path: Path) -> memoryview:
    """All bytes of a file; a file that is not a trajectory file is not read beyond the header.

    Raises:
        DamageError: the file cannot be opened, is of another kind or version, or differs from its stated size.
    """
    try:
        return _content(path)
    except (OSError, ValueError) as fault:  # ValueError: invalid path name
        raise DamageError(getattr(fault, "strerror", None) or str(fault), "T101") from fault


def opened(content: Content) -> tuple[np.void, dict[str, Records]]:
    """The header record, and the tables by name, from the bytes of a file.

    Raises:
        DamageError: they are of another kind or version, or damaged.
    """
    header = _header(content)
    _check_size(header, len(content))
    _check_header(header, content)
    _check_tables(header, len(content))
    if zlib.crc32(memoryview(content)[int(header["header_size"]) :]) != header["body_crc"]:
        raise DamageError("the checksum of the body is wrong")
    return header, {name: _table(header, name, content) for name in TABLES}


def _content(path: Path) -> memoryview:
    if not stat.S_ISREG(path.stat().st_mode):  # opening a pipe would block until it has a writer
        raise DamageError("it is not a regular file", "T101")
    with path.open("rb", buffering=0) as file:
        header = _header(file.read(HEADER.itemsize))
        size = os.fstat(file.fileno()).st_size
        _check_size(header, size)
        file.seek(0)
        content = np.fromfile(file, np.uint8).data  # uses large pages: half the time of ``file.read``
    if len(content) != size:
        raise DamageError(f"the file changed from {size} to {len(content)} bytes while it was read")
    return content


def _header(content: Content) -> np.void:
    """The header record of a file of the supported kind and version."""
    content = bytes(content[: HEADER.itemsize])
    if not content.startswith(MAGIC):
        raise DamageError(f"it begins with {content[: len(MAGIC)]!r}" if content else "it is empty", "T101")
    header: np.void = np.frombuffer(content.ljust(HEADER.itemsize, b"\0"), HEADER)[0]
    if len(content) >= offset_of(HEADER, "header_size") and header["major"] != MAJOR:
        raise DamageError(f"it has version {header['major']}.{header['minor']}, known is {MAJOR}.{MINOR}", "T102")
    if len(content) < HEADER.itemsize:
        raise DamageError(f"the header of {HEADER.itemsize} bytes ends after {len(content)}")
    return header


def _check_size(header: np.void, size: int) -> None:
    if header["file_size"] != size:
        raise DamageError(f"the file has {size} bytes, its header says {header['file_size']}")


def _check_header(header: np.void, content: Content) -> None:
    size = int(header["header_size"])
    if not _is_size(size, HEADER.itemsize, header) or size > len(content):
        raise DamageError(f"the header size is {size}, version {MAJOR}.{MINOR} has {HEADER.itemsize}")
    checked = bytearray(content[:size])
    at = offset_of(HEADER, "header_crc")
    checked[at : at + 4] = bytes(4)
    if zlib.crc32(checked) != header["header_crc"]:
        raise DamageError("the checksum of the header is wrong")


def _check_tables(header: np.void, file_size: int) -> None:
    """Refuse tables with unknown record sizes, outside the file, or overlapping each other."""
    spans = [(0, int(header["header_size"]), "header")]
    for name, record in TABLES.items():
        offset, count, record_size = header[name].item()
        if not _is_size(record_size, record.itemsize, header) or record_size > file_size:
            raise DamageError(f"a record of the table {name} has {record_size} bytes, expected {record.itemsize}")
        if offset % ALIGNMENT or offset + count * record_size > file_size:
            raise DamageError(
                f"the table {name} of {count} records of {record_size} bytes at byte {offset} does not fit the file"
            )
        spans.append((offset, offset + count * record_size, name))
    for (_, end, name), (begin, _, follower) in pairwise(sorted(spans)):
        if begin < end:
            raise DamageError(f"the tables {name} and {follower} overlap")


def _is_size(size: int, known: int, header: np.void) -> bool:
    """Whether a record has its known size; a newer minor version may extend it."""
    grown = header["minor"] > MINOR and known > 1 and size > known and size % ALIGNMENT == 0
    return bool(size == known or grown)


def _table(header: np.void, name: str, content: Content) -> Records:
    """The known fields of the records of a table, (count,)."""
    offset, count, record_size = header[name].item()
    return np.ndarray((count,), TABLES[name], content, offset, (record_size,))
