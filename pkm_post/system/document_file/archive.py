# SPDX-License-Identifier: LGPL-2.1-or-later
"""Archive: verify the ZIP archive of a FreeCAD document from first to last byte.

Enters: an open file. Leaves: its members, or ``Damaged``. FreeCAD reads members sequentially by their local headers. It
ignores the central directory and checksums, and treats members that it cannot unpack as empty. So here each member must
match its checksum, the central directory must match the local headers, and there must be no gap between members: then
the archive is unambiguous. [PKWARE APPNOTE 4.3]
"""

from __future__ import annotations

import os
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

from pkm_post.system.document_file.damaged import archive_is_damaged, is_no_document

DOCUMENT = "Document.xml"
_SIGNATURE = b"PK\x03\x04"
_IN_FRONT = struct.Struct("<4s5H3I2H")
"""Local header: signature; version, flags, method, time, date; checksum, packed and full size; name, extra length."""
_AT_END = struct.Struct("<4s4H2IH")
"""End record: signature; four counts, size and offset of the directory; length of the comment that follows."""
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_UTF8_NAME = 1 << 11
_KNOWN_FLAGS = 0b110 | _UTF8_NAME
"""Compression level, and UTF-8 name. FreeCAD reads members with a trailing data descriptor as empty."""
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


@contextmanager
def whole_archive(stream: BinaryIO) -> Iterator[zipfile.ZipFile]:
    """Open the archive of a document and verify all of it.

    Args:
        stream: the file, open.

    Raises:
        Damaged: it is not an archive, or not a complete one.
    """
    if stream.read(len(_SIGNATURE)) != _SIGNATURE:
        raise is_no_document("it does not begin as a ZIP archive")
    try:
        archive = zipfile.ZipFile(stream)
    except _BROKEN as fault:
        raise archive_is_damaged(f"no directory at its end, as in a file that was cut off: {fault}") from fault
    with archive:
        _check_end(archive, stream)
        _check_places(archive, stream)
        for member in archive.infolist():
            _check_content(archive, member)
        yield archive


def _check_end(archive: zipfile.ZipFile, stream: BinaryIO) -> None:
    """Check that the file ends where the archive does, with its complete comment."""
    stream.seek(-_AT_END.size - len(archive.comment), os.SEEK_END)
    signature, *_, length = _AT_END.unpack(stream.read(_AT_END.size))
    if signature != b"PK\x05\x06" or length != len(archive.comment):
        raise archive_is_damaged("the file does not end where the archive does")


def _check_places(archive: zipfile.ZipFile, stream: BinaryIO) -> None:
    """Check that the directory lists the members in sequence and agrees with their local headers."""
    end, names = 0, set()
    for member in sorted(archive.infolist(), key=lambda each: each.header_offset):
        if not end and member.filename != DOCUMENT:
            raise is_no_document(f"its first member is {member.filename}, not {DOCUMENT}")
        if member.header_offset != end:
            raise archive_is_damaged(f"{member.filename} begins at byte {member.header_offset}, not at {end}")
        if member.filename in names:
            raise archive_is_damaged(f"{member.filename} is in it twice")
        names.add(member.filename)
        end += _length(member, stream)
    if end != archive.start_dir:
        raise archive_is_damaged(f"its members end at byte {end}, its directory begins at {archive.start_dir}")
    if not names:
        raise is_no_document("it is an empty archive")
    if sum(member.file_size for member in archive.infolist()) > _MOST_UNPACKED:
        raise archive_is_damaged(f"it unpacks to more than {_MOST_UNPACKED >> 30} GiB")


def _length(member: zipfile.ZipInfo, stream: BinaryIO) -> int:
    """Size of a member in bytes; its local header must agree with the directory."""
    stream.seek(member.header_offset)
    header = stream.read(_IN_FRONT.size)
    if len(header) < _IN_FRONT.size:
        raise archive_is_damaged(f"{member.filename} is cut off")
    signature, _, flags, method, _, _, *sizes, name, extra = _IN_FRONT.unpack(header)
    said = (member.flag_bits, member.compress_type, member.CRC, member.compress_size, member.file_size)
    if signature != _SIGNATURE or (flags, method, *sizes) != said:
        raise archive_is_damaged(f"the directory says other things of {member.filename} than is written in front of it")
    if method not in _METHODS or flags & ~_KNOWN_FLAGS:
        raise archive_is_damaged(f"{member.filename} is packed as FreeCAD does not read it, not by FreeCAD")
    return _IN_FRONT.size + int(name) + int(extra) + member.compress_size


def _check_content(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> None:
    """Unpack a member and verify its checksum."""
    try:
        with archive.open(member) as packed:
            while packed.read(_PIECE):
                pass
    except _BROKEN as fault:
        raise archive_is_damaged(f"{member.filename} cannot be unpacked: {fault}") from fault
