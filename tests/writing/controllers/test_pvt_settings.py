# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of the controllers, from the text of a machine file: what its reader lets through, and what they refuse."""

import re
from dataclasses import replace

import pytest
from controller_settings import settings_for

from pkm_post.machine import find_machine, machine_named, presets
from pkm_post.machine.description.reader import machine_of
from pkm_post.writing.controllers import CONTROLLERS

TEXT = find_machine("example_6tps").read_text(encoding="utf-8")


def with_entry(entry, value):
    """The example machine's file with another line for an entry of its controller; without it, when there is none."""
    text, count = re.subn(rf"(?m)^{entry} = .*\n", lambda line: f"{entry} = {value}\n" if value else "", TEXT)
    assert count == 1
    return text


def settings_from(text, kind="turbo_pmac"):
    """The settings, and the code and words of all that was found on the way to them."""
    machine, faults = machine_of(text.encode("utf-8"), "machine.toml")
    settings = None
    if machine:
        settings, found = CONTROLLERS[kind].settings_of(machine)
        faults += found
    return settings, [f"{fault.code} {fault.found}" for fault in faults]


@pytest.mark.parametrize("kind", CONTROLLERS)
def test_the_entries_of_the_file_are_the_settings(kind):
    text = with_entry("kind", f'"{kind}"').replace('["A", "B", "C", "U", "V", "W"]', '["U", "V", "W", "X", "Y", "Z"]')
    for old, new in (
        ("coordinate_system = 1", "coordinate_system = 2"),
        ("program = 10", "program = 7"),
        ("length_decimals = 6", "length_decimals = 5"),
        ("speed_decimals = 4", "speed_decimals = 3"),
        ("line_limit = 159", "line_limit = 255"),
        ('coolant_mist = "M7"', 'coolant_mist = "M17"'),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    settings, faults = settings_from(text, kind)
    assert faults == []
    assert settings.letters == ("U", "V", "W", "X", "Y", "Z")
    assert (settings.coordinate_system, settings.program, settings.line_limit) == (2, 7, 255)
    assert (settings.length_decimals, settings.speed_decimals) == (5, 3)
    assert (settings.counts_per_mm, settings.zero_length, settings.approach_speed) == (10000, (1007.8869,) * 6, 10)
    assert settings.codes["coolant_mist"] == "M17" and settings.codes["coolant_flood"] == "M8"


def test_the_memory_is_that_of_the_extended_option():
    # open memory from $6000 to $40000 (Turbo PMAC Software Reference, p. 164)
    assert settings_from(with_entry("memory_words", ""))[0].memory_words == 0x40000 - 0x6000
    assert settings_from(with_entry("memory_words", "43008"))[0].memory_words == 43008


@pytest.mark.parametrize(
    ("entry", "value", "complaint"),
    [
        ("kind", '"siemens"', "controller.kind: expected one of turbo_pmac, power_pmac, got 'siemens'"),
        ("kind", '"power_pmac"', "controller.kind: expected turbo_pmac, got 'power_pmac'"),
        ("counts_per_mm", "0", "controller.counts_per_mm: expected a number above 0, got 0"),
        ("counts_per_mm", "nan", "controller.counts_per_mm: expected a number above 0, got nan"),
        ("counts_per_mm", "true", "controller.counts_per_mm: expected a number above 0, got true"),
        ("zero_length", "[500, 500, 500, 500, 500]", "controller.zero_length: expected 6 numbers, got a list of 5"),
        ("zero_length", "500", "controller.zero_length: expected 6 numbers, got 500"),
        ("approach_speed", "0", "controller.approach_speed: expected a number above 0, got 0"),
        ("letters", '["A", "B", "C", "U", "V", "V"]', "controller.letters: expected 6 different letters"),
        ("letters", '["A", "B", "C", "U", "V", "F"]', "controller.letters: expected 6 different letters"),
        ("letters", '"ABCUVW"', "controller.letters: expected 6 different letters"),
        ("coordinate_system", "17", "controller.coordinate_system: expected a whole number from 1 to 16, got 17"),
        ("coordinate_system", "1.0", "controller.coordinate_system: expected a whole number from 1 to 16, got 1.0"),
        ("program", "1000", "controller.program: expected a whole number from 1 to 999, got 1000"),
        ("length_decimals", "0", "controller.length_decimals: expected a whole number from 1 to 9, got 0"),
        ("speed_decimals", "10", "controller.speed_decimals: expected a whole number from 1 to 9, got 10"),
        ("memory_words", "-1", "controller.memory_words: expected a whole number from 1 to 16777216, got -1"),
        ("line_limit", "10", "controller.line_limit: expected a whole number from 40 to 65536, got 10"),
        ("coolant_mist", '"M8"', "controller.codes: expected different texts, got 'M8' for coolant_flood and"),
        ("stop", '"PVT20"', "controller.codes.stop: expected text without ';' and braces, no comment, not beginning"),
        ("stop", '"M60==1"', "controller.codes.stop: expected DWELL0 behind a synchronous assignment, got 'M60==1'"),
    ],
)
def test_a_wrong_entry_is_refused_by_name(entry, value, complaint):
    settings, faults = settings_from(with_entry(entry, value))
    assert settings is None
    assert len(faults) == 1 and faults[0].startswith(f"M104 {complaint}")


@pytest.mark.parametrize("entry", ["kind", "letters", "counts_per_mm", "zero_length", "approach_speed", "stop"])
def test_an_entry_without_default_is_required(entry):
    settings, faults = settings_from(with_entry(entry, ""))
    assert settings is None
    assert len(faults) == 1 and re.match(rf"M103 controller\.(codes\.)?{entry}: ", faults[0])


def test_an_entry_that_is_not_known_is_refused():
    settings, faults = settings_from(TEXT.replace("line_limit = 159\n", 'line_limit = 159\ncolour = "blue"\n'))
    assert settings is None
    assert len(faults) == 1 and faults[0].startswith("M105 controller.colour: ")


def test_the_settings_of_another_controller_are_refused():
    settings, faults = settings_from(TEXT, "power_pmac")
    assert settings is None
    assert faults == ["M104 controller.kind: expected power_pmac, got 'turbo_pmac'"]


@pytest.mark.parametrize("kind", CONTROLLERS)
@pytest.mark.parametrize("number", [0, 1000])
def test_a_number_that_is_none_for_a_program_is_refused_when_it_is_chosen_later(kind, number):
    with pytest.raises(ValueError, match=f"program: expected a whole number from 1 to 999, got {number}"):
        replace(settings_for(kind), program=number)


@pytest.mark.parametrize("name", presets())
def test_the_controller_of_every_machine_preset_is_accepted(name):
    machine, _ = machine_named(name)
    settings, faults = CONTROLLERS[machine.controller["kind"]].settings_of(machine)
    assert settings is not None and faults == ()
