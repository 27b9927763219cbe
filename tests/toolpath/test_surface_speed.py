# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spindle speeds from the surface speed: worked numbers, limits, and what stays as it was."""

import dataclasses

import numpy as np
import pytest
from programs import program

from pkm_post.model import Event, EventKind, Kind, Tool
from pkm_post.toolpath.surface_speed import SurfaceSpeed, with_surface_speed

WIDE = (0.0, np.inf)
BALL = Tool(1, "ball", 12.0, 6.0, 120.0)
R, L = Kind.RAPID, Kind.LINE


def two_cuts(normals=None, tool=BALL, sense=1.0):
    position = [[0, 0, 30], [0, 0, 0], [10, 0, 0], [10, 0, 30], [20, 0, 30], [20, 0, 0], [30, 0, 0], [30, 0, 30]]
    events = (
        Event(0, EventKind.TOOL_CHANGE, 1),
        Event(0, EventKind.SPINDLE, 5000 * sense),
        Event(8, EventKind.SPINDLE, 0),
    )
    made = program(position, kind=[R, L, L, R, R, L, L, R], events=events, tools={1: tool})
    if normals is not None:
        column = np.full((8, 3), np.nan)
        column[[1, 2, 5, 6]] = np.repeat(normals, 2, axis=0)
        made = dataclasses.replace(made, normal=column)
    return made


def speeds(made):
    return [(event.row, event.value) for event in made.events if event.kind is EventKind.SPINDLE]


def test_without_normals_the_diameter_of_the_tool_counts():
    # 200 m/min on 12 mm: S = 1000 * 200 / (pi 12) = 5305 per minute.
    made, reported = with_surface_speed(two_cuts(), SurfaceSpeed(200_000 / 60), WIDE)
    assert not reported
    assert speeds(made) == [(0, 5305), (8, 0)]


@pytest.mark.parametrize("change", [(), (Event(3, EventKind.TOOL_CHANGE, 1),)], ids=["none", "later"])
def test_before_the_first_tool_change_the_first_tool_counts_as_loaded(change):
    events = (Event(0, EventKind.SPINDLE, 5000), *change, Event(3, EventKind.SPINDLE, 4000))
    made, reported = with_surface_speed(
        dataclasses.replace(two_cuts(), events=events), SurfaceSpeed(200_000 / 60), WIDE
    )
    assert not reported
    assert speeds(made) == [(0, 5305), (3, 5305)]


def test_a_ball_touches_on_its_effective_diameter():
    # Ball of 12 mm: normals at 30 and 90 degrees from the axis touch on 12 sin 30 = 6 mm and on 12 mm.
    normals = [[0.5, 0.0, np.sqrt(0.75)], [1.0, 0.0, 0.0]]
    made, _ = with_surface_speed(two_cuts(normals), SurfaceSpeed(200_000 / 60), WIDE)
    assert speeds(made) == [(0, 10610), (5, 5305), (8, 0)]
    assert (made.feed[1:3] == two_cuts().feed[1:3]).all()


def test_a_bull_nose_touches_outside_its_flat():
    # D 20, r 4: on a wall 20 mm, on a slope of 30 degrees from the axis 2 (6 + 4 sin 30) = 16 mm.
    tool = Tool(1, "bull nose", 20.0, 4.0, 120.0)
    normals = [[0.5, 0.0, np.sqrt(0.75)], [1.0, 0.0, 0.0]]
    made, _ = with_surface_speed(two_cuts(normals, tool), SurfaceSpeed(1000.0), WIDE)
    assert [value for _, value in speeds(made)[:2]] == [round(60000 / (np.pi * 16)), round(60000 / (np.pi * 20))]


def test_near_the_tip_the_speed_is_that_of_a_tenth_of_the_diameter():
    made, _ = with_surface_speed(two_cuts([[0.0, 0.0, 1.0]] * 2), SurfaceSpeed(100.0), WIDE)
    assert speeds(made)[0] == (0, round(6000 / (np.pi * 1.2)))


def test_the_spindle_keeps_its_limits_and_its_sense():
    made, _ = with_surface_speed(two_cuts(sense=-1.0), SurfaceSpeed(200_000 / 60), (1000.0, 4000.0))
    assert speeds(made) == [(0, -4000), (8, 0)]


def test_a_limit_that_is_no_whole_number_is_kept():
    made, _ = with_surface_speed(two_cuts(), SurfaceSpeed(1.0), (1000.6, 4000.0))
    assert speeds(made)[0] == (0, 1000.6)


def test_the_chip_load_of_a_cut_without_spindle_stays():
    made = dataclasses.replace(
        two_cuts(), events=(Event(0, EventKind.TOOL_CHANGE, 1), Event(5, EventKind.SPINDLE, 5000))
    )
    slow, _ = with_surface_speed(made, SurfaceSpeed(100.0, keep_chip_load=True), WIDE)
    assert (slow.feed[1:3] == made.feed[1:3]).all()
    assert (slow.feed[5:7] < made.feed[5:7]).all()


def test_the_chip_load_is_kept():
    normals = [[0.5, 0.0, np.sqrt(0.75)], [1.0, 0.0, 0.0]]
    before = two_cuts(normals)
    made, _ = with_surface_speed(before, SurfaceSpeed(200_000 / 60, keep_chip_load=True), WIDE)
    cuts = [1, 2, 5, 6]
    load = made.feed[cuts] / np.array([10610, 10610, 5305, 5305])
    assert load == pytest.approx(before.feed[cuts] / 5000)
    assert np.isnan(made.feed[[0, 3, 4, 7]]).all()


def test_a_spindle_that_is_off_stays_off():
    made = dataclasses.replace(two_cuts(), events=(Event(0, EventKind.TOOL_CHANGE, 1),))
    assert speeds(with_surface_speed(made, SurfaceSpeed(1000.0), WIDE)[0]) == []


def test_an_unknown_corner_matters_only_where_normals_say_where_it_touches():
    unknown = dataclasses.replace(BALL, corner_radius=0.0, corner_known=False)
    wanted = SurfaceSpeed(200_000 / 60)
    assert with_surface_speed(two_cuts(tool=unknown), wanted, WIDE)[0] is not None
    made, reported = with_surface_speed(
        two_cuts([[0.5, 0.0, np.sqrt(0.75)], [1.0, 0.0, 0.0]], tool=unknown), wanted, WIDE
    )
    assert made is None
    assert [fault.code for fault in reported] == ["N117"]


def test_a_tool_of_unknown_diameter_is_refused():
    made, reported = with_surface_speed(two_cuts(tool=dataclasses.replace(BALL, diameter=0.0)), SurfaceSpeed(1.0), WIDE)
    assert made is None
    assert [fault.code for fault in reported] == ["N109"]


def test_two_tools_in_one_motion_have_a_speed_each():
    # 1 m/s on 12 and 6 mm: 60000 / (pi 12) = 1592 and 60000 / (pi 6) = 3183 per minute.
    tools = {1: BALL, 2: dataclasses.replace(BALL, number=2, diameter=6.0, corner_radius=3.0)}
    kinds = EventKind.TOOL_CHANGE, EventKind.SPINDLE
    events = tuple(Event(row, kinds[kind], value) for row, kind, value in [(0, 0, 1), (0, 1, 9), (2, 0, 2), (2, 1, 9)])
    before = program([[0, 0, 30], [0, 0, 0], [10, 0, 0], [30, 0, 0]], events=events, tools=tools)
    made, reported = with_surface_speed(before, SurfaceSpeed(1000.0), WIDE)
    assert not reported
    assert speeds(made) == [(0, 1592), (2, 3183)]


def test_a_program_without_cuts_stays():
    before = dataclasses.replace(two_cuts(), kind=np.full(8, R))
    made, reported = with_surface_speed(before, SurfaceSpeed(1000.0), WIDE)
    assert not reported
    assert made.events == before.events
