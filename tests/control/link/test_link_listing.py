# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a listing may differ in, and what it may not."""

import pytest
from link_faults import small_program

from pkm_post.control.link.program import PmacProgram, compare_listing, parse_program

MOVE = "A512.062500:3.1250 B-513.000000:-0.5000"


@pytest.mark.parametrize(
    "listed",
    [MOVE, "A512.0625:3.125B-513:-.5", "A512.06250000001:3.1249999 B-513:-0.5", "a512.0625:3.125 b-513:-0.5"],
)
def test_the_same_numbers_in_other_digits(listed):
    assert compare_listing([MOVE], [listed]).same


@pytest.mark.parametrize(
    "listed",
    ["A512.062501:3.125B-513:-0.5", "A512.0625:3.125B-513:0.5", "A512.0625:3.125B513:-0.5", "A512.0625:3.125C-513:-0.5",
     "A512.0625:3.125", "A512.0625:3.125B-513:-0.5U1", "A512.0625:3.12501B-513:-0.5", "A512.0625001:3.125B-513:-0.5",
     "A512.062:3.125B-513:-0.5"],
)  # fmt: skip
def test_the_last_digit_counts(listed):
    assert not compare_listing([MOVE], [listed]).same


def test_a_line_in_two_is_two_moves():
    assert not compare_listing(["A1.0:0.0 B2.0:0.0"], ["A1:0", "B2:0"]).same
    assert not compare_listing(["A1.0:0.0", "B2.0:0.0"], ["A1:0B2:0"]).same


def test_numbers_that_the_controller_cannot_hold():
    # 48-bit floating point with 36 bits of mantissa: 512.345678901 is held as a multiple of 2^-26
    held = round(512.345678901 * 2**26) / 2**26
    assert abs(held - 512.345678901) > 1e-9
    assert compare_listing(["A512.345678901"], [f"A{held:.12f}"]).same
    assert not compare_listing(["A512.345678901"], [f"A{held + 2**-24:.12f}"]).same


def test_every_changed_digit_of_a_program_is_seen():
    lines = small_program().lines
    for index, line in enumerate(lines):
        for place, character in enumerate(line):
            if character.isdigit():
                other = line[:place] + str((int(character) + 1) % 10) + line[place + 1 :]
                found = compare_listing(lines, [*lines[:index], other, *lines[index + 1 :]])
                assert not found.same and found.lines == index and not found.nothing_else


def test_a_return_at_the_end_is_the_controllers_own():
    assert compare_listing(["ABS"], ["ABS", "RETURN"]).same
    assert compare_listing([], ["RET"]).same
    assert not compare_listing(["ABS"], ["RETURN", "ABS"]).same


def test_how_far_a_cut_download_came():
    lines = small_program().lines
    for count in range(len(lines)):
        found = compare_listing(lines, [*lines[:count], "RETURN"])
        assert (found.lines, found.all_there, found.nothing_else) == (count, False, True)
        half = compare_listing(lines, [*lines[:count], lines[count][:3]])
        assert not half.same
    assert not compare_listing(lines, [*lines, "LINEAR"]).same


def test_a_program_of_a_file():
    text = "; comment\n\nCLOSE\nDELETE GATHER\nOPEN PROG 12\nCLEAR\nABS ; absolute\nPVT20\nCLOSE\n"
    program = parse_program(text)
    assert program == PmacProgram(12, ("ABS", "PVT20"))
    assert program.digest == parse_program(text.replace("; comment", "; another")).digest
    assert program.digest != parse_program(text.replace("PVT20", "PVT21")).digest


@pytest.mark.parametrize(
    "text", ["", "OPEN PROG 1\nCLEAR\nABS\nCLOSE\n", "CLOSE\nDELETE GATHER\nOPEN PROG 1\nCLEAR\nABS\n"]
)
def test_a_file_without_the_frame(text):
    with pytest.raises(ValueError, match="expected CLOSE"):
        parse_program(text)


def test_words():
    assert PmacProgram(1, (MOVE,)).words == 4
    assert PmacProgram(1, ("TA500 TS0 F10", "DWELL0")).words == 8
