# SPDX-License-Identifier: LGPL-2.1-or-later
import tomllib
from pathlib import Path

import pytest

from pkm_post.controllers.pmac import Settings
from pkm_post.controllers.pvt.codes import DEFAULT_CODES

PRESETS = sorted((Path(__file__).parents[2] / "resources" / "machines").glob("*.toml"))
TABLE = {
    "kind": "turbo_pmac",
    "counts_per_mm": 10000,
    "zero_length": [500, 500, 500, 500, 500, 501.5],
    "approach_speed": 8,
}


def test_a_short_table_is_filled_with_defaults():
    settings = Settings.of(TABLE)
    assert settings.zero_length == (500, 500, 500, 500, 500, 501.5)
    assert settings.letters == ("A", "B", "C", "U", "V", "W")
    assert settings.codes == DEFAULT_CODES


def test_the_memory_is_that_of_the_extended_option():
    # open memory from $6000 to $40000 (Turbo PMAC Software Reference, p. 164)
    assert Settings.of(TABLE).memory_words == 0x40000 - 0x6000


def test_a_full_table_is_taken_as_it_is():
    table = TABLE | {
        "letters": ["U", "V", "W", "X", "Y", "Z"],
        "coordinate_system": 2,
        "program": 7,
        "length_decimals": 5,
        "speed_decimals": 3,
        "memory_words": 43008,
        "line_limit": 255,
        "codes": {"coolant_mist": "M17"},
    }
    settings = Settings.of(table)
    assert settings.letters == ("U", "V", "W", "X", "Y", "Z")
    assert (settings.coordinate_system, settings.program, settings.memory_words, settings.line_limit) == (
        2,
        7,
        43008,
        255,
    )
    assert settings.codes == DEFAULT_CODES | {"coolant_mist": "M17"}


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"kind": "power_pmac"}, "controller.kind: expected 'turbo_pmac', got 'power_pmac'"),
        ({"colour": "blue"}, r"unknown \['colour'\]"),
        ({"counts_per_mm": 0}, "counts_per_mm: expected a number other than zero, got 0"),
        ({"counts_per_mm": float("nan")}, "counts_per_mm"),
        ({"counts_per_mm": True}, "counts_per_mm"),
        ({"zero_length": [500] * 5}, "zero_length: expected six lengths"),
        ({"zero_length": 500}, "zero_length: expected six lengths"),
        ({"approach_speed": 0}, "approach_speed"),
        ({"letters": list("ABCUVV")}, "letters: expected six different"),
        ({"letters": list("ABCUVF")}, "letters: expected six different"),
        ({"letters": "ABCUVW"}, "letters: expected six different"),
        ({"coordinate_system": 17}, "coordinate_system: expected a whole number from 1 to 16"),
        ({"coordinate_system": 1.0}, "coordinate_system"),
        ({"program": 1000}, "program: expected a whole number from 1 to 999"),
        ({"length_decimals": 0}, "length_decimals"),
        ({"speed_decimals": 10}, "speed_decimals"),
        ({"memory_words": -1}, "memory_words"),
        ({"line_limit": 10}, "line_limit"),
        ({"codes": {"coolant_mist": "M8"}}, "expected different texts"),
    ],
)
def test_a_wrong_entry_is_refused_by_name(change, complaint):
    with pytest.raises(ValueError, match=complaint):
        Settings.of(TABLE | change)


@pytest.mark.parametrize("name", ["counts_per_mm", "zero_length", "approach_speed"])
def test_an_entry_without_default_is_required(name):
    with pytest.raises(ValueError, match=rf"missing \['{name}'\]"):
        Settings.of({key: value for key, value in TABLE.items() if key != name})


def test_there_are_machine_presets():
    assert PRESETS


@pytest.mark.parametrize("path", PRESETS, ids=lambda path: path.stem)
def test_the_controller_of_every_machine_preset_is_accepted(path):
    assert Settings.of(tomllib.loads(path.read_text(encoding="utf-8"))["controller"]).codes
