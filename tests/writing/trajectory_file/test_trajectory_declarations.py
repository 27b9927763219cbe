# SPDX-License-Identifier: LGPL-2.1-or-later
"""The C header and the Kaitai description in resources/trajectory state the records as the layout has them."""

import math
import re
from pathlib import Path

import pytest

from pkm_post.model import EventKind, Kind
from pkm_post.writing.trajectory_file import layout

FOLDER = Path(__file__).parents[3] / "resources" / "trajectory"
HEADER = (FOLDER / "pkmt.h").read_text(encoding="utf-8")
KAITAI = (FOLDER / "pkmt.ksy").read_text(encoding="utf-8")
RECORDS = ("HEADER", "TABLE", "STRING", "TOOL", "OPERATION", "INSTRUCTION", "SEGMENT", "BLOCK")

C_NAMES = {
    "u1": "uint8_t", "u2": "uint16_t", "u4": "uint32_t", "u8": "uint64_t",
    "i4": "int32_t", "f8": "double", "S8": "char",
}  # fmt: skip
KAITAI_NAMES = {"u1": "u1", "u2": "u2", "u4": "u4", "u8": "u8", "i4": "s4", "f8": "f8"}


def fields(name):
    """Name, element type, shape and offset of each field of a record; records in it by their names."""
    names = {getattr(layout, one): one for one in ("TABLE", "STRING")}
    for field, (dtype, offset, *_) in getattr(layout, name).fields.items():
        element, shape = dtype.subdtype or (dtype, ())
        code = names.get(element) or element.str[1:]
        yield field, code, (8,) if code == "S8" else shape, offset


def test_the_header_has_all_records_and_no_others():
    assert set(re.findall(r"^struct pkmt_(\w+) \{", HEADER, re.MULTILINE)) == {*map(str.lower, RECORDS), "pose"}


@pytest.mark.parametrize("name", RECORDS)
def test_the_header_declares_every_field_in_its_order(name):
    body = re.search(rf"^struct pkmt_{name.lower()} \{{\n(.*?)^\}};", HEADER, re.MULTILINE | re.DOTALL)[1]
    declared = re.findall(r"^    (\S+|struct \S+) (\w+)((?:\[\d+\])*);", body, re.MULTILINE)
    assert len(declared) == body.count("\n")
    expected = [
        (C_NAMES.get(code) or f"struct pkmt_{code.lower()}", field, "".join(f"[{size}]" for size in shape))
        for field, code, shape, _ in fields(name)
    ]
    assert declared == expected


@pytest.mark.parametrize("name", RECORDS)
def test_the_header_asserts_the_offset_of_every_field_and_the_size(name):
    asserted = re.findall(rf"^PKMT_AT\({name.lower()}, (\w+), (\d+)\);", HEADER, re.MULTILINE)
    assert asserted == [(field, str(offset)) for field, _, _, offset in fields(name)]
    assert f"\nPKMT_SIZE({name.lower()}, {getattr(layout, name).itemsize});\n" in HEADER


def test_the_header_has_the_version_the_magic_bytes_and_the_kinds():
    assert re.findall(r"^#define PKMT_(MAJOR|MINOR) (\d+)", HEADER, re.MULTILINE) == [
        ("MAJOR", str(layout.MAJOR)),
        ("MINOR", str(layout.MINOR)),
    ]
    magic = re.search(r'^#define PKMT_MAGIC "(.*)"', HEADER, re.MULTILINE)[1]
    assert magic.encode().decode("unicode_escape").encode("latin-1") == layout.MAGIC
    kinds = re.findall(r"PKMT_([A-Z_]+) = (\d+)", HEADER)
    assert kinds == [(kind.name, str(int(kind))) for kind in (*Kind, *EventKind)]


def kaitai_section(name):
    """What stands below a type of the description."""
    return re.search(rf"^  {name}:\n(.*?)(?=^  \w|^\w|\Z)", KAITAI.split("\ntypes:\n")[1], re.MULTILINE | re.DOTALL)[1]


@pytest.mark.parametrize("name", RECORDS)
def test_the_kaitai_description_has_every_field_in_its_order(name):
    found, offset = [], 0
    sequence = kaitai_section(name.lower()).split("    seq:\n")[1].split("    instances:\n")[0]
    for field in re.findall(r"^      - id: (\w+)\n((?: {8}.*\n)*)", sequence, re.MULTILINE):
        keys = dict(re.findall(r"^ {8}(\S+): (.*)$", field[1], re.MULTILINE))
        code, count = kaitai_type(keys)
        found.append((field[0], code, count, offset))
        offset += count * (int(code[1:]) if code[1:].isdigit() else getattr(layout, code.upper()).itemsize)
    expected = [
        ("u1" if code == "S8" else KAITAI_NAMES.get(code, code.lower()), math.prod(shape), place)
        for _, code, shape, place in fields(name)
    ]
    assert [field for field, *_ in found] == [field for field, *_ in fields(name)]
    assert [(code, count, place) for _, code, count, place in found] == expected
    assert offset == getattr(layout, name).itemsize


def kaitai_type(keys):
    """The type of a field and how many of it there are."""
    if "contents" in keys:
        content = bytes(int(byte, 16) for byte in keys["contents"].strip("[]").split(","))
        assert content == layout.MAGIC
        return "u1", len(content)
    if "size" in keys:
        return "u1", int(keys["size"])
    return keys["type"], int(keys.get("repeat-expr", 1))


def test_the_kaitai_description_steps_through_every_table_by_the_size_of_its_records():
    tables = re.findall(
        r"^  (\w+):\n    pos: header\.(\w+)\.offset\n    type: (\w+)\n    size: header\.(\w+)\.record_size\n"
        r"    repeat: expr\n    repeat-expr: header\.(\w+)\.count\n",
        KAITAI,
        re.MULTILINE,
    )
    records = {name: layout.TABLES[name] for name in layout.TABLES if name != "text"}
    assert [table[0] for table in tables] == list(records)
    for name, *others in tables:
        assert getattr(layout, others.pop(1).upper()) == records[name]
        assert set(others) == {name}


@pytest.mark.parametrize(("name", "kinds"), [("segment_kind", Kind), ("instruction_kind", EventKind)])
def test_the_kaitai_description_has_the_kinds(name, kinds):
    section = re.search(rf"^  {name}:\n((?:    .*\n)*)", KAITAI.split("\nenums:\n")[1], re.MULTILINE)[1]
    found = re.findall(r"^    (\d+): (\w+)$", section, re.MULTILINE)
    assert found == [(str(int(kind)), kind.name.lower()) for kind in kinds]
    assert f"enum: {name}\n" in KAITAI
