# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.controllers.pmac import program_of_rotary, program_text, read_program, rotary_text


def test_the_moves_are_those_of_the_program(job, settings):
    program = program_text(job, settings, ["job"])
    rotary = rotary_text(program, settings)
    # Turbo PMAC Software Reference: B0 before OPEN ROT; behind it, it is a move of axis B
    assert rotary.startswith("; job\nCLOSE\nDELETE GATHER\n&1\nB0\nOPEN ROT\nABS\nFRAX(A,B,C,U,V,W)\nLINEAR\n")
    assert rotary.split("OPEN ROT\n")[1] == program.split("CLEAR\n")[1]
    assert "OPEN PROG" not in rotary


def test_the_rotary_form_reads_back_as_the_program(job, settings):
    program = program_text(job, settings, ["job"])
    back = program_of_rotary(rotary_text(program, settings), settings)
    assert back == program
    read, faults = read_program(back, settings, "job.pmc")
    assert not faults
    assert np.array_equal(read.time_ms, job.time_ms)
    assert read.events == job.events


def test_a_text_without_the_frame_is_refused(job, settings):
    program = program_text(job, settings, [])
    with pytest.raises(ValueError, match="expected 'CLOSE.*once, got it 0 times"):
        rotary_text(program.replace("CLEAR\n", ""), settings)
    with pytest.raises(ValueError, match="got it 0 times"):
        program_of_rotary(program, settings)
