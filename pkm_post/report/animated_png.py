# SPDX-License-Identifier: LGPL-2.1-or-later
"""Animated PNG: pictures of a film made one file that browsers and viewers play.

PNG files of one size and kind enter, in their order; one animated PNG leaves. The pictures are not compressed anew:
their data is taken over as it is, in the chunks that PNG has for animations. Programs that know no animated PNG show
the first picture. [PNG third edition]
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_START, _HEAD = 33, slice(16, 29)
"""Bytes up to the end of the first chunk, and where its content is: size and kind."""
_KIND_AT, _PALETTE = 25, 3
"""Where the kind of the pixels is told, and the kind that is not taken: its colours would be told elsewhere."""
_LARGEST = 65535
"""Of both halves of the fraction of a second that a picture is shown."""


def animate(pictures: Sequence[Path], target: Path, per_second: float) -> None:
    """Write an animated PNG that plays for ever.

    Args:
        pictures: PNG files of the same width, height and kind of pixels.
        target: gets the animation.
        per_second: pictures for each second.

    Raises:
        ValueError: there is no picture, one is no PNG file or has a palette, or they differ in size or kind.
    """
    if not pictures:
        raise ValueError("expected pictures, got none")
    shown = Fraction(1.0 / per_second).limit_denominator(_LARGEST)
    head = _head(pictures)
    with target.open("wb") as file:
        file.write(_SIGNATURE + _chunk(b"IHDR", head))
        file.write(_chunk(b"acTL", struct.pack(">II", len(pictures), 0)))
        file.write(_chunk(b"fcTL", _control(0, head, shown)) + _chunk(b"IDAT", _data(pictures[0])))
        for number, picture in enumerate(pictures[1:], start=1):  # both chunks of a picture are counted
            file.write(_chunk(b"fcTL", _control(2 * number - 1, head, shown)))
            file.write(_chunk(b"fdAT", struct.pack(">I", 2 * number) + _data(picture)))
        file.write(_chunk(b"IEND", b""))


def _head(pictures: Sequence[Path]) -> bytes:
    """What all pictures say of their size and kind; read of all of them, before anything is written."""
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
    """How a picture is shown: all of it, for how long, and it takes the place of what was there."""
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
    """A chunk: its length, kind, content, and the check sum over the last two."""
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
