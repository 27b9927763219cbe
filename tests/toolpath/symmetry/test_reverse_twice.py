# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random programs with leads, tilted tools and retracts that turn the axis: a plunge keeps its feed, twice is once."""

import functools

import numpy as np
import pytest
from programs import program

from pkm_post.geometry import norm
from pkm_post.geometry.vectors import dot, unit
from pkm_post.model import Kind
from pkm_post.toolpath.symmetry.passes import displacements, pass_rows
from pkm_post.toolpath.symmetry.reverse import reversed_passes
from pkm_post.toolpath.symmetry.transform import mirror, transform

ROUNDING = 1e-9
CLEAR, SAFE = 60.0, 40.0
PLUNGE, LIFT, LEAD, CUT = 5.0, 20.0, 12.0, 30.0
RAPID = np.nan
Z = np.array([0.0, 0.0, 1.0])
COLUMNS = ("kind", "position", "tool_axis", "feed", "normal", "side_offset")


def on_plane(tip, axis, height):
    """Where the tip comes along its axis to a plane."""
    return tip + (height - tip[2]) / axis[2] * axis


def tilted(rng, most=0.4):
    return unit(Z + rng.uniform(-most, most, 3) * [1, 1, 0])


def cut(rng, axes):
    """Poses of a pass, with leads in and out at a feed of their own."""
    tips = np.cumsum(rng.normal(scale=8.0, size=(len(axes), 3)) * [1, 1, 0.2], axis=0)
    for end, beside in ((0, 1), (-1, -2)):
        across = axes[end] + axes[beside]
        tips[end] -= dot(tips[end] - tips[beside], across) / dot(across, across) * across
    feeds = [LEAD, *[CUT] * (len(axes) - 3), LEAD]
    return tips + rng.uniform(-20, 20, 3) * [1, 1, 0.2], feeds


def steady(rng):
    """The axis of a whole program, upright or tilted."""
    axis = Z if rng.random() < 0.5 else tilted(rng)
    return lambda count: np.tile(axis, (count, 1))


def turning(rng):
    """Axes that turn along each pass."""

    def axes(count):
        share = np.linspace(0, 1, count)[:, None]
        return unit((1 - share) * tilted(rng) + share * tilted(rng))

    return axes


def planes(rng):
    """CAM's heights: rapid to a plane, plunge, and a lift that stops at planes as well, or does not."""
    stop = rng.random() < 0.5

    def down(tip, axis):
        return [
            (on_plane(tip, axis, CLEAR), axis, RAPID),
            (on_plane(tip, axis, SAFE), axis, RAPID),
            (tip, axis, PLUNGE),
        ]

    def up(tip, axis):
        stops = [on_plane(tip, axis, SAFE)] if stop else []
        return [(each, axis, RAPID) for each in (*stops, on_plane(tip, axis, CLEAR))]

    return down, up


def distance(rng, resting=False):
    """A plunge from one distance and a lift to another one, at feed or rapid; the tool may stand up in place."""
    begin, end, feed = rng.uniform(1, 4), rng.uniform(1, 4), rng.choice([LIFT, RAPID])

    def down(tip, axis):
        above = on_plane(tip, axis, CLEAR)
        stand = [(above, Z, RAPID)] if resting else []
        return [*stand, (above, axis, RAPID), (tip + begin * axis, axis, RAPID), (tip, axis, PLUNGE)]

    def up(tip, axis):
        above = on_plane(tip, axis, CLEAR)
        first = [] if np.isnan(feed) else [(tip + end * axis, axis, feed)]
        return [*first, (above, axis, RAPID), *([(above, Z, RAPID)] if resting else [])]

    return down, up


def standing_up(rng):
    return distance(rng, resting=True)


def swinging(rng):
    """A retract that turns the tool upright while it goes up, straight from the pass or after a lift."""
    begin, lift = rng.uniform(1, 4), rng.choice([0.0, 5.0])

    def down(tip, axis):
        return [(tip + [0, 0, 45], Z, RAPID), (tip + begin * axis, axis, RAPID), (tip, axis, PLUNGE)]

    def up(tip, axis):
        return [*([(tip + lift * axis, axis, RAPID)] if lift else []), (tip + [0, 0, 45], Z, RAPID)]

    return down, up


def slanted(rng):
    """A leaning tool that is plunged and lifted upright, at feeds of their own, as three axes do."""
    begin, feed = rng.uniform(3, 8), rng.choice([LIFT, PLUNGE])

    def down(tip, axis):
        return [(tip + 40 * Z, axis, RAPID), (tip + begin * Z, axis, RAPID), (tip, axis, PLUNGE)]

    def up(tip, axis):
        return [(tip + begin * Z, axis, feed), (tip + 40 * Z, axis, RAPID)]

    return down, up


KINDS = {
    "planes": (steady, planes),
    "distance, steady": (steady, distance),
    "distance, turning": (turning, distance),
    "standing up": (turning, standing_up),
    "swinging": (turning, swinging),
    "slanted": (turning, slanted),
}


def random_program(rng, kind):
    axes_of, leads_of = (part(rng) for part in KINDS[kind])
    down, up = leads_of
    rows = []
    for _ in range(rng.integers(2, 5)):
        axes = axes_of(int(rng.integers(4, 8)))
        tips, feeds = cut(rng, axes)
        rows += [*down(tips[0], axes[0]), *zip(tips[1:], axes[1:], feeds, strict=True), *up(tips[-1], axes[-1])]
    tip, axis, feed = (np.array(column) for column in zip(*rows, strict=True))
    return program(tip, axis, kind=np.where(np.isnan(feed), Kind.RAPID, Kind.LINE), feed=feed)


@functools.cache
def reversed_program(kind, seed):
    """A random program and what comes of it when its passes are reversed, once for all that is asked of them."""
    made = random_program(np.random.default_rng([seed, list(KINDS).index(kind)]), kind)
    return made, *reversed_passes(made)


def mirrored_climbing(made, matrix):
    """A copy in a mirror with Keep climb."""
    turned, faults = reversed_passes(transform(made, matrix)[0])
    assert turned is not None, faults
    return turned


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(60))
def test_mirrored_twice_with_climb_kept_is_the_original(kind, seed):
    rng = np.random.default_rng([seed, list(KINDS).index(kind)])
    made = random_program(rng, kind)
    matrix = mirror(rng.uniform(-20, 20, 3), rng.normal(size=3) * [1, 1, 0])
    twice = mirrored_climbing(mirrored_climbing(made, matrix), matrix)
    for name in COLUMNS:
        np.testing.assert_allclose(getattr(twice, name), getattr(made, name), atol=ROUNDING, err_msg=name)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(60))
def test_what_comes_down_to_a_pass_has_the_feed_of_the_plunge(kind, seed):
    made, once, faults = reversed_program(kind, seed)
    assert once is not None, faults
    feeds = {PLUNGE, LIFT, LEAD, CUT}
    assert set(once.feed[np.isfinite(once.feed)].tolist()) <= feeds
    cuts = [tuple(point) for point in np.round(made.position[np.isin(made.feed, (LEAD, CUT))], 6).tolist()]
    begins = [
        row for row in range(1, len(once)) if once.feed[row] in (LEAD, CUT) and once.feed[row - 1] not in (LEAD, CUT)
    ]
    assert len(begins) == len(pass_rows(made))
    assert once.feed[np.array(begins) - 1].tolist() == [PLUNGE] * len(begins)
    assert {*map(tuple, np.round(once.position[np.isin(once.feed, (LEAD, CUT))], 6).tolist())} & {*cuts}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(60))
def test_no_rapid_move_comes_nearer_to_a_pass_than_one_did(kind, seed):
    made, once, _ = reversed_program(kind, seed)

    def nearest(each):
        rapid = np.isnan(each.feed)
        down = np.flatnonzero(rapid[:-1] & ~rapid[1:] & (dot(displacements(each), each.tool_axis)[:-1] < -ROUNDING))
        begins = [row + 1 + int(np.argmax(np.isin(each.feed[row + 1 :], (LEAD, CUT)))) - 1 for row in down]
        return norm(each.position[down] - each.position[begins])

    assert len(nearest(once)) == len(nearest(made))
    if kind != "planes":
        assert nearest(once).min() >= nearest(made).min() - ROUNDING
    else:
        heights = [dot(each.position, each.tool_axis)[np.isnan(each.feed)].min() for each in (once, made)]
        assert heights[0] >= heights[1] - ROUNDING
