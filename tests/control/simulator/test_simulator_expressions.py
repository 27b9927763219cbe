# SPDX-License-Identifier: LGPL-2.1-or-later
import random

import pytest

from pkm_post.control.simulator.errors import CommandError
from pkm_post.control.simulator.expressions import Scanner, expression
from pkm_post.control.simulator.variables import printed, stored

LAST_BIT = 2.0**-35
"""Of a mantissa between 1/2 and 1."""


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1+2*3", "7"),
        ("(1+2)*3", "9"),
        ("7-2-1", "4"),
        ("12/3/2", "2"),
        ("7%4+1", "4"),
        ("6&3", "2"),
        ("6|1^3", "4"),  # from the left: 7, then 4
        ("-3*-2", "6"),
        ("$1F", "31"),
        ("2*SIN(30)", "1"),
        ("SQRT(2)*SQRT(2)", "2"),
        ("INT(-2.5)", "-3"),
        ("ABS(-2.5)+ATAN(1)", "47.5"),
        ("P(1+1)+Q3+M4+I3", "13"),
        ("EXP(LN(5))", "5"),
    ],
)
def test_values(pmac, text, value):
    pmac.say("P2=3 Q3=4 M4=4")
    pmac.say(f"P1={text}")
    assert pmac.say("P1") == value


@pytest.mark.parametrize(
    "text", ["1/0", "SQRT(-1)", "1+", "(1", "FOO(1)", "P9999", "P(-1)", "EXP(9999)", "5%0", "-" * 40 + "1"]
)
def test_what_has_no_value_is_refused(pmac, text):
    assert pmac.error(f"P1={text}") == 3
    assert pmac.say("P1") == "0"


def test_deep_nesting_is_refused_and_not_followed():
    with pytest.raises(CommandError, match="ERR003"):
        expression(Scanner("(" * 200 + "1" + ")" * 200))


def test_a_word_keeps_about_ten_and_a_half_digits():
    # Turbo PMAC User Manual: 48-bit floating point, 36 bits of mantissa with the sign.
    chance = random.Random(1)
    for _ in range(2000):
        value = chance.uniform(-1, 1) * 10.0 ** chance.randint(-12, 12)
        assert abs(stored(value) - value) <= abs(value) * LAST_BIT
        assert stored(stored(value)) == stored(value)


def test_what_is_printed_reads_back_as_the_same_word():
    chance = random.Random(2)
    for _ in range(2000):
        value = round(chance.uniform(-2000, 2000), chance.randint(0, 9))
        text = printed(value)
        assert stored(float(text)) == stored(value)
        assert "e" not in text and not text.startswith(".")


def test_numbers_with_few_digits_are_printed_as_they_were_written():
    assert [printed(value) for value in (512.345678, -0.0001, 0.0, -0.0, 25.0, 1e10)] == [
        *("512.345678", "-0.0001", "0", "0", "25", "10000000000"),
    ]
