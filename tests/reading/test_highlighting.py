# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours: no terminal of the grammars is forgotten, and lines are coloured as the grammars read them."""

import random
import re
from pathlib import Path

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from pkm_post.reading.grammar import BLOCK, STATEMENT, parser_of
from pkm_post.reading.highlighting import LONGEST, TABLES, Colour, coloured_spans, shown_language
from pkm_post.reading.language import Language
from pkm_post.reading.siemens.tokens import tokens_of

BLANKS = {"BLANKS", "BLANK"}
GRAMMARS = {Language.GCODE: BLOCK, Language.CLDATA: STATEMENT}
ROOT = Path(__file__).parents[2]


def colour_of(terminal, language):
    (colour,) = [row.colour for row in TABLES[language] if terminal in row.terminals]
    return colour


@pytest.mark.parametrize("language", GRAMMARS)
def test_every_terminal_has_one_colour_and_no_colour_a_terminal_that_is_none(language):
    named = [terminal for row in TABLES[language] for terminal in row.terminals]
    assert sorted(named) == sorted({terminal.name for terminal in parser_of(GRAMMARS[language]).terminals} - BLANKS)


def assert_coloured_as_read(line, language):
    """Every character of every token has the colour of its terminal."""
    colours = [None] * len(line)
    for span in coloured_spans(line, language):
        colours[span.start : span.end] = [span.colour] * (span.end - span.start)
    parsing = parser_of(GRAMMARS[language]).parse_interactive(line)
    before = ""
    for token in parsing.exhaust_lexer():
        expected = colour_of(token.type, language)
        if before == "_N":  # the number of a line goes with its N
            expected = Colour.LINE_NUMBER
        shown = {
            colour
            for character, colour in zip(
                line[token.start_pos : token.end_pos], colours[token.start_pos :], strict=False
            )
            if not character.isspace()
        }
        assert shown <= {expected}, (line, token)
        before = token.type


G_LINES = [
    "N10 G1 X1.5 Y-2 F300 M3 M8",
    "/N20 G2X+1Y.5I-3J0 (a comment)",
    "n 30 g43.5 h1 ; to the end",
    "#1=2 #<depth>=[#1+1]",
    "X[1+sin[30]-2] Y#<a b> Z-#5",
    "X[2**3 mod 4 / 5] Y[[#1 eq 2] and [#2ge3] xor [1or0]]",
    "Gexp[0] Xatan[1]/[2] Xabs[-1] Yexists[#<a>]",
    "Lexp[0] Y[1 lt tan[1]]",
    "Ltan[45]",
    "Ifix[1.5] Jround[2] Rfup[1]",
    "O100 sub",
    "o<bolt circle> call [1] [#2]",
    "O[1+2] while [#1 lt 3]",
    "o1if[#1lt3]",
    "O3 endsub [1]",
    "LN X1 Y2 Z3 NX0 NY0 NZ1 TX0 TY0 TZ1",
    "TRAORI",
    "TRAORI(1) G1 X1",
    "TRAFOOF",
    "A3=0.5 B3 =0 C3=#1",
    "%",
    "G1(between)X(letter and number)2",
]
C_LINES = [
    "PARTNO bracket 4711, /all of it",
    "PPRINT 'quoted' text",
    "TOOL PATH/MILL,TOOL,D10",
    "GOTO/0.0,-1.5E-05,3,0,0,1",
    "TLON,GOFWD/(CIRCLE/0,0,0,5),ON,(LINE/0,0,0,1,0,0)",
    "P1=POINT/1,2,3",
    "LOADTL/1,LENGTH,100.0,'name 5'",
    "1.0,2.0,-3.5",
    "SPINDL/RPM,9000,CLW",
    "CUTTER/10,R=5",
    "FEDRAT/600,MMPM",
]


@pytest.mark.parametrize("line", G_LINES)
def test_gcode_is_coloured_as_it_is_read(line):
    parser_of(BLOCK).parse(line)
    assert_coloured_as_read(line, Language.GCODE)


@pytest.mark.parametrize("line", C_LINES)
def test_cl_data_is_coloured_as_it_is_read(line):
    parser_of(STATEMENT).parse(line)
    assert_coloured_as_read(line, Language.CLDATA)


S_LINES = {
    "N10 G90 G54": "N10:line number G:word 90:number G:word 54:number",
    '/1 N5 MSG("A;B") ; TO THE END': '/:operator 1:number N5:line number MSG:keyword (:operator "A;B":text ):operator',
    "X=AC(R1+2.5) CR=.5 A3=-1": "X:word =:operator AC:function (:operator R1:parameter +:operator 2.5:number ):operator"
    " CR:word =:operator .5:number A3:word =:operator -:operator 1:number",
    "IF (R1==5) AND NOT B_OR GOTOF END_1": "IF:keyword (:operator R1:parameter ==:operator 5:number"
    " ):operator AND:operator NOT:operator B_OR:operator GOTOF:keyword END_1:keyword",
    "END_1: R[R2]=SIN(30) MOD 2": "END_1::line number R:parameter [:operator R2:parameter ]:operator =:operator"
    " SIN:function (:operator 30:number ):operator MOD:operator 2:number",
    "CYCLE81(10,,2,-5)": "CYCLE81:keyword (:operator 10:number ,:operator ,:operator 2:number ,:operator -:operator"
    " 5:number ):operator",
    "%_N_PART_MPF": "%_N_PART_MPF:keyword",
    "DEF REAL DEPTH=1EX-3 $P_UIFR='HFF'": "DEF:keyword REAL:keyword DEPTH:word =:operator 1EX-3:number"
    " $P_UIFR:parameter =:operator 'HFF':number",
    "G1X10F=R1": "G:word 1:number X:word 10:number F:word =:operator R1:parameter",
}


@pytest.mark.parametrize("line", S_LINES)
def test_siemens_language_is_coloured(line):
    spans = [*coloured_spans(line, Language.SIEMENS)]
    found = [f"{line[span.start : span.end]}:{span.colour.value}" for span in spans]
    assert " ".join(each for each in found if not each.endswith(":comment")) == S_LINES[line]
    program = line.split(" ; ")[0]
    tokens = [(each.column - 1, each.column - 1 + len(each.text)) for each in tokens_of(program)]
    edges = {span.start for span in spans} | {span.end for span in spans}
    assert all(any(span.start <= start and end <= span.end for span in spans) for start, end in tokens)
    assert edges - {len(line)} <= {edge for token in tokens for edge in token} | {len(program) + 1}


def test_the_language_is_that_of_name_flavour_and_content():
    text = b'N10 MSG("A")\nTRAORI\nCYCLE81(10,0,2,-5)\n'
    assert shown_language("part.nc", text, None) is Language.SIEMENS
    assert shown_language("part.nc", text, "fanuc") is Language.GCODE
    assert shown_language("part.nc", b"G1 X1\n", None) is Language.GCODE
    assert shown_language("part.nc", b"G1 X1\n", "siemens") is Language.SIEMENS
    assert shown_language("part.mpf", b"G1 X1\n", None) is Language.SIEMENS
    assert shown_language("part.cls", text, "siemens") is Language.CLDATA


_FUNCTIONS = st.sampled_from(["sin", "EXP", "tan", "ln", "round", "sqrt"])
_OPERATORS = st.sampled_from(["+", "-", "*", "/", "**", "mod", "eq", "ne", "gt", "GE", "lt", "le", "and", "xor", "or"])
_VALUE = st.recursive(
    st.sampled_from(["1", "-2.5", "+.5", "#5", "#<a b>", "-#1"]),
    lambda value: st.one_of(
        st.tuples(_FUNCTIONS, value).map(lambda made: f"{made[0]}[{made[1]}]"),
        st.tuples(value, _OPERATORS, value).map(lambda made: f"[{made[0]} {made[1]}{made[2]}]"),
        st.tuples(value, value).map(lambda made: f"atan[{made[0]}]/[{made[1]}]"),
    ),
    max_leaves=6,
)


@pytest.mark.slow
@given(st.lists(st.tuples(st.sampled_from("ABCDEFGHIJKLMPQRSTUVWXYZ"), st.sampled_from(["", " "]), _VALUE), max_size=5))
def test_any_block_of_words_is_coloured_as_it_is_read(words):
    line = "".join(letter + blank + value + blank for letter, blank, value in words)
    assume(not re.search("A(sin|tan)", line, re.IGNORECASE))
    assume(not isinstance(BLOCK.parse(line), Exception))  # A1Lexp[1] is none: le is taken for an operator
    assert_coloured_as_read(line, Language.GCODE)


@pytest.mark.slow
@example("MACHIN", Language.CLDATA)
@given(st.text(max_size=80), st.sampled_from(list(Language)))
def test_any_line_has_spans_in_order(line, language):
    at = 0
    for span in coloured_spans(line, language):
        assert at <= span.start < span.end <= len(line)
        at = span.end


def test_comments_and_continuation_of_cl_data():
    found = [(span.colour, span.start) for span in coloured_spans("GOTO/1,2,$ $$ more", Language.CLDATA)]
    assert found[-1] == (Colour.COMMENT, 11)
    assert [span.colour for span in coloured_spans("GOTO/1,$ ", Language.CLDATA)][-1] is Colour.OPERATOR


def test_a_comment_that_is_not_closed_is_a_comment():
    assert [(span.start, span.end, span.colour) for span in coloured_spans("G1 (open X1", Language.GCODE)][-1] == (
        3,
        11,
        Colour.COMMENT,
    )


def test_a_long_line_is_coloured_as_far_as_people_see_it():
    assert max(span.end for span in coloured_spans("X1" * LONGEST, Language.GCODE)) <= LONGEST


def test_lines_of_the_faulty_examples_do_not_matter_to_colours():
    chosen = random.Random(7).sample(sorted((ROOT / "tests/data/bad_gcode").glob("*.ngc")), 20)
    for file in chosen:
        for line in re.split(r"\r?\n", file.read_bytes().decode("latin-1")):
            assert all(span.colour in Colour for span in coloured_spans(line, Language.GCODE))
