# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories played on the simulated controller; whatever happens, the tool stays on the path."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from bad_luck import by_chance
from playing import RECTANGLE, SETTINGS, Playing, trajectory_of

from pkm_post.control.link import stopping
from pkm_post.control.link.errors import LinkLostError, PmacError
from pkm_post.control.player.knot_list import Layout
from pkm_post.control.player.operator_input import OperatorInput
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.run_to_rest import RunToRest
from pkm_post.model import Event, EventKind


def test_a_program_is_played_without_rests():
    playing = Playing.of()
    done = playing.play()
    assert done.finished and done.log.holds and (done.stops, done.losses) == (0, 0)
    playing.check()
    assert playing.arrived() < 1e-3
    to_go = [state.to_go for state in playing.states]
    assert to_go == sorted(to_go, reverse=True) and to_go[-1] < 1e-3
    assert {state.line for state in playing.states} == {1, 2, 3}


def test_overrides_up_to_150_a_hold_and_an_override_of_zero():
    orders = {
        5: [Order("override", 1.5)],
        20: [Order("hold")],
        21: [Order("resume")],
        30: [Order("override", 0.0)],
        90: [Order("override", 0.6)],
        100: [Order("override", 9.0)],
    }
    playing = Playing.of(trajectory_of(RECTANGLE), at=orders)
    done = playing.play(first_variable=7600)  # 41 points, which are written again and again
    playing.check()
    assert done.finished and done.log.holds and playing.arrived() < 1e-3 and not orders
    assert max(state.override for state in playing.states) == 1.5
    assert max(state.reached for state in playing.states if state.line > 1) > 1.2


def test_a_planner_that_is_too_late_ends_in_a_stop_on_the_path():
    calls = itertools.count()
    playing = Playing.of()
    done = playing.play(delay=lambda: 1.5 if next(calls) in (4, 5) else 0.0)
    playing.check()
    assert done.finished and done.stops >= 1 and playing.arrived() < 1e-3


def test_a_list_too_short_for_so_slow_a_planner_is_started_when_it_is_full():
    playing = Playing.of(trajectory_of(RECTANGLE))
    done = playing.play(delay=lambda: 1.2, first_variable=7600)
    playing.check()
    assert done.finished and playing.arrived() < 1e-3


def test_a_list_too_short_for_a_piece_and_its_stop_is_refused():
    with pytest.raises(ValueError, match="expected room for 32 points"):
        Layout(8000)
    asked = []
    planner = SimpleNamespace(next_piece=lambda *arguments: asked.append(arguments[-1]) or SimpleNamespace(size=50))
    feed, session, operator = (
        SimpleNamespace(capacity=41),
        SimpleNamespace(now=lambda: 0.0),
        OperatorInput(PlayOptions()),
    )
    run = RunToRest(session, feed, planner, None, operator, None)
    with pytest.raises(PmacError, match="41 points, a piece and its stop take 50: choose lower --variables"):
        run._next_piece(None, 250)
    assert asked == [250, 125, 62, 40]


@pytest.mark.parametrize("seed", range(6))
def test_bad_luck(seed):
    by_chance(seed)


@pytest.mark.parametrize("at", (18_000, 24_000))
def test_a_link_that_is_cut_and_comes_back(at):
    playing = Playing.of(cut_at=at)
    done = playing.play()
    playing.check()
    assert done.finished and playing.arrived() < 1e-3


def test_a_link_that_is_cut_for_good_ends_in_a_stop_on_the_path():
    playing = Playing.of(cut_at=22_000, mends=False)
    with pytest.raises(LinkLostError):
        playing.play(patience_s=1.0)
    playing.rest()
    playing.check()
    assert not playing.wire.controller.runs_program() and playing.arrived() > 1.0


def test_single_block_rests_at_the_end_of_each_line():
    playing = Playing.of()
    done = playing.play(single_block=True)
    playing.check()
    phases = [phase for phase, _ in itertools.groupby(state.phase for state in playing.states)]
    assert done.finished and phases.count("waits: single block") == 3 and playing.arrived() < 1e-3


def test_events_between_moves_and_stops_that_wait():
    events = (Event(1, EventKind.SPINDLE, 1000.0), Event(2, EventKind.STOP, 0), Event(3, EventKind.STOP, 1))
    playing = Playing.of(trajectory_of(events=events))
    assert playing.play().finished
    assert playing.wire.controller.variables.read("P", 7001) == 1
    assert {state.phase for state in playing.states if "M" in state.phase} == {"waits: M0"}
    playing = Playing.of(trajectory_of(events=events))
    assert playing.play(optional_stop=True, dry_feed=60.0).finished
    assert playing.wire.controller.variables.read("P", 7001) == 0
    assert {state.phase for state in playing.states if "M" in state.phase} == {"waits: M0", "waits: M1"}


def test_after_an_abort_the_program_goes_on_at_a_line():
    playing = Playing.of(at={40: [lambda player: stopping.abort(player._session, SETTINGS, at_once=True)]})
    with pytest.raises(PmacError, match="ended from elsewhere in Finish line"):
        playing.play()
    row = playing.states[-1].row
    assert playing.arrived() > 1.0
    playing.play(first_row=row)
    assert playing.arrived() < 1e-3
    assert any(state.phase.startswith("waits: T1") for state in playing.states)
    assert np.all([state.row >= row for state in playing.states[-20:]])
