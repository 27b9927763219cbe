# SPDX-License-Identifier: LGPL-2.1-or-later
"""Logical lines: a $ in quotes continues nothing, a $$ in quotes begins no comment, and too long lines are refused.

The second opinion reads character by character: a quote opens a text where the same quote closes it on its line.
"""

import tracemalloc

import numpy as np
import pytest

from pkm_post.reading.cldata import read
from pkm_post.reading.cldata.logical_lines import JOINT, LONGEST_LINE, decoded, logical_lines, without_long_lines

AROUND = (b"UNITS/MM\n$$ comment\n", b"\nRAPID\nGOTO/1,2,3\n")

PIECES = [
    "GOTO/1,2,3",
    "SYN/",
    ",",
    "'a'",
    "'$'",
    "'$$ b'",
    '"$ \'"',
    '"$$"',
    "'",
    '"',
    "$$ c",
    "$$ it's 'so'",
    " ",
    "N1",
]
STRAY = "a $ within a line"
ENDS = ["\n", "\n", "\n", "$\n", "$ \n", "$ $$ d 'e'\n"]


def statements(text):
    """The logical lines of a text, each with the number of its first line."""
    done, current, number, first = [], "", 1, 1
    for line in text.split("\n"):
        kept, is_continued = without_comment(line)
        current += kept
        if is_continued:
            current += JOINT
        else:
            done.append((current, first))
            current, first = "", number + 1
        number += 1
    return done


def without_comment(line):
    """A line up to its comment, and whether the next one continues it."""
    column = 0
    while column < len(line):
        if line[column] in "'\"" and line.find(line[column], column + 1) > 0:
            column = line.index(line[column], column + 1)
        elif line.startswith("$$", column):
            return line[:column], False
        elif line[column] == "$":
            rest = line[column + 1 :].strip()
            continues = not rest or rest.startswith("$$")
            return (line[:column], True) if continues else (STRAY, False)
        column += 1
    return line, False


@pytest.mark.slow
def test_quotes_and_comments_agree_with_reading_by_character():
    random = np.random.default_rng(12)
    quoted = compared = 0
    for _ in range(2000):
        lines = ["".join(random.choice(PIECES, random.integers(0, 6))) + random.choice(ENDS) for _ in range(6)]
        text = "".join(lines) + "FINI"
        expected = statements(text)
        if any(STRAY in line for line, _ in expected):
            continue  # refused with L106, wherever the line ends
        found = logical_lines(decoded(text))
        assert list(zip(found.text, found.number.tolist(), strict=True)) == expected, repr(text)
        compared += 1
        quoted += any("$" in line for line in found.text)
    assert compared > 1000
    assert quoted > 500


@pytest.mark.parametrize("text", ["'TLAXIS','$$*TLAXIS'", '"a$","$$"', "'it is $ 5'"])
def test_a_statement_with_quoted_dollars_is_read(text):
    program, diagnostics = read(
        f"UNITS/MM\nFEDRAT/100,MMPM\nSYNONYM/{text} $$ not read\nGOTO/1,2,3\nGOTO/1,2,4\n", "part.apt"
    )
    assert [fault.code for fault in diagnostics] == ["L404", "L411"]
    assert program.position.tolist() == [[1, 2, 3], [1, 2, 4]]


@pytest.mark.parametrize("unit", [b"1,2,3,", b"A", b"'a", b"$ ", b"(", b"~ ", b"GOTO/1 ", b"\xff"])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r", b""])
def test_a_too_long_line_is_reported_and_the_lines_around_it_are_read(unit, end):
    line = b"GOTO/" + unit * LONGEST_LINE
    head, tail = (part.replace(b"\n", end or b"\n") for part in AROUND)
    program, diagnostics = read(head + line + (tail if end else b""), "part.cl")
    assert program is None
    (fault,) = [each for each in diagnostics if each.code == "L104"]
    assert (fault.place.line, fault.found) == (3, f"a line of {len(line)} bytes, at most {LONGEST_LINE}")


def test_work_and_memory_do_not_grow_with_the_length_of_a_line():
    content = AROUND[0] + b"GOTO/" + b"1.5,-2.5,3.5," * 1_000_000 + AROUND[1]
    left, too_long = without_long_lines(content)
    assert left == AROUND[0] + AROUND[1]
    assert [line for line, _ in too_long] == [3]
    tracemalloc.start()
    try:
        assert read(content, "part.cl")[0] is None
        assert tracemalloc.get_traced_memory()[1] < len(content) // 4
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("length", [LONGEST_LINE - 1, LONGEST_LINE, LONGEST_LINE + 1])
def test_lines_up_to_the_limit_are_kept(length):
    lines = [b"GOTO/1,2,3", b"x" * length, b"y" * length, b"GOTO/1,2,4", b"z" * length]
    left, too_long = without_long_lines(b"\n".join(lines))
    kept = [line if len(line) <= LONGEST_LINE else b"" for line in lines]
    assert left == b"\n".join(kept)
    assert too_long == [(number, length) for number in (2, 3, 5) if length > LONGEST_LINE]


def test_text_is_as_long_as_its_bytes():
    assert without_long_lines("é" * LONGEST_LINE + "\nGOTO/1,2,3") == (b"\nGOTO/1,2,3", [(1, 2 * LONGEST_LINE)])


def test_a_statement_of_too_many_lines_is_reported():
    joined = "GOTO/1,2,$\n" * LONGEST_LINE
    program, diagnostics = read(f"UNITS/MM\n{joined}3\nGOTO/1,2,3\n", "part.cl")
    assert program is None
    (fault,) = [each for each in diagnostics if each.code == "L104"]
    assert (fault.place.line, fault.found.split(" lines")[0][-6:]) == (2, "100001")
