# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from dataclasses import replace

import numpy as np

from pkm_post.controllers.pmac import memory_faults, program_text, program_words
from pkm_post.model import StrutMotion


def test_every_knot_takes_twelve_words():
    def at_rest(knots):
        return StrutMotion(np.arange(knots) * 20, np.full((knots, 6), 500.0), np.zeros((knots, 6)), ())

    assert program_words(at_rest(1001)) - program_words(at_rest(1)) == 12 * 1000 + 1


def test_a_program_that_fills_the_memory_is_accepted_and_one_word_more_is_not(job, settings):
    words = program_words(job)
    assert memory_faults(job, replace(settings, memory_words=words), "job") == ()
    (fault,) = memory_faults(job, replace(settings, memory_words=words - 1), "job")
    assert (fault.code, fault.place.file) == ("C102", "job")
    assert fault.found == f"about {words} words for 4 knots, the controller has {words - 1}"


def test_the_estimate_is_not_below_the_numbers_and_words_of_the_text(job, settings):
    body = program_text(job, settings, []).split("CLEAR\n")[1]
    assert program_words(job) >= len(re.findall(r"[A-Z]+-?[0-9.]+|:|LINEAR|ABS|FRAX", body))
