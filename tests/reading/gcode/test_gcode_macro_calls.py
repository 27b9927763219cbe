# SPDX-License-Identifier: LGPL-2.1-or-later
"""Custom macro B: arguments, levels of variables, vacant ones, modal calls, and what a program knows of its own state.

Golden values are those of Fanuc's manual (B-63684EN, chapter 16) where a line says so.
"""

import math

import pytest

from pkm_post.model import Tool
from pkm_post.reading.gcode import ExecutionLimits, ReadOptions, read

ANY = Tool(0, "any", 6.0, 0.0, 50.0)
HEAD = "O1\nG21 G90 G94 G17\nG0 X0. Y0. Z10.\nG1 F100.\n"


def taken(text, flavour="fanuc", **options):
    return read(HEAD + text, "part.nc", ReadOptions(default_tool=ANY, flavour=flavour, **options))


def ends(text, **options):
    program, faults = taken(text, **options)
    assert program is not None, faults
    return [tuple(round(value, 6) for value in point) for point in program.position[1:].tolist()]


def heights(text, **options):
    """Values that a program writes as Z."""
    return [point[2] for point in ends(text, **options)]


def codes(text, **options):
    return [(fault.code, fault.place.line - 4) for fault in taken(text, **options)[1] if fault.code != "G214"]


def arguments(words):
    """The local variables that a call gives, by number, 0 where vacant."""
    shown = "".join(f"Z[#{number}+0]\n" for number in range(1, 34))
    return {number: z for number, z in enumerate(heights(f"G65 P9 {words}\nM30\nO9\n{shown}M99\n"), 1) if z}


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("A1.0 B2.0 I-3.0 I4.0 D5.0", {1: 1.0, 2: 2.0, 4: -3.0, 7: 5.0}),  # the example of the manual
        ("A1. B2. C3. I4. J5. K6. D7. E8. F9.", dict(zip(range(1, 10), map(float, range(1, 10)), strict=True))),
        ("H11 M13 Q17. R18. S19 T20 U21. V22. W23. X24. Y25. Z26.", {n: float(n) for n in (11, 13, *range(17, 27))}),
        ("I1. J2. K3. I4. J5. K6. K9.", {4: 1.0, 5: 2.0, 6: 3.0, 7: 4.0, 8: 5.0, 9: 6.0, 12: 9.0}),
        ("J1. I2.", {5: 1.0, 7: 2.0}),
        ("D5. I1. I2.", {4: 1.0, 7: 2.0}),
        (
            " ".join(f"I{number}." for number in range(1, 11)),
            {1 + 3 * number: float(number) for number in range(1, 11)},
        ),
        ("A#33 B[1+1]", {2: 2.0}),
    ],
)
def test_arguments(words, expected):
    assert arguments(words) == expected


@pytest.mark.parametrize(
    ("text", "z"),
    [
        # levels: a macro has its own locals, M98 shares them, common ones are everybody's
        ("#1=5.\n#100=6.\nG65 P9 A7.\nZ#1\nM30\nO9\nZ#1\nZ#100\n#1=8.\nM99\n", [7.0, 6.0, 5.0]),
        ("#1=5.\nM98 P9\nZ#1\nM30\nO9\n#1=#1+1.\nM99\n", [6.0]),
        # a further pass has the values that the one before left [Haas, L of G65; Fanuc, G66, limitations]
        ("G65 P9 L3 A2.\nM30\nO9\nZ#1\n#1=#1+1.\nM99\n", [2.0, 3.0, 4.0]),
        ("G66 P9 A2.\nX1.\nX2.\nG67\nG65 P9 A2.\nM30\nO9\nZ#1\n#1=#1+1.\nM99\n", [10.0, 2.0, 2.0, 3.0, 2.0]),
        ("WHILE [#1 LT 2] DO1\n#1=#1+1\nG65 P9 A2.\nEND1\nM30\nO9\nZ#1\n#1=#1+1.\nM99\n", [2.0, 2.0]),
        ("G65 P9 L0 A2.\nZ1.\nM30\nO9\nZ#1\nM99\n", [1.0]),
        ("G65 P8 A1.\nM30\nO8\nG65 P9 A[#1+1]\nZ#1\nM99\nO9\nZ#1\nM99\n", [2.0, 1.0]),
        # vacant variables
        ("X1. Z#1\n#1=3.\nZ#1\n#1=#0\nX2. Z#1\nM30\n", [10.0, 3.0, 3.0]),
        ("Z[#1+4.]\nIF [#1 EQ #0] THEN #2=1.\nIF [#1 EQ 0] THEN #2=2.\nZ#2\nM30\n", [4.0, 1.0]),
        ("#1=0\nIF [#1 NE #0] THEN #2=5.\nIF [#3 NE 0] THEN #2=#2+1.\nZ#2\nM30\n", [6.0]),
        ("G#1 M#2 X1. Z5.\nM30\n", [5.0]),
        # functions
        ("Z[FIX[-1.5]]\nZ[FUP[-1.5]]\nZ[FUP[1.2]]\nM30\n", [-1.0, -2.0, 2.0]),
        ("Z[6 AND 3]\nZ[6 OR 3]\nZ[6 XOR 3]\nM30\n", [2.0, 7.0, 5.0]),
        ("Z[ATAN[-1]/[1]]\nZ[ASIN[-0.5]]\nM30\n", [315.0, 330.0]),
        ("Z[-7 MOD 3]\nZ[7 MOD -3]\nM30\n", [-1.0, 1.0]),  # the sign of the first [Fanuc, 30i, arithmetic]
        ("Z[6 AND [3+1]]\nZ[[1 EQ 1] AND [2 GT 1]]\nZ[4 AND 6 OR 1 OR 2]\nM30\n", [4.0, 1.0, 7.0]),
        # ROUND in a word keeps the decimals that the control can go to [Fanuc, ROUND; Haas]
        ("#1=1.2345\n#2=2.3456\nG91 Z-#1\nZ-#2\nG90 Z[10.-ROUND[#1]-ROUND[#2]]\nM30\n", [8.7655, 6.4199, 6.4199]),
        ("#1=1.6\n#2=ROUND[#1]\nZ#2\nZ#[ROUND[#1]]\nIF [ROUND[#1] EQ 2] THEN #3=5.\nZ#3\nM30\n", [2.0, 2.0, 5.0]),
        ("#1=1.6\nG65 P9 A[ROUND[2.]]\nM30\nO9\nZ#1\nM99\n", [2.0]),
        # jumps
        ("M98 P9\nZ1.\nN5 Z2.\nM30\nO9\nM99 P5\n", [2.0]),
        ("#1=#1+1.\nZ#1\nN7\nIF [#1 GT 2.] GOTO #2\n#1=#1+1.\nZ#1\n#2=9\nM99 P7\nN9 Z0.\nM30\n", [1.0, 2.0, 3.0, 0.0]),
        ("#1=10\nGOTO [#1+10]\nZ1.\nN20 Z2.\nM30\n", [2.0]),
        ("M98 P0030009\nM30\nO9\n#1=#1+1.\nZ#1\nM99\n", [1.0, 2.0, 3.0]),
        # the state of the program
        ("X3. Y4.\nZ[#5001+#5002]\nZ[#5043+1.]\nM30\n", [10.0, 7.0, 8.0]),
        ("G91 X3.\nG90 Z#5041\nG20\nZ[#5001*25.4]\nM30\n", [10.0, 3.0, 76.2]),
        ("G52 X1.\nX3.\nZ#5001\nM30\n", [10.0, 3.0]),
        ("#1=#4003\nG91\nG#1 Z#4109\nZ#4001\nM30\n", [100.0, 1.0]),
        ("#3003=1\n#3004=7\nZ2.\nM30\n", [2.0]),
    ],
)  # fmt: skip
def test_values(text, z):
    assert heights(text) == z


def test_a_modal_call_follows_every_move_and_no_other_block():
    text = "G66 P9 A2. L2\nX1.\nM8\n#1=3.\nX#1\nG67\nX9.\nM30\nO9\nG91 Y#1\nG90\nM99\n"
    assert [(x, y) for x, y, _ in ends(text)] == [(1, 0), (1, 2), (1, 4), (3, 4), (3, 6), (3, 8), (9, 8)]


def test_holes_on_a_circle():
    """A macro as shops have it: holes on a circle about X Y, with radius, first angle and step, under G81."""
    call = "G65 P9100 X100. Y50. R5. Z-8. F200. I30. A0. B45. H5\nM30\n"
    macro = (
        "O9100\n#3=#4003\nG81 Z#26 R#18 F#9 L0\nIF[#3 EQ 90]GOTO 1\n#24=#5001+#24\n#25=#5002+#25\n"
        "N1 WHILE[#11GT0]DO1\n#5=#24+#4*COS[#1]\n#6=#25+#4*SIN[#1]\nG90X#5Y#6\n#1=#1+#2\n#11=#11-1\nEND1\n"
        "G#3G80\nM99\n"
    )
    drilled = [(x, y) for x, y, z in ends(call + macro) if z == -8.0]
    angles = [math.radians(45 * number) for number in range(5)]
    expected = [(100 + 30 * math.cos(angle), 50 + 30 * math.sin(angle)) for angle in angles]
    assert drilled == [pytest.approx(place, abs=1e-6) for place in expected]


def test_the_place_on_the_machine():
    assert heights("X3.\nZ#5021\nM30\n", machine_zero=(1.0, 0.0, 0.0)) == [10.0, 2.0]
    turned = "G68 X0. Y0. R90.\nX3. Y0.\n#1=#5022\nG69\nX0. Y0. Z#1\nM30\n"
    assert heights(turned, machine_zero=(0.0, 1.0, 0.0)) == [10.0, 2.0]
    scaled = HEAD + "G51 X0. Y0. Z0. P2.\nX3.\nZ#5021\nM30\n"
    _, faults = read(scaled, "part.nc", ReadOptions(default_tool=ANY, flavour="fanuc", machine_zero=(0.0, 0.0, 0.0)))
    assert [fault.code for fault in faults if fault.code != "G214"] == ["G303"]


def test_linuxcnc_reads_the_place_of_the_tool():
    program, _ = taken("X3. Y4.\nZ[#5420+#5421]\nG20\nX[#5422]\nM2\n", flavour="rs274")
    assert program.position[1:].tolist() == [[3.0, 4.0, 10.0], [3.0, 4.0, 7.0], [7.0, 4.0, 7.0]]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G65 P9\nM30\n", [("G309", 1)]),
        ("G65 A1.\nM30\n", [("G316", 1)]),
        ("G65 P9 O5\nM30\n", [("G210", 1)]),
        ("G65 P9 A1. A2.\nM30\n", [("G202", 1)]),
        ("G65 P9 " + "K1. " * 11 + "\nM30\nO9\nM99\n", [("G315", 1)]),
        ("G66 P9\nG65 P9\nM30\nO9\nM99\n", [("G316", 2)]),
        ("G66 P9\nG81 X1. Z-1. R1.\nM30\nO9\nM99\n", [("G316", 2)]),
        ("G66 P9\nM98 P9\nM30\nO9\nM99\n", [("G316", 2)]),
        ("Z#500\nM30\n", [("G301", 1)]),
        ("Z#1000\nM30\n", [("G303", 1)]),
        ("#5221=1.\nM30\n", [("G303", 1)]),
        ("Z#<depth>\nM30\n", [("G302", 1)]),
        ("Z-#1\nM30\n", [("G301", 1)]),
        ("Z[1.5 AND 1]\nM30\n", [("G305", 1)]),
        ("Z[6 AND 3+1]\nM30\n", [("G305", 1)]),
        ("Z[4 OR 6 AND 1]\nM30\n", [("G305", 1)]),
        ("IF [#1 EQ 1 AND #2 EQ 2] GOTO 5\nN5 M30\n", [("G305", 1)]),
        ("Z[7.6 MOD 3]\nM30\n", [("G305", 1)]),
        ("Z[7 MOD 0]\nM30\n", [("G304", 1)]),
        ("G65 P9 A[ROUND[1.2]]\nM30\nO9\nM99\n", [("G305", 1)]),
        ("G43 H1\nZ#5043\nM30\n", [("G303", 2)]),
        ("Z#5021\nM30\n", [("G303", 1)]),
        # the coordinates of the program, or those of the turned, mirrored or scaled tool
        ("G68 X0. Y0. R90.\nX1. Y0.\nZ#5001\nM30\n", [("G303", 3)]),
        ("G51.1 X0. Y0.\nG50.1 X0.\nX1. Y0.\nZ#5041\nM30\n", [("G303", 4)]),
        ("G51 X0. Y0. Z0. P2.\nX1.\nZ#5041\nM30\n", [("G303", 3)]),
        ("IF [#1 EQ #0] THEN #3000=1 (NO DEPTH)\nM30\n", [("G319", 1)]),
        ("M99 P5\n", [("G320", 1)]),
        ("N5 M99 P5\n", [("G313", 1)]),
    ],
)
def test_faults(text, expected):
    limits = ExecutionLimits(blocks=1000)
    _, faults = read(HEAD + text, "part.nc", ReadOptions(default_tool=ANY, flavour="fanuc"), limits)
    assert [(fault.code, fault.place.line - 4) for fault in faults if fault.code != "G214"] == expected


def test_with_rs274_there_are_no_macros():
    assert codes("G65 P9 A1.\nX1.\nM2\n", flavour="rs274") == [("G401", 1)]
    assert heights("Z#1\nM2\n", flavour="rs274") == [0.0]


def test_an_argument_without_a_point_is_reported():
    _, faults = taken("G65 P9 A10 D5 T2\nM30\nO9\nZ#1\nM99\n")
    assert [(fault.code, fault.found, fault.place.column) for fault in faults] == [("G214", "A10", 8)]


def test_looking_at_the_state_counts_as_execution():
    text = HEAD + "X1.\n" * 50 + "WHILE [#1 LT 100] DO1\n#1=#1+1\n#2=#5001\nEND1\nM30\n"
    options = ReadOptions(default_tool=ANY, flavour="fanuc")
    assert read(text, "part.nc", options, ExecutionLimits(blocks=10_000))[0] is not None
    _, faults = read(text, "part.nc", options, ExecutionLimits(blocks=2_000))
    assert [fault.code for fault in faults] == ["G313"]
