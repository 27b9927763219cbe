# SPDX-License-Identifier: LGPL-2.1-or-later
"""Animated PNG: combine frames into one file that browsers and viewers play.

Input: PNG files of one size and kind, in order. Output: one animated PNG. The frames are not recompressed: their data
is copied into the animation chunks of PNG. Programs without support for animated PNG show the first frame.
[PNG third edition]
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_START, _HEAD = 33, slice(16, 29)
"""Bytes up to the end of the first chunk, and the range of its content: size and kind."""
_KIND_AT, _PALETTE = 25, 3
"""Position of the colour type, and the unsupported type: its colours are stored in another chunk."""
_LARGEST = 65535
"""Largest numerator and denominator of the frame duration in seconds."""


def animate(pictures: Sequence[Path], target: Path, per_second: float) -> None:
    """Write an animated PNG that loops for ever.

    Args:
        pictures: PNG files of the same width, height and kind of pixels.
        target: path of the animation.
        per_second: frames per second.

    Raises:
        ValueError: there is no picture, one is not a PNG file or has a palette, or they differ in size or kind.
    """
    if not pictures:
        raise ValueError("expected pictures, got none")
    shown = Fraction(1.0 / per_second).limit_denominator(_LARGEST)
    head = _head(pictures)
    with target.open("wb") as file:
        file.write(_SIGNATURE + _chunk(b"IHDR", head))
        file.write(_chunk(b"acTL", struct.pack(">II", len(pictures), 0)))
        file.write(_chunk(b"fcTL", _control(0, head, shown)) + _chunk(b"IDAT", _data(pictures[0])))
        for number, picture in enumerate(pictures[1:], start=1):  # both chunks of a frame take a sequence number
            file.write(_chunk(b"fcTL", _control(2 * number - 1, head, shown)))
            file.write(_chunk(b"fdAT", struct.pack(">I", 2 * number) + _data(picture)))
        file.write(_chunk(b"IEND", b""))


def _head(pictures: Sequence[Path]) -> bytes:
    """The common size and kind of all pictures; all headers are read before anything is written."""
    heads = []
    for picture in pictures:
        with picture.open("rb") as file:
            start = file.read(_START)
        if not start.startswith(_SIGNATURE) or len(start) < _START or start[_KIND_AT] == _PALETTE:
            raise ValueError(f"{picture}: expected a PNG file without a palette")
        heads.append(start[_HEAD])
        if heads[-1] != heads[0]:
            raise ValueError(f"{picture}: expected a picture of the size and kind of the first one")
    return heads[0]


def _control(number: int, head: bytes, shown: Fraction) -> bytes:
    """Frame control: the whole picture, its duration, and that it replaces the previous one."""
    width, height = struct.unpack(">II", head[:8])
    return struct.pack(">IIIIIHHBB", number, width, height, 0, 0, shown.numerator, shown.denominator, 0, 0)


def _data(picture: Path) -> bytes:
    """The compressed pixels of a picture."""
    return b"".join(content for kind, content in _split(picture.read_bytes()) if kind == b"IDAT")


def _split(content: bytes) -> Iterator[tuple[bytes, bytes]]:
    place = len(_SIGNATURE)
    while place + 12 <= len(content):
        length, kind = struct.unpack(">I4s", content[place : place + 8])
        yield kind, content[place + 8 : place + 8 + length]
        place += 12 + length


def _chunk(kind: bytes, content: bytes) -> bytes:
    """A chunk: its length, kind, content, and the checksum of the last two."""
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
