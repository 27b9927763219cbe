# SPDX-License-Identifier: LGPL-2.1-or-later
"""Archive: the ZIP archive that a FreeCAD document is, checked from its first byte to its last.

An open file enters; its members leave, or ``Damaged``. FreeCAD reads one member after the other by what is written in
front of each. It looks neither at the directory at the end nor at checksums, and takes members that it cannot unpack as
empty. So here each member must have its checksum, the directory must say of it what is written in front of it, and
there must be nothing between two members: then there is one way to read the archive. [PKWARE APPNOTE 4.3]
"""

from __future__ import annotations

import os
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

from pkm_post.document_file.damaged import archive_is_damaged, is_no_document

DOCUMENT = "Document.xml"
_SIGNATURE = b"PK\x03\x04"
_IN_FRONT = struct.Struct("<4s5H3I2H")
"""Signature; version, flags, method, time and date; checksum, packed and unpacked size; lengths of name and extra."""
_AT_END = struct.Struct("<4s4H2IH")
"""Signature; four counts, size and place of the directory; length of the comment that follows."""
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_UTF8_NAME = 1 << 11
_KNOWN_FLAGS = 0b110 | _UTF8_NAME
"""How hard a member was packed, and that its name is UTF-8. FreeCAD takes members with sizes behind them as empty."""
_MOST_UNPACKED = 4 << 30
"""Bytes of all members together. FreeCAD's archives cannot be larger than this packed."""
_PIECE = 1 << 20
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    NotImplementedError,  # a version of ZIP that is not known
    ValueError,  # names that are no UTF-8, places before the beginning
    OverflowError,
)
"""What ``zipfile`` raises where an archive is damaged."""


@contextmanager
def whole_archive(stream: BinaryIO) -> Iterator[zipfile.ZipFile]:
    """The archive of a document, when all of it was checked.

    Args:
        stream: the file, open.

    Raises:
        Damaged: it is no archive, or not a whole one.
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
    """See that the file ends where the archive does, with all of its comment."""
    stream.seek(-_AT_END.size - len(archive.comment), os.SEEK_END)
    signature, *_, length = _AT_END.unpack(stream.read(_AT_END.size))
    if signature != b"PK\x05\x06" or length != len(archive.comment):
        raise archive_is_damaged("the file does not end where the archive does")


def _check_places(archive: zipfile.ZipFile, stream: BinaryIO) -> None:
    """See that the directory names the members as they follow one another, each as it says in front of it."""
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
    """How many bytes a member takes, if what is written in front of it is what the directory says."""
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
    """Unpack a member and see that it has its checksum."""
    try:
        with archive.open(member) as packed:
            while packed.read(_PIECE):
                pass
    except _BROKEN as fault:
        raise archive_is_damaged(f"{member.filename} cannot be unpacked: {fault}") from fault
