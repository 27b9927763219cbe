# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from bisect import bisect_left
from dataclasses import replace

import numpy as np
import pytest
from strut_motions import read_back, with_rests

from pkm_post.model import Event, EventKind, StrutMotion
from pkm_post.writing.controllers.pmac import memory_faults, program_parts, program_text
from pkm_post.writing.controllers.pmac.memory import memory_cuts


def at_rest(knots, events=()):
    return StrutMotion(np.arange(knots) * 20, np.full((knots, 6), 500.0), np.zeros((knots, 6)), tuple(events))


def words_of(motion, settings):
    """The least memory that takes the program of a motion whole."""

    def is_whole(words):
        small = replace(settings, memory_words=words)
        return not memory_faults(motion, small, "job") and not memory_cuts(motion, small)

    return bisect_left(range(1 << 20), True, key=is_whole)


def test_every_knot_takes_twelve_words(settings):
    # a value takes one word (Turbo PMAC User Manual, p. 337), and a knot has six lengths and six speeds
    assert words_of(at_rest(1001), settings) - words_of(at_rest(1), settings) == 12 * 1000 + 1


def test_a_program_that_fills_the_memory_is_written_whole_and_one_word_less_parts_it(job, settings):
    words = words_of(job, settings)
    assert len(program_parts(job, replace(settings, memory_words=words), [])) == 1
    assert len(program_parts(job, replace(settings, memory_words=words - 1), [])) == 2


def test_a_whole_program_says_nothing_of_parts(job, settings):
    assert program_parts(job, settings, ["job"]) == (program_text(job, settings, ["job"]),)


@pytest.mark.parametrize("memory_words", [400, 700, 2000])
def test_the_parts_together_are_the_whole_and_each_fits(settings, memory_words):
    events = [Event(row, EventKind.DWELL, 0.25) for row in (0, 30, 30, 60, 199)]
    motion = with_rests(10, 200, events)
    small = replace(settings, memory_words=memory_words)
    texts = program_parts(motion, small, ["any heading"])
    assert len(texts) > 1
    for number, text in enumerate(texts, start=1):
        part, faults = read_back([re.sub(r"; part .*\n", "", text)], small)
        assert not faults
        assert words_of(part, settings) <= memory_words
        assert f"; part {number} of {len(texts)}:" in text
    whole, faults = read_back(texts, small)
    assert not faults
    alone, _ = read_back([program_text(motion, small, [])], small)
    assert np.array_equal(whole.time_ms, motion.time_ms)
    assert np.array_equal(whole.length, alone.length)
    assert np.array_equal(whole.speed, alone.speed)
    assert whole.events == motion.events


def test_a_cut_is_where_the_machine_is_best_left_waiting(settings):
    events = [Event(20, EventKind.TOOL_CHANGE, 2.0), Event(30, EventKind.STOP, 0.0), Event(40, EventKind.DWELL, 1.0)]
    motion = with_rests(10, 101, events)
    knots = [text.count(":") // 6 for text in program_parts(motion, replace(settings, memory_words=800), [])]
    assert knots[0] == 20  # up to the tool change, though more would fit
    without = with_rests(10, 101)
    assert program_parts(without, replace(settings, memory_words=800), [])[0].count(":") // 6 == 60


def test_what_happens_at_a_cut_belongs_to_the_part_behind_it(settings):
    motion = with_rests(10, 41, [Event(20, EventKind.TOOL_CHANGE, 2.0), Event(20, EventKind.SPINDLE, 900.0)])
    first, second = program_parts(motion, replace(settings, memory_words=400), [])
    assert "M6" not in first
    assert "DWELL0\nT2 M6\nS900 M3\nPVT" in second


def test_a_motion_without_a_rest_that_is_near_enough_is_refused(settings):
    motion = with_rests(50, 101)
    small = replace(settings, memory_words=600)
    (fault,) = memory_faults(motion, small, "job")
    assert (fault.code, fault.place.file) == ("C102", "job")
    assert re.fullmatch(
        r"about 6\d\d words for 51 knots without a rest from 0 s on, the controller has 600", fault.found
    )
    with pytest.raises(ValueError, match="expected a rest within 600 words"):
        program_parts(motion, small, [])
    assert memory_faults(motion, replace(settings, memory_words=700), "job") == ()


def test_a_memory_that_does_not_take_one_knot_is_reported(settings):
    (fault,) = memory_faults(at_rest(1), replace(settings, memory_words=31), "job")
    reported = "about 32 words for 1 knots without a rest from 0 s on, the controller has 31"
    assert (fault.code, fault.found) == ("C102", reported)


def test_the_estimate_is_not_below_the_numbers_and_words_of_the_text(job, settings):
    body = program_text(job, settings, []).split("CLEAR\n")[1]
    assert words_of(job, settings) >= len(re.findall(r"[A-Z]+-?[0-9.]+|:|LINEAR|ABS|FRAX", body))
