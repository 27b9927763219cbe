# SPDX-License-Identifier: LGPL-2.1-or-later
"""All faults of a program in one go: those behind another one, none that is its consequence, and equal ones as one."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pkm_post.model import Diagnostic, Place, Tool
from pkm_post.reading.gcode import ReadOptions, read
from pkm_post.reading.gcode.foreign import LANGUAGES
from pkm_post.reading.gcode.recovery import merged

ANY = Tool(0, "any", 6.0, 0.0, 50.0)


def faults(text, **options):
    program, found = read(text, "part.ngc", ReadOptions(default_tool=ANY, **options))
    assert program is None
    return [(fault.code, fault.place.line) for fault in found]


START = "G21 F100\nG0 X0 Y0 Z5\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G1 X[1\nG77\nG1 X1 G2\n", [("G205", 3), ("G401", 4), ("G403", 5)]),
        ("G77\nG1 X[1\n", [("G401", 3), ("G205", 4)]),
        ("G77 X3\nG28 Z0\nG1 X1\n", [("G401", 3), ("G413", 4)]),
        ("G28 Z0\nG77 X3\nG2 X9 R1\n", [("G413", 3), ("G401", 4)]),
        ("G77\no5 call\nG78\n", [("G401", 3), ("G309", 4)]),
        ("#1=[1/0]\nG77\n", [("G304", 3)]),
        ("o1 if [1]\nG77\n", [("G308", 3), ("G401", 4)]),
        ("#<a>=[2\no1 if [1]\nG77\nO2 sub O3\n", [("G205", 3), ("G401", 5), ("G210", 6)]),
    ],
)
def test_faults_behind_another_one_are_reported(text, expected):
    assert faults(START + text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "G1 F[100\nG1 X1\n",
        "G21 F100\nG0 X[0 Y0 Z0\nG2 X1 I1\nM3\n",
        "G1 X1 F10 Y[\nX2\nG80 G[81\nX3\n",
        "M3 S[100\nM3\nG43.4 A[1\nG41 X1 D[\nM2[",
        "o1 if [1\no1 else\nG1 X1\no1 endif\n",
        "o1 sub [\no1 return\no1 endsub\no1 call\n",
        "M98 P200\nG1 X[\nM98 P200 L2\nM30\nO200\nG91 X1\nM99\n",
    ],
)
def test_consequences_of_a_fault_are_not_reported(text):
    found = faults(text, needs_end=True)
    assert {code for code, _ in found} <= {"G201", "G205", "G206", "G207", "G209"}


def test_a_rotary_word_is_a_fault_of_its_own_where_there_is_no_notation_of_the_axis():
    assert faults("G1 X[\nG0 X1 B5\n")[-1] == ("G414", 2)
    assert faults("G43.4 X[\nG1 X1 B5\n", axis_words="BC") == [("G205", 1)]


def test_equal_faults_are_one_with_their_number_and_lines():
    _, found = read(START + "M77\n" * 400 + "G77\n", "part.ngc")
    assert [(fault.code, fault.place.line, fault.found) for fault in found] == [
        ("G401", 3, "M77 (400 times, in lines 3, 4, 5, 6, 7 and others)"),
        ("G401", 403, "G77"),
    ]


@pytest.mark.slow
@pytest.mark.parametrize("faulty", ["G1 X1..5", "G1 X[1", "G1 X1\xe4"])
def test_equal_syntax_faults_are_one_however_many(faulty):
    _, found = read(START + f"{faulty}\n" * 3950 + "Y\nM2\n", "part.ngc")
    assert [(fault.code, fault.place.line) for fault in found[1:]] == [("G201", 3953)]
    assert found[0].found.endswith(" (3950 times, in lines 3, 4, 5, 6, 7 and others)")


def test_many_faults_of_a_code_are_the_first_ones_and_a_number():
    _, found = read(START + "".join(f"G1 X1 A{n}\n" for n in range(1, 401)), "part.ngc")
    assert [fault.place.line for fault in found] == [3, 4, 5, 6, 7]
    assert found[-1].found == "A5, and 395 more like it, in lines 8, 9, 10, 11, 12 and others"


def test_a_block_that_is_carried_out_again_has_its_fault_once():
    assert faults("o1 repeat [50]\nG77\no1 endrepeat\n") == [("G401", 2)]


@given(st.lists(st.tuples(st.sampled_from(["G401", "G404"]), st.integers(1, 30), st.sampled_from("abc")), max_size=80))
def test_merged_faults_stay_as_many_and_in_order(given_faults):
    found = [Diagnostic(code, Place("f", line=line), word) for code, line, word in given_faults]
    one = merged(found)
    assert [fault.place.line for fault in one] == sorted(fault.place.line for fault in one)
    assert {fault.code for fault in one} == {fault.code for fault in found}
    assert merged(()) == ()
    assert len(one) <= 20


KLARTEXT = "0 BEGIN PGM A MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n2 TOOL CALL 1 Z S1000\n3 L X+10 Y+5 R0 FMAX M3\n"
DIN_ISO = "%A G71\nN10 G30 G17 X+0 Y+0 Z-20*\nN20 G01 X+10 G41 Y+5 F100*\nN30 G26 R2*\nN99999999 %A G71*\n"
"""First and last block: TNC 320, ISO Programming User's Manual, 10/2017, section 3.2."""
SINUMERIK = 'N10 G90 G54 G71\nN15 MSG("PATH")\nN16 T="MILL10" D1\nN45 G3 X=IC(5) Y10 CR=10\nN47 R1=5\n'


@pytest.mark.parametrize(("text", "name"), [*zip((KLARTEXT, DIN_ISO, SINUMERIK), LANGUAGES, strict=True)])
def test_another_language_is_named_once(text, name):
    _, ((diagnostic),) = read(text.replace("\n", "\r\n") * 50, "part.nc", ReadOptions())
    assert (diagnostic.code, diagnostic.found.split(":")[0]) == ("G213", name)
    assert diagnostic.place.line == (1 if name.startswith("H") else 2)


def test_one_slip_is_no_other_language():
    assert faults('G0 X1\nMSG("A")\nG1 Y[\n')[-1] == ("G205", 3)
    assert read("(BEGIN PGM A\nTOOL CALL)\nG0 X1 Y1 Z1\n", "part.nc")[1][0].code == "G204"
