# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader: read a trajectory file as the ``model.Trajectory`` that was written, bit for bit, or report its faults.

The container is checked first, then the strings and numbers that a ``Trajectory`` cannot hold, then the promises of
every trajectory, then the precomputed data: the returned trajectory does not contain it, but other players rely on it.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.model import (
    TRAJECTORY_COLUMNS,
    ColumnBuilder,
    Diagnostic,
    Event,
    EventKind,
    Place,
    Tolerances,
    Tool,
    Trajectory,
)
from pkm_post.writing.trajectory_file.container import Content, DamageError, bytes_of, opened
from pkm_post.writing.trajectory_file.contradictions import contradictions
from pkm_post.writing.trajectory_file.interpolation import blocks, strayed
from pkm_post.writing.trajectory_file.layout import TOOL_COLUMNS, UNITS, Records
from pkm_post.writing.trajectory_file.parts import SEGMENTS, parts
from pkm_post.writing.trajectory_file.promises import broken_promises, in_segments


def read(path: Path) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
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


def decode(content: Content, file: str) -> tuple[Trajectory | None, tuple[Diagnostic, ...]]:
    """The same for the bytes of a file.

    Args:
        content: all bytes.
        file: its name in diagnostics.
    """
    place = Place(file)
    try:
        header, tables = opened(content)
        trajectory = _trajectory(header, tables)
    except DamageError as damage:
        return None, (Diagnostic(damage.code, place, str(damage)),)
    broken = broken_promises(trajectory) or [*_broken_advance(trajectory, tables)]
    if broken:
        return None, tuple(Diagnostic("T103", place, words) for words in broken)
    against_itself = contradictions(trajectory)
    if against_itself:
        return None, tuple(Diagnostic("T106", place, words) for words in against_itself)
    return trajectory, ()


def _broken_advance(trajectory: Trajectory, tables: dict[str, Records]) -> Iterator[str]:
    """Precomputed data that does not follow from the trajectory."""
    records = tables["segments"]
    found = ((begin, strayed(part, records[begin : begin + len(part)])) for begin, part in parts(trajectory))
    for words in in_segments(found):
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
    for begin in range(0, max(len(segments), 1), SEGMENTS):
        part = segments[begin : begin + SEGMENTS]
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
