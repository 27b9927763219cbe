# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jumps and loops of Fanuc's macros, and values without brackets: the places that a program comes to."""

import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ExecutionLimits, ReadOptions, read

ANY = Tool(0, "any", 6.0, 0.0, 50.0)


def taken(text, **limits):
    options = ReadOptions(default_tool=ANY, flavour="fanuc")
    return read(f"G21 F100\nG0 X0. Y0. Z0.\n{text}", "part.nc", options, ExecutionLimits(**limits))


def xs(text):
    program, faults = taken(text)
    assert program is not None, [str(fault) for fault in faults]
    return program.position[1:, 0].tolist()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("#1=0\nWHILE [#1 LT 3] DO1\n#1=#1+1\nG1 X#1\nEND1\nX9.\n", [1, 2, 3, 9]),
        ("#1=0\nWHILE[#1LT2]DO1\n#2=0\nWHILE[#2LT2]DO2\n#2=#2+1\nG1X[#1*10+#2]\nEND2\n#1=#1+1\nEND1\n", [1, 2, 11, 12]),
        ("WHILE [0] DO1\nG1 X1.\nEND1\nG1 X2.\n", [2]),
        ("#1=1\nN10 G1 X#1\n#1=#1+1\nIF [#1 LE 3] GOTO 10\nX9.\n", [1, 2, 3, 9]),
        ("GOTO 20\nG1 X1.\nN20\nG1 X2.\n", [2]),
        ("GOTO20\nG1 X1.\nN0020 G1 X2.\n", [2]),
        ("GOTO 20\nG1 X1.\n/2 N20 X2.\nGOTO 30\n/1/3N0030 X3.\n", [2, 3]),
        ("#3=20\n(N20)\n/ N30 G1 X1.\nIF [#3 EQ 20] GOTO 40\nX2.\nN40 X3.\n", [1, 3]),
        ("#1=1+2*3-4/2\nG1 X#1\n#1=-#1\nX#1\n#2=2**3 #4=#1\nX#2 Y#4\n", [5, -5, 8]),
        ("M98 P7\nM30\nO7\nIF [1] GOTO 5\nG1 X1.\nN5 G1 X2.\nM99\n", [2]),
    ],
)
def test_the_way_through_a_program(text, expected):
    assert xs(text) == expected


@pytest.mark.parametrize(
    ("text", "code", "line"),
    [
        ("GOTO 20\nG1 X1.\n", "G320", 3),
        ("M98 P7\nM30\nN5 G1 X1.\nO7\nGOTO 5\nM99\n", "G320", 7),
        ("WHILE [1] DO1\nG1 X1.\n", "G308", 3),
        ("END1\nG1 X1.\n", "G307", 3),
        ("WHILE [1] DO1\nWHILE [1] DO2\nEND1\nEND2\n", "G307", 5),
        ("IF [1]\nG1 X1.\n", "G206", 3),
        ("N10 GOTO 10\n", "G313", 3),
    ],
)
def test_faults(text, code, line):
    _, faults = taken(text, blocks=1000)
    assert (code, line) in [(fault.code, fault.place.line) for fault in faults]


def test_jumps_speak_for_fanuc():
    program, _ = read("G21 F100\nG0 X0 Y0 Z0\nIF [0] GOTO 10\nN10 G1 X1.\n", "part.nc", ReadOptions(default_tool=ANY))
    assert program.reading[0] == "flavour fanuc, by IF GOTO in line 3"
