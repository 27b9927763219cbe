# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sessions with bad luck: some of those that ``make soak`` draws."""

import random

import pytest
import sessions


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_the_machine_rests_or_moves_as_was_certified(seed):
    luck, how = sessions.by_chance(seed)
    assert luck and how


def test_every_kind_of_bad_luck_is_drawn():
    drawn = set()
    for seed in range(40):
        choice = random.Random(seed)
        choice.choice(("serial", "tcp"))
        drawn.add(choice.choice(tuple(sessions._BAD_LUCK)))
    assert drawn == set(sessions._BAD_LUCK)


def test_struts_that_leave_their_path_are_found():
    wire = sessions.machine("tcp")
    assert not wire.line.refusal("#3J:5000")
    with pytest.raises(AssertionError, match="out of step"):
        wire.sleep(1.0)
        sessions._assert_all_is_well(wire)


def test_a_machine_that_goes_on_is_found():
    wire = sessions.machine("tcp")
    assert not wire.line.refusal("&1B10R")
    wire.sleep(1.1)
    with pytest.raises(AssertionError, match="does not rest"):
        sessions.assert_at_rest(wire)
