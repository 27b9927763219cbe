# SPDX-License-Identifier: LGPL-2.1-or-later
"""Words of LinuxCNC: what rs274 2.9 does with a quotient after a bracket, O words apart, pins, and D below 0."""

import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ReadOptions, read

ANY = Tool(0, "any", 6.0, 0.0, 50.0)


def taken(text):
    return read(f"G21 F100\nG0 X0 Y0 Z0\n{text}\n", "part.ngc", ReadOptions(default_tool=ANY))


def x_of(text):
    program, faults = taken(text)
    assert program is not None, [str(fault) for fault in faults]
    return program.position[-1, 0]


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("[[1+2]/3]", 1),
        ("[[8]/[2]/2]", 2),
        ("[6/3]", 2),
        ("[atan[1]/[1]/5]", 9),
        ("[[atan[1]/[1]]/9]", 5),
        ("[2*[3]/4]", 1.5),
        ("[[7] mod [4]]", 3),
    ],
)
def test_a_quotient_after_a_bracket(value, expected):
    assert x_of(f"#1={value}\nG1 X#1\n/G1 X{value}") == pytest.approx(expected, abs=1e-12)


def test_return_ends_the_subprogram_that_runs_whatever_its_label():
    assert x_of("o1 sub\no2 return [3]\nG1 X99\no1 endsub\no1 call\nG1 X#<_value>") == 3
    assert [fault.code for fault in taken("o2 return\n")[1]] == ["G312"]


def test_blanks_within_o_words_mean_nothing():
    assert x_of("o1 if [0]\nG1 X2\no1 else if [1]\nG1 X3\no1 end if") == 3
    assert x_of("o1 sub\nG1 X4\no1 end sub\no1 call\no2 repeat [1]\no2 end repeat\no3 while [0]\no3 end while") == 4


@pytest.mark.parametrize("name", ["#<_hal[motion.x]>", "#<_ini[AXIS_X]HOME>", "exists[#<_hal[a.b-c]>]"])
def test_what_only_the_control_knows_is_named(name):
    ((code, found),) = [(fault.code, fault.found) for fault in taken(f"G1 X[{name}]")[1]]
    assert code == "G303"
    assert found.startswith(("#<_hal[", "#<_ini["))


def test_d_below_zero_changes_the_side():
    sides = [taken(f"{code} G1 X1\nG40 X2")[0].side_offset[1] for code in ("G41.1 D2", "G41.1 D-2", "G42.1 D-2")]
    assert sides == [1, -1, 1]
    assert [fault.code for fault in taken("G41 D-2 G1 X1")[1]] == ["G406"]
