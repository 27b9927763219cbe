# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from pkm_post.controllers.pvt.numbers import numbers_of

LETTERS = tuple("ABCUVW")


def lines_of(numbers):
    """Lines of moves of texts of numbers, (N, 6, 2)."""
    return "".join(
        " ".join(f"{letter}{length}:{speed}" for letter, (length, speed) in zip(LETTERS, row, strict=True)) + "\n"
        for row in numbers
    )


def printed(decimals, count=2000):
    rng = np.random.default_rng(17)
    length = rng.uniform(0, 10.0 ** rng.integers(0, 8, (count, 6)))
    speed = rng.normal(scale=10.0 ** rng.integers(-3, 4, (count, 6)), size=(count, 6))
    return [
        [(f"{one:.{decimals[0]}f}", f"{other:.{decimals[1]}f}") for one, other in zip(*row, strict=True)]
        for row in zip(length, speed, strict=True)
    ]


@pytest.mark.parametrize("decimals", [(6, 4), (3, 6), (1, 1), (9, 0), (0, 0)])
def test_numbers_are_those_that_python_reads(decimals):
    numbers = printed(decimals)
    expected = [[[float(length), float(speed)] for length, speed in row] for row in numbers]
    np.testing.assert_array_equal(numbers_of(lines_of(numbers), LETTERS), expected)


@pytest.mark.parametrize(
    "odd",
    ["1.5", "-0.0000", "12", "123456789012345.123456", "0.1234567890123456789012345", "9007199254740993.0000"],
    ids=["fewer decimals", "minus zero", "no point", "many digits", "very many decimals", "beyond 2^53"],
)
def test_one_odd_number_is_read_as_python_reads_it(odd):
    numbers = printed((6, 4), 20)
    numbers[11][4] = (numbers[11][4][0], odd)
    expected = [[[float(length), float(speed)] for length, speed in row] for row in numbers]
    np.testing.assert_array_equal(numbers_of(lines_of(numbers), LETTERS), expected)


def test_a_point_that_one_number_lacks_and_another_has_too_much_is_no_agreement():
    # as many points as numbers: what decides is where they are
    numbers = printed((6, 4), 3)
    numbers[1][2] = ("12", "3.0000")
    text = lines_of(numbers)
    assert numbers_of(text, LETTERS)[1, 2].tolist() == [12.0, 3.0]
