# SPDX-License-Identifier: LGPL-2.1-or-later
"""Decimals parsed many at once are those that Python reads one by one, to the last bit."""

import random
import re

import numpy as np
import pytest

from pkm_post.system import DecimalReader

RUN = re.compile(rb"[-+.\d]+")
DECIMAL = re.compile(r"-?(?:0|[1-9][0-9]{0,14})\.[0-9]{1,15}")
WHOLE = re.compile(r"0|[1-9][0-9]{0,14}")


def one_by_one(run):
    try:
        return float(run)
    except ValueError:
        return np.nan


def compare(text):
    runs = list(RUN.finditer(text))
    starts, ends = (np.array([getattr(run, which)() for run in runs], np.int64) for which in ("start", "end"))
    values = DecimalReader(text).numbers(starts, ends)
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


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_numbers_of_any_size(seed):
    chance = random.Random(seed)
    texts = [
        f"{chance.choice(['', '-', '+'])}{chance.random() * 10 ** chance.randint(-6, 12):.{chance.randint(0, 14)}f}"
        for _ in range(20_000)
    ]
    compare(" ".join(texts).encode())


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_digits_points_and_signs_in_any_order(seed):
    chance = random.Random(seed)
    compare(b" ".join(bytes(chance.choices(b"0123456789.+-", k=chance.randint(1, 12))) for _ in range(20_000)))


def read(numbers):
    """Numbers read out of one text, with their points where Python finds the first."""
    text = "".join(f":{number} " for number in numbers)
    before = np.cumsum([0, *(len(number) + 2 for number in numbers)])[:-1]
    ends = before + 1 + np.array([len(number) for number in numbers])
    points = before + 1 + np.array([number.index(".") for number in numbers])
    return DecimalReader(text.encode("latin-1")).decimals(before, points, ends)


def assert_read(numbers):
    """All of them are read, each as the double that Python takes it for, to the sign of zero."""
    values, fits = read(numbers)
    assert [number for number, right in zip(numbers, fits, strict=True) if not right] == []
    expected = np.array([float(number) for number in numbers])
    np.testing.assert_array_equal(values, expected)
    np.testing.assert_array_equal(np.signbit(values), np.signbit(expected))


@pytest.mark.parametrize("decimals", range(1, 10))
def test_numbers_are_those_that_python_reads(decimals):
    rng = np.random.default_rng(17)
    values = rng.normal(size=4000) * 10.0 ** rng.integers(-6, 6, 4000)
    assert_read([f"{value:.{decimals}f}" for value in values])


def test_numbers_of_any_length_side_by_side():
    rng = np.random.default_rng(18)
    counts = rng.integers(1, 8, (4000, 2))
    numbers = [f"{rng.integers(0, 10**whole)}.{rng.integers(0, 10**part):0{part}d}" for whole, part in counts]
    assert_read(numbers)
    assert_read([f"-{number}" for number in numbers])


@pytest.mark.parametrize(
    "number",
    ["0.0", "-0.0000", "9007199254.740991", "0.900719925474099", "900719925474099.1", "-12345678.12345678", "0.1"],
)
def test_single_decimals_are_read_wherever_they_are(number):
    assert_read([number])
    assert_read(["1.5", number, "2.25"])


@pytest.mark.parametrize(
    "number",
    ["9007199254.740992", "900719925474099.2", "0.9007199254740992", "1234567890123456.5", "0.1234567890123456"],
)
def test_numbers_that_one_division_may_not_give_are_left_to_others(number):
    assert read([number])[1].tolist() == [False]


@pytest.mark.parametrize(
    "number", ["1.5", "0.5", "-123.4567", "1009.941772", "1234567.12345678", "123456789.123456", "0.000000000001"]
)
def test_one_changed_character_is_judged_as_the_form_of_a_decimal_judges_it(number):
    places = [place for place in range(len(number)) if number[place] != "."]
    changed = [number[:place] + chr(code) + number[place + 1 :] for place in places for code in range(256)]
    assert read(changed)[1].tolist() == [DECIMAL.fullmatch(text) is not None for text in changed]


@pytest.mark.parametrize(
    "number", [".5", "5.", "-.5", "--1.5", "00.5", "01.5", "-01.5", "1.-5", "1.5-", "-1-2.5", "+1.5"]
)
def test_what_is_no_plain_decimal_is_not_taken(number):
    assert read([number])[1].tolist() == [False]
    assert read(["1.5", number, "2.25"])[1].tolist() == [True, False, True]


def test_whole_numbers_have_no_zeros_in_front_and_no_sign():
    numbers = ["0", "1", "9", "10", "4095", "12345678", "123456789", "999999999999999", *("", "00", "01", "-1", "1:5")]
    text = "".join(f"T{number}\n" for number in numbers)
    before = np.cumsum([0, *(len(number) + 2 for number in numbers)])[:-1]
    ends = before + 1 + np.array([len(number) for number in numbers])
    values, fits = DecimalReader(text.encode("ascii")).whole_numbers(before, ends)
    assert fits.tolist() == [WHOLE.fullmatch(number) is not None for number in numbers]
    assert values[fits].tolist() == [int(number) for number in numbers[:8]]
