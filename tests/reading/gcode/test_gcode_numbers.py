# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers read many at once are those that Python reads one by one, to the last bit."""

import random
import re

import numpy as np
import pytest

from pkm_post.reading.gcode.numbers import values_of

RUN = re.compile(rb"[-+.\d]+")


def one_by_one(run):
    try:
        return float(run)
    except ValueError:
        return np.nan


def compare(text):
    runs = list(RUN.finditer(text))
    starts, ends = (np.array([getattr(run, which)() for run in runs], np.int64) for which in ("start", "end"))
    values = values_of(text, starts, ends)
    expected = np.array([one_by_one(run[0]) for run in runs], np.float64)
    # As bits, so that -0 is not 0; what is no number is NaN in both.
    np.testing.assert_array_equal(np.isnan(values), np.isnan(expected))
    good = ~np.isnan(expected)
    np.testing.assert_array_equal(values[good].view(np.int64), expected[good].view(np.int64))


def test_no_numbers_at_all():
    compare(b"")
    compare(b"G X\n")


@pytest.mark.parametrize(
    "number",
    [b"0", b"-0", b"+0.", b".5", b"-.5", b"5.", b"00012.500", b"12345678", b"123456789", b"1.12345678", b"1.123456789"]
    + [b"99999999.99999999", b"90071992.54740993", b"-12345678.1234567", b"9" * 400, b"0." + b"0" * 400 + b"1"]
    + [b"-", b"+", b".", b"-.", b"1.2.3", b"1-2", b"--1", b"+-1", b"1..", b"..1", b"1-", b"1+", b"1.-2", b"12345678-"],
)
def test_a_number_at_every_place_of_a_text(number):
    for text in (number, b"X" + number, number + b"\n", b" 7 " + number + b" 8 ", b".5" + b" " * 9 + number):
        compare(text)


@pytest.mark.parametrize("seed", range(4))
def test_numbers_of_any_size(seed):
    chance = random.Random(seed)
    texts = [
        f"{chance.choice(['', '-', '+'])}{chance.random() * 10 ** chance.randint(-6, 12):.{chance.randint(0, 14)}f}"
        for _ in range(20_000)
    ]
    compare(" ".join(texts).encode())


@pytest.mark.parametrize("seed", range(4))
def test_digits_points_and_signs_in_any_order(seed):
    chance = random.Random(seed)
    compare(b" ".join(bytes(chance.choices(b"0123456789.+-", k=chance.randint(1, 12))) for _ in range(20_000)))
