# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bad machine files: the first line of each says which faults must be found in it, no more and no fewer."""

import datetime
import functools
import json
import re
import tomllib
from pathlib import Path

import pytest

from pkm_post.machine.description.fields import FIELDS
from pkm_post.machine.description.presets import find_machine
from pkm_post.machine.description.reader import read_machine

PRESET = find_machine("example_6tps")
BAD_MACHINES = sorted((Path(__file__).parents[2] / "data" / "bad_machines").glob("*.toml"))
MACHINE_FILE_CODES = {"M101", "M102", "M103", "M104", "M105", "M106", "M107"}


def stated_faults(path):
    """(code, entry) as the first line has them, ``# M104 struts.stroke; M102``; a whole file has no entry."""
    first = path.read_bytes().split(b"\n", 1)[0].decode("ascii")
    return [tuple((item.split() + [""])[:2]) for item in first.removeprefix("#").split(";")]


def found_faults(diagnostics):
    whole_file = ("M101", "M102")
    return [(item.code, "" if item.code in whole_file else item.found.split(": ")[0]) for item in diagnostics]


def read_changed(tmp_path, old, new):
    text = PRESET.read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = tmp_path / "changed.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    machine, diagnostics = read_machine(path)
    assert machine is None
    return diagnostics


def key_lines(table, above=()):
    """The document as one dotted key per line; the texts of the preset need no escapes."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from key_lines(value, (*above, key))
        else:
            yield f"{'.'.join((*above, key))} = {shown(value)}"


def shown(value):
    """A value as TOML has it in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {shown(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(shown, value))}]"
    return json.dumps(value) if isinstance(value, str) else str(value)


@pytest.mark.slow
@pytest.mark.parametrize("field", FIELDS, ids=lambda field: field.entry)
@pytest.mark.parametrize("foreign", [datetime.date(2024, 1, 31), [[]], True])
def test_every_entry_turns_away_a_value_of_foreign_type(tmp_path, field, foreign):
    document = tomllib.loads(PRESET.read_text(encoding="utf-8"))
    *sections, key = field.entry.replace("*", "G54").split(".")
    functools.reduce(lambda table, part: table.setdefault(part, {}), sections, document)[key] = "FOREIGN"
    path = tmp_path / "machine.toml"
    path.write_text("\n".join(key_lines(document)).replace('"FOREIGN"', str(foreign).lower()), encoding="utf-8")
    machine, diagnostics = read_machine(path)
    assert machine is None
    assert ("M104", ".".join((*sections, key))) in found_faults(diagnostics)
    assert {item.code for item in diagnostics} == {"M104"}


def test_there_are_bad_machines_for_every_code():
    assert {code for path in BAD_MACHINES for code, _ in stated_faults(path)} == MACHINE_FILE_CODES


@pytest.mark.parametrize("path", BAD_MACHINES, ids=lambda path: path.stem)
def test_bad_machine_gives_exactly_the_stated_faults(path):
    machine, diagnostics = read_machine(path)
    assert machine is None
    assert sorted(found_faults(diagnostics)) == sorted(stated_faults(path))


@pytest.mark.parametrize("path", BAD_MACHINES, ids=lambda path: path.stem)
def test_faults_are_reported_in_the_order_of_the_text(path):
    _, diagnostics = read_machine(path)
    lines = [item.place.line for item in diagnostics]
    assert lines == sorted(lines)
    assert {item.place.file for item in diagnostics} == {str(path)}


@pytest.mark.parametrize("path", BAD_MACHINES, ids=lambda path: path.stem)
def test_line_of_a_fault_shows_its_key_or_its_section(path):
    _, diagnostics = read_machine(path)
    text = path.read_bytes().decode("latin-1").split("\n")
    for item in diagnostics:
        if item.code in ("M101", "M102") or not item.place.line:
            continue
        entry = item.found.split(": ")[0]
        section, _, key = entry.rpartition(".")
        line = text[item.place.line - 1]
        if item.code == "M103" or entry.startswith("work_offsets."):
            assert re.match(rf"\[{re.escape(section)}\]|{section.rpartition('.')[2]} = |{key} = ", line), (entry, line)
        else:
            assert re.match(rf"{key} = |\[+{re.escape(entry)}\]", line), (entry, line)


@pytest.mark.parametrize(
    ("old", "new", "entry"),
    [
        ("stroke = [750.0, 1250.0]", "stroke = [0.0, 1250.0]", "struts.stroke"),
        ("stroke = [750.0, 1250.0]", "stroke = [750.0, 750.0]", "struts.stroke"),
        ("acceleration = 5000.0\n", "acceleration = 1e300\n", "struts.acceleration"),
        ("acceleration = 5000.0\n", f"acceleration = 0x{'f' * 5000}\n", "struts.acceleration"),
        ("acceleration = 5000.0\n", "acceleration = 2024-01-31\n", "struts.acceleration"),
        ("base_cone = 25.0", "base_cone = 0", "joints.base_cone"),
        ("rest_tool_length = 120.0", "rest_tool_length = -1.0", "joints.rest_tool_length"),
        ("rest_pose = [0.0, 0.0, 200.0]", "rest_pose = { z = 200.0 }", "joints.rest_pose"),
        ("[586.8886, 124.7470, 1400.0]", '[586.8886, "124.7470", 1400.0]', "base.joints"),
        ("least_singular_value = 0.1", "least_singular_value = -0.1", "singularity.least_singular_value"),
        ('name = "Example 6-TPS"', 'name = " "', "name"),
        ('name = "Example 6-TPS"', 'name = "two\\nlines"', "name"),
        ('length = "mm"', 'length = ["mm"]', "units.length"),
        ('["A", "B", "C", "U", "V", "W"]', '["A", "B", "C", "U", "V", "D"]', "controller.letters"),
        ('["A", "B", "C", "U", "V", "W"]', '["A", "B", "C", "U", "VW", ""]', "controller.letters"),
        ('["A", "B", "C", "U", "V", "W"]', '"ABCUVW"', "controller.letters"),
        ("coordinate_system = 1", "coordinate_system = 0", "controller.coordinate_system"),
        ("coordinate_system = 1", "coordinate_system = 17", "controller.coordinate_system"),
        ("program = 10\n", "program = 1.0\n", "controller.program"),
        ("line_limit = 159", "line_limit = true", "controller.line_limit"),
        ('"M8"', '"M8 \u00e9"', "controller.codes.coolant_flood"),
        ('"M8"', '"M{value:99999999999d}"', "controller.codes.coolant_flood"),
        ('"M8"', '"M{}"', "controller.codes.coolant_flood"),
        ("rotation_z = 0.0", "rotation_z = [0.0]", "work_offsets.G54.rotation_z"),
    ],
)
def test_value_of_wrong_form_is_named(tmp_path, old, new, entry):
    diagnostics = read_changed(tmp_path, old, new)
    assert found_faults(diagnostics) == [("M104", entry)]
    assert ": expected " in diagnostics[0].found
    assert ", got " in diagnostics[0].found
    assert len(diagnostics[0].found) < 200


@pytest.mark.parametrize(
    ("old", "new", "nearest"),
    [
        ("\nspeed = 500.0", "\nspeed = 500.0\nsped = 1.0", "struts.speed"),
        ("[tool_path]", "[controler]\n[tool_path]", "controller"),
        ("home_tip =", "rapid_feed = 1\nhome_tip =", "tool_path.rapid_speed"),
    ],
)
def test_unknown_entry_is_reported_with_the_nearest_known_one(tmp_path, old, new, nearest):
    (diagnostic,) = read_changed(tmp_path, old, new)
    assert diagnostic.code == "M105"
    assert diagnostic.found.endswith(nearest)


def test_entry_like_no_other_is_reported_without_a_suggestion(tmp_path):
    (diagnostic,) = read_changed(tmp_path, 'name = "Example', 'xyzzy = 1\nname = "Example')
    assert diagnostic.found == "xyzzy: no known entry is like it"


def test_syntax_fault_has_line_and_column():
    path = next(path for path in BAD_MACHINES if path.stem == "not_toml")
    _, (diagnostic,) = read_machine(path)
    line = path.read_text(encoding="utf-8").split("\n")[diagnostic.place.line - 1]
    assert line == "speed = "
    assert diagnostic.place.column == len(line) + 1


@pytest.mark.parametrize("text", ["a = [", "a = " + "9" * 10_000, "a = 2024-02-31", "name\ufeff = 1"])
def test_text_that_toml_cannot_hold_is_a_fault_of_the_file(tmp_path, text):
    path = tmp_path / "machine.toml"
    path.write_text(text, encoding="utf-8")
    machine, (diagnostic,) = read_machine(path)
    assert machine is None
    assert diagnostic.code == "M102"


def test_missing_file_and_directory_cannot_be_read(tmp_path):
    for path in (tmp_path / "missing.toml", tmp_path, Path("nul\0byte.toml")):
        machine, (diagnostic,) = read_machine(path)
        assert machine is None
        assert diagnostic.code == "M101"
        assert diagnostic.place.file == str(path)


def test_binary_file_cannot_be_read(tmp_path):
    path = tmp_path / "machine.toml"
    path.write_bytes(bytes(range(256)))
    machine, (diagnostic,) = read_machine(path)
    assert machine is None
    assert diagnostic.code == "M101"


def test_empty_file_misses_every_required_entry(tmp_path):
    path = tmp_path / "machine.toml"
    path.write_bytes(b"")
    machine, diagnostics = read_machine(path)
    assert machine is None
    assert {item.code for item in diagnostics} == {"M103"}
    assert {"name", "base.joints", "controller.codes.stop"} <= {entry for _, entry in found_faults(diagnostics)}
