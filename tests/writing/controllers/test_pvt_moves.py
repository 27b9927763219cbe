# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines that are found all at once are those that the forms of the grammar take one by one."""

import numpy as np
import pytest
from controller_settings import settings_for
from hypothesis import given, strategies
from hypothesis import settings as hypothesis_settings

from pkm_post.writing.controllers.pmac.program import _grammar as turbo
from pkm_post.writing.controllers.power_pmac import _grammar as power
from pkm_post.writing.controllers.pvt.moves import lines_of

GRAMMARS = {"turbo": turbo(settings_for("turbo_pmac")), "power": power(settings_for("power_pmac"))}
LONGEST = 4095
CHARACTERS = "0123456789-.: \nABCUVWPTpvtFXD;/+,eE\t\r\x00\x7f\x80\xb3\xff\u20ac\u0663\U0001f600"


def found(text, _grammar):
    return lines_of(text.encode("latin-1", "replace"), _grammar.forms["move"], _grammar.forms["interval"], LONGEST)


def in_full(numbers):
    """Whether the numbers of a line of moves are such as the writer prints them."""
    parts = [number.lstrip("-").split(".") for number in numbers]
    return all(len(part) == 2 and len(part[1]) <= 15 and int("".join(part)) < 2**53 for part in parts)


def assert_as_one_by_one(text, _grammar):
    """Each line is judged as its form judges it, but for numbers that are printed in another way."""
    lines = found(text, _grammar)
    one_by_one = text.split("\n")
    complete, rest = one_by_one[:-1], one_by_one[-1:] if one_by_one[-1] else []
    assert lines.complete == len(complete)
    assert np.diff(lines.edges).tolist() == [*(len(line) + 1 for line in complete), *map(len, rest)]
    assert lines.lengths().tolist() == [len(line) for line in [*complete, *rest]]
    moves = [_grammar.forms["move"].match(line) for line in complete]
    intervals = [_grammar.forms["interval"].match(line) for line in complete]
    assert lines.is_move.tolist() == [
        *(bool(move and in_full(move.groups())) for move in moves),
        *(False for _ in rest),
    ]
    reported = [int(interval[1]) if interval else 0 for interval in intervals]
    assert lines.interval.tolist() == [*(ms if ms <= LONGEST else 0 for ms in reported), *(0 for _ in rest)]
    expected = [[float(number) for number in move.groups()] for move in moves if move and in_full(move.groups())]
    np.testing.assert_array_equal(lines.values.reshape(-1, 12), np.array(expected).reshape(-1, 12))


def some_lines(rng, word, count=12):
    """Moves with other decimals on each line, and intervals."""
    text = []
    for _ in range(count):
        if rng.random() < 0.4:
            text.append(f"{word}{rng.integers(1, 10 ** rng.integers(1, 6))}\n")
        first, second = rng.integers(1, 10, 2)
        length = rng.normal(scale=10.0 ** rng.integers(-2, 5, 6))
        speed = rng.normal(scale=10.0 ** rng.integers(-2, 4, 6))
        axes = zip("ABCUVW", length, speed, strict=True)
        text.append(" ".join(f"{letter}{at:.{first}f}:{how:.{second}f}" for letter, at, how in axes) + "\n")
    return "".join(text)


def mutated(text, rng):
    """The text with a character changed, put in, taken out, or exchanged with its neighbour."""
    place, new = rng.integers(len(text)), CHARACTERS[rng.integers(len(CHARACTERS))]
    ways = [
        text[:place] + new + text[place + 1 :],
        text[:place] + new + text[place:],
        text[:place] + text[place + 1 :],
        text[:place] + text[place : place + 2][::-1] + text[place + 2 :],
    ]
    return ways[rng.integers(len(ways))]


@pytest.mark.parametrize("name", GRAMMARS)
@hypothesis_settings(derandomize=True, deadline=None)
@given(strategies.integers(0, 2**32 - 1), strategies.integers(0, 30))
def test_lines_are_judged_as_their_forms_judge_them(name, seed, mutations):
    rng = np.random.default_rng(seed)
    text = some_lines(rng, GRAMMARS[name].forms["interval"].name)
    for _ in range(mutations):
        text = mutated(text, rng)
    assert_as_one_by_one(text, GRAMMARS[name])


@pytest.mark.parametrize("name", GRAMMARS)
def test_every_place_of_a_line_with_every_character(name):
    _grammar = GRAMMARS[name]
    word = _grammar.forms["interval"].name
    for line in ("A1009.941772:-65.2572 B0.5:0.0 C9.68:57.04 U1.7:28.2 V1008.753379:2.5 W1.9:-0.1", f"{word}63"):
        text = "".join(
            f"{line[:place]}{new}{line[place + dropped :]}\n"
            for place in range(len(line) + 1)
            for new in CHARACTERS
            for dropped in (0, 1)
        )
        assert_as_one_by_one(text, _grammar)


@pytest.mark.parametrize(
    "line",
    [
        "A1.5:0.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 5W1.5:0.0",
        "5A1.5:0.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.0",
        "A1.5:0.0- B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.0",
        "A1.5:0.0 -B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.0",
        "A1.5:0.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.",
        "A1.5:0.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:",
        "B1.5:0.0 A1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.0",
        "A1.5:0.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0",
        "A1:5.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.0",
        "A1234567890123456.5:0.0 B1.5:0.0 C1.5:0.0 U1.5:0.0 V1.5:0.0 W1.5:0.0",
        "P1VT20",
        "1PVT20",
        "PVT-20",
        "PVT020",
        "PVT",
        "PVT20.0",
        "PVT4096",
    ],
)
def test_a_line_that_looks_like_another_is_not_taken(line):
    lines = found(f"{line}\n" * 3, GRAMMARS["turbo"])
    assert not lines.is_move.any()
    assert not lines.interval.any()


MOVE = "A1.5:0.5 B1.5:0.5 C1.5:0.5 U1.5:0.5 V1.5:0.5 W1.5:0.5\n"


def pattern(letters):
    return found(
        "".join({"m": MOVE, "i": "PVT20\n", "j": "PVT30\n", "x": "DWELL0\n"}[letter] for letter in letters),
        GRAMMARS["turbo"],
    )


@pytest.mark.parametrize(
    ("letters", "alone"),
    [
        ("", []),
        ("x", [0]),
        ("m", [0]),
        ("i", [0]),
        ("mmmm", [0]),
        ("imimm", [0, 1]),
        ("mimi", [0, 3]),
        ("mijm", [0, 1, 2, 3]),
        ("mxmm", [0, 1, 2]),
        ("ximmjmxx", [0, 1, 2, 6, 7]),
    ],
)
def test_lines_to_be_read_by_themselves_are_all_but_moves_behind_a_move(letters, alone):
    runs = list(pattern(letters).runs())
    assert [row for row, _ in runs] == alone
    assert [end for _, end in runs] == [*alone[1:], len(letters)][: len(alone)]


def test_each_move_takes_the_time_reported_last():
    values, intervals = pattern("mmimmjm").moves(1, 7, 7)
    assert intervals.tolist() == [7, 20, 20, 30]
    assert values.shape == (4, 6, 2)
    assert pattern("mimjm").moves(1, 3, 7)[1].tolist() == [20]
