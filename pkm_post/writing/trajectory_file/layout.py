# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layout: the records of a trajectory file, byte by byte; docs/trajectory-format.md describes them in prose.

All numbers are little-endian, in mm, rad, s and mm/s. Every record is a multiple of 8 bytes and every field is aligned
to its own size, so C reads the records as plain structs, also from a mapped file. New fields go to the end of their
record or replace reserved bytes, which are zero until then. The C header and the Kaitai description in
resources/trajectory define the same layout. [paper section 5.1]
"""

from __future__ import annotations

from typing import Any

import numpy as np

Records = np.ndarray[Any, Any]

MAGIC = b"PKMT\r\n\x1a\n"
"""The first bytes. A transfer in text mode corrupts the line ends in them."""
MAJOR = 1
"""Major version of the layout: others cannot be read."""
MINOR = 1
"""Minor version, for additions to the layout: a newer one is read without them."""

ALIGNMENT = 8
"""Bytes; every table begins at a multiple of this."""

UNITS = {"length_unit": 0.001, "angle_unit": 1.0, "time_unit": 1.0}
"""The units in the header, in m, rad and s: version 1 has no others."""

STRING = np.dtype([("offset", "<u8"), ("length", "<u8")], align=True)
"""A UTF-8 string: its offset in the text table, and its length in bytes."""

TABLE = np.dtype([("offset", "<u8"), ("count", "<u8"), ("record_size", "<u8")], align=True)
"""A table: its offset in the file, its number of records, and the bytes per record."""

TOOL = np.dtype(
    [
        ("number", "<i4"),
        ("reserved", "<u4"),
        ("name", STRING),
        ("diameter", "<f8"),
        ("corner_radius", "<f8"),
        ("length", "<f8"),
        ("bottom_angle", "<f8"),
        ("side_angle", "<f8"),
    ],
    align=True,
)
"""A tool of the trajectory, with the gauge length that the trajectory was made for."""
TOOL_COLUMNS = ("number", "diameter", "corner_radius", "length", "bottom_angle", "side_angle")
"""The numeric fields of ``model.Tool``."""

OPERATION = np.dtype([("name", STRING)], align=True)
"""An operation of the CAM job."""

INSTRUCTION = np.dtype([("row", "<u8"), ("kind", "<u4"), ("reserved", "<u4"), ("value", "<f8")], align=True)
"""An auxiliary instruction: a ``model.Event``."""

SEGMENT = np.dtype(
    [
        ("tip", "<f8", (3,)),
        ("axis", "<f8", (3,)),
        ("feed", "<f8"),
        ("length", "<f8"),
        ("spin", "<f8"),
        ("arc_centre", "<f8", (3,)),
        ("arc_axis", "<f8", (3,)),
        ("sweep", "<f8"),
        ("angle", "<f8"),
        ("start_tip", "<f8", (3,)),
        ("start_axis", "<f8", (3,)),
        ("start_spin", "<f8"),
        ("shift", "<f8", (3,)),
        ("radius", "<f8", (3,)),
        ("quarter", "<f8", (3,)),
        ("growth", "<f8"),
        ("axis_quarter", "<f8", (3,)),
        ("tool", "<i4"),
        ("operation", "<i4"),
        ("line", "<i4"),
        ("kind", "u1"),
        ("smooth", "u1"),
        ("exact_stop", "u1"),
        ("reserved", "u1"),
        ("tip_tolerance", "<f8"),
    ],
    align=True,
)
"""A motion instruction: one row of the columns of ``model.Trajectory`` and of ``interpolation``.

Five cache lines of 64 bytes: the first has the fields for a scan of all segments.
"""

BLOCK = np.dtype([("operation", "<i4"), ("line", "<i4"), ("segment", "<u8")], align=True)
"""A line of the source that moves the tool, and its first segment."""

TABLES: dict[str, np.dtype[Any]] = {
    "segments": np.dtype(SEGMENT),
    "blocks": np.dtype(BLOCK),
    "instructions": np.dtype(INSTRUCTION),
    "tools": np.dtype(TOOL),
    "operations": np.dtype(OPERATION),
    "text": np.dtype("u1"),
}
"""Records by table, in the order of the file. The text is last, as its size is not a multiple of 8."""

HEADER = np.dtype(
    [
        ("magic", "S8"),
        ("major", "<u2"),
        ("minor", "<u2"),
        ("header_size", "<u4"),
        ("file_size", "<u8"),
        ("header_crc", "<u4"),
        ("body_crc", "<u4"),
        *((name, TABLE) for name in TABLES),
        ("machine", STRING),
        ("source", STRING),
        ("machine_fingerprint", "u1", (32,)),
        ("source_fingerprint", "u1", (32,)),
        ("length_unit", "<f8"),
        ("angle_unit", "<f8"),
        ("time_unit", "<f8"),
        ("tip_tolerance", "<f8"),
        ("axis_tolerance", "<f8"),
        ("machine_from_work", "<f8", (4, 4)),
        ("start_tip", "<f8", (3,)),
        ("start_axis", "<f8", (3,)),
        ("start_spin", "<f8"),
        ("reserved", "u1", (16,)),
    ],
    align=True,
)
"""The start of the file, before the tables: 512 bytes, so that the segments start on a cache line of 64."""


def offset_of(record: np.dtype[Any], field: str) -> int:
    """Byte offset of a field in its record."""
    if record.fields is None:
        raise ValueError(f"expected a record with fields, got {record}")
    return int(record.fields[field][1])
