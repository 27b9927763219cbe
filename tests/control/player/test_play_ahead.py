# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the list is ahead: planning takes as long as a script says, by the clock of player and machine alone.

The bound comes from the formula by hand: what is asked for at the lead is in the list when half of it is over, and the
two intervals of the controller are left even behind one piece that adds nothing.
"""

import itertools
import random

import numpy as np
import pytest
from behind_links import PlannedInStep
from playing import RECTANGLE, Playing, trajectory_of

from pkm_post.control.player import sections
from pkm_post.control.player.certified_motion import LONGEST_MS
from pkm_post.control.player.orders import Ahead, PathProgress
from pkm_post.control.player.run_to_rest import Timing
from pkm_post.model import Event, EventKind

SLOW = 8.0
"""mm/s: the rectangle takes twelve seconds."""


class WireClock:
    def __init__(self, wire):
        self.now = wire.clock


def played(trajectory, takes, answer_s=0.002, **choices):
    """A play in which planning takes what a script says, in the background; each answer of the controller some time."""
    playing = Playing.of(trajectory)
    playing.wire.delay = lambda: answer_s
    done = playing.play(planning=PlannedInStep(WireClock(playing.wire), takes), **choices)
    playing.check()
    assert done.finished and done.log.holds and playing.arrived() < 1e-3
    return playing, done


def least_ahead(playing):
    """Least motion that the list had, in s, while more was to come."""
    states = [state for state in playing.states if state.phase == "runs"]
    begun = next(n for n, state in enumerate(states) if state.ahead)
    last = max(n for n, (one, other) in enumerate(itertools.pairwise(states)) if other.ahead > one.ahead)
    return min(state.ahead for state in states[begun : last + 1])


def drawn(least, most, seed):
    chance = random.Random(seed)
    return lambda: chance.uniform(least, most)


def scripted(times, at_last, each=6):
    """Each time so often, and the last one from then on."""
    script = itertools.chain(np.repeat(times, each), itertools.repeat(at_last))
    return lambda: next(script)


def every(count, long, short):
    """A long planning among so many."""
    calls = itertools.count(1)
    return lambda: short if next(calls) % count else long


@pytest.mark.slow
@pytest.mark.parametrize(
    ("takes", "answer_s"),
    [
        (lambda: 0.35, 0.002),
        (drawn(0.1, 0.35, 1), 0.002),
        (drawn(0.1, 0.35, 2), 0.05),
        (scripted([0.1, 0.19, 0.36, 0.68], 1.0), 0.002),
        (every(16, 0.5, 0.2), 0.01),
    ],
    ids=["steady", "drawn", "slow link", "ever slower", "now and then"],
)
def test_the_motion_does_not_rest_while_planning_keeps_to_twice_its_longest(takes, answer_s):
    playing, done = played(trajectory_of(RECTANGLE, feed=SLOW), takes, answer_s)
    assert done.stops == 0
    assert least_ahead(playing) >= LONGEST_MS / 1000


@pytest.mark.slow
def test_ends_of_sections_do_not_use_up_the_lead(monkeypatch):
    monkeypatch.setattr(sections, "BLOCK_ROWS", 48)
    monkeypatch.setattr(sections, "_CHOICE", 8)
    x = np.linspace(0, 60, 200)
    wave = trajectory_of(np.column_stack([x, np.sin(x / 6), 80 + np.cos(x / 5)]), feed=10.0)
    playing, done = played(wave, drawn(0.2, 0.35, 3))
    assert done.stops == 0 and least_ahead(playing) >= LONGEST_MS / 1000


@pytest.mark.slow
def test_a_list_without_room_for_the_lead_is_kept_full():
    x = np.linspace(0, 60, 200)
    wave = trajectory_of(np.column_stack([x, np.sin(x / 6), 80 + np.cos(x / 5)]), feed=30.0)
    _, done = played(wave, lambda: 0.3, first_variable=6000)
    assert done.stops == 0


@pytest.mark.slow
def test_a_planning_beyond_the_lead_rests_once_and_is_counted_on_from_then_on():
    slower = [0.1] * 10 + [3.0] + [0.1] * 5 + [1.4] + [0.1] * 5 + [1.4]
    _, done = played(trajectory_of(RECTANGLE, feed=SLOW), scripted(slower, 0.1, each=1))
    assert done.stops == 1


def test_lead_and_length_of_pieces_follow_the_longest_times():
    timing = Timing()
    assert (timing.lead_s, timing.piece_ms) == (0.25 + 0.256, 250)
    timing.planning.extend([0.3, 0.2])
    timing.sending.extend([0.05, 0.1])
    assert (timing.lead_s, timing.piece_ms) == (pytest.approx(2 * 0.4 + 0.256), 850)
    timing.planning.extend([0.01] * 63)
    assert timing.lead_s == pytest.approx(2 * 0.3 + 0.256)
    timing.planning.append(9.0)
    assert timing.piece_ms == 2000


@pytest.mark.slow
def test_the_time_that_is_left_has_corners_and_limits_of_the_machine():
    steps = np.arange(1, 61)
    stairs = trajectory_of(np.column_stack([steps // 2, (steps + 1) // 2, 0 * steps + 80]) * [1.5, 1.5, 1.0], feed=80.0)
    seen = []

    def note(player):
        seen.append((playing.wire.now, playing.states[-1]))

    playing = Playing.of(stairs, at={number: [note] for number in range(9, 240, 8)})
    assert playing.play(override=0.8).finished
    found = [(playing.wire.now - at, state) for at, state in seen if state.row >= 25]  # row 0 is a long way there
    assert len(found) > 10
    for left, state in found:
        assert state.remaining == pytest.approx(left, abs=0.12 * left + 0.06)
    left, state = found[0]
    assert state.to_go / 80.0 / 0.8 < 0.4 * left  # by the programmed feed alone
    assert seen[-1][1].remaining == seen[-1][1].ahead  # all is planned


def test_dwells_that_are_to_come_are_in_the_time_that_is_left():
    made = trajectory_of(events=(Event(2, EventKind.DWELL, 7.0),))
    way = PathProgress(made)
    before, behind = (way.state(None, "rests", 0.5, 0.0, Ahead(), row).remaining for row in (0, 2))
    assert before == pytest.approx(7.0 + 2 * (made.length / made.feed).sum())
    assert behind == pytest.approx(2 * made.length[2] / made.feed[2])
