# SPDX-License-Identifier: LGPL-2.1-or-later
import pytest

from pkm_post.writing.controllers.pmac import program_text, rotary_opening, rotary_text


def test_the_buffer_is_opened_empty_by_the_system_that_is_pointed_to_it(settings):
    # Turbo PMAC Software Reference: B0 before OPEN ROT; behind it, it is a move of axis B
    assert rotary_opening(settings) == ("CLOSE", "DELETE GATHER", "&1B0", "OPEN ROT", "CLEAR")


def test_the_lines_behind_the_opening_are_those_of_the_program(job, settings):
    program = program_text(job, settings, ["job"])
    rotary = rotary_text(program, settings)
    assert rotary.startswith("; job\nCLOSE\nDELETE GATHER\n&1B0\nOPEN ROT\nCLEAR\nABS\nFRAX(A,B,C,U,V,W)\nLINEAR\n")
    assert rotary.split("CLEAR\n")[1] == program.split("CLEAR\n")[1]
    assert "OPEN PROG" not in rotary


def test_a_text_without_the_frame_is_refused(job, settings):
    program = program_text(job, settings, [])
    for wrong, count in ((program.replace("CLEAR\n", ""), 0), (rotary_text(program, settings), 0), (program * 2, 2)):
        with pytest.raises(ValueError, match=f"expected 'CLOSE.*once, got it {count} times"):
            rotary_text(wrong, settings)
