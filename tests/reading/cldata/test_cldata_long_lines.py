# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines of CL data that are too long are refused, and nothing looks into them."""

import tracemalloc

import pytest

from pkm_post.reading.cldata import read
from pkm_post.reading.cldata.logical_lines import LONGEST_LINE, without_long_lines

AROUND = (b"UNITS/MM\n$$ comment\n", b"\nRAPID\nGOTO/1,2,3\n")


@pytest.mark.parametrize("unit", [b"1,2,3,", b"A", b"'a", b"$ ", b"(", b"~ ", b"GOTO/1 ", b"\xff"])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r", b""])
def test_a_line_that_is_too_long_is_named_and_the_lines_around_it_are_read(unit, end):
    line = b"GOTO/" + unit * LONGEST_LINE
    head, tail = (part.replace(b"\n", end or b"\n") for part in AROUND)
    program, told = read(head + line + (tail if end else b""), "part.cl")
    assert program is None
    (fault,) = [each for each in told if each.code == "L104"]
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
def test_the_limit_is_that_of_the_page(length):
    lines = [b"GOTO/1,2,3", b"x" * length, b"y" * length, b"GOTO/1,2,4", b"z" * length]
    left, too_long = without_long_lines(b"\n".join(lines))
    kept = [line if len(line) <= LONGEST_LINE else b"" for line in lines]
    assert left == b"\n".join(kept)
    assert too_long == [(number, length) for number in (2, 3, 5) if length > LONGEST_LINE]


def test_text_is_as_long_as_its_bytes():
    assert without_long_lines("é" * LONGEST_LINE + "\nGOTO/1,2,3") == (b"\nGOTO/1,2,3", [(1, 2 * LONGEST_LINE)])


def test_a_statement_of_too_many_lines_is_named():
    joined = "GOTO/1,2,$\n" * LONGEST_LINE
    program, told = read(f"UNITS/MM\n{joined}3\nGOTO/1,2,3\n", "part.cl")
    assert program is None
    (fault,) = [each for each in told if each.code == "L104"]
    assert (fault.place.line, fault.found.split(" lines")[0][-6:]) == (2, "100001")
