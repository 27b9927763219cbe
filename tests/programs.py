# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs for the tests: small jobs built from arrays."""

from dataclasses import replace

import numpy as np

from pkm_post.model import Event, EventKind, Kind, Program, Tool

ON_PALLET = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 150], [0, 0, 0, 1]])
"""A work offset that puts the jobs below well inside the example machine."""
BALL = Tool(1, "ball", 12.0, 6.0, 120.0)


def program(position, axis=None, kind=None, feed=30.0, events=None, centre=None, turn=None, tools=None) -> Program:
    """A program with one operation; row 0 is a rapid unless kinds are given."""
    position = np.asarray(position, dtype=float)
    count = len(position)
    kind = np.array([Kind.RAPID] + [Kind.LINE] * (count - 1) if kind is None else kind)
    axis = np.tile([0.0, 0.0, 1.0], (count, 1)) if axis is None else axis
    blank = np.full((count, 3), np.nan)
    return Program(
        kind=kind,
        position=position,
        tool_axis=axis,
        feed=np.where(kind == Kind.RAPID, np.nan, feed),
        arc_centre=blank if centre is None else centre,
        arc_axis=blank if turn is None else turn,
        operation=np.zeros(count),
        line=np.arange(1, count + 1),
        events=(Event(0, EventKind.TOOL_CHANGE, 1),) if events is None else events,
        operations=("Finish",),
        tools={1: BALL} if tools is None else tools,
        source="part.FCStd",
    )


def cone(count=200, turns=1.0, tilt_deg=15.0) -> Program:
    """A path down a cone of elliptic section with the axis leaning outwards; five degrees of freedom move."""
    turn = np.linspace(0, 2 * np.pi * turns, count)
    tilt = np.radians(tilt_deg)
    position = np.column_stack([60 * np.cos(turn), 40 * np.sin(turn), np.linspace(80, 40, count)])
    axis = np.column_stack([
        np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.full(count, np.cos(tilt)),
    ])  # fmt: skip
    return program(position, axis)


def square_with_arc() -> Program:
    """Straight moves with right angles, a half circle that leaves a line smoothly, and a helix down."""
    position = [[0, 0, 60], [0, 0, 40], [30, 0, 40], [30, 20, 40], [0, 20, 40], [0, 0, 40], [0, 0, 36]]
    kind = [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.ARC, Kind.LINE, Kind.LINE, Kind.ARC]
    centre, turn = np.full((7, 3), np.nan), np.full((7, 3), np.nan)
    centre[3], turn[3] = [30, 10, 40], [0, 0, 1]
    centre[6], turn[6] = [5, 0, 40], [0, 0, -1]
    return program(position, kind=kind, centre=centre, turn=turn)


def tapped_hole(lead=1.25) -> Program:
    """A thread of 12 mm on a machine whose spindle is an axis: down, up, and away."""
    kind = [Kind.RAPID, Kind.LINE, Kind.LINE, Kind.RAPID]
    thread = Event(1, EventKind.SPINDLE_AXIS, lead), Event(3, EventKind.SPINDLE_AXIS, 0.0)
    events = (Event(0, EventKind.TOOL_CHANGE, 1), *thread)
    return program([[0, 0, 62], [0, 0, 50], [0, 0, 62], [0, 0, 70]], kind=kind, feed=12.5, events=events)


def steep_helices() -> Program:
    """Three helices that rise and fall five times as far as their radius, with sharp corners between."""
    position = [[0, 0, 40], [5, 5, 70], [10, 10, 45], [15, 15, 70]]
    blank = [np.nan] * 3
    centre = np.array([blank, [5, 0, 40], [5, 10, 70], [15, 10, 45]])
    turn = np.array([blank, [0, 0, -1], [0, 0, 1], [0, 0, -1]])
    return program(position, kind=[Kind.RAPID, *3 * [Kind.ARC]], centre=centre, turn=turn)


def random_job(rng) -> Program:
    """A job of random corners, step lengths, tilts, feeds, rapids, dwells, and sometimes a point visited twice."""
    count = int(rng.integers(2, 60))
    walk = np.cumsum(rng.normal(size=(count, 3)) * 10 ** rng.uniform(-1, 1.3), axis=0)
    position = np.clip(walk, -60, 60) + [0, 0, 60]
    if rng.random() < 0.3:
        position[rng.integers(1, count)] = position[rng.integers(0, count)]
    tilt = np.radians(np.clip(np.abs(np.cumsum(rng.normal(size=count) * 10 ** rng.uniform(-1, 0.6))), 0, 18))
    azimuth = np.cumsum(rng.normal(size=count) * 10 ** rng.uniform(-1.5, 0.5))
    axis = np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    kind = np.where(rng.random(count) < 0.2, Kind.RAPID, Kind.LINE)
    kind[0] = Kind.RAPID
    dwells = (Event(int(row), EventKind.DWELL, 0.1) for row in sorted(rng.integers(1, count, 2)))
    events = (Event(0, EventKind.TOOL_CHANGE, 1), *dwells)
    return program(position, axis, kind=kind, feed=10 ** rng.uniform(0.3, 2.2), events=events)


TOOLS = {1: BALL, 2: Tool(2, "long", 8.0, 4.0, 150.0), 3: Tool(3, "short", 10.0, 0.0, 83.5)}


def random_changes(rng) -> Program:
    """A random job whose spindle starts and stops, with up to six changes of tools of other lengths."""
    job = random_job(rng)
    count = len(job)
    rows = sorted(rng.integers(0, count + 1, int(rng.integers(1, 6))).tolist())
    events = list(job.events[1:])
    for row in (0, *rows):
        if rng.random() < 0.5:
            events.append(Event(row, EventKind.SPINDLE, 0.0))
        events.append(Event(row, EventKind.TOOL_CHANGE, float(rng.integers(1, 4))))
        events.append(Event(row, EventKind.SPINDLE, float(rng.integers(-9, 10)) * 1000 or 500.0))
    events.sort(key=lambda event: event.row)
    return replace(job, events=tuple(events), tools=TOOLS)
