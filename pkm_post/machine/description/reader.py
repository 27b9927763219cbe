# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine file reader: from TOML text to a ``model.Machine`` in mm, rad and s.

All faults are collected in one run: first the form of every entry by the table of fields, then contradictions among the
well-formed entries. A file with a fault yields no machine, since a misread limit can damage one.
"""

from __future__ import annotations

import hashlib
import math
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.machine.description.consistency import contradictions, rest_axes, tool_change
from pkm_post.machine.description.faults import MOST_BYTES, EntryFault, fault_diagnostics, not_toml, too_deep, too_large
from pkm_post.machine.description.fields import ANY, FIELDS, REQUIRED, Field, Name, section_tree
from pkm_post.machine.description.spindle_axis import spindle_axis
from pkm_post.machine.description.units import Scale, stated_units
from pkm_post.machine.description.value_types import NAME, PROSE, WrongValueError, contains_unknown, quoted
from pkm_post.model import Array, Diagnostic, Diagnostics, Machine, Place
from pkm_post.system import reason_of

SECTION = "work_offsets"


def offset_names(document: dict[str, Any]) -> list[str]:
    """Names of the work offsets, in file order."""
    section = document.get(SECTION)
    return [name for name, offset in section.items() if isinstance(offset, dict)] if isinstance(section, dict) else []


def stated_poses(names: list[str], document: dict[str, Any]) -> list[EntryFault]:
    """Faults of offsets without exactly one of origin and matrix."""
    faults = []
    for name in names:
        stated = document[SECTION][name]
        if "origin" not in stated and "matrix" not in stated:
            faults.append(EntryFault("M103", (SECTION, name, "origin"), "needed, unless there is a matrix"))
        faults += [
            EntryFault("M104", (SECTION, name, key), "expected either a matrix or an origin, got both")
            for key in ("origin", "rotation_z")
            if "matrix" in stated and key in stated
        ]
    return faults


def _upright(origin: Array, rotation_z: float) -> Array:
    """Pose with this origin, rotated by ``rotation_z`` rad about the z axis of {M}."""
    cosine, sine = math.cos(rotation_z), math.sin(rotation_z)
    pose = np.eye(4)
    pose[:2, :2] = (cosine, -sine), (sine, cosine)
    pose[:3, 3] = origin
    return pose


def work_offsets(names: list[str], values: dict[str, Any]) -> dict[str, Array]:
    """Poses ``machine_from_work`` by name, of faultless offsets."""
    poses = {}
    for name in names:
        origin, rotation_z, matrix = (values[f"{SECTION}.{name}.{key}"] for key in ("origin", "rotation_z", "matrix"))
        poses[name] = _upright(origin, rotation_z) if matrix is None else matrix
        poses[name].flags.writeable = False
    return poses


CONTROLLER = "controller"
_FREE_TEXTS = (NAME, PROSE)
"""Forms in which "unknown" is an ordinary word."""


def read_machine(path: Path) -> tuple[Machine | None, Diagnostics]:
    """Read a machine file and check all of it.

    Args:
        path: the file, as the user named it; diagnostics show it unchanged.

    Returns:
        The machine, or None when the file has a fault; and every fault, in text order.
    """
    file = str(path)
    try:
        with path.open("rb") as stream:
            content = stream.read(MOST_BYTES + 1)
    except (OSError, ValueError) as fault:
        return None, (Diagnostic("M101", Place(file), reason_of(fault, path)),)
    machine, faults = machine_of(content, file)
    if machine is not None and machine.tool_table is not None:
        machine = replace(machine, tool_table=str(path.parent / machine.tool_table))
    return machine, faults


def machine_of(content: bytes, file: str) -> tuple[Machine | None, Diagnostics]:
    """Read the content of a machine file, as ``read_machine``.

    Args:
        content: TOML in UTF-8.
        file: name shown in diagnostics.
    """
    limit = too_large(content, file)
    if limit:
        return None, (limit,)
    try:
        text = content.decode("utf-8-sig")
    except ValueError as fault:
        return None, (Diagnostic("M101", Place(file), str(fault)),)
    limit = too_deep(text, file)
    if limit:
        return None, (limit,)
    try:
        document = tomllib.loads(text)
    except ValueError as fault:
        return None, (not_toml(fault, file, text),)
    offsets = offset_names(document)
    values, faults = _read_entries(document, offsets)
    faults += stated_poses(offsets, document) + contradictions(values)
    if faults:
        return None, fault_diagnostics(faults, file, text, document)
    return _machine(values, offsets, hashlib.sha256(content).hexdigest()), ()


def _read_entries(document: dict[str, Any], offsets: list[str]) -> tuple[dict[str, Any], list[EntryFault]]:
    """Convert every entry, by dotted name, with defaults for omitted ones; and collect the entry faults."""
    units = stated_units(document)
    optional = [field for field in FIELDS if field.default is not REQUIRED]
    values = {entry: field.default for field in optional for entry in field.entries(offsets)}
    faults: list[EntryFault] = []
    present: set[Name] = set()
    for name, known, value in _walk(document, section_tree(), ()):
        present.add(name)
        try:
            if known is None:
                faults.append(EntryFault("M105", name))
            elif isinstance(known, Field) and known.form not in _FREE_TEXTS and contains_unknown(value):
                values.pop(".".join(name), None)
                faults.append(EntryFault("M107", name, f"expected {known.form.words}"))
            elif isinstance(known, Field):
                values[".".join(name)] = known.form.read(value, Scale.of(known.dimension, units))
            else:
                faults.append(EntryFault("M104", name, f"expected a table, got {quoted(value)}"))
        except WrongValueError as wrong:
            values.pop(".".join(name), None)
            faults.append(EntryFault("M104", name, f"expected {known.form.words}, got {wrong}"))
    return values, faults + _missing(present)


def _walk(table: dict[str, Any], tree: dict[str, Any], above: Name) -> Iterator[tuple[Name, Any, Any]]:
    """Yield each entry of the document: name, ``Field`` (a dict for a section, None if unknown) and value."""
    for key, value in table.items():
        known = tree.get(key, tree.get(ANY))
        if isinstance(known, dict) and isinstance(value, dict):
            yield from _walk(value, known, (*above, key))
        else:
            yield (*above, key), known, value


def _missing(present: set[Name]) -> list[EntryFault]:
    """Required entries that are absent; those in a malformed section are reported with it."""
    return [
        EntryFault("M103", field.name, f"expected {field.form.words}")
        for field in FIELDS
        if field.default is REQUIRED
        and not any(field.name[:length] in present for length in range(1, len(field.name) + 1))
    ]


def _machine(values: dict[str, Any], offsets: list[str], fingerprint: str) -> Machine:
    base_rest, platform_rest = rest_axes(values)
    attributes = {field.attribute: values[field.entry] for field in FIELDS if field.attribute}
    return Machine(
        fingerprint=fingerprint,
        base_rest=base_rest,
        platform_rest=platform_rest,
        work_offsets=work_offsets(offsets, values),
        controller=_controller(values),
        tool_change=tool_change(values),
        spindle_axis=spindle_axis(values),
        # omitted entries get the machine's own defaults
        **{name: value for name, value in attributes.items() if value is not None},
    )


def _controller(values: dict[str, Any]) -> dict[str, Any]:
    """Entries below ``controller``, nested as in the file, in mm and mm/s; functions are listed among the codes."""
    settings: dict[str, Any] = {}
    for field in FIELDS:
        if field.name[0] == CONTROLLER:
            _, *sections, key = field.name
            section = settings
            for part in sections:
                section = section.setdefault(part, {})
            section[key] = values[field.entry]
    codes = settings["codes"] | settings["codes"].pop("functions")
    settings["codes"] = {name: text for name, text in codes.items() if text is not None}
    axis = spindle_axis(values)
    return settings if axis is None else settings | {"spindle_axis": axis}
