# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faults of G-code text: bad programs state in their first line what they must give."""

import re
import sys
from pathlib import Path

import pytest
from by_block import scan_by_block

from pkm_post.reading.gcode.scan import scan
from pkm_post.reading.gcode.syntax_faults import EXPECTED
from pkm_post.reading.grammar import BLOCK, parser_of

BAD_PROGRAMS = sorted((Path(__file__).parents[2] / "data" / "bad_gcode").glob("*.ngc"))
EXPECTATION = re.compile(rb"; expects ((?:[GL]\d{3} \d+:\d+(?:, |\r?\n))+)")


def expectation(program):
    """The faults of its text that a program states: pairs of code and line:column."""
    stated = EXPECTATION.match(program)
    assert stated, "the first line states what is expected, such as: ; expects G201 2:4, G102 4:2"
    faults = [tuple(fault.split()) for fault in stated[1].decode().split(",")]
    return [fault for fault in faults if fault[0] < "G3"]


def test_there_are_bad_programs():
    assert len(BAD_PROGRAMS) >= 40


@pytest.mark.parametrize("path", BAD_PROGRAMS, ids=lambda path: path.stem)
@pytest.mark.parametrize("way", [scan, scan_by_block])
def test_bad_programs_give_the_stated_diagnostics(path, way):
    program = path.read_bytes()
    blocks, diagnostics = way(program, path.name)
    given = [(fault.code, f"{fault.place.line}:{fault.place.column}") for fault in diagnostics]
    assert given == expectation(program)
    assert (blocks is None) == bool(given)
    assert {fault.place.file for fault in diagnostics} <= {path.name}


@pytest.mark.parametrize(
    "line, found",
    [
        ("X1 $", "'$'"),
        ("X\0", "character 0x00"),
        ("G1 X1.2.3 Y1", "'1.2.3'"),
        ("G1 X Y2", "'X', expected a number, a parameter, '[', a function or a sign"),
        ("#1=", "the end of the block, expected a number, a parameter, '[', a function or a sign"),
        ("#1 2", "'2', expected '='"),
        ("O1 goto", "'g', expected a keyword such as sub, call, if or while or the end of the block"),
        ("X[1 2]", "'2', expected a sign, an operator or ']'"),
        ("G1 X1 Y2 X3", "'X'"),
    ],
)
def test_diagnostics_tell_what_was_found_and_expected(line, found):
    (fault,) = scan(line, "part.ngc")[1]
    assert fault.found == found


@pytest.mark.parametrize(
    ("line", "column", "code", "found"),
    [
        ("G1 X-1,25 Y2", 5, "G102", "'-1,25'"),
        ("G1 X10,R2", 7, "G402", ",R: a rounding between two blocks"),  # [Fanuc], optional chamfering and corner R
        ("G1 X10. , c1.", 9, "G402", ",c: a chamfer between two lines"),
        ("X[1,5]", 4, "G101", "','"),
    ],
)
def test_a_decimal_comma_is_a_malformed_number(line, column, code, found):
    """The cure of G101, to remove the character, makes -125 of it."""
    (fault,) = scan(line, "part.ngc")[1]
    assert (fault.place.column, fault.code, fault.found) == (column, code, found)


@pytest.mark.slow
@pytest.mark.parametrize(
    "line, code",
    [
        ("#1=[" + "1+" * 4000 + "1]", "G211"),
        ("#1=[" + "1+" * 4000 + "1]]", "G207"),
        ("#1=[" + "1+" * 4000, "G205"),
        ("#1=" + "abs[" * 1600 + "1" + "]" * 1600, "G211"),
        ("#1=" + "abs[" * 1600 + "1" + "]" * 1600 + "Y", "G201"),
        ("#" * 9000, "G209"),
        ("%X" + "9" * 400, "G206"),
        ("X" + "[" * 9000, "G205"),
    ],
)
def test_blocks_that_nest_without_end_are_faults(line, code):
    assert [fault.code for fault in scan(line, "part.ngc")[1]] == [code]


def test_characters_are_shown_as_people_see_them():
    for text in ("X\u2212aa\xfc", "X\u2212"):
        assert scan(text, "part.ngc")[1][0].found == "'\u2212'"
    assert scan(b"X\xfc", "part.ngc")[1][0].found == "'\xfc'"


def test_every_terminal_of_the_grammar_has_words():
    diagnostics = {name for names in EXPECTED.values() for name in names}
    terminals = {terminal.name for terminal in parser_of(BLOCK).terminals} - {"COMMENT", "BLANKS"}
    assert terminals | {"$END", "<END-OF-FILE>"} == diagnostics


def test_plain_words_are_read_without_lark(monkeypatch):
    parser_of.cache_clear()
    monkeypatch.setitem(sys.modules, "lark", None)
    blocks, faults = scan("%\nN10 G0 X1 (c)\n\n/ g43.4 h1 m08\n", "part.ngc")
    assert (blocks.g.tolist(), blocks.m.tolist(), faults) == ([0, 434], [8], ())


@pytest.mark.parametrize("way", [scan, scan_by_block])
def test_a_missing_lark_is_named(monkeypatch, way):
    parser_of.cache_clear()
    monkeypatch.setitem(sys.modules, "lark", None)
    with pytest.raises(ImportError, match="needs lark: .* install "):
        way("G1 X[1]", "part.ngc")
