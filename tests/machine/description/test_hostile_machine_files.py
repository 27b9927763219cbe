# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine files of a size, a depth or with numbers that no machine has: refused, with little work."""

import random
import re
import tomllib

import pytest

from pkm_post.machine.description import faults, reader
from pkm_post.machine.description.faults import DEEPEST, MOST_BYTES, MOST_SHOWN
from pkm_post.machine.description.presets import FOLDER, presets
from pkm_post.machine.description.reader import machine_of, read_machine
from pkm_post.machine.description.value_types import MOST_SOLIDS
from pkm_post.posting.machine_check import machine_faults, machine_summary

PRESET = (FOLDER / "example_6tps.toml").read_text(encoding="utf-8")
LINES = PRESET.count("\n") + 1
NUMBER = re.compile(r"(?<![\w.\"])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.\"])")
HOSTILE = ("0", "-1", "1e-300", "1e-310", "1e300", "nan", "inf", "1e-12", "1e11")
DEEP = {
    "lists": "x = " + "[" * 100_000 + "]" * 100_000,
    "lists without an end": "x = " + "[" * 200_000,
    "tables in a line": "x = " + "{a=" * 60_000,
    "a key of many parts": ".".join("a" * 100_000) + " = 1",
    "a section of many parts": "[" + ".".join("a" * 100_000) + "]",
    "quoted parts": ".".join(['"a"'] * 50_000) + " = 1",
}


def refusal(text):
    """The one diagnostic of a file."""
    machine, diagnostics = machine_of(text.encode(), "machine.toml")
    assert machine is None
    (diagnostic,) = diagnostics
    return diagnostic


@pytest.fixture
def not_parsed(monkeypatch):
    """What is beyond the limits is not given to ``tomllib``, whose work is not bounded."""

    def loads(text):
        raise AssertionError("a text beyond the limits was parsed")

    monkeypatch.setattr(reader.tomllib, "loads", loads)


@pytest.mark.usefixtures("not_parsed")
@pytest.mark.parametrize("more", DEEP.values(), ids=DEEP)
def test_what_is_nested_deeply_is_refused_with_its_line(more):
    found = refusal(f"{PRESET}\n{more}")
    assert (found.code, found.place.line) == ("M207", LINES + 1)


@pytest.mark.usefixtures("not_parsed")
def test_two_hundred_thousand_bodies_are_refused_with_the_line_where_they_are_too_many():
    bodies = '[[interference.bodies]]\nname = "spindle"\nradius = 1.0\nfrom = 0.0\nto = 1.0\n'
    text = PRESET + bodies * 200_000
    found = refusal(text)
    assert found.code == "M206"
    assert found.place.line == text[:MOST_BYTES].count("\n") + 1


@pytest.mark.usefixtures("not_parsed")
def test_a_large_file_is_not_read_to_its_end(tmp_path):
    path = tmp_path / "large.toml"
    with path.open("wb") as file:
        file.truncate(1 << 40)  # a terabyte of zeros, of which nothing is on disk
    machine, (found,) = read_machine(path)
    assert machine is None
    assert found.code == "M206"


def test_the_limits_themselves_are_kept():
    text = PRESET + "#" * (MOST_BYTES - len(PRESET.encode()))
    assert machine_of(text.encode(), "m.toml")[0] is not None
    assert refusal(text + "#").code == "M206"
    levels = "[" * DEEPEST + "]" * DEEPEST
    assert refusal(f"{PRESET}\nx = {levels}").code == "M105"
    assert refusal(f"{PRESET}\nx = [{levels}]").code == "M207"


@pytest.mark.parametrize(
    "text", ["'[[[[[[[[[['", '"""[[[[[[[[[[\n]"""', "'''{{{{{{{{{{'''", '"a.\\".b.c.d.e.f.g.h.i.j"']
)
def test_brackets_and_dots_in_texts_and_comments_are_no_levels(text):
    others = re.sub(r"^description = .*$", "", PRESET, flags=re.MULTILINE)
    machine, diagnostics = machine_of(f"description = {text}  # [[[[[[[[[[[[[[[[\n{others}".encode(), "m.toml")
    assert diagnostics == ()
    assert machine is not None


@pytest.mark.parametrize("key", ["bodies", "fixtures"])
def test_more_solids_than_are_checked_are_refused(key):
    one = {
        "bodies": '{ name = "b", radius = 1.0, from = 900.0, to = 901.0 }',
        "fixtures": '{ name = "f", lowest = [9000, 9000, 9000], highest = [9001, 9001, 9001] }',
    }[key]
    start = re.search(rf"^{key} = ", PRESET, re.MULTILINE).start()
    end = (
        start
        + 1
        + next(
            at
            for at in range(len(PRESET[start:]))
            if PRESET[start : start + at + 1].count("[") == PRESET[start : start + at + 1].count("]") > 0
        )
    )
    with_many = {
        count: PRESET[:start] + f"{key} = [{', '.join([one] * count)}]" + PRESET[end:]
        for count in (MOST_SOLIDS, MOST_SOLIDS + 1)
    }
    assert machine_of(with_many[MOST_SOLIDS].encode(), "m.toml")[0] is not None
    found = refusal(with_many[MOST_SOLIDS + 1])
    assert (found.code, found.place.line) == ("M104", PRESET[:start].count("\n") + 1)
    assert f"got a list of {MOST_SOLIDS + 1}" in found.found


def test_of_very_many_faults_the_first_are_shown_with_little_work(monkeypatch):
    looked = []
    monkeypatch.setattr(faults, "_suggestion", lambda name: looked.append(name) or "nothing")
    text = "".join(f"u{number} = 1\n" for number in range(20_000)) + PRESET
    machine, found = machine_of(text.encode(), "m.toml")
    assert machine is None
    assert [item.code for item in found] == ["M105"] * MOST_SHOWN + ["M208"]
    assert found[-1].found == f"{20_000 - MOST_SHOWN} more from here on"
    assert found[-1].place.line == MOST_SHOWN + 1
    assert len(looked) == MOST_SHOWN


def with_numbers(text):
    """The text with each of its numbers replaced by each hostile one, as line and text."""
    lines = text.split("\n")
    for row, line in enumerate(lines):
        code = line.split("#")[0]
        for number in NUMBER.finditer(code, code.find("=") + 1):
            for value in HOSTILE:
                changed = line[: number.start()] + value + line[number.end() :]
                yield row + 1, "\n".join([*lines[:row], changed, *lines[row + 1 :]])


@pytest.mark.slow
@pytest.mark.parametrize("name", presets())
def test_any_number_of_any_machine_may_be_anything(name):
    """Without a warning of NumPy: the machine is refused at that line, or it can be looked at."""
    text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    outcomes = set()
    cases = list(with_numbers(text))
    for line, changed in random.Random(7).sample(cases, min(len(cases), 400)):
        assert tomllib.loads(changed)
        machine, found = machine_of(changed.encode(), "m.toml")
        outcomes.add(machine is None)
        if machine is None:
            assert found, line
            assert {item.code for item in found} <= {"M103", "M104", "M106"}
        else:
            machine_faults(machine, "m.toml")
            machine_summary(machine)
    assert outcomes == {True, False}


PLACES = (
    ("struts.acceleration", "acceleration = "), ("tool_path.axis_speed", "axis_speed = "),
    ("tool_path.rapid_speed", "rapid_speed = "), ("singularity.characteristic_length", "characteristic_length = "),
    ("controller.block_rate", "block_rate = "), ("controller.counts_per_mm", "counts_per_mm = "),
)  # fmt: skip


@pytest.mark.parametrize(("entry", "key"), PLACES)
@pytest.mark.parametrize("value", ["1e-300", "1e-310", "1e-12", "9e11"])
def test_sizes_without_sense_are_named_with_those_that_make_sense(entry, key, value):
    text = re.sub(rf"^{key}[^\s#]+", f"{key}{value}", PRESET, count=1, flags=re.MULTILINE)
    assert text != PRESET
    found = refusal(text)
    assert found.code == "M104"
    assert found.found.startswith(f"{entry}: expected a number above 0, got {float(value)!r}; ")
    assert re.search(r"; sizes from \S+ to \S+ [^ ]+ make sense$", found.found)


def test_a_home_beyond_all_reach_is_refused():
    """The way from there would be planned and looked at step by step."""
    text = re.sub(r"^home_tip = .*$", "home_tip = [1e6, 0.0, 300.0]", PRESET, flags=re.MULTILINE)
    found = refusal(text)
    assert found.code == "M106"
    assert found.found.startswith("tool_path.home_tip: 1000000.")
    assert found.place.line == PRESET[: PRESET.index("\nhome_tip = ")].count("\n") + 2
