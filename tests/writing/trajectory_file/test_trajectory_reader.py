# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a file contains, it is read or refused with a reason; nothing in it is believed."""

import dataclasses
import os
import struct
import tracemalloc

import numpy as np
import pytest
from made_files import header_of, newer, sealed
from trajectories import everything, random_trajectory

from pkm_post.model import Kind
from pkm_post.writing.trajectory_file import decode, read, write
from pkm_post.writing.trajectory_file.invariants import contradictions, violations
from pkm_post.writing.trajectory_file.layout import HEADER, MAGIC, MINOR, SEGMENT, STRING, TABLES, offset_of

KILOBYTE = 1024
BUFFERS = 256 * KILOBYTE
"""What reading any file takes: from Python 3.14 on, an open file has a buffer of 128 kilobytes."""
TRAJECTORY = random_trajectory(11, count=12, events=5)


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    path = tmp_path_factory.mktemp("sound") / "part.pkmt"
    write(TRAJECTORY, path)
    return path.read_bytes()


@pytest.fixture
def path(tmp_path):
    return tmp_path / "part.pkmt"


def changed(content, at, form, *values):
    content = bytearray(content)
    struct.pack_into(form, content, at, *values)
    return bytes(content)


def refusal(path, content):
    """The one diagnostic of a file."""
    path.write_bytes(content)
    trajectory, diagnostics = read(path)
    assert trajectory is None
    assert len(diagnostics) == 1
    assert diagnostics[0].place.file == str(path)
    return f"{diagnostics[0].code} {diagnostics[0].found}"


def in_table(content, table, field, record=0):
    """Where a field of a record stands in the file."""
    return int(header_of(content)[table]["offset"]) + record * TABLES[table].itemsize + offset_of(TABLES[table], field)


def in_header(table, field):
    return offset_of(HEADER, table) + offset_of(HEADER[table], field)


def test_what_is_no_file_is_reported(tmp_path):
    names = ["missing", ".", "nul\0name"]
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
        names.append("pipe")
    found = {}
    for name in names:
        trajectory, (diagnostic,) = read(tmp_path / name)
        assert trajectory is None
        assert diagnostic.code == "T101"
        found[name] = diagnostic.found
    assert found["missing"] == "there is no such file or folder"
    assert found["."] == found.get("pipe", found["."]) == "it is not a regular file"
    assert "null" in found["nul\0name"]


def test_other_files_are_reported(path):
    assert refusal(path, b"") == "T101 it is empty"
    assert refusal(path, b"%\nO1000 G54\n") == "T101 it begins with '%\\nO1000 '"
    assert refusal(path, MAGIC[:7]).startswith("T101")


def test_a_file_sent_as_text_is_not_taken(path, sound):
    assert refusal(path, sound.replace(b"\r\n", b"\n")).startswith("T101")
    assert refusal(path, sound.replace(b"\n", b"\r\n")).startswith("T101")


@pytest.mark.parametrize("major", [0, 2, 65535])
def test_another_major_version_is_reported_whatever_follows(path, sound, major):
    assert refusal(path, changed(sound, 8, "<H", major)[:12]) == f"T102 it has version {major}.1, known is 1.1"


def test_a_newer_minor_version_is_read_without_what_it_adds(path, sound):
    path.write_bytes(newer(sound))
    trajectory, diagnostics = read(path)
    assert diagnostics == ()
    assert everything(trajectory) == everything(TRAJECTORY)


def test_a_file_of_version_1_0_has_no_tolerances_of_the_program(path):
    older = dataclasses.replace(TRAJECTORY, tip_tolerance=None)
    write(older, path)
    path.write_bytes(sealed(changed(path.read_bytes(), 10, "<H", 0)))
    trajectory, diagnostics = read(path)
    assert diagnostics == ()
    assert everything(trajectory) == everything(older)


def test_this_minor_version_has_no_additions(path, sound):
    assert f"header size is {HEADER.itemsize + 8}" in refusal(path, sealed(changed(newer(sound), 10, "<H", MINOR)))


def test_every_truncation_is_reported(path, sound):
    for length in range(len(MAGIC), len(sound)):
        trajectory, (diagnostic,) = decode(sound[:length], "part.pkmt")
        assert trajectory is None and diagnostic.code == "T103"
    for length in (*range(len(MAGIC), 40), HEADER.itemsize - 1, HEADER.itemsize, len(sound) - 1):
        assert refusal(path, sound[:length]).startswith("T103")


def test_bytes_behind_the_end_are_reported(path, sound):
    size = len(sound)
    assert refusal(path, sound + b"\0") == f"T103 the file has {size + 1} bytes, its header says {size}"


def test_every_flipped_bit_is_reported(sound):
    for bit in range(8 * len(sound)):
        if bit // 8 % 5 == bit % 5 or bit < 8 * HEADER.itemsize:
            damaged = bytearray(sound)
            damaged[bit // 8] ^= 1 << bit % 8
            trajectory, (diagnostic,) = decode(bytes(damaged), "part.pkmt")
            assert trajectory is None and diagnostic.code in ("T101", "T102", "T103")


HUGE = (2**32, 2**63 - 1, 2**63, 2**64 - 8, 2**64 - 1)


def test_empty_tables_of_huge_records_are_reported(path, sound):
    content = changed(newer(sound), in_header("instructions", "count"), "<QQ", 0, 2**64 - 8)
    assert f"a record of the table instructions has {2**64 - 8} bytes" in refusal(path, sealed(content))


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("value", HUGE)
@pytest.mark.parametrize("field", ["offset", "count", "record_size"])
def test_lies_about_tables_cost_no_memory(path, sound, table, field, value):
    path.write_bytes(sealed(changed(sound, in_header(table, field), "<Q", value)))
    tracemalloc.start()
    trajectory, (diagnostic,) = read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert trajectory is None
    assert diagnostic.code == "T103"
    assert f"table {table}" in diagnostic.found
    assert peak < 3 * len(sound) + BUFFERS


def test_tables_upon_each_other_are_reported(path, sound):
    begin = int(header_of(sound)["tools"]["offset"])
    assert "tables operations and tools overlap" in refusal(
        path, sealed(changed(sound, in_header("operations", "offset"), "<Q", begin))
    )
    assert "tables header and segments overlap" in refusal(
        path, sealed(changed(sound, in_header("segments", "offset"), "<Q", 8))
    )


def test_a_table_at_an_odd_place_is_reported(path, sound):
    at = in_header("tools", "offset")
    assert "does not fit the file" in refusal(path, sealed(changed(sound, at, "<Q", HEADER.itemsize + 4)))


def test_strings_that_lie_are_reported(path, sound):
    machine, source = offset_of(HEADER, "machine"), offset_of(HEADER, "source")
    text = int(header_of(sound)["text"]["count"])
    for lie in ((0, text + 1), (text + 1, 0), (text, 2**64 - 1), (2**64 - 1, 1), (2**63, 2**63)):
        assert "string lies beyond the text" in refusal(path, sealed(changed(sound, machine, "<QQ", *lie)))
    assert "two strings overlap" in refusal(path, sealed(changed(sound, source, "<QQ", 0, text)))


def test_strings_cannot_multiply_the_file(path, sound):
    """Ten thousand names on the same ten thousand bytes would be a hundred megabytes."""
    count, text = 10_000, b"x" * 10_000
    header = bytearray(sound[: HEADER.itemsize])
    places = {"operations": (count, 16), "text": (len(text), 1)}
    end = HEADER.itemsize
    for name, record in TABLES.items():
        records, size = places.get(name, (0, record.itemsize))
        struct.pack_into("<3Q", header, offset_of(HEADER, name), end, records, size)
        end += records * size
    struct.pack_into("<4Q", header, offset_of(HEADER, "machine"), 0, 0, 0, 0)
    body = np.tile(np.array((0, len(text)), STRING), count).tobytes() + text
    path.write_bytes(sealed(bytes(header) + body))
    tracemalloc.start()
    trajectory, (diagnostic,) = read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert trajectory is None
    assert diagnostic.found == "two strings overlap"
    assert peak < 10 * len(header + body)


def test_text_that_is_not_unicode_is_reported(path, sound):
    at = int(header_of(sound)["text"]["offset"])
    assert "is not UTF-8" in refusal(path, sealed(changed(sound, at, "B", 0xFF)))


BAD_VALUES = [
    ("segments", "kind", "B", 3, "segment 2: the kind is unknown"),
    ("segments", "smooth", "B", 2, "segment 2: the flag smooth is 2"),
    ("segments", "exact_stop", "B", 255, "segment 2: the flag exact_stop is 255"),
    ("segments", "tool", "<i", 5, "segment 2: the tool is not in the table"),
    ("segments", "operation", "<i", 3, "segment 2: the operation is not in the table"),
    ("segments", "feed", "<d", -1.0, "segment 2: the feed is not"),
    ("segments", "tip_tolerance", "<d", -1.0, "segment 2: the tip tolerance is not 0, nor a finite number"),
    ("segments", "tip_tolerance", "<d", 1e-300, "segment 2: the tip tolerance is not 0, nor a finite number"),
    ("segments", "feed", "<d", 1e-300, "segment 2: the feed is so low that the segment takes more than a day"),
    ("segments", "spin", "<d", 1e300, "segment 2: the spin is not finite, or beyond 1e+06 rad"),
    ("segments", "tip_tolerance", "<d", float("nan"), "segment 2: the tip tolerance is not"),
    ("segments", "axis", "<d", 2.0, "segment 2: the axis is not of unit length"),
    ("segments", "tip", "<d", float("nan"), "segment 2: the tip is not finite"),
    ("instructions", "kind", "<I", 0, "instruction 2: the kind 0 is unknown"),
    ("instructions", "row", "<Q", 2**64 - 1, "instruction 2: the row 18446744073709551615 is not between 0 and 12"),
    ("instructions", "value", "<d", float("inf"), "instruction 2: "),
    ("tools", "number", "<i", 0, "the numbers of the tools do not ascend"),
    ("tools", "number", "<i", 3, "the numbers of the tools do not ascend"),
    ("tools", "length", "<d", -1.0, "the length of tool 12 is -1.0 mm"),
    ("tools", "side_angle", "<d", 1.6, "the side angle of tool 12 is 1.6 rad"),
    ("segments", "angle", "<d", 0.1, "segment 2: the axis does not follow from the rest"),
    ("blocks", "segment", "<Q", 12, "the table blocks does not have the first segment of every line"),
    ("blocks", "line", "<i", -1, "the table blocks does not have the first segment of every line"),
    *(
        ("segments", field, "<d", value, f"segment 2: the {field} does not follow from the rest")
        for field in ("start_tip", "start_axis", "start_spin", "shift", "radius", "quarter", "growth", "axis_quarter")
        for value in (1e3, 1e300, float("nan"))
    ),
]


@pytest.mark.parametrize(("table", "field", "form", "value", "found"), BAD_VALUES)
def test_values_without_sense_are_reported(path, sound, table, field, form, value, found):
    path.write_bytes(sealed(changed(sound, in_table(sound, table, field, record=2), form, value)))
    trajectory, diagnostics = read(path)
    assert trajectory is None
    assert {diagnostic.code for diagnostic in diagnostics} == {"T103"}
    assert diagnostics[0].found.startswith(found)


@pytest.mark.parametrize("more", [-0.4, -1e-5, 1e-5, 40.0])
@pytest.mark.parametrize("is_arc", [False, True])
def test_a_segment_is_as_long_as_its_way(path, sound, more, is_arc):
    row = int(np.flatnonzero((TRAJECTORY.kind == Kind.ARC) == is_arc)[-1])
    length = TRAJECTORY.length[row]
    found = refusal(path, sealed(changed(sound, in_table(sound, "segments", "length", row), "<d", length + more)))
    assert found == f"T103 segment {row}: the length does not follow from the rest"
    path.write_bytes(sealed(changed(sound, in_table(sound, "segments", "length", row), "<d", length + more * 1e-9)))
    assert read(path)[1] == ()


BAD_HEADER = [
    ("length_unit", 0.0254, "the length unit is 0.0254, expected 0.001"),
    ("angle_unit", float("nan"), "the angle unit is nan, expected 1.0"),
    ("time_unit", 60.0, "the time unit is 60.0, expected 1.0"),
    ("tip_tolerance", -1.0, "the tolerances -1.0 mm and "),
    ("axis_tolerance", 0.0, "the tolerances 0."),
    ("start_tip", 2e9, "the start tip is not finite, or farther than 1e+09 mm"),
]


@pytest.mark.parametrize(("field", "value", "found"), BAD_HEADER)
def test_a_header_without_sense_is_reported(path, sound, field, value, found):
    assert refusal(path, sealed(changed(sound, offset_of(HEADER, field), "<d", value))).startswith(f"T103 {found}")


def test_all_wrong_columns_are_reported_at_once(path, sound):
    content = sound
    for field in ("tip", "feed", "length"):
        for record in (4, 6):
            content = changed(content, in_table(sound, "segments", field, record), "<d", float("nan"))
    path.write_bytes(sealed(content))
    _, diagnostics = read(path)
    assert [diagnostic.found.split(":")[0] for diagnostic in diagnostics] == 3 * ["segment 4 and 1 more"]


def test_lines_that_are_left_out_of_the_blocks_are_reported(path, sound):
    count = int(header_of(sound)["blocks"]["count"])
    content = sealed(changed(sound, in_header("blocks", "count"), "<Q", count - 1))
    assert "the table blocks does not have" in refusal(path, content)


def flip_bits(rng, content):
    damaged = bytearray(content)
    for place in rng.integers(0, len(content), rng.integers(1, 4)).tolist():
        damaged[place] ^= 1 << int(rng.integers(8))
    return bytes(damaged)


def cut(rng, content):
    begin, end = sorted(rng.integers(0, len(content), 2).tolist())
    return content[:begin] + content[end + 1 :] if rng.random() < 0.5 else content[:end]


def lie_in_header(rng, content):
    lies = [0, 1, 7, 8, len(content), len(content) - 8, int(rng.integers(2**63)), *HUGE]
    return changed(content, 8 * int(rng.integers(1, HEADER.itemsize // 8)), "<Q", lies[rng.integers(len(lies))])


def lie_in_body(rng, content):
    at = int(rng.integers(HEADER.itemsize, len(content) - 8))
    lies = [rng.bytes(8), bytes(8), b"\xff" * 8, struct.pack("<d", rng.normal()), struct.pack("<d", np.nan)]
    at = at - at % 8 if rng.random() < 0.8 else at
    return content[:at] + lies[rng.integers(len(lies))] + content[at + 8 :]


DAMAGES = [(flip_bits, False), (cut, False), (flip_bits, True), (cut, True), (lie_in_header, True), (lie_in_body, True)]
"""What is done to a file, and whether size and checksums are made right afterwards."""


MUTATIONS = 2500


@pytest.mark.slow
@pytest.mark.parametrize(("damage", "seal"), DAMAGES)
def test_thousands_of_damaged_files_of_each_sort_are_reported_or_sound(path, sound, damage, seal):
    """All in all 15,000: without the right checksums none is taken, and with them only what violates no invariant."""
    rng = np.random.default_rng(DAMAGES.index((damage, seal)))
    outcomes, later = [], newer(sound)
    for turn in range(MUTATIONS):
        content = damage(rng, later if turn % 4 == 3 else sound)
        content = sealed(content) if seal and len(content) >= HEADER.itemsize else content
        trajectory, diagnostics = decode(content, "damaged.pkmt")
        if trajectory is None:
            assert diagnostics
            assert {diagnostic.code for diagnostic in diagnostics} <= {"T101", "T102", "T103", "T106"}
        else:
            assert diagnostics == ()
            assert seal
            assert violations(trajectory) == contradictions(trajectory) == []
            if turn % 25 == 0:
                write(trajectory, path)
        outcomes.append(trajectory is None)
    assert sum(outcomes) > 100
    assert all(outcomes) or seal


def test_records_are_read_where_they_lie(path, sound):
    """The end of segment 5 in the file is that in the trajectory: no permutation cancels out in a round trip."""
    at = in_table(sound, "segments", "tip", 5)
    assert struct.unpack_from("<3d", sound, at) == tuple(TRAJECTORY.tip[5])
    assert SEGMENT.itemsize == 320
