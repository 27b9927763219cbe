# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a machine file says about G-code reaches the reader, in the work frame, and the user goes before it."""

import numpy as np
import pytest

from pkm_post.machine import find_machine
from pkm_post.posting.post_file import prepared_file

OFFSETS = """[work_offsets]
G54 = { origin = [5.0, 0.0, 150.0], rotation_z = 0.0 }
G55 = { origin = [5.0, 40.0, 160.0], rotation_z = 90.0 }
G57 = { matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]] }
"""
PROGRAMS = """[part_programs]
machine_zero = [0.0, 0.0, 450.0]
leave_out = ["M21 chip conveyor", "G211 monitor"]
"""
HEAD = "O1\nT1 M6\nG21 G90 G94 S900 M3\n"


@pytest.fixture
def prepared(tmp_path):
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    begin, end = text.index("[work_offsets]"), text.index("[controller]")
    machine = tmp_path / "machine.toml"
    machine.write_text(f"{text[:begin]}{OFFSETS}\n{PROGRAMS}\n{text[end:]}", encoding="utf-8")

    def prepare(program, arguments=""):
        file = tmp_path / "part.nc"
        file.write_text(f"{HEAD}{program}M30\n", encoding="utf-8")
        return prepared_file(file, str(machine), arguments=f"--tool-length 1=60 --flavour fanuc {arguments}")

    return prepare


def ends(made):
    assert made.program is not None, made.found
    return np.round(made.program.position[1:], 9).tolist()


def codes(made):
    return [fault.code for fault in made.found if fault.code not in ("G214", "V131")]


def test_further_work_offsets_are_those_of_the_machine(prepared):
    text = "G0 X0. Y0. Z50.\nX1.\nG55 X1. Y2. Z3.\nG54 X1. Y2. Z3.\n"
    assert ends(prepared(text)) == [[1, 0, 50], [-2, 41, 13], [1, 2, 3]]
    assert ends(prepared(f"G54 {text}")) == [[1, 0, 50], [-2, 41, 13], [1, 2, 3]]


def test_one_work_offset_is_the_frame_that_was_chosen(prepared):
    assert ends(prepared("G55 G0 X0. Y0. Z50.\nX1.\n")) == [[1, 0, 50]]


@pytest.mark.parametrize(
    ("text", "arguments"),
    [
        ("G55 G0 X0. Y0. Z5.\nG54 X1.\n", ""),  # the first is not the one that --work-offset names
        ("G54 G0 X0. Y0. Z5.\nG56 X1.\n", ""),  # the machine has no G56
        ("G54 G0 X0. Y0. Z5.\nG57 X1.\n", ""),  # G57 is turned about x
        ("G54 G0 X0. Y0. Z5.\nG55 X1.\n", "--work-offset=0,0,150"),  # no name, which they could refer to
    ],
)
def test_an_offset_that_is_not_known_is_refused(prepared, text, arguments):
    assert codes(prepared(text, arguments)) == ["G412"]


def test_the_origins_of_the_user_go_before(prepared):
    text = "G54 G0 X0. Y0. Z50.\nG55 X1. Y0. Z0.\n"
    assert ends(prepared(text, "--origin G54=0,0,0 --origin G55=7,8,9")) == [[8, 8, 9]]


def test_the_zero_of_the_machine_in_the_work_frame(prepared):
    text = "G0 X0. Y0. Z50.\nG91 G28 Z0\nG90\n"
    assert ends(prepared(text))[-1] == [0, 0, 300]
    assert ends(prepared(text, "--machine-zero 0,0,280"))[-1] == [0, 0, 280]


def test_without_parallel_axes_the_zero_of_the_machine_is_not_taken(prepared):
    assert codes(prepared("G0 X0. Y0. Z50.\nG28 Z0\n", "--work-offset G55")) == ["G413"]


def test_codes_of_the_machine_are_left_out_and_named(prepared):
    made = prepared("M21\nG211\nM77\nG0 X0. Y0. Z50.\n", "--leave-out M77")
    assert codes(made) == []
    assert [line for line in made.program.reading if "left out" in line] == [
        "G211, left out as chosen (line 5)",
        "M21, left out as chosen (line 4)",
        "M77, left out as chosen (line 6)",
    ]
    assert codes(prepared("M78\nG0 X0. Y0. Z50.\n")) == ["G401"]
