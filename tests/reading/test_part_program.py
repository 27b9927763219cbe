# SPDX-License-Identifier: LGPL-2.1-or-later
"""Warnings about the end of a program."""

import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.reading.part_program import end_warnings

OPTIONS = ReadOptions(default_tool=Tool(1, "", 6.0, 0.0, 100.0), axis_words="vector")
IN = "G0 X0 Y0 Z50\nG0 Z2\nM3 S9000\nG1 Z-1 F100\nG1 X50\n"


def warnings_of(text):
    program, faults = read(text, "part.ngc", OPTIONS)
    assert faults == ()
    return [(each.code, each.place.line, each.found) for each in end_warnings(program)]


@pytest.mark.parametrize(
    "end",
    [
        "G0 Z5\nM2\n",
        "G0 Z5\nG0 X0 Y0\nM5\n",
        "G0 Z5\nG1 Z-2\nX60\nG0 Z5\nM2\n",
        "G0 Z5\nG1 Z-2\nX60\nG0 Z50\nM2\n",
        "G0 Z5\nG98 G81 X1 Z-3 R1\nG80\nM2\n",
        "G0 Z5\nG43.5\nG0 X9 I0.6 J0 K0.8\nM2\n",
    ],
)
def test_nothing_of_a_program_that_leaves_the_machine_in_order(end):
    assert warnings_of(IN + end) == []


@pytest.mark.parametrize(
    ("end", "expected"),
    [
        ("M2\n", [("V131", 5, "51 mm lower than after the retract in line 1")]),
        ("G1 Z2\nM2\n", [("V131", 6, "48 mm lower than after the retract in line 1")]),
        ("G0 Z5\nG0 Z1\nM30\n", [("V131", 7, "4 mm lower than after the retract in line 6")]),
        ("G0 Z5\nG1 Z-2\nX9\nM2\n", [("V131", 8, "7 mm lower than after the retract in line 6")]),
        ("G0 Z5\n", [("V130", 6, "9000 rpm")]),
        ("G0 Z5\n%\n", [("V130", 6, "9000 rpm")]),
        ("M4 S500\nG0 Z5\n%\n", [("V130", 7, "500 rpm")]),
    ],
)
def test_what_stays_on_and_what_stays_low(end, expected):
    assert warnings_of(IN + end) == expected


def test_height_is_along_the_tool():
    # retracted by 20 mm along a tool that leans by 36.9 degrees, then deeper by 10
    tilted = "G43.5\nG0 X0 Y0 Z0 I0.6 J0 K0.8\nG1 X-6 Z-8 F100\nG0 X6 Z8\n"
    assert warnings_of(f"{tilted}M2\n") == []
    assert warnings_of(f"{tilted}G0 X0 Z0\nM2\n") == [("V131", 5, "10 mm lower than after the retract in line 4")]
