# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from dataclasses import replace

import pytest

from pkm_post.writing.controllers.pmac import setup_text


def _commands(text):
    return [line.split(" ;")[0] for line in text.splitlines() if not line.startswith(";")]


def test_the_set_up_of_a_machine(settings):
    # counts = 10000 * (length - 500): -5000000 at length zero, and the stroke in counts
    text = setup_text(settings, "Säule", (450.0, 700.25))
    assert text.startswith("; Set-up of S\\xe4ule\n")
    assert _commands(text) == [
        "CLOSE",
        "&1",
        *(f"#{motor}->10000{letter}-5000000" for motor, letter in enumerate("ABCUVW", start=1)),
        "I5190=1000",
        "I5150=0",
        "I5192=0",
        "I5193=$2000",
        *(line for motor in range(1, 7) for line in (f"I{motor}13=2002500", f"I{motor}14=-500000")),
        "I127=0",
        "I227=0",
        "I327=0",
    ]


def test_the_variables_follow_the_coordinate_system(settings):
    text = setup_text(replace(settings, coordinate_system=12, letters=tuple("UVWXYZ")), "m", (450.0, 700.0))
    assert {"&12", "#4->10000X-5000000", "I6290=1000", "I6250=0", "I6293=$2B00"} < set(_commands(text))
    assert "I68 must be 11 or more" in text
    assert not re.search(r"^I\d27", text, re.MULTILINE)


def test_a_falling_count_turns_the_limits_round_and_halves_of_counts_are_cut_inward(settings):
    text = setup_text(replace(settings, counts_per_mm=-2.5), "m", (499.0, 501.0))
    assert {"#1->-2.5A+1250", "I113=2", "I114=-2"} < set(_commands(text))


def test_a_limit_at_zero_is_not_switched_off(settings):
    assert "I114=-1" in _commands(setup_text(settings, "m", (500.0, 700.0)))
    assert "I113=1" in _commands(setup_text(settings, "m", (400.0, 500.0)))


def test_decimal_lengths_give_exact_offsets(settings):
    text = setup_text(replace(settings, zero_length=(512.3, 0.1, 1007.8869, 500, 500, 500)), "m", (400.0, 1200.0))
    assert {"#1->10000A-5123000", "#2->10000B-1000", "#3->10000C-10078869"} < set(_commands(text))


def test_no_assignment_is_followed_by_an_ampersand_or_a_number_sign(settings):
    commands = _commands(setup_text(settings, "m", (450.0, 700.0)))
    first = next(index for index, line in enumerate(commands) if "=" in line)
    assert all(line.startswith("I") for line in commands[first:])


def test_lines_are_short_ascii(settings):
    text = setup_text(settings, "床" * 200, (450.0, 700.0))
    assert text.isascii()
    assert max(map(len, text.splitlines())) <= settings.line_limit


@pytest.mark.parametrize("stroke", [(700.0, 450.0), (450.0, 450.0), (450.0, float("inf"))])
def test_a_stroke_that_is_none_is_refused(settings, stroke):
    with pytest.raises(ValueError, match="stroke: expected two finite lengths"):
        setup_text(settings, "m", stroke)
