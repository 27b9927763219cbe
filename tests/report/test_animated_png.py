# SPDX-License-Identifier: LGPL-2.1-or-later
"""Animated PNG: read back chunk by chunk as the format is published, its pictures are those that went in."""

import struct
import zlib

import numpy as np
import pytest

from pkm_post.report.animated_png import animate

SIGNATURE = bytes([137, 80, 78, 71, 13, 10, 26, 10])
"""The first eight bytes of a PNG file, in decimal as the format states them."""
SIZE = 7, 5
"""Rows and columns."""


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def written(path, pixels, colour=2, pieces=1):
    """A picture file of pixels (H, W, 3), in several IDAT chunks if that is asked for."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    packed = zlib.compress(rows)
    edges = np.linspace(0, len(packed), pieces + 1).astype(int)
    parts = [packed[start:end] for start, end in zip(edges[:-1], edges[1:], strict=True)]
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0))
    body = b"".join(chunk(b"IDAT", part) for part in parts)
    path.write_bytes(SIGNATURE + head + chunk(b"tEXt", b"Software\0test") + body + chunk(b"IEND", b""))
    return path


def chunks(path):
    """Kind and content of each chunk; a wrong check sum or a byte too many is a failure."""
    content, found = path.read_bytes(), []
    assert content[:8] == SIGNATURE
    at = 8
    while at < len(content):
        (length,) = struct.unpack(">I", content[at : at + 4])
        kind, body = content[at + 4 : at + 8], content[at + 8 : at + 8 + length]
        assert content[at + 8 + length : at + 12 + length] == struct.pack(">I", zlib.crc32(kind + body))
        found.append((kind, body))
        at += 12 + length
    assert at == len(content)
    return found


def pixels_of(packed):
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(SIZE[0], 1 + 3 * SIZE[1])
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(*SIZE, 3)


@pytest.fixture
def film():
    return np.random.default_rng(5).integers(0, 256, (4, *SIZE, 3), np.uint8)


def test_all_pictures_come_back_in_order_and_their_chunks_are_counted(tmp_path, film):
    files = [written(tmp_path / f"{number}.png", pixels, pieces=1 + number) for number, pixels in enumerate(film)]
    target = tmp_path / "film.png"
    animate(files, target, 30.0)
    found = chunks(target)
    assert [kind for kind, _ in found] == [b"IHDR", b"acTL", b"fcTL", b"IDAT", *[b"fcTL", b"fdAT"] * 3, b"IEND"]
    assert struct.unpack(">II", found[1][1]) == (4, 0)  # pictures, and how often they are played: for ever
    packed = [body if kind == b"IDAT" else body[4:] for kind, body in found if kind in (b"IDAT", b"fdAT")]
    np.testing.assert_array_equal([pixels_of(data) for data in packed], film)
    numbers = [struct.unpack(">I", body[:4])[0] for kind, body in found if kind in (b"fcTL", b"fdAT")]
    assert numbers == list(range(7))


@pytest.mark.parametrize(("per_second", "shown"), [(30.0, (1, 30)), (12.5, (2, 25)), (0.5, (2, 1))])
def test_every_picture_fills_the_frame_for_its_time(tmp_path, film, per_second, shown):
    files = [written(tmp_path / f"{number}.png", pixels) for number, pixels in enumerate(film)]
    animate(files, tmp_path / "film.png", per_second)
    for kind, body in chunks(tmp_path / "film.png"):
        if kind == b"fcTL":
            _, width, height, left, top, *time, dispose, blend = struct.unpack(">IIIIIHHBB", body)
            assert (width, height, left, top, dispose, blend) == (SIZE[1], SIZE[0], 0, 0, 0, 0)
            assert tuple(time) == shown


def test_pictures_that_do_not_belong_together_are_refused(tmp_path, film):
    one = written(tmp_path / "one.png", film[0])
    other = written(tmp_path / "other.png", film[1][:-1])
    palette = written(tmp_path / "palette.png", film[1], colour=3)
    text = tmp_path / "text.png"
    text.write_text("no picture")
    target = tmp_path / "film.png"
    for files, reported in (
        ([], "none"),
        ([one, other], "other.png: expected a picture of the size"),
        ([one, palette], "palette.png: expected a PNG file without a palette"),
        ([text], "text.png: expected a PNG file"),
    ):
        with pytest.raises(ValueError, match=reported):
            animate(files, target, 30.0)
        assert not target.exists()
