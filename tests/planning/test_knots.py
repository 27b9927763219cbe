# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots: every interval holds, and there are few of them."""

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, program, square_with_arc

from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan_feed
from pkm_post.planning.knots.choice import LONGEST_MS, even_marks, knots
from pkm_post.planning.knots.interpolation import InterpolationCheck
from pkm_post.toolpath.place import place

NO_EDGES = np.array([], dtype=np.int64)
TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
MOST = 1.2
"""Intervals by the least that a search from the left finds (docs/planning.md#knots)."""
DOUBLED, HALVED = 10, 3
"""Widths tried at once: 2 ms to 512 ms, and those that three halvings may come to."""


def by_width(longest):
    """An error that grows with the fourth power of the width, as that of cubics on a smooth path does."""
    return lambda start, end, group=None: ((end - start) / longest) ** 4.0


def test_intervals_are_cut_where_the_error_is_large():
    # An error that grows with the width and is large near 500 ms: knots must crowd there and nowhere else.
    def error(start, end, group=None):
        near = (start <= 500) & (end >= 500)
        return np.where(near, (end - start) / 4, (end - start) / 64)

    found = knots(np.array([0, 1000, 1003]), NO_EDGES, error)
    width = np.diff(found)
    assert {0, 1000, 1003} <= set(found.tolist())
    assert width.max() <= 64 < LONGEST_MS
    assert width[np.searchsorted(found, 500) - 1] <= 4
    assert (error(found[:-1], found[1:]) <= 1).all()


def test_an_error_that_never_holds_ends_at_one_millisecond():
    found = knots(np.array([0, 37]), NO_EDGES, lambda start, end, group=None: np.full(len(start), 2.0))
    np.testing.assert_array_equal(found, np.arange(38))


def test_cuts_are_made_at_edges():
    # A path of straights with short blends: an interval holds when no edge lies inside it.
    edges = np.array([20, 23, 57, 60, 91, 94])

    def error(start, end, group=None):
        return 2.0 * ((edges[:, None] > start) & (edges[:, None] < end)).any(0)

    np.testing.assert_array_equal(knots(np.array([0, 120]), edges, error), [0, *edges, 120])


@pytest.mark.parametrize("longest", [7, 31, 40, 65, 100, 127, 129, 500])
def test_halves_of_halves_are_joined_to_few_intervals(longest):
    found = knots(np.array([0, 4000]), NO_EDGES, by_width(longest))
    assert np.diff(found).max() <= longest
    assert len(found) - 1 <= max(MOST * 4000 / longest, 4000 // longest + 2)


@pytest.mark.parametrize("shortest", [2, 5, 20])
def test_no_interval_becomes_too_short(shortest):
    found = knots(np.array([0, 997, 4000]), np.arange(3, 4000, 17), by_width(1.7 * shortest), shortest)
    assert np.diff(found).min() >= shortest
    assert 997 in found


def test_one_part_does_not_change_another():
    marks, edges = np.array([0, 900, 1000, 4000]), np.array([120, 450, 950, 2222])

    def error(start, end, group=None):
        return (end - start) / np.where(start < 900, 31.0, 77.0)

    whole = knots(marks, edges, error)
    parts = [knots(marks[first : first + 2], edges, error) for first in range(3)]
    np.testing.assert_array_equal(whole, np.unique(np.concatenate(parts)))


def scan():
    x = np.linspace(-40, 40, 201)
    return program(np.column_stack([x, 0 * x, 60 + 2 * np.sin(x / 4)]), feed=40.0)


def pocket():
    """Seven rings: long straights between corners."""
    flat = np.concatenate([[[-r, -r], [r, -r], [r, r], [-r, r], [-r, -r]] for r in np.arange(3.0, 24.0, 3.0)])
    return program(np.column_stack([flat, np.full(len(flat), 60.0)]), feed=10.0)


def fewest(error, marks):
    """Intervals between marks if each is the widest that holds."""
    count = 0
    for first, last in zip(marks[:-1], marks[1:], strict=True):
        at = first
        while at < last:
            at, count = widest(error, at, last), count + 1
    return count


def widest(error, start, last):
    """End of the widest interval that holds, found by doubling and halving; what may come next is tried at once."""
    doubled = np.unique(np.minimum(start + 2 ** np.arange(1, DOUBLED), last))
    fails = np.append(error(np.full(len(doubled), start), doubled) > 1, True)
    first = int(np.argmax(fails))
    least, most = [start + 1, *doubled, last + 1][first : first + 2]
    while most - least > 1:
        tried = np.array(middles(least, most, HALVED))
        holds = dict(zip(tried, error(np.full(len(tried), start), tried) <= 1, strict=True))
        while (middle := (least + most) // 2) in holds and most - least > 1:
            least, most = (middle, most) if holds[middle] else (least, middle)
    return least


def middles(least, most, times):
    """The middle, and those of both halves, and so on: what halving may try."""
    if not times or most - least < 2:
        return []
    middle = (least + most) // 2
    return [*middles(least, middle, times - 1), middle, *middles(middle, most, times - 1)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "made", [cone(60), square_with_arc(), scan(), pocket()], ids=["cone", "arcs", "scan", "pocket"]
)
def test_there_are_little_more_intervals_than_a_search_from_the_left_finds(made):
    trajectory, _ = place(made, example(), ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, example(), TOLERANCES)
    schedule = feed_plan.schedule
    marks = even_marks(schedule.rests_ms)
    check = InterpolationCheck(feed_plan.path, schedule, example(), TOLERANCES, marks)
    found = knots(marks, schedule.edges_ms, check.error)
    wide = np.diff(found) > 1
    assert (check.error(found[:-1][wide], found[1:][wide]) <= 1).all()
    assert len(found) - 1 <= MOST * fewest(check.error, marks)
