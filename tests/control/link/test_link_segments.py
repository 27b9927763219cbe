# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program cut at its rests: nothing is lost, every part ends at rest and fits."""

import numpy as np
import pytest
from rig import SETTINGS
from streams import JOB, swings

from pkm_post.control.link.errors import NotReadyError
from pkm_post.control.link.program import PmacProgram, line_words
from pkm_post.control.link.rotary_buffer import split_into_segments
from pkm_post.writing.controllers.pmac import read_program

APPROACH = ["ABS", "LINEAR", "TA500 TS0 F10", " ".join(f"{letter}500.000" for letter in "ABCUVW"), "DWELL0"]


def knot(length, speed):
    return " ".join(f"{letter}{length:.3f}:{speed:.3f}" for letter in "ABCUVW")


def program(*lines):
    return PmacProgram(10, (*APPROACH, *lines))


def without_gates(segments):
    """The lines of segments in one, without what was put between them."""
    lines = []
    for segment in segments:
        *body, stop = segment.lines
        assert stop == "STOP" and "STOP" not in body
        lines += body
    return lines


@pytest.mark.parametrize("words", [330, 400, 500, 700, 1000, 5000])
def test_the_program_is_there_whole_and_fits(words):
    segments = split_into_segments(JOB.program, SETTINGS, words)
    for segment in segments:
        assert sum(map(line_words, segment.lines)) <= words
    knots = [line for line in without_gates(segments) if ":" in line]
    assert knots == [line for line in JOB.program.lines if ":" in line]
    assert segments[-1].last == len(JOB.program.lines)


def test_half_of_the_buffer_is_filled_if_the_rests_allow_it():
    for words in (700, 1000, 5000):
        sizes = [sum(map(line_words, segment.lines)) for segment in split_into_segments(JOB.program, SETTINGS, words)]
        assert max(sizes) <= words // 2


def test_between_dwells_only_stop_is_added():
    lines = ["PVT20", knot(501, 5), knot(502, 0), "DWELL0", "M5", "PVT20", knot(501, -5), knot(500, 0), "DWELL0"]
    segments = split_into_segments(program(*lines, "LINEAR"), SETTINGS, 150)
    assert [segment.lines[-2:] for segment in segments] == [("DWELL0", "STOP"), ("DWELL0", "STOP"), ("LINEAR", "STOP")]
    assert segments[1].lines[0] == "PVT20" and segments[2].lines[0] == "M5"
    assert without_gates(segments) == [*APPROACH, *lines, "LINEAR"]
    assert np.array_equal(segments[1].rest, np.full(6, 502.0))


def test_behind_a_knot_at_rest_the_struts_stand_and_the_interval_is_stated_again():
    lines = ["PVT20", knot(501, 5), knot(502, 0), knot(501, -5), knot(500, 0), "DWELL0", "LINEAR"]
    first, second, third = split_into_segments(program(*lines), SETTINGS, 150)
    assert first.lines == (*APPROACH, "STOP")
    assert second.lines == ("PVT20", knot(501, 5), knot(502, 0), "DWELL0", "STOP")
    assert third.lines[:2] == ("PVT20", knot(501, -5))


def test_a_program_that_rests_too_seldom_is_refused():
    lines = ["PVT20", *(knot(500 + 0.1 * count, 5) for count in range(1, 40)), knot(504, 0), "DWELL0", "LINEAR"]
    with pytest.raises(NotReadyError, match=r"between its lines 6 and 47, which take \d+ words; the rotary buffer has"):
        split_into_segments(program(*lines), SETTINGS, 400)
    assert split_into_segments(program(*lines), SETTINGS, 600)


def test_a_program_that_does_not_end_at_rest_is_refused():
    with pytest.raises(NotReadyError, match="does not end at rest"):
        split_into_segments(program("PVT20", knot(501, 5)), SETTINGS, 400)


def test_a_swing_rests_at_both_of_its_ends():
    rests = {tuple(segment.rest) for segment in split_into_segments(swings(4).program, SETTINGS, 330)}
    assert rests == {(500.0,) * 6, (501.0, 502.0, 497.0, 504.0, 495.0, 506.0)}


@pytest.mark.parametrize("words", [330, 500, 700])
def test_read_back_without_its_stops_it_is_the_motion_that_was_certified(words):
    lines = without_gates(split_into_segments(JOB.program, SETTINGS, words))
    text = "\n".join(["CLOSE", "DELETE GATHER", "OPEN PROG 10", "CLEAR", *lines, "CLOSE", ""])
    motion, faults = read_program(text, SETTINGS, "streamed.pmc")
    assert not faults
    for column in ("time_ms", "length", "speed"):
        assert np.array_equal(getattr(motion, column), getattr(JOB.motion, column))
