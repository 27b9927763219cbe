# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer: write a ``model.Trajectory`` to a trajectory file; the same trajectory gives the same bytes.

The tables follow the header without gaps in the order of ``layout.TABLES``; tools are sorted by number. The text table
has the strings in the order machine, source, operations, tools. Segments are encoded and written part by part, so the
writer needs little memory besides the trajectory; the header, with the checksum of all bytes, is written last.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from pkm_post.model import TRAJECTORY_COLUMNS, Event, Tool, Trajectory, checkpoint
from pkm_post.system import staged
from pkm_post.writing.trajectory_file.interpolation import blocks, interpolation, missed_ends
from pkm_post.writing.trajectory_file.invariants import chunks, contradictions, first_segments, violations
from pkm_post.writing.trajectory_file.layout import (
    HEADER,
    INSTRUCTION,
    MAGIC,
    MAJOR,
    MINOR,
    OPERATION,
    SEGMENT,
    STRING,
    TABLES,
    TOOL,
    TOOL_COLUMNS,
    UNITS,
    Records,
)


def write(trajectory: Trajectory, path: Path) -> None:
    """Write a trajectory file; it appears complete, or not at all.

    A missing folder is created, an existing file is replaced.

    Raises:
        ValueError: the trajectory violates an invariant, or has a text that is not Unicode.
        OSError: the file cannot be written.
    """
    _require_readable(trajectory)
    with staged(path.parent) as folder:
        _write(trajectory, folder / path.name)


def write_in_private(trajectory: Trajectory, path: Path) -> None:
    """Write a trajectory file in a private folder, whose owner flushes it to disk: no other process sees the file.

    Raises:
        ValueError: the trajectory violates an invariant, or has a text that is not Unicode.
        OSError: the file cannot be written.
    """
    _require_readable(trajectory)
    _write(trajectory, path)


def _require_readable(trajectory: Trajectory) -> None:
    faults = violations(trajectory) or contradictions(trajectory)
    if faults:
        raise ValueError(f"expected a trajectory that can be read back, got {'; '.join(faults)}")


def _write(trajectory: Trajectory, path: Path) -> None:
    strings = _Strings.of(trajectory)
    with path.open("wb") as file:
        file.write(bytes(HEADER.itemsize))
        header = _header(trajectory, strings)
        _write_tables(file, header, trajectory, strings)
        header["header_crc"] = zlib.crc32(header.tobytes())  # the field itself counts as zero
        file.seek(0)
        file.write(header.tobytes())


class _Strings(NamedTuple):
    """Places of the strings in the text table, each (n,) of ``layout.STRING``, and the bytes of all strings."""

    machine_and_source: Records
    operations: Records
    tools: Records
    text: bytes

    @classmethod
    def of(cls, trajectory: Trajectory) -> _Strings:
        tools = [tool.name for tool in _tools_by_number(trajectory)]
        names = [trajectory.machine, trajectory.source, *trajectory.operations, *tools]
        encoded = [name.encode("utf-8") for name in names]
        places = np.zeros(len(encoded), STRING)
        places["length"] = [len(name) for name in encoded]
        places["offset"] = np.cumsum(places["length"]) - places["length"]
        first_tool = 2 + len(trajectory.operations)
        return cls(places[:2], places[2:first_tool], places[first_tool:], b"".join(encoded))


def _tools_by_number(trajectory: Trajectory) -> list[Tool]:
    return [trajectory.tools[number] for number in sorted(trajectory.tools)]


def _header(trajectory: Trajectory, strings: _Strings) -> Records:
    """The header without the sizes and checksums of the tables."""
    header: Records = np.zeros((), HEADER)
    header["magic"], header["major"], header["minor"], header["header_size"] = MAGIC, MAJOR, MINOR, HEADER.itemsize
    header["machine"], header["source"] = strings.machine_and_source
    for name in ("machine_fingerprint", "source_fingerprint"):
        digits = bytes.fromhex(getattr(trajectory, name))
        header[name] = np.frombuffer(digits or bytes(32), np.uint8)
    for name, unit in UNITS.items():
        header[name] = unit
    if trajectory.tolerances:
        header["tip_tolerance"], header["axis_tolerance"] = trajectory.tolerances.tip, trajectory.tolerances.axis
    for name in ("machine_from_work", "start_tip", "start_axis", "start_spin"):
        header[name] = getattr(trajectory, name)
    return header


def _write_tables(file: BinaryIO, header: Records, trajectory: Trajectory, strings: _Strings) -> None:
    """Write the tables after the header, and enter their offsets and checksum in it."""
    tables: dict[str, Iterable[Records]] = {
        "segments": (_segments(begin, part) for begin, part in chunks(trajectory)),
        "blocks": (blocks(trajectory) for _ in range(1)),  # deferred until the segments are written
        "instructions": [_instructions(trajectory.events)],
        "tools": [_tools(_tools_by_number(trajectory), strings.tools)],
        "operations": [_operations(strings.operations)],
        "text": [np.frombuffer(strings.text, np.uint8)],
    }
    end, checksum = HEADER.itemsize, 0
    for name, record in TABLES.items():
        count = 0
        for records in tables[name]:
            checkpoint()
            data = records.view(np.uint8).data
            file.write(data)
            checksum = zlib.crc32(data, checksum)
            count += len(records)
        header[name] = (end, count, record.itemsize)
        end += count * record.itemsize
    header["file_size"], header["body_crc"] = end, checksum


def _tools(tools: list[Tool], names: Records) -> Records:
    table = np.zeros(len(tools), TOOL)
    for column in TOOL_COLUMNS:
        table[column] = [getattr(tool, column) for tool in tools]
    table["name"] = names
    return table


def _operations(names: Records) -> Records:
    table = np.zeros(len(names), OPERATION)
    table["name"] = names
    return table


def _instructions(events: tuple[Event, ...]) -> Records:
    table = np.zeros(len(events), INSTRUCTION)
    for column in ("row", "kind", "value"):
        table[column] = [getattr(event, column) for event in events]
    return table


def _segments(begin: int, trajectory: Trajectory) -> Records:
    """The records of a part; ``begin`` is the index of its first segment in the trajectory."""
    table = np.zeros(len(trajectory), SEGMENT)
    for column in TRAJECTORY_COLUMNS:
        table[column] = getattr(trajectory, column)
    columns = interpolation(trajectory)
    for words in first_segments([(begin, missed_ends(trajectory, columns))]):
        raise ValueError(f"expected segments that end where they say, got {words} does not follow from the rest")
    for column, values in columns.items():
        table[column] = values
    return table
