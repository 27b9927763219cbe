# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: read a trajectory file as the ``model.Trajectory`` that was written, bit for bit, or report its faults.

No statement of the file is trusted before it is checked: sizes against the file, tables against its bounds and each
other, the bytes against their checksums. A table is a view into the bytes read: a false count cannot allocate memory.

The container is checked first, then the strings and numbers that a ``Trajectory`` cannot hold, then the invariants of
every trajectory, then the precomputed data: the returned trajectory does not contain it, but other players rely on it.
"""

from __future__ import annotations

import os
import stat
import zlib
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.model import (
    TRAJECTORY_COLUMNS,
    Array,
    ColumnBuilder,
    Diagnostic,
    Diagnostics,
    Event,
    EventKind,
    Place,
    Tolerances,
    Tool,
    Trajectory,
    checkpoint,
)
from pkm_post.system import in_workers, reason_of
from pkm_post.writing.trajectory_file.interpolation import blocks, deviating_columns
from pkm_post.writing.trajectory_file.invariants import (
    SEGMENTS_PER_CHUNK,
    Chunk,
    chunks,
    contradictions,
    first_segments,
    violations,
)
from pkm_post.writing.trajectory_file.layout import (
    ALIGNMENT,
    HEADER,
    MAGIC,
    MAJOR,
    MINOR,
    TABLES,
    TOOL_COLUMNS,
    UNITS,
    Records,
    offset_of,
)

Content = bytes | memoryview
"""The bytes of a file."""


_BYTES_AT_ONCE = 1 << 24


class DamageError(Exception):
    """The file cannot be read; holds the code and the text of the diagnostic. Internal to this package."""

    def __init__(self, found: str, code: str = "T103") -> None:
        self.code = code
        super().__init__(found)


def bytes_of(path: Path) -> memoryview:
    """All bytes of a file; a file that is not a trajectory file is not read beyond the header.

    Raises:
        DamageError: the file cannot be opened, is of another kind or version, or differs from its stated size.
    """
    try:
        return _content(path)
    except (OSError, ValueError) as fault:  # ValueError: invalid path name
        raise DamageError(reason_of(fault, path), "T101") from fault


def opened(content: Content) -> tuple[np.void, dict[str, Records]]:
    """The header record, and the tables by name, from the bytes of a file.

    Raises:
        DamageError: they are of another kind or version, or damaged.
    """
    header = _header(content)
    _check_size(header, len(content))
    _check_header(header, content)
    _check_tables(header, len(content))
    if _checksum(memoryview(content)[int(header["header_size"]) :]) != header["body_crc"]:
        raise DamageError("the checksum of the body is wrong")
    return header, {name: _table(header, name, content) for name in TABLES}


def _checksum(content: memoryview) -> int:
    checksum = 0
    for begin in range(0, len(content), _BYTES_AT_ONCE):
        checkpoint()
        checksum = zlib.crc32(content[begin : begin + _BYTES_AT_ONCE], checksum)
    return checksum


def _content(path: Path) -> memoryview:
    if not stat.S_ISREG(path.stat().st_mode):  # opening a pipe would block until it has a writer
        raise DamageError("it is not a regular file", "T101")
    with path.open("rb", buffering=0) as file:
        header = _header(file.read(HEADER.itemsize))
        size = os.fstat(file.fileno()).st_size
        _check_size(header, size)
        file.seek(0)
        content, length = np.empty(size, np.uint8).data, 0  # uses large pages: half the time of ``file.read``
        while count := file.readinto(content[length : length + _BYTES_AT_ONCE]):
            checkpoint()
            length += count
        length += len(file.read(1))
    if length != size:
        raise DamageError(f"the file changed from {size} to {length} bytes while it was read")
    return content


def _header(content: Content) -> np.void:
    """The header record of a file of the supported kind and version."""
    content = bytes(content[: HEADER.itemsize])
    if not content.startswith(MAGIC):
        raise DamageError(
            f"it begins with {content[: len(MAGIC)].decode('latin-1')!r}" if content else "it is empty", "T101"
        )
    header: np.void = np.frombuffer(content.ljust(HEADER.itemsize, b"\0"), HEADER)[0]
    if len(content) >= offset_of(HEADER, "header_size") and header["major"] != MAJOR:
        raise DamageError(f"it has version {header['major']}.{header['minor']}, known is {MAJOR}.{MINOR}", "T102")
    if len(content) < HEADER.itemsize:
        raise DamageError(f"the header of {HEADER.itemsize} bytes ends after {len(content)}")
    return header


def _check_size(header: np.void, size: int) -> None:
    if header["file_size"] != size:
        raise DamageError(f"the file has {size} bytes, its header says {header['file_size']}")


def _check_header(header: np.void, content: Content) -> None:
    size = int(header["header_size"])
    if not _is_size(size, HEADER.itemsize, header) or size > len(content):
        raise DamageError(f"the header size is {size}, version {MAJOR}.{MINOR} has {HEADER.itemsize}")
    checked = bytearray(content[:size])
    at = offset_of(HEADER, "header_crc")
    checked[at : at + 4] = bytes(4)
    if zlib.crc32(checked) != header["header_crc"]:
        raise DamageError("the checksum of the header is wrong")


def _check_tables(header: np.void, file_size: int) -> None:
    """Refuse tables with unknown record sizes, outside the file, or overlapping each other."""
    spans = [(0, int(header["header_size"]), "header")]
    for name, record in TABLES.items():
        offset, count, record_size = header[name].item()
        if not _is_size(record_size, record.itemsize, header) or record_size > file_size:
            raise DamageError(f"a record of the table {name} has {record_size} bytes, expected {record.itemsize}")
        if offset % ALIGNMENT or offset + count * record_size > file_size:
            raise DamageError(
                f"the table {name} of {count} records of {record_size} bytes at byte {offset} does not fit the file"
            )
        spans.append((offset, offset + count * record_size, name))
    for (_, end, name), (begin, _, follower) in pairwise(sorted(spans)):
        if begin < end:
            raise DamageError(f"the tables {name} and {follower} overlap")


def _is_size(size: int, known: int, header: np.void) -> bool:
    """Whether a record has its known size; a newer minor version may extend it."""
    grown = header["minor"] > MINOR and known > 1 and size > known and size % ALIGNMENT == 0
    return bool(size == known or grown)


def _table(header: np.void, name: str, content: Content) -> Records:
    """The known fields of the records of a table, (count,)."""
    offset, count, record_size = header[name].item()
    return np.ndarray((count,), TABLES[name], content, offset, (record_size,))


def read(path: Path) -> tuple[Trajectory | None, Diagnostics]:
    """Read a trajectory file and check all of it.

    Args:
        path: the file, as named by the user and shown in diagnostics.

    Returns:
        The trajectory, or None if the file has a fault; and the faults: T101 for a file of another kind,
        T102 for an unknown version, T103 for damage, T106 for content that contradicts itself.
    """
    try:
        content = bytes_of(path)
    except DamageError as damage:
        return None, (Diagnostic(damage.code, Place(str(path)), str(damage)),)
    return decode(content, str(path))


def decode(content: Content, file: str) -> tuple[Trajectory | None, Diagnostics]:
    """Decode the bytes of a trajectory file."""
    place = Place(file)
    try:
        header, tables = opened(content)
        trajectory = _trajectory(header, tables)
    except DamageError as damage:
        return None, (Diagnostic(damage.code, place, str(damage)),)
    broken = violations(trajectory) or [*_broken_advance(trajectory, tables)]
    if broken:
        return None, tuple(Diagnostic("T103", place, words) for words in broken)
    against_itself = contradictions(trajectory)
    if against_itself:
        return None, tuple(Diagnostic("T106", place, words) for words in against_itself)
    return trajectory, ()


def _broken_advance(trajectory: Trajectory, tables: dict[str, Records]) -> Iterator[str]:
    """Precomputed data that does not follow from the trajectory."""
    records = tables["segments"]

    def deviating(chunk: Chunk) -> tuple[int, dict[str, Array]]:
        begin, part = chunk
        return begin, deviating_columns(part, records[begin : begin + len(part)])

    for words in first_segments(in_workers(deviating, chunks(trajectory))):
        yield f"{words} does not follow from the rest"
    if not np.array_equal(blocks(trajectory), tables["blocks"]):
        yield "the table blocks does not have the first segment of every line"


def _trajectory(header: np.void, tables: dict[str, Records]) -> Trajectory:
    for name, unit in UNITS.items():
        if header[name] != unit:
            raise DamageError(f"the {name.replace('_', ' ')} is {header[name]}, expected {unit}")
    operations, tools = tables["operations"], tables["tools"]
    ends = [np.array([header["machine"], header["source"]]), operations["name"], tools["name"]]
    machine, source, *names = _strings(np.concatenate(ends), tables["text"])
    return Trajectory(
        **_columns(tables["segments"]),
        start_tip=header["start_tip"],
        start_axis=header["start_axis"],
        start_spin=float(header["start_spin"]),
        events=_events(tables["instructions"]),
        operations=tuple(names[: len(operations)]),
        tools=_tools(tools, names[len(operations) :]),
        machine_from_work=header["machine_from_work"],
        machine=machine,
        machine_fingerprint=header["machine_fingerprint"].tobytes().hex(),
        source=source,
        source_fingerprint=header["source_fingerprint"].tobytes().hex() if header["source_fingerprint"].any() else "",
        tolerances=_tolerances(float(header["tip_tolerance"]), float(header["axis_tolerance"])),
    )


def _tolerances(tip: float, axis: float) -> Tolerances | None:
    return None if tip == axis == 0 else Tolerances(tip, axis)


def _strings(places: Records, text: Records) -> list[str]:
    """The strings at their places in the text table.

    No two may share bytes: many long strings on the same bytes would expand far beyond the size of the file.
    """
    offset, length = places["offset"], places["length"]
    outside = (offset > len(text)) | (length > len(text) - np.minimum(offset, len(text)))
    if np.any(outside):
        raise DamageError(f"a string lies beyond the text of {len(text)} bytes")
    order = np.lexsort((length, offset))
    if np.any((offset + length)[order][:-1] > offset[order][1:]):
        raise DamageError("two strings overlap")
    content = text.tobytes()
    try:
        return [content[begin : begin + size].decode("utf-8") for begin, size in places.tolist()]
    except UnicodeDecodeError as fault:
        raise DamageError(f"the string {fault.object!r} is not UTF-8") from fault


def _columns(segments: Records) -> dict[str, Any]:
    """The columns of a trajectory, read part by part, as whole records are fetched from memory.

    A column with equal rows, such as the axis in three-axis work, takes the memory of one row.
    """
    columns = {name: ColumnBuilder(len(segments)) for name in TRAJECTORY_COLUMNS}
    for begin in range(0, max(len(segments), 1), SEGMENTS_PER_CHUNK):
        checkpoint()
        part = segments[begin : begin + SEGMENTS_PER_CHUNK]
        for name, (dtype, _) in TRAJECTORY_COLUMNS.items():
            if dtype == np.bool_ and np.any(part[name] > 1):
                row = int(np.argmax(part[name] > 1))
                raise DamageError(f"segment {begin + row}: the flag {name} is {part[name][row]}")
            columns[name].put(begin, part[name].astype(dtype))
    return {name: column.whole() for name, column in columns.items()}


def _events(instructions: Records) -> tuple[Event, ...]:
    unknown = np.flatnonzero(~np.isin(instructions["kind"], list(EventKind)))
    if len(unknown):
        raise DamageError(f"instruction {unknown[0]}: the kind {instructions['kind'][unknown[0]]} is unknown")
    rows, kinds, values = (instructions[name].tolist() for name in ("row", "kind", "value"))
    return tuple(Event(row, EventKind(kind), value) for row, kind, value in zip(rows, kinds, values, strict=True))


def _tools(tools: Records, names: list[str]) -> dict[int, Tool]:
    numbers = tools["number"]
    if np.any(numbers[1:] <= numbers[:-1]):
        raise DamageError("the numbers of the tools do not ascend")
    columns = {name: tools[name].tolist() for name in TOOL_COLUMNS}
    rows = zip(*columns.values(), strict=True)
    found = (Tool(name=name, **dict(zip(columns, row, strict=True))) for name, row in zip(names, rows, strict=True))
    return {tool.number: tool for tool in found}
