# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writer: a ``model.Trajectory`` enters, a trajectory file leaves; the same trajectory gives the same bytes.

The tables follow the header without gaps in the order of ``layout.TABLES``; tools are sorted by number. The strings
stand in the text table in the order machine, source, operations, tools.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from pkm_post.files import staged
from pkm_post.model import Event, Trajectory
from pkm_post.model.trajectory import TRAJECTORY_COLUMNS
from pkm_post.trajectory_file.layout import (
    HEADER,
    INSTRUCTION,
    MAGIC,
    MAJOR,
    MINOR,
    OPERATION,
    SEGMENT,
    STRING,
    TOOL,
    Records,
)
from pkm_post.trajectory_file.promises import broken_promises


def write(trajectory: Trajectory, path: Path) -> None:
    """Write a trajectory file; it appears complete or not at all.

    Args:
        trajectory: what to write.
        path: the file; its folder is made when it is missing, a file that is there is replaced.

    Raises:
        ValueError: the trajectory does not keep the promises of a trajectory, or has a text that is not Unicode.
        OSError: the file cannot be written.
    """
    broken = broken_promises(trajectory)
    if broken:
        raise ValueError(f"expected a trajectory that can be read back, got {'; '.join(broken)}")
    header, tables = _encoded(trajectory)
    with staged(path.parent) as folder, (folder / path.name).open("wb") as file:
        file.write(header.tobytes())
        for records in tables.values():
            file.write(_bytes(records))


def _encoded(trajectory: Trajectory) -> tuple[Records, dict[str, Records]]:
    """The header, as one record, and the tables by name in the order of the file."""
    tools = [trajectory.tools[number] for number in sorted(trajectory.tools)]
    names = [trajectory.machine, trajectory.source, *trajectory.operations, *(tool.name for tool in tools)]
    strings, text = _string_table(names)
    first_tool = 2 + len(trajectory.operations)

    tool_table = np.zeros(len(tools), TOOL)
    for column in ("number", "diameter", "corner_radius", "length"):
        tool_table[column] = [getattr(tool, column) for tool in tools]
    tool_table["name"] = strings[first_tool:]
    operation_table = np.zeros(len(trajectory.operations), OPERATION)
    operation_table["name"] = strings[2:first_tool]
    tables = {
        "tools": tool_table,
        "operations": operation_table,
        "instructions": _instructions(trajectory.events),
        "segments": _segments(trajectory),
        "text": np.frombuffer(text, np.uint8),
    }
    return _header(trajectory, strings, tables), tables


def _string_table(names: Iterable[str]) -> tuple[Records, bytes]:
    """Where each string stands, and the bytes of all of them."""
    encoded = [name.encode("utf-8") for name in names]
    strings = np.zeros(len(encoded), STRING)
    strings["length"] = [len(name) for name in encoded]
    strings["offset"] = np.cumsum(strings["length"]) - strings["length"]
    return strings, b"".join(encoded)


def _instructions(events: tuple[Event, ...]) -> Records:
    table = np.zeros(len(events), INSTRUCTION)
    for column in ("row", "kind", "value"):
        table[column] = [getattr(event, column) for event in events]
    return table


def _segments(trajectory: Trajectory) -> Records:
    table = np.zeros(len(trajectory), SEGMENT)
    for column in TRAJECTORY_COLUMNS:
        table[column] = getattr(trajectory, column)
    return table


def _header(trajectory: Trajectory, strings: Records, tables: dict[str, Records]) -> Records:
    """The header of the tables, with all sizes and checksums."""
    header: Records = np.zeros((), HEADER)
    header["magic"], header["major"], header["minor"], header["header_size"] = MAGIC, MAJOR, MINOR, HEADER.itemsize
    header["machine"], header["source"] = strings[0], strings[1]
    header["machine_fingerprint"] = np.frombuffer(bytes.fromhex(trajectory.machine_fingerprint), np.uint8)
    for name in ("machine_from_work", "start_tip", "start_axis", "start_spin"):
        header[name] = getattr(trajectory, name)
    end, checksum = HEADER.itemsize, 0
    for name, records in tables.items():
        header[name] = (end, len(records), records.itemsize)
        end, checksum = end + records.nbytes, zlib.crc32(_bytes(records), checksum)
    header["file_size"], header["body_crc"] = end, checksum
    header["header_crc"] = zlib.crc32(header.tobytes())  # the field itself counts as zero
    return header


def _bytes(records: Records) -> memoryview:
    """The records as bytes, without a copy."""
    return records.view(np.uint8).data
