# SPDX-License-Identifier: LGPL-2.1-or-later
"""The same machine stated in inches and radians is the same machine, every number of it."""

import math
import tomllib
from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from pkm_post.machine.description.fields import FIELDS, section_tree
from pkm_post.machine.description.presets import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.machine.description.units import LENGTH, SPEED, TURNING_RATE, factor

PRESET = find_machine("example_6tps")
INCH = 25.4  # mm, exactly
ROUNDING = 1e-14  # relative, a few units in the last place
ROUNDED = {"rel": ROUNDING, "abs": 1e-12}


def numbers(value):
    """What a field of the machine holds, with nothing but numbers, texts, lists and dicts in it."""
    if isinstance(value, tuple):
        return [number for item in value for number in numbers(item)]
    if is_dataclass(value):
        return [number for field in fields(value) for number in np.ravel(getattr(value, field.name)).tolist()]
    return np.ravel(value).tolist() if isinstance(value, np.ndarray) else [value]


def toml_value(value):
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {toml_value(item)}' for key, item in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml_value, value))}]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def in_inch_and_rad(value, dimension):
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return {key: in_inch_and_rad(item, dimension) for key, item in value.items()}
    if isinstance(value, list):
        return [in_inch_and_rad(item, dimension) for item in value]
    return value / INCH**dimension.length * math.radians(1) ** dimension.angle


def flat_text(table, tree, above=()):
    """The document as one dotted key per line, every number taken to inches and radians."""
    for key, value in table.items():
        known = tree.get(key, tree.get("*"))
        if isinstance(value, dict):
            yield from flat_text(value, known, (*above, key))
        else:
            converted = in_inch_and_rad(value, known.dimension) if known.dimension.unit != "-" else value
            yield f"{'.'.join((*above, key))} = {toml_value(converted)}"


def test_inch_file_gives_the_same_machine_as_the_mm_file(tmp_path):
    document = tomllib.loads(PRESET.read_text(encoding="utf-8"))
    document["units"] = {"length": "inch", "angle": "rad", "time": "s"}
    path = tmp_path / "inch.toml"
    path.write_text("\n".join(flat_text(document, section_tree())), encoding="utf-8")
    (inch, faults), (mm, _) = read_machine(path), read_machine(PRESET)
    assert faults == ()
    for field in fields(mm):
        if field.name in ("fingerprint", "work_offsets", "controller"):
            continue
        found, stated = (numbers(getattr(machine, field.name)) for machine in (inch, mm))
        for left, right in zip(found, stated, strict=True):
            assert left == right or left == pytest.approx(right, **ROUNDED), field.name
    assert inch.work_offsets["G54"] == pytest.approx(mm.work_offsets["G54"], rel=ROUNDING)
    assert inch.controller.pop("zero_length") == pytest.approx(mm.controller.pop("zero_length"), rel=ROUNDING)
    assert inch.controller.pop("approach_speed") == pytest.approx(mm.controller.pop("approach_speed"), rel=ROUNDING)
    assert inch.controller == mm.controller
    assert inch.fingerprint != mm.fingerprint


def test_matrix_of_an_inch_file_is_shifted_in_inches(tmp_path):
    text = PRESET.read_text(encoding="utf-8")
    rows = "[[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]"
    start = text.index("G54 = ")
    text = text[:start] + f"G54 = {{ matrix = {rows} }}\n" + text[text.index("\n", start) :]
    numbers = tomllib.loads(text)
    numbers["units"]["length"] = "inch"
    path = tmp_path / "inch.toml"
    path.write_text("\n".join(flat_text_as_is(numbers)), encoding="utf-8")
    machine, faults = read_machine(path)
    assert faults == ()
    assert machine.work_offsets["G54"][:, 3] == pytest.approx([25.4, 50.8, 76.2, 1.0])
    assert machine.work_offsets["G54"][0, :3] == pytest.approx([0.0, -1.0, 0.0], abs=1e-15)


def flat_text_as_is(table, above=()):
    for key, value in table.items():
        if isinstance(value, dict):
            yield from flat_text_as_is(value, (*above, key))
        else:
            yield f"{'.'.join((*above, key))} = {toml_value(value)}"


def test_factors_follow_the_exponents():
    units = {"length": 25.4, "angle": 1.0, "time": 60.0}
    assert factor(LENGTH, units) == pytest.approx(25.4)
    assert factor(SPEED, units) == pytest.approx(25.4 / 60.0)
    assert factor(TURNING_RATE, units) == pytest.approx(1.0 / 60.0)


def test_texts_and_whole_numbers_have_no_unit():
    plain = {field.entry for field in FIELDS if field.dimension.unit == "-"}
    assert {"name", "controller.program", "controller.codes.stop", "joints.base_rest"} <= plain
    assert not plain & {"struts.stroke", "tool_path.axis_speed", "controller.zero_length"}
