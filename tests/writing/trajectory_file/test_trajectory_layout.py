# SPDX-License-Identifier: LGPL-2.1-or-later
"""The records are C structs, they have the columns of the model, and docs/trajectory-format.md says the same."""

import ctypes
import re
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from trajectories import random_trajectory

from pkm_post.model import EventKind, Kind
from pkm_post.model.trajectory import TRAJECTORY_COLUMNS
from pkm_post.writing.trajectory_file import layout, write
from pkm_post.writing.trajectory_file.interpolation import interpolation

RECORDS = ("HEADER", "TABLE", "STRING", "TOOL", "OPERATION", "INSTRUCTION", "SEGMENT", "BLOCK")
DOCUMENT = (Path(__file__).parents[3] / "docs" / "trajectory-format.md").read_text(encoding="utf-8")
HEADING = re.compile(r"^### (\w+), (\d+) bytes$", re.MULTILINE)
FIELD = re.compile(r"^\| (\d+) \| `(\S+)` \| `(\w+)` \| (.+?) \| (.*?) ?\|$", re.MULTILINE)
KIND = re.compile(r"^\| (\d+) \| `([A-Z_]+)` \|", re.MULTILINE)
ONE = {"u1": "u8", "u2": "u16", "u4": "u32", "u8": "u64", "i4": "i32", "f8": "f64", "S8": "char[8]"}
"""numpy's names count bytes, those of the document bits."""
C_TYPES = {
    "u1": ctypes.c_uint8, "u2": ctypes.c_uint16, "u4": ctypes.c_uint32, "u8": ctypes.c_uint64,
    "i4": ctypes.c_int32, "f8": ctypes.c_double, "S8": ctypes.c_char * 8,
}  # fmt: skip


def fields(record):
    """Offset, element type and shape of each field by name."""
    return {name: (offset, *(dtype.subdtype or (dtype, ()))) for name, (dtype, offset, *_) in record.fields.items()}


def sections():
    """The text of the document by record, with the size in the heading."""
    parts = HEADING.split(DOCUMENT)[1:]
    return {name: (int(size), text) for name, size, text in zip(*[iter(parts)] * 3, strict=True)}


def in_words(dtype, shape):
    names = {getattr(layout, name): name for name in ("TABLE", "STRING")}
    one = names.get(dtype) or ONE[dtype.str[1:]]
    return one + "".join(f"[{size}]" for size in shape)


def test_document_has_a_section_for_every_record():
    assert tuple(sections()) == RECORDS


@pytest.mark.parametrize("name", RECORDS)
def test_document_states_every_field_as_the_layout_has_it(name):
    record = getattr(layout, name)
    size, text = sections()[name]
    described = [(int(offset), kind, field) for offset, kind, field, _, _ in FIELD.findall(text)]
    stated = [(offset, in_words(dtype, shape), field) for field, (offset, dtype, shape) in fields(record).items()]
    assert described == stated
    assert size == record.itemsize


def test_every_field_has_a_unit_and_a_meaning():
    rows = [row for _, text in sections().values() for row in FIELD.findall(text)]
    assert {unit for *_, unit, _ in rows} == {"-", "byte", "m", "mm", "rad", "s", "mm/s", "see below"}
    assert all(len(meaning) > 10 or field == "reserved" for _, _, field, _, meaning in rows)


@pytest.mark.parametrize(("record", "kinds"), [("INSTRUCTION", EventKind), ("SEGMENT", Kind)])
def test_document_names_every_kind(record, kinds):
    assert KIND.findall(sections()[record][1]) == [(str(int(kind)), kind.name) for kind in kinds]


def test_document_names_the_tables_in_their_order():
    tables = re.findall(r"^\| `(\w+)` \| `(\w+)` \| ", DOCUMENT, re.MULTILINE)
    assert [name for name, _ in tables] == list(layout.TABLES)
    records = [np.dtype("u1") if record == "u8" else getattr(layout, record) for _, record in tables]
    assert records == list(layout.TABLES.values())


def test_document_has_the_version_and_the_check_value_of_the_sum():
    header = sections()["HEADER"][1]
    assert f"Version of the layout, {layout.MAJOR}." in header
    assert f"added to the layout, {layout.MINOR}." in header
    assert f"0x{zlib.crc32(b'123456789'):X}" in header


def c_struct(record):
    """The record as a C compiler lays it out on this platform."""
    members = []
    for name, (_, dtype, shape) in fields(record).items():
        kind = C_TYPES[dtype.str[1:]] if dtype.fields is None else c_struct(dtype)
        for size in reversed(shape):
            kind = kind * size
        members.append((name, kind))
    return type("Record", (ctypes.LittleEndianStructure,), {"_fields_": members})


@pytest.mark.parametrize("name", RECORDS)
def test_records_are_c_structs(name):
    record = getattr(layout, name)
    compiled = c_struct(record)
    assert ctypes.sizeof(compiled) == record.itemsize
    for field, (offset, dtype, _) in fields(record).items():
        assert getattr(compiled, field).offset == offset
        assert offset % dtype.alignment == 0


@pytest.mark.parametrize("name", RECORDS)
def test_records_have_no_gaps_and_whole_words(name):
    record = getattr(layout, name)
    assert record.itemsize % layout.ALIGNMENT == 0
    assert sum(dtype.itemsize for dtype, *_ in record.fields.values()) == record.itemsize


def test_a_segment_has_every_column_of_the_model_with_all_its_bits_and_what_is_computed_of_them():
    columns = {
        name: (np.dtype(np.uint8 if dtype is np.bool_ else dtype), shape)
        for name, (dtype, shape) in TRAJECTORY_COLUMNS.items()
    }
    in_record = {name: (dtype, shape) for name, (_, dtype, shape) in fields(layout.SEGMENT).items()}
    assert in_record.pop("reserved") == (np.dtype(np.uint8), ())
    computed = interpolation(random_trajectory(1))
    assert in_record == columns | {name: (column.dtype, column.shape[1:]) for name, column in computed.items()}


def test_the_document_is_enough_to_read_a_file(tmp_path):
    """A reader made of the document's tables alone finds the numbers of the trajectory."""
    trajectory = random_trajectory(21, count=9)
    write(trajectory, tmp_path / "part.pkmt")
    content = (tmp_path / "part.pkmt").read_bytes()
    codes = {"u8": "B", "u16": "H", "u32": "I", "u64": "Q", "i32": "i", "f64": "d"}

    def value(record, field, base):
        rows = {name: (int(offset), kind) for offset, kind, name, _, _ in FIELD.findall(sections()[record][1])}
        offset, kind = rows[field]
        one, *sizes = re.findall(r"\w+", kind)
        found = struct.unpack_from(f"<{np.prod(sizes, dtype=int)}{codes[one]}", content, base + offset)
        return found if sizes else found[0]

    def table(name):
        at = next(int(offset) for offset, _, field, _, _ in FIELD.findall(sections()["HEADER"][1]) if field == name)
        return tuple(value("TABLE", field, at) for field in ("offset", "count", "record_size"))

    offset, count, size = table("segments")
    assert count == len(trajectory)
    for row in range(count):
        for column in ("tip", "axis", "spin", "feed", "length", "angle", "tool", "operation", "line", "kind", "smooth"):
            np.testing.assert_array_equal(
                value("SEGMENT", column, offset + row * size), getattr(trajectory, column)[row], err_msg=column
            )
    offset, count, size = table("instructions")
    events = [tuple(value("INSTRUCTION", name, offset + row * size) for name in ("row", "kind", "value"))
              for row in range(count)]  # fmt: skip
    assert events == [(event.row, event.kind, event.value) for event in trajectory.events]
    np.testing.assert_array_equal(
        np.reshape(value("HEADER", "machine_from_work", 0), (4, 4)), trajectory.machine_from_work
    )
