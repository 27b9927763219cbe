# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories played on the simulated controller; whatever happens, the tool stays on the path."""

import itertools
import logging
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from bad_luck import by_chance
from playing import BOTH, JUMPING, RECTANGLE, SETTINGS, TOLERANCES, Playing, distance, trajectory_of
from rig import Wire

from pkm_post.control.link import run, stopping
from pkm_post.control.link.errors import LinkLostError, NotReadyError, PmacError
from pkm_post.control.player import stop_events
from pkm_post.control.player.knot_list import Layout
from pkm_post.control.player.operator_input import LOWEST_OVERRIDE, OperatorInput
from pkm_post.control.player.orders import Order, PlayOptions
from pkm_post.control.player.run_to_rest import RunToRest
from pkm_post.control.simulator import function_programs
from pkm_post.geometry import norm
from pkm_post.model import Event, EventKind


@pytest.mark.slow
@BOTH
def test_a_program_is_played_without_rests(machine):
    playing = Playing.of(machine=machine)
    done = playing.play()
    assert done.finished and done.log.holds and (done.stops, done.losses) == (0, 0)
    playing.check()
    assert playing.arrived() < 1e-3
    state = playing.states[0]
    assert f" mm, {state.remaining:.0f} s to go; 100%" in str(state)
    assert f": {state.to_go:.1f} mm to go; 0%" in str(replace(state, override=0.0, remaining=np.inf))
    to_go = [state.to_go for state in playing.states]
    assert to_go == sorted(to_go, reverse=True) and to_go[-1] < 1e-3
    assert {state.line for state in playing.states} == {1, 2, 3}


@pytest.mark.slow
@BOTH
def test_overrides_up_to_150_a_hold_and_an_override_of_zero(machine):
    orders = {
        5: [Order("override", 1.5)],
        20: [Order("hold")],
        21: [Order("resume")],
        30: [Order("override", 0.0)],
        90: [Order("override", 0.6)],
        100: [Order("override", 9.0)],
    }
    playing = Playing.of(trajectory_of(RECTANGLE), at=orders, machine=machine)
    done = playing.play(first_variable=7600)  # 41 points, which are written again and again
    playing.check()
    assert done.finished and done.log.holds and playing.arrived() < 1e-3 and not orders
    held = "held" in {state.phase for state in playing.states}
    assert held == (machine is JUMPING)  # a planned stop that is resumed before it begins is not taken
    assert max(state.override for state in playing.states) == 1.5
    assert max(state.reached for state in playing.states if state.line > 1) > 1.2


@pytest.mark.slow
@BOTH
def test_a_resume_of_what_is_not_held_is_refused_and_the_play_goes_on(machine, caplog):
    """While it runs, at M0, and twice after a hold."""
    orders = {state: [Order("resume")] for state in (5, 20, 60)} | {30: [Order("hold")], 40: [Order("resume")] * 2}
    playing = Playing.of(trajectory_of(RECTANGLE, events=(Event(1, EventKind.STOP, 0.0),)), at=orders, machine=machine)
    playing.answer = lambda player: [player.order(Order(kind)) for kind in ("resume", "start")]
    done = playing.play()
    playing.check()
    assert done.finished and done.log.holds and playing.arrived() < 1e-3 and not orders
    assert [record.message for record in caplog.records if "no program is held" in record.message]


@pytest.mark.slow
@BOTH
def test_a_planner_that_is_too_late_ends_in_a_stop_on_the_path(machine):
    calls = itertools.count()
    playing = Playing.of(machine=machine)
    done = playing.play(delay=lambda: 1.5 if next(calls) in (4, 5) else 0.0)
    playing.check()
    assert done.finished and done.stops >= 1 and playing.arrived() < 1e-3


@pytest.mark.slow
def test_a_list_too_short_for_so_slow_a_planner_is_started_when_it_is_full():
    playing = Playing.of(trajectory_of(RECTANGLE))
    done = playing.play(delay=lambda: 1.2, first_variable=7600)
    playing.check()
    assert done.finished and playing.arrived() < 1e-3


def test_a_list_too_short_for_a_piece_and_its_stop_is_refused():
    with pytest.raises(ValueError, match="expected room for 32 points"):
        Layout(8000)
    asked = []
    motion = SimpleNamespace(struts=SimpleNamespace(time_ms=np.array([0, 250])))
    piece = SimpleNamespace(size=50, motion=motion)
    planner = SimpleNamespace(next_piece=lambda *arguments: asked.append(arguments[-1]) or piece)
    feed, session, operator = (
        SimpleNamespace(capacity=41),
        SimpleNamespace(now=lambda: 0.0),
        OperatorInput(PlayOptions()),
    )
    run = RunToRest(session, feed, planner, None, operator, None)
    with pytest.raises(PmacError, match="41 points, a piece and its stop take 50: choose lower --variables"):
        run._next_piece(None, 250)
    assert asked == [250, 90, 40]


@pytest.mark.slow
def test_an_end_takes_the_stop_of_a_piece_near_by():
    given = []
    orders = {20: [lambda _: given.append(len(playing.lengths)), Order("end")]}
    playing = Playing.of(trajectory_of(RECTANGLE, feed=30.0), at=orders)
    done = playing.play()
    playing.check()
    moves = np.flatnonzero(np.abs(np.diff(playing.struts(), axis=0)).max(axis=1) > 1e-9)
    assert not done.finished and done.stops == 0 and done.log.holds
    assert moves[-1] - given[0] < 1000 * playing.states[19].ahead  # the last stop begins there


@pytest.mark.slow
@BOTH
def test_a_stop_that_is_not_wanted_any_more_is_not_taken(machine):
    seen = []
    orders = {26: [Order("override", 0.0)], 28: [lambda player: seen.append(player._feed._early is not None)]}
    orders[28].append(Order("override", 1.0))
    playing = Playing.of(trajectory_of(RECTANGLE, feed=30.0), at=orders, machine=machine)
    done = playing.play()
    playing.check()
    assert seen == [True] and done.finished and done.stops == 0 and playing.arrived() < 1e-3
    assert {state.phase for state in playing.states[5:-1]} == {"runs"}


@pytest.mark.slow
@pytest.mark.parametrize("back", range(29, 45, 3))
def test_a_stop_that_was_asked_for_is_not_counted_as_late(back):
    """Undone too late or in time: nothing came too late, since every plan is there when it is asked for."""
    orders = {26: [Order("override", 0.0)], back: [Order("override", 1.0)]}
    playing = Playing.of(trajectory_of(RECTANGLE, feed=30.0), at=orders)
    done = playing.play()
    playing.check()
    assert done.finished and done.stops == 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", (*range(6), 11))
def test_bad_luck(seed):
    by_chance(seed)


@pytest.mark.slow
@BOTH
@pytest.mark.parametrize("at", (18_000, 24_000))
def test_a_link_that_is_cut_and_comes_back(at, machine):
    playing = Playing.of(cut_at=at, machine=machine)
    done = playing.play()
    playing.check()
    assert done.finished and playing.arrived() < 1e-3


@pytest.mark.slow
def test_a_link_that_is_cut_for_good_ends_in_a_stop_on_the_path():
    playing = Playing.of(cut_at=22_000, mends=False)
    with pytest.raises(LinkLostError):
        playing.play(patience_s=1.0)
    playing.rest()
    playing.check()
    assert not playing.wire.controller.runs_program() and playing.arrived() > 1.0


def fails(playing):
    """The largest following error becomes a count, which no moving motor keeps."""
    playing.wire.controller.variables.write("I", 311, 1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("happens", "said"),
    [
        (lambda playing: playing.wire.controller.kill(2), "strut 3: in open loop"),
        (fails, "strut 3: following error too large, switched off"),
    ],
)
def test_a_motor_that_fails_on_the_way_is_named(happens, said):
    playing = Playing.of(at={12: [lambda player: happens(playing)]})
    with pytest.raises(PmacError, match=rf"ended from elsewhere in Finish line \d+ \(.*{said}.*\); continue with"):
        playing.play()
    assert playing.wire.controller.systems[0].running is False


@pytest.mark.slow
@BOTH
def test_an_override_above_the_certificate_that_another_client_sets_is_held(machine):
    at = {12: [lambda player: playing.wire.controller.systems[0].set_override(150.0)]}
    playing = Playing.of(at=at, machine=machine)
    said = r"the override is 1\d\d\S* % in Finish line \d+, set from elsewhere: .* at most 100 %; the machine is held"
    with pytest.raises(PmacError, match=said):
        playing.play()
    system, log = playing.wire.controller.systems[0], playing.player.log
    assert system.holding and system.override == 0.0 and 100 < log.override < 115
    assert not log.holds and all(finding.holds for finding in log.findings)
    off = distance(playing.tips(), np.vstack([playing.trajectory.start_tip, playing.trajectory.tip]))
    assert off.max() < TOLERANCES.tip and playing.arrived() > 1.0


@pytest.mark.slow
def test_an_override_below_is_only_slower():
    playing = Playing.of(at={12: [lambda player: playing.wire.controller.systems[0].set_override(60.0)]})
    done = playing.play()
    playing.check()
    assert done.finished and done.log.holds and done.log.override == 100.0 and playing.arrived() < 1e-3


@pytest.mark.slow
@BOTH
def test_single_block_rests_at_the_end_of_each_line(machine):
    playing = Playing.of(machine=machine)
    done = playing.play(single_block=True)
    playing.check()
    phases = [phase for phase, _ in itertools.groupby(state.phase for state in playing.states)]
    assert done.finished and phases.count("waits: single block") == 3 and playing.arrived() < 1e-3


@pytest.mark.slow
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


@pytest.mark.slow
def test_the_line_shown_is_never_before_one_that_was_shown():
    """While it waits at M0, the next line is shown; while it prepares that, the line before was."""
    playing = Playing.of(trajectory_of(events=(Event(1, EventKind.STOP, 0), Event(2, EventKind.STOP, 0))))
    assert playing.play(single_block=True).finished
    rows = [state.row for state in playing.states]
    assert rows == sorted(rows) and rows[-1] == len(playing.trajectory) - 1


@pytest.mark.slow
def test_an_m_code_of_the_machine_is_carried_out(monkeypatch):
    monkeypatch.setattr("playing.SETTINGS", replace(SETTINGS, codes=SETTINGS.codes | {"M21": "M21"}))
    playing = Playing.of(trajectory_of(events=(Event(2, EventKind.FUNCTION, 21.0),)))
    playing.wire.controller.load(function_programs([21]))
    assert playing.play().finished and playing.arrived() < 1e-3
    playing.check()
    assert playing.wire.controller.variables.read("P", 7004) == 21


@pytest.mark.slow
@pytest.mark.parametrize("repeats", (False, True))
def test_an_m_code_before_the_first_line_is_repeated_where_that_is_wanted(repeats, monkeypatch):
    monkeypatch.setattr("playing.SETTINGS", replace(SETTINGS, codes=SETTINGS.codes | {"M21": "M21"}))
    playing = Playing.of(trajectory_of(events=(Event(1, EventKind.FUNCTION, 21.0),)))
    playing.wire.controller.load(function_programs([21]))
    assert playing.play(first_row=2, repeat_codes=repeats).finished and playing.arrived() < 1e-3
    assert playing.wire.controller.variables.read("P", 7004) == (21 if repeats else 0)


@pytest.mark.slow
@pytest.mark.parametrize("asked", [1e-300, 1e-11, 0.009])
def test_an_override_that_cannot_be_planned_is_the_lowest_one(asked):
    playing = Playing.of(at={30: [Order("override", asked)], 60: [Order("override", 1.0)]})
    assert playing.play(override=asked).finished
    assert {state.override for state in playing.states} == {LOWEST_OVERRIDE, 1.0}


def during_a_move_by_hand(playing, act):
    """Let something happen when codes or an approach have run for a second."""
    passed, ms = playing.wire.sleep, [0.0]

    def sleep(seconds):
        passed(seconds)
        before = ms[0]
        if playing.wire.controller.runs_program() and playing.states[-1].phase != "runs":
            ms[0] += 1000 * seconds
        if before < 1000 <= ms[0]:
            act()

    playing.wire.sleep = sleep


@pytest.mark.slow
def test_a_code_that_waits_for_a_person_takes_as_long_as_it_takes(monkeypatch):
    """A tool changed by hand; the struts stand, and the link lives: no limit of time applies."""
    monkeypatch.setattr(stop_events, "_LONGEST_S", 1.0)
    monkeypatch.setattr("playing.SETTINGS", replace(SETTINGS, codes=SETTINGS.codes | {"M21": "M21"}))
    playing = Playing.of(trajectory_of(events=(Event(1, EventKind.FUNCTION, 21.0),)))
    label, *_, end = function_programs([21])[2:]
    assert label == "N21000 P7004=21 RETURN"
    code = ["N21000 P7004=21", "DWELL5000", "RETURN"]
    playing.wire.controller.load(["CLOSE", "OPEN PROG 1001", *code, end])
    done = playing.play()
    assert done.finished and done.log.holds and playing.arrived() < 1e-3
    playing.check()
    stood = np.abs(np.diff(playing.struts(), axis=0)).max(axis=1) < 1e-9
    assert playing.wire.controller.variables.read("P", 7004) == 21 and stood.sum() >= 5000


STOP = Event(1, EventKind.STOP, 0.0)


def held_by_another_client(playing, seconds):
    """Hold a play between two motions from another client, and resume after some seconds; return when both were."""
    other, times = Wire(playing.wire.controller, "tcp", moves=True, line=playing.wire.line), []

    def sleep(seconds):
        other.now += seconds

    def hold():
        with other.session() as session:
            session._sleep = sleep
            status = stopping.hold(session, SETTINGS)
            assert status.standing and not status.running
        times.append(playing.wire.now)

    def look():
        if len(times) == 1 and playing.wire.now > times[0] + seconds:
            times.append(playing.wire.now)
            with other.session() as session:
                assert not run.resume_program(session, SETTINGS).held
                with pytest.raises(NotReadyError, match="no program is held"):
                    run.resume_program(session, SETTINGS)

    passed = playing.wire.sleep
    playing.wire.sleep = lambda seconds: (passed(seconds), look())
    return hold, times


@pytest.mark.slow
@BOTH
@pytest.mark.parametrize("where", ["planning", "M0"])
@pytest.mark.parametrize("resumed", ["here", "there"])
def test_a_hold_of_another_client_between_two_motions_lasts_until_a_resume(where, resumed, machine):
    """Longer than the second in which another motion might begin; a start is none."""
    playing = Playing.of(trajectory_of(events=(STOP,)), machine=machine)
    hold, times = held_by_another_client(playing, 6.0 if resumed == "there" else np.inf)
    ran = []

    def delay():
        if where == "planning" and not times:
            hold()
        return 0.0

    def answer(player):
        if where == "M0" and not times:
            hold()
        player.order(Order("start"))
        if resumed == "here" and times and playing.wire.now > times[0] + 6.0:
            times.append(playing.wire.now)
            player.order(Order("resume"))
        if len(times) == 1 and playing.wire.now > times[0] + 1.0:
            ran.append(playing.wire.controller.runs_program() or np.ptp(playing.lengths[-100:], axis=0).max() > 0)

    playing.answer = answer
    assert playing.play(delay=delay).finished and playing.arrived() < 1e-3
    playing.check()
    assert times[1] > times[0] + 6.0 and len(ran) > 100 and not any(ran)
    assert "waits: hold" in {state.phase for state in playing.states}


DWELL = (Event(1, EventKind.DWELL, 4.0),)


@pytest.mark.slow
@pytest.mark.parametrize("at_once", [False, True])
def test_an_abort_from_elsewhere_while_codes_run_ends_the_play(at_once):
    playing = Playing.of(trajectory_of(events=DWELL))
    during_a_move_by_hand(playing, lambda: stopping.abort(playing.player._session, SETTINGS, at_once))
    with pytest.raises(PmacError, match="codes between two moves were ended from elsewhere"):
        playing.play()
    assert playing.arrived() > 10.0


@pytest.mark.slow
@BOTH
@pytest.mark.parametrize(("events", "row"), [(DWELL, 0), ((), 2)], ids=["codes", "approach"])
def test_a_hold_while_codes_or_an_approach_run_is_immediate_and_lasts_until_the_resume(events, row, machine, caplog):
    playing = Playing.of(trajectory_of(events=events), machine=machine)
    passed, held = playing.wire.sleep, []

    def sleep(seconds):
        passed(seconds)
        if playing.wire.controller.systems[0].holding and len(held) < 2:
            held[:] = held or [playing.wire.now]
            if playing.wire.now - held[0] > 4.0:
                assert np.ptp(playing.lengths[-2000:], axis=0).max() == 0.0  # its deceleration takes a second
                held.append(playing.wire.now)
                playing.player.order(Order("resume"))

    playing.wire.sleep = sleep
    during_a_move_by_hand(playing, lambda: playing.player.order(Order("hold")))
    assert playing.play(first_row=row).finished
    assert playing.arrived() < 1e-3 and held[1:]
    assert [record.message for record in caplog.records if record.message.startswith("held: resume continues")]


def test_an_end_while_a_hold_stands_in_codes_ends_the_play():
    playing = Playing.of(trajectory_of(events=DWELL))
    during_a_move_by_hand(playing, lambda: [playing.player.order(Order(kind)) for kind in ("hold", "end")])
    with pytest.raises(PmacError, match="did not end: held"):
        playing.play()
    assert playing.wire.controller.systems[0].holding


@pytest.mark.slow
def test_a_start_while_codes_run_is_not_for_the_stop_behind_them():
    playing = Playing.of(trajectory_of(events=(*DWELL, Event(1, EventKind.STOP, 0.0))))
    asked = []
    playing.answer = lambda player: asked.append(player.order(Order("start")))
    during_a_move_by_hand(playing, lambda: playing.player.order(Order("start")))
    assert playing.play().finished and asked


@pytest.mark.slow
def test_optional_stops_are_switched_while_it_plays():
    events = (Event(1, EventKind.STOP, 1), Event(2, EventKind.STOP, 1))

    def switch_off(player):
        assert playing.states[-1].phase == "waits: M1"
        player.order(Order("optional", 0.0))

    playing = Playing.of(trajectory_of(events=events), at={5: [Order("optional", 1.0)]})
    playing.answer = switch_off
    assert playing.play().finished
    playing.check()
    phases = [phase for phase, _ in itertools.groupby(state.phase for state in playing.states)]
    assert phases.count("waits: M1") == 1 and playing.arrived() < 1e-3


@pytest.mark.slow
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


def up_then_start(way):
    """An operator who retracts once at each place where the player waits, and then starts."""
    places = set()

    def answer(player):
        place = None if player._point is None else player._point.motion.row[player._point.knot]
        player.order(Order("start") if place in places else Order("retract", way))
        places.add(place)

    return answer


@pytest.mark.slow
def test_a_retract_goes_up_along_the_tool_axis_and_back_before_the_play_goes_on():
    axis = np.array([np.sin(0.1), 0.0, np.cos(0.1)])
    playing = Playing.of(trajectory_of(axis=np.tile(axis, (3, 1))), at={12: [Order("retract", 5.0)]})  # nothing waits
    playing.answer = up_then_start(15.0)
    done = playing.play(single_block=True)
    assert done.finished and done.log.holds and playing.arrived() < 1e-3
    made, tips = playing.trajectory, playing.tips()  # it waits before each of the three blocks
    rests, axes = np.vstack([made.start_tip, made.tip[:-1]]), np.vstack([made.start_axis, axis, axis])
    way = np.stack([rests, rests + 15 * axes, rests], axis=1).reshape(-1, 3)
    assert distance(tips, np.vstack([way, made.tip[-1]])).max() < TOLERANCES.tip
    reached = [norm(tips - rest - 15 * up).min() for rest, up in zip(rests, axes, strict=True)]
    assert max(reached) < 1e-3, reached


@pytest.mark.slow
def test_a_second_retract_adds_to_the_first(caplog):
    playing = Playing.of()
    orders = iter((Order("retract", 15.0), Order("retract", 10.0)))
    playing.answer = lambda player: player.order(next(orders, Order("start")))
    with caplog.at_level(logging.INFO, "pkm_post.control.player"):
        assert playing.play(single_block=True).finished
    said = [record.getMessage().partition(" above its path")[0] for record in caplog.records]
    assert [text for text in said if text.startswith("the tool is ")] == ["the tool is 15 mm", "the tool is 25 mm"]
    assert playing.arrived() < 1e-3


@pytest.mark.slow
def test_a_retract_out_of_reach_is_not_made():
    playing = Playing.of()
    playing.answer = up_then_start(400.0)
    assert playing.play(single_block=True).finished
    playing.check()
