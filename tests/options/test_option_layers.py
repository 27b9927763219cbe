# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options of one layer go before those of another one by one; what is shown of an option can be typed again."""

import random
import shlex

import numpy as np
import pytest
from option_examples import ADDED, FLAGS, words

from pkm_post.options import (
    argument_values,
    explicit_values,
    flag_of,
    format_value,
    options_from,
    overridden,
    overrides,
    parse_text,
    tool_lengths_from,
)
from pkm_post.options.choices import Options

ULP = 1e-12
SEEDS = range(20)


def options_of(text):
    return vars(options_from(parse_text(text)))


def same(one, other):
    """Whether options are equal; a work offset may be a matrix, and degrees are radians and back."""
    for name, value in one.items():
        if isinstance(value, np.ndarray | float):
            assert np.allclose(value, other[name], rtol=ULP, atol=ULP), name
        elif name == "spin":
            assert (value.rule, value.objective) == (other[name].rule, other[name].objective)
            assert value.heading == pytest.approx(other[name].heading, abs=ULP)
        else:
            assert value == other[name], name
    return True


def retyped(given):
    """Values as they are shown, typed again."""
    for name, value in given.items():
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, bool):
                yield flag_of(name) if one else flag_of(name).replace("--", "--no-", 1)
            else:
                yield f"{flag_of(name)}={format_value(name, one)}"


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("flag", FLAGS)
def test_what_is_shown_is_what_was_typed(flag, which):
    given = explicit_values(parse_text(shlex.join(words(flag, which))))
    assert len(given) == 1
    assert explicit_values(parse_text(shlex.join(retyped(given)))) == given


def test_defaults_are_not_given():
    assert explicit_values(parse_text("")) == {}
    assert (
        list(
            overrides(explicit_values(parse_text("--tip-tolerance 0.01 --machine a")), explicit_values(parse_text("")))
        )
        == []
    )


@pytest.mark.parametrize("flag", sorted(ADDED))
def test_what_is_added_replaces_nothing(flag):
    job, given = (parse_text(shlex.join(words(flag, which))) for which in (0, 1))
    (name,) = explicit_values(given)
    assert vars(overridden(job, explicit_values(given)))[name] == [*vars(job)[name], *vars(given)[name]]
    assert list(overrides(explicit_values(job), explicit_values(given))) == []


@pytest.mark.parametrize("flag", [flag for flag in FLAGS if flag not in ADDED])
def test_one_option_goes_before_and_all_others_stay(flag):
    job = parse_text(shlex.join([word for each in FLAGS for word in words(each, 0)]))
    given = explicit_values(parse_text(shlex.join(words(flag, 1))))
    (name,) = given
    mixed = vars(overridden(job, given))
    assert mixed[name] == vars(parse_text(shlex.join(words(flag, 1))))[name]
    assert {each for each in mixed if mixed[each] != vars(job)[each]} == {name, "given"}
    (reported,) = overrides(explicit_values(job), given)
    assert reported.flag == flag
    assert list(overrides(explicit_values(job), explicit_values(job))) == []


def test_what_is_said_of_one_tool_leaves_the_others():
    job = parse_text("--tool-length 1=120 --tool-length 2=80 --actual-tool 3=9.5,1")
    given = explicit_values(parse_text("--tool-length 2=85 --tool-length 4=60"))
    assert tool_lengths_from(overridden(job, given)) == {1: 120, 2: 85, 4: 60}
    assert [str(each) for each in overrides(explicit_values(job), given)] == ["--tool-length 2=85 instead of 2=80"]


def test_options_in_place_of_all_take_back_what_they_do_not_say():
    job = explicit_values(parse_text("--actual-tool 3=9.5,1 --also csv --surface-speed 120"))
    reported = [str(each) for each in overrides(job, argument_values(Options()), whole=True)]
    assert sorted(reported) == [
        "--actual-tool none instead of 3=9.5,1",
        "--also none instead of csv",
        "--surface-speed none instead of 120",
    ]


@pytest.mark.parametrize("seed", SEEDS)
def test_options_are_said_as_they_were_typed(seed):
    chance = random.Random(seed)
    chosen = shlex.join(word for flag in FLAGS if chance.random() < 0.6 for word in words(flag, chance.randrange(2)))
    said = argument_values(options_from(parse_text(chosen)))
    again = shlex.join(retyped({name: value for name, value in said.items() if value is not None}))
    assert same(options_of(again), options_of(chosen))


def numbers_in(values):
    for value in values:
        if isinstance(value, list | tuple):
            yield from numbers_in(value)
        elif isinstance(value, float):
            yield value


LETTERS = "=,-. 0179eaxZ'\"\\\u00b5\n"


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_mutated_options_are_refused_or_can_be_typed_again(seed):
    """Text with letters left out, put in and exchanged: never another exception than that of text, never infinity."""
    chance = random.Random(seed)
    refused = understood = 0
    for _ in range(200):
        text = list(shlex.join(words(chance.choice(FLAGS), chance.randrange(2))))
        for _ in range(chance.randrange(3)):
            place = chance.randrange(len(text))
            text[place : place + chance.randrange(2)] = chance.choice(["", chance.choice(LETTERS)])
        try:
            given = explicit_values(parse_text("".join(text)))
        except ValueError:
            refused += 1
            continue
        understood += 1
        assert explicit_values(parse_text(shlex.join(retyped(given)))) == given, "".join(text)
        assert np.isfinite(list(numbers_in(given.values()))).all()
    assert refused and understood
