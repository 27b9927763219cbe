# SPDX-License-Identifier: LGPL-2.1-or-later
"""Document archive: verify the ZIP archive of a FreeCAD document from first to last byte.

Input: an open file. Output: its members, or ``DamagedDocument``. FreeCAD reads members sequentially by their local
headers. It ignores the central directory and checksums, and treats members that it cannot unpack as empty. So here each
member must match its checksum, the central directory must match the local headers, and there must be no gap between
members: then the archive is unambiguous. [PKWARE APPNOTE 4.3]
"""

from __future__ import annotations

import os
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

DOCUMENT = "Document.xml"
_SIGNATURE = b"PK\x03\x04"
_LOCAL_HEADER = struct.Struct("<4s5H3I2H")
"""Local header: signature; version, flags, method, time, date; checksum, packed and full size; name, extra length."""
_END_RECORD = struct.Struct("<4s4H2IH")
"""End record: signature; four counts, size and offset of the directory; length of the comment that follows."""
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_UTF8_NAME = 1 << 11
_KNOWN_FLAGS = 0b110 | _UTF8_NAME
"""Compression level, and UTF-8 name. FreeCAD reads members with a trailing data descriptor as empty."""
_NAMES = "utf-8"
"""Encoding of names: FreeCAD writes UTF-8 without the flag, and 1.1 in Chinese names its tool bits in Chinese."""
_MOST_UNPACKED = 4 << 30
"""Total bytes of all members. The packed size of a FreeCAD archive cannot exceed this either."""
_PIECE = 1 << 20
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    NotImplementedError,  # unknown ZIP version
    ValueError,  # names that are not UTF-8, negative offsets
    OverflowError,
)
"""Exceptions that ``zipfile`` raises on a damaged archive."""


class DamagedDocument(Exception):  # noqa: N818 - it is no error of the program
    """The file is not as FreeCAD wrote it.

    Attributes:
        found: the finding and its place in the file.
    """

    def __init__(self, code: str, found: str) -> None:
        super().__init__(found)
        self.code, self.found = code, found


def _not_a_document(found: str) -> DamagedDocument:
    return DamagedDocument("J101", found)


def _damaged_archive(found: str) -> DamagedDocument:
    """The archive was modified by another program, or is truncated."""
    return DamagedDocument("J129", found)


def damaged_content(found: str) -> DamagedDocument:
    """The archive is intact, but its content is inconsistent."""
    return DamagedDocument("J130", found)


@contextmanager
def verified_archive(stream: BinaryIO) -> Iterator[zipfile.ZipFile]:
    """Open the archive of a document and verify all of it.

    Args:
        stream: the file, open.

    Raises:
        DamagedDocument: it is not an archive, or not a complete one.
    """
    if stream.read(len(_SIGNATURE)) != _SIGNATURE:
        raise _not_a_document("it does not begin as a ZIP archive")
    try:
        archive = zipfile.ZipFile(stream, metadata_encoding=_NAMES)
    except _BROKEN as fault:
        raise _damaged_archive(f"no directory at its end, the file may be truncated: {fault}") from fault
    with archive:
        _check_end(archive, stream)
        _check_member_offsets(archive, stream)
        for member in archive.infolist():
            _check_content(archive, member)
        yield archive


def _check_end(archive: zipfile.ZipFile, stream: BinaryIO) -> None:
    """Check that the file ends where the archive does, with its complete comment."""
    stream.seek(-_END_RECORD.size - len(archive.comment), os.SEEK_END)
    signature, *_, length = _END_RECORD.unpack(stream.read(_END_RECORD.size))
    if signature != b"PK\x05\x06" or length != len(archive.comment):
        raise _damaged_archive("the file does not end where the archive does")


def _check_member_offsets(archive: zipfile.ZipFile, stream: BinaryIO) -> None:
    """Check that the directory lists the members in sequence and agrees with their local headers."""
    end, names = 0, set()
    for member in sorted(archive.infolist(), key=lambda each: each.header_offset):
        if not end and member.filename != DOCUMENT:
            raise _not_a_document(f"its first member is {member.filename}, not {DOCUMENT}")
        if member.header_offset != end:
            raise _damaged_archive(f"{member.filename} begins at byte {member.header_offset}, not at {end}")
        if member.filename in names:
            raise _damaged_archive(f"{member.filename} is in it twice")
        names.add(member.filename)
        end += _length(member, stream)
    if end != archive.start_dir:
        raise _damaged_archive(f"its members end at byte {end}, its directory begins at {archive.start_dir}")
    if not names:
        raise _not_a_document("it is an empty archive")
    if sum(member.file_size for member in archive.infolist()) > _MOST_UNPACKED:
        raise _damaged_archive(f"it unpacks to more than {_MOST_UNPACKED >> 30} GiB")


def _length(member: zipfile.ZipInfo, stream: BinaryIO) -> int:
    """Size of a member in bytes; its local header must agree with the directory."""
    stream.seek(member.header_offset)
    header = stream.read(_LOCAL_HEADER.size)
    if len(header) < _LOCAL_HEADER.size:
        raise _damaged_archive(f"{member.filename} is truncated")
    signature, _, flags, method, _, _, *sizes, name, extra = _LOCAL_HEADER.unpack(header)
    listed = (member.flag_bits, member.compress_type, member.CRC, member.compress_size, member.file_size)
    if signature != _SIGNATURE or (flags, method, *sizes) != listed:
        raise _damaged_archive(f"the directory entry of {member.filename} differs from its local header")
    if method not in _METHODS or flags & ~_KNOWN_FLAGS:
        raise _damaged_archive(f"{member.filename} is packed in a way that FreeCAD does not read")
    return _LOCAL_HEADER.size + int(name) + int(extra) + member.compress_size


def _check_content(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> None:
    """Unpack a member and verify its checksum."""
    try:
        with archive.open(member) as packed:
            while packed.read(_PIECE):
                pass
    except _BROKEN as fault:
        raise _damaged_archive(f"{member.filename} cannot be unpacked: {fault}") from fault
