# SPDX-License-Identifier: LGPL-2.1-or-later
"""2D compensation of programs that make no sense: an answer or diagnostics, and never anything else."""

import itertools

import numpy as np
import pytest
from programs import program
from series import cases

from pkm_post.model import Event, EventKind, Kind, Program
from pkm_post.model.diagnostics import errors
from pkm_post.toolpath.compensation.contour_offset import offset_contours
from pkm_post.toolpath.compensation.offset_options import OffsetOptions

MICRON = 1e-3


def anything(rng) -> Program:
    """Lines, arcs, rapids and rows that stand still on a coarse grid, with compensation that comes and goes."""
    count = int(rng.integers(1, 30))
    position = np.column_stack([rng.integers(-4, 5, (count, 2)) * 7.0, rng.choice([0.0, -2.0], count)])
    stays = np.flatnonzero(rng.random(count) < 0.2)
    position[stays, :2] = position[np.maximum(stays - 1, 0), :2]
    kind = rng.choice([Kind.RAPID, Kind.LINE, Kind.LINE, Kind.LINE, Kind.ARC], count)
    kind[0] = Kind.RAPID
    centre, axis = np.full((count, 3), np.nan), np.full((count, 3), np.nan)
    for row in np.flatnonzero(kind == Kind.ARC):
        way = position[row] - position[row - 1]
        aside = np.array([-way[1], way[0], 0.0]) * rng.choice([0.0, 0.5, -2.0])
        middle = (position[row] + position[row - 1]) / 2 + aside
        centre[row] = middle if np.any(way[:2]) else position[row] + [rng.choice([2.0, 20.0]), 0.0, 0.0]
        axis[row] = [0.0, 0.0, rng.choice([-1.0, 1.0])]
    side = np.repeat(rng.choice([0.0, 3.0, -3.0, 1.0], count), rng.integers(1, 9, count))[:count]
    events = tuple(Event(int(row), EventKind.DWELL, 1.0) for row in sorted(rng.integers(0, count + 1, 3)))
    made = program(position, kind=kind, centre=centre, turn=axis, events=events)
    return Program(**{**vars(made), "side_offset": side})


def radii(moved, row):
    centre, axis = moved.arc_centre[row], moved.arc_axis[row]
    return [np.linalg.norm(np.cross(moved.position[i] - centre, axis)) for i in (row - 1, row)]


@pytest.mark.slow
@pytest.mark.parametrize(("corners", "swallowed"), list(itertools.product(("chord", "arc"), ("refuse", "remove"))))
def test_an_answer_or_diagnostics(corners, swallowed):
    answered = 0
    for seed in range(cases(60)):
        given = anything(np.random.default_rng(seed))
        moved, faults = offset_contours(given, OffsetOptions(corners, "B", swallowed))
        assert (moved is None) == bool(errors(faults))
        assert all(fault.place.line in given.line for fault in faults)
        if moved is None:
            continue
        assert np.isfinite(moved.position).all()
        assert not moved.side_offset.any()
        assert np.all(np.diff(moved.line) >= 0)
        rows = [event.row for event in moved.events]
        assert rows == sorted(rows)
        assert all(0 <= row <= len(moved) for row in rows)
        for row in np.flatnonzero(moved.kind == Kind.ARC):
            assert np.ptp(radii(moved, row)) < MICRON
        answered += given.side_offset.any()
    assert answered > 10


def test_a_program_in_which_nothing_moves_stays():
    given = program(np.zeros((3, 3)))
    moved, faults = offset_contours(Program(**{**vars(given), "side_offset": np.full(3, 5.0)}))
    assert faults == ()
    np.testing.assert_array_equal(moved.position, given.position)
    assert not moved.side_offset.any()
