# SPDX-License-Identifier: LGPL-2.1-or-later
"""The bytes of trajectory files that this version does not write, for the tests of readers."""

import struct
import zlib

import numpy as np

from pkm_post.writing.trajectory_file.layout import HEADER, MINOR, TABLES, offset_of


def header_of(content):
    return np.frombuffer(content, HEADER, 1)[0]


def sealed(content, file_size=None):
    """The content with file size and checksums made right: whoever lies can count."""
    content = bytearray(content)
    size = int.from_bytes(content[12:16], "little")
    struct.pack_into("<Q", content, 16, len(content) if file_size is None else file_size)
    struct.pack_into("<II", content, 24, 0, zlib.crc32(content[size:]))
    struct.pack_into("<I", content, 24, zlib.crc32(content[:size]))
    return bytes(content)


def newer(content):
    """The same trajectory in a minor version to come: 8 bytes more in the header and in every record."""
    header, size = header_of(content), HEADER.itemsize + 8
    body = b""
    places = []
    for name, record in TABLES.items():
        offset, count, _ = header[name].item()
        grown = 0 if name == "text" else 8
        rows = np.frombuffer(content, np.uint8, count * record.itemsize, offset).reshape(count, record.itemsize)
        rows = np.pad(rows, ((0, 0), (0, grown)), constant_values=0xEE)
        places.append((size + len(body), count, record.itemsize + grown))
        body += rows.tobytes()
    beginning = bytearray(content[: HEADER.itemsize] + b"\xee" * 8)
    struct.pack_into("<HI", beginning, 10, MINOR + 1, size)
    for name, place in zip(TABLES, places, strict=True):
        struct.pack_into("<3Q", beginning, offset_of(HEADER, name), *place)
    return sealed(bytes(beginning) + body)
