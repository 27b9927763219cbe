# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of part programs: bytes and back, line numbers, places of diagnostics, tip paths of lines."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pkm_post.reading import gcode
from pkm_post.reading.editing import TextFile, check_text, jump_by_number, renumbered, tip_paths_of_line
from pkm_post.reading.highlighting import underlined
from pkm_post.reading.language import Language
from pkm_post.reading.part_program import ReadingOptions

# Text of a file


@given(st.binary(max_size=60).filter(lambda content: len({b"\r\n", b"\n", b"\r"} & set(_ends(content))) <= 1))
def test_bytes_come_back(content):
    read = TextFile.decode(content)
    assert "\r" not in read.text
    assert read.encode(read.text) == content


def _ends(content):
    rest = content.replace(b"\r\n", b"")
    return [end for end, text in ((b"\r\n", content), (b"\n", rest), (b"\r", rest)) if end in text]


def test_mark_line_ends_and_encoding_are_kept():
    content = TextFile.decode(b"\xef\xbb\xbfG1\r\nX1\r\n")
    assert (content.text, content.line_end, content.has_byte_order_mark) == ("G1\nX1\n", "\r\n", True)
    latin = TextFile.decode(b"(\xe4)\n")
    assert latin.encode("(\xe4!)\n") == b"(\xe4!)\n"
    assert latin.encode("(\u2014)\n") == "(\u2014)\n".encode()


# Renumbering


def test_blocks_are_numbered_and_nothing_else():
    text = "%\n(head)\n\nG1 X1\nN5 X2\n  /N7X3\nO1 sub\n; end\nN9\n%\n"
    assert renumbered(text, 100, 5) == ("%\n(head)\n\nN100 G1 X1\nN105 X2\n  /N110 X3\nN115 O1 sub\n; end\nN120\n%\n")


def test_the_number_of_a_switch_stays_behind_its_slash():
    assert renumbered("/2 G1 X1\n / 3N7X3\n/9\n/G1\n") == "/2 N10 G1 X1\n / 3N20 X3\n/9\n/N30 G1\n"
    assert renumbered("/1/3 N5 G1 X1\n/1 /3 G0\n") == "/1/3 N10 G1 X1\n/1 /3 N20 G0\n"


def test_numbers_of_programs_and_main_blocks_get_no_other():
    text = "%\nO1234 (part)\nG1 X1\n:20 G1 X2\no100 sub\nO2\n:0003\n"
    assert renumbered(text) == "%\nO1234 (part)\nN10 G1 X1\n:20 G1 X2\nN20 o100 sub\nO2\n:0003\n"


@pytest.mark.parametrize(
    "line",
    ["GOTO 8", "IF [#1 EQ 1] GOTO8", "go to #1", "GOTO [#1*10]", "M99 P30", "N5 m099P#3", "M97 P100", "M98 P1000 Q20",
     "GOTOF N40", "IF R1>2 GOTOB N40", "CASE R1 OF 1 GOTOF ENDE DEFAULT GOTOF N40", "GOTOF NOWHERE", "REPEAT ENDE N40"],
)  # fmt: skip
def test_jumps_by_number_are_found(line):
    assert jump_by_number(f"G1 X1 (GOTO 8)\n\n{line}\nN8 X2\nN40 ENDE: X3\n") == 3


@pytest.mark.parametrize(
    "line",
    [
        "(M99 P30)",
        "; GOTO 8",
        "M99",
        "M98 P1000",
        "G4 P99",
        "GOTOF ENDE",
        "REPEAT ENDE P=3",
        "M990 P1",
        "G28 GOTOB ENDE",
    ],
)
def test_other_lines_are_no_jumps_by_number(line):
    assert jump_by_number(f"{line}\nN8 X2\nN40 ende: X3\n") is None


_LINES = st.lists(
    st.sampled_from(
        ["", "(a)", "G21", "N3 G90", "/G0 X1 Y1 Z1", "/2 N4G0 X3", " n12g1 x2 f100", "N 7.5 Y3", "M2 ; end", "%"]
    ),
    max_size=12,
).map("\n".join)


@given(_LINES, st.integers(0, 1000), st.integers(1, 100))
def test_renumbering_twice_is_renumbering_once(text, first, step):
    assert renumbered(renumbered(text), first, step) == renumbered(text, first, step)


@pytest.mark.slow
@settings(deadline=None)  # the first example builds the parser
@given(_LINES)
def test_renumbering_changes_nothing_of_the_program(text):
    read = [gcode.read(each, "part.ngc", gcode.ReadOptions()) for each in (text, renumbered(text))]
    assert [[(one.code, one.place.line) for one in diagnostics] for _, diagnostics in read][0] == [
        (one.code, one.place.line) for one in read[1][1]
    ]
    if read[0][0] is not None:
        assert np.array_equal(read[0][0].position, read[1][0].position)
        assert np.array_equal(read[0][0].line, read[1][0].line)


def test_numbers_that_make_no_sense_are_a_fault_of_the_caller():
    for first, step in ((-1, 10), (10, 0)):
        with pytest.raises(ValueError, match="expected a first number from 0"):
            renumbered("G1\n", first, step)


# Diagnostics and their places


def test_faults_of_a_text_that_is_not_saved():
    text = "G21 G90\nG0 X0 Y0 Z5\nG1 X1..5 F100\nG1 Q\n"
    checked = check_text(text, "part.ngc")
    assert (checked.program, checked.size) == (None, None)
    lines = text.split("\n")
    found = [
        (
            one.code,
            lines[one.place.line - 1][slice(*underlined(lines[one.place.line - 1], one.place.column, Language.GCODE))],
        )
        for one in checked.diagnostics
    ]
    assert found == [("G102", "1..5"), ("G201", "Q")]


def test_a_program_and_its_size():
    checked = check_text("G21 G90\nG0 X0 Y0 Z5\nG1 X3 Y4 F100\nM2\n", "part.ngc")
    assert checked.size.length == pytest.approx(5.0)
    assert checked.diagnostics == ()


def test_what_the_user_says_of_the_text_is_used():
    text = "G21 G90 G43.5\nG0 X0 Y0 Z5 I0 J0 K1\nG1 X3 I0 J0.6 K0.8 F100\nM2\n"
    assert check_text(text, "a.ngc", ReadingOptions("vector")).program.tool_axis[-1] == pytest.approx([0, 0.6, 0.8])
    assert check_text(text, "a.ngc").program is None


def test_an_unknown_suffix_is_a_fault_of_the_caller():
    with pytest.raises(ValueError, match="expected one of"):
        check_text("G1", "a.doc")


def test_underlined():
    line = "  N10 G1 X12.5 (note)  "
    assert [line[slice(*underlined(line, column, Language.GCODE))] for column in (0, 3, 7, 11, 99)] == [
        line.strip(),
        "N10",
        "G",
        "12.5",
        line.strip(),
    ]
    assert underlined("a\u00e9", 2, Language.GCODE) == (1, 2)


# Tip paths


def test_tip_paths_of_lines_and_arcs():
    checked = check_text("G21 G90 G17\nG0 X0 Y0 Z0\nG1 X10 F100\nG3 X0 Y10 I-10 J0\n\nG0 Z5\n", "a.ngc")
    program = checked.program
    assert [len(tip_paths_of_line(program, line)) for line in range(1, 8)] == [0, 1, 1, 1, 0, 1, 0]
    assert tip_paths_of_line(program, 3)[0] == pytest.approx(np.array([[0, 0, 0], [10, 0, 0]]))
    (arc,) = tip_paths_of_line(program, 4)
    assert arc[[0, -1]] == pytest.approx(np.array([[10, 0, 0], [0, 10, 0]]), abs=1e-12)
    assert np.hypot(arc[:, 0], arc[:, 1]) == pytest.approx(10)
    assert arc[len(arc) // 2] == pytest.approx([10 * math.sqrt(0.5), 10 * math.sqrt(0.5), 0])


def test_a_line_in_a_loop_has_a_tip_path_for_each_turn():
    text = "G21 G90 G91.1\nG0 X0 Y0 Z0\n#1=0\nO1 while [#1 lt 4]\n#1=[#1+1]\nG0 X#1\nO1 endwhile\nM2\n"
    assert [path[:, 0].tolist() for path in tip_paths_of_line(check_text(text, "a.ngc").program, 6)] == [
        [0, 1],
        [1, 2],
        [2, 3],
        [3, 4],
    ]
