# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories for the tests of their file: random ones of any values the format allows, and some that are placed."""

import dataclasses

import numpy as np
from machines import example
from programs import BALL, ON_PALLET, cone, program, square_with_arc

from pkm_post.geometry import angle_between, arc_sweep, norm, unit
from pkm_post.geometry.curves import arc_length
from pkm_post.model import Event, EventKind, Kind, Tool, Trajectory
from pkm_post.model.certificate import Tolerances
from pkm_post.model.trajectory import TRAJECTORY_COLUMNS
from pkm_post.toolpath.place import place

NAMES = ("", "Finish", "Schlichten – Kegel ⌀12", "精加工", "🛠 rough\nsecond line\0end", "x" * 300)
VALUES = {  # threads, which have to fit the segments between their events, are in tests/posting/test_threads.py
    EventKind.TOOL_CHANGE: (0.0, 1.0, 7.0),
    EventKind.SPINDLE: (-12000.0, -0.0, 0.0, 18000.5),
    EventKind.COOLANT: (0.0, 1.0, 2.0),
    EventKind.DWELL: (0.0, 0.25),
    EventKind.STOP: (0.0, 1.0),
    EventKind.FUNCTION: (21.0, 999.0),
}
OTHER_NAN = np.array(0xFFF8_0000_DEAD_BEEF, np.uint64).view(np.float64)
"""A NaN with sign and payload: a reader that computes with it might lose them."""


def directions(rng, count):
    return unit(rng.normal(size=(count, 3)))


def rotation(rng):
    matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return matrix * np.sign(np.linalg.det(matrix))


def random_events(rng, segments, count):
    rows = np.sort(rng.integers(0, segments + 1, count)).tolist()
    kinds = [EventKind(int(kind)) for kind in rng.choice([int(kind) for kind in VALUES], count)]
    return tuple(Event(row, kind, float(rng.choice(VALUES[kind]))) for row, kind in zip(rows, kinds, strict=True))


def random_columns(rng, count, tools, operations):
    kind = rng.choice([int(kind) for kind in Kind], count)
    arc = kind == Kind.ARC
    nan = np.where(rng.random((count, 3)) < 0.5, np.nan, OTHER_NAN)
    return {
        "kind": kind,
        "tip": rng.choice([-0.0, 5e-324, 1e3], (count, 3)) * rng.normal(size=(count, 3)),
        "axis": directions(rng, count),
        "spin": rng.normal(size=count),
        "feed": rng.uniform(0.1, 500, count),
        "arc_centre": np.where(arc[:, None], rng.normal(size=(count, 3)), nan),
        "arc_axis": np.where(arc[:, None], directions(rng, count), nan),
        "sweep": np.where(arc, rng.uniform(1e-6, 2 * np.pi, count), 0.0),
        "length": rng.uniform(1e-6, 100, count),
        "angle": rng.uniform(0, np.pi, count),
        "smooth": np.zeros(count),
        "exact_stop": rng.random(count) < 0.5,
        "tip_tolerance": rng.choice([0.0, 1e-9, 0.05, 2.54], count),
        "tool": rng.choice(tools, count) if count else [],
        "operation": rng.integers(0, operations, count),
        "line": rng.integers(0, 2**31 - 1, count),
    }


def random_tool(rng, number, name):
    return Tool(number, name, *rng.uniform(0, 100, 3).tolist(), *rng.uniform(-1.5, 1.5, 2).tolist())


def random_trajectory(seed, count=20, events=6) -> Trajectory:
    """Not a way that a machine could go: it leaps. But segments end where they say."""
    rng = np.random.default_rng(seed)
    numbers = rng.permutation([0, 3, 12, 2**31 - 1]).tolist()
    names = iter(NAMES[index] for index in rng.integers(len(NAMES), size=9))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation(rng), rng.normal(size=3)
    return fitted(
        agreeing(
            Trajectory(
                **random_columns(rng, count, numbers, 3),
                start_tip=rng.normal(size=3),
                start_axis=directions(rng, 1)[0],
                start_spin=float(rng.normal()),
                events=random_events(rng, count, events),
                operations=(next(names), next(names), next(names)),
                tools={number: random_tool(rng, number, next(names)) for number in numbers},
                machine_from_work=pose,
                machine=next(names),
                machine_fingerprint=rng.bytes(32).hex(),
                source=next(names),
                source_fingerprint=rng.bytes(32).hex() if seed % 3 else "",
                tolerances=Tolerances(*rng.uniform(1e-4, 1, 2).tolist()) if seed % 2 else None,
            )
        )
    )


def agreeing(trajectory) -> Trajectory:
    """The same with the tools that the instructions say, and at rest at each of them and at the end."""
    count = len(trajectory)
    rows = [event.row for event in trajectory.events]
    rests = trajectory.exact_stop.copy()
    rests[[row - 1 for row in (*rows, count) if row]] = True
    if not count:
        return trajectory
    changes = [event for event in trajectory.events if event.kind is EventKind.TOOL_CHANGE]
    numbers = sorted(trajectory.tools)
    tool, events = np.full(count, numbers[0]), list(trajectory.events)
    for turn, change in enumerate(changes):
        number = numbers[turn % len(numbers)]
        events[events.index(change)] = Event(change.row, change.kind, float(number))
        tool[(change.row if turn else 0) :] = number
    return dataclasses.replace(trajectory, exact_stop=rests, tool=tool, events=tuple(events))


def fitted(trajectory) -> Trajectory:
    """The same with the sweeps and angles that lead to the ends, and with the lengths of lines and arcs."""
    start, arc, sweep = trajectory.tip_before(), trajectory.kind == Kind.ARC, np.zeros(len(trajectory))
    way = start[arc], trajectory.tip[arc], trajectory.arc_centre[arc], trajectory.arc_axis[arc]
    sweep[arc] = arc_sweep(*way)
    angle = angle_between(trajectory.axis_before(), trajectory.axis)
    length = norm(trajectory.tip - start)
    length[arc] = arc_length(*way)
    return dataclasses.replace(trajectory, sweep=sweep, angle=angle, length=length)


def everything(trajectory):
    """The content of a trajectory as something that can be compared with ==, floats by their bits."""
    arrays = (*TRAJECTORY_COLUMNS, "start_tip", "start_axis", "machine_from_work")
    plain = ("events", "operations", "tools", "machine", "machine_fingerprint", "source", "source_fingerprint")
    return {
        **{name: (getattr(trajectory, name).dtype, getattr(trajectory, name).tobytes()) for name in arrays},
        **{name: getattr(trajectory, name) for name in plain},
        "values of events": np.array([event.value for event in trajectory.events], float).tobytes(),
        "start_spin": trajectory.start_spin.hex(),
        "tolerances": trajectory.tolerances,
    }


def two_tools():
    """Two lines with a tool change between them, to a tool that is 30 mm longer; the axis is tilted there."""
    axis = np.array([[0, 0, 1], [0.6, 0, 0.8], [0.6, 0, 0.8], [0, 0, 1]])
    events = (Event(0, EventKind.TOOL_CHANGE, 1), Event(2, EventKind.TOOL_CHANGE, 2))
    longer = dataclasses.replace(BALL, number=2, length=BALL.length + 30)
    tools = {1: BALL, 2: longer}
    return program([[0, 0, 60], [5, 0, 50], [9, 0, 50], [9, 9, 60]], axis, events=events, tools=tools)


def spiral():
    """A helix whose radius grows from 10 to 10.001 mm while the tool axis turns."""
    kind = [Kind.RAPID, Kind.ARC]
    centre, turn = np.full((2, 3), np.nan), np.full((2, 3), np.nan)
    centre[1], turn[1] = [0, 0, 70], [0, 0, 1]
    axis = np.array([[0, 0, 1], [0, 0.6, 0.8]])
    return program([[10, 0, 40], [0, -10.001, 33]], axis, kind=kind, centre=centre, turn=turn)


PROGRAMS = (cone, square_with_arc, two_tools, spiral)


def placed(made) -> Trajectory:
    """The trajectory of a program on the example machine, with a spin that turns steadily."""
    trajectory, _ = place(made(), example(), ON_PALLET)
    return dataclasses.replace(trajectory, spin=np.linspace(0.1, 2, len(trajectory)))
