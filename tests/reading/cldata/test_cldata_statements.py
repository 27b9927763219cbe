# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: the scan agrees with the grammar; lines, columns and encodings are kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pkm_post.reading.cldata import read
from pkm_post.reading.cldata.diagnostics import StatementDiagnostics
from pkm_post.reading.cldata.logical_lines import JOINT, decoded, logical_lines
from pkm_post.reading.cldata.statements import scan, template_of
from pkm_post.reading.grammar import STATEMENT

BLANKS = st.sampled_from(["", " ", "  ", " $\n"])
NUMBERS = st.sampled_from(["1", "-2.5", ".25", "+3.", "1.0E-05", "-0.0", "12e2", "007"])
WORDS = st.sampled_from(["MMPM", "1STPECK", "clw", "DEEP2", "OUT-PUT", "A_1", "END.2"])
ITEMS = st.one_of(NUMBERS, WORDS, st.just(""), st.just("N=4"), st.just("(LINE/1,2)"), st.just("'a 1'"))


@st.composite
def statements(draw):
    major = draw(st.sampled_from(["GOTO", "CIRCLE", "cycle", "TLON,GOFWD", "N10,GOTO", "RAPID"]))
    items = draw(st.lists(ITEMS, max_size=6))
    blanks = [draw(BLANKS) for _ in range(2 * len(items) + 1)]
    spaced = ",".join(
        before + item + after for before, item, after in zip(blanks[::2], items, blanks[1::2], strict=False)
    )
    if draw(st.integers(0, 5)) == 0:
        return ",".join(draw(st.lists(NUMBERS, min_size=1, max_size=6)))
    return f"{major}{draw(st.sampled_from(['', ' ']))}/{spaced}"


def leaves(tree):
    """The numbers of a tree, in order."""
    return [float(token) for token in tree.scan_values(lambda token: getattr(token, "type", "") == "NUMBER")]


@pytest.mark.slow
@settings(deadline=None, derandomize=True)
@given(st.lists(statements(), min_size=1, max_size=8))
def test_scan_agrees_with_the_grammar(written):
    text = "\n".join(written)
    faults = StatementDiagnostics("part.cl")
    table = scan(logical_lines(text), faults)
    assert faults.diagnostics() == ()
    assert len(table) == len(written)
    for row, one in enumerate(written):
        tree = STATEMENT.parse(one.replace("$\n", JOINT))
        assert table.statement(row) == template_of(tree).fill(iter(leaves(tree)))


def test_numbers_are_those_of_the_text_to_the_last_bit():
    values = np.random.default_rng(5).normal(0, 100, (50, 6))
    text = "".join(f"GOTO/{','.join(map(repr, row))}\n" for row in values.tolist())
    table = scan(logical_lines(text), StatementDiagnostics("part.cl"))
    assert np.array_equal(table.numbers.reshape(-1, 6), values)
    assert len(table.templates) == 1


def test_quoted_numbers_and_foreign_digits_are_no_numbers():
    table = scan(logical_lines("PPFUN/'A 1',2\nPPFUN/'A 3',4\n"), StatementDiagnostics("part.cl"))
    assert [table.statement(row).items for row in range(2)] == [("'A 1'", 2.0), ("'A 3'", 4.0)]
    assert [fault.code for fault in read("GOTO/1,\u0662,3", "part.cl")[1]] == ["L101"]


def test_continued_statements_keep_their_lines():
    text = "PARTNO X\nGOTO/1,$\n 2, $$ note\n$$ comment\nGOTO / 1, 2, $ $$ note\n  3 ; 4\nRAPID"
    diagnostics = read(text.replace("2, $$ note", "2,3"), "part.cl")[1]
    assert [(fault.code, str(fault.place)) for fault in diagnostics] == [("L101", "part.cl: line 6:5")]


def test_a_tilde_continues_text():
    table = scan(
        logical_lines("TPRINT/one, ~\ntwo ~  \nthree\nGOTO/1,2,3\nPPRINT a ~ b\nRAPID"), StatementDiagnostics("part.cl")
    )
    assert [template.word for template in table.templates] == ["TPRINT", "GOTO", "PPRINT", "RAPID"]
    assert table.statement(0).text == "one, two three"
    assert table.statement(2).text == "a ~ b"
    assert [table.place(row)[0] for row in range(4)] == [1, 4, 5, 6]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_line_ends_and_byte_order_marks_do_not_matter(end, mark):
    text = f"%{end}UNITS/MM{end}FROM/0,0,9{end}GOTO/1,2,3{end}%"
    program, diagnostics = read(mark + text.replace("GOTO", "RAPID" + end + "GOTO").encode(), "part.cl")
    assert program.position.tolist() == [[0, 0, 9], [1, 2, 3]]
    assert program.line.tolist() == [3, 5]
    assert [fault.code for fault in diagnostics] == ["L411"]


def test_latin_1_is_read_where_it_is_not_utf_8():
    assert decoded("Fräser".encode("latin-1")) == decoded("Fräser".encode()) == "Fräser"
    assert read("UNITS/MM\nPARTNO Fräser\nGOTO/1,2,3".encode("latin-1"), "part.cl")[0] is not None
