# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories for the tests of their file: any values the format allows, not a way that a machine could go."""

import numpy as np

from pkm_post.geometry import unit
from pkm_post.model import Event, EventKind, Kind, Tool, Trajectory
from pkm_post.model.trajectory import TRAJECTORY_COLUMNS

NAMES = ("", "Finish", "Schlichten – Kegel ⌀12", "精加工", "🛠 rough\nsecond line\0end", "x" * 300)
VALUES = {
    EventKind.TOOL_CHANGE: (0.0, 1.0, 7.0),
    EventKind.SPINDLE: (-12000.0, -0.0, 0.0, 18000.5),
    EventKind.COOLANT: (0.0, 1.0, 2.0),
    EventKind.DWELL: (0.0, 0.25),
    EventKind.STOP: (0.0, 1.0),
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
    kinds = [EventKind(int(kind)) for kind in rng.choice([int(kind) for kind in EventKind], count)]
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
        "feed": rng.uniform(1e-3, 500, count),
        "arc_centre": np.where(arc[:, None], rng.normal(size=(count, 3)), nan),
        "arc_axis": np.where(arc[:, None], directions(rng, count), nan),
        "sweep": np.where(arc, rng.uniform(1e-6, 2 * np.pi, count), 0.0),
        "length": rng.uniform(1e-6, 100, count),
        "angle": rng.uniform(0, np.pi, count),
        "smooth": rng.random(count) < 0.5,
        "exact_stop": rng.random(count) < 0.5,
        "tool": rng.choice(tools, count) if count else [],
        "operation": rng.integers(0, operations, count),
        "line": rng.integers(0, 2**31 - 1, count),
    }


def random_trajectory(seed, count=20, events=6) -> Trajectory:
    rng = np.random.default_rng(seed)
    numbers = rng.permutation([0, 3, 12, 2**31 - 1]).tolist()
    names = iter(NAMES[index] for index in rng.integers(len(NAMES), size=9))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation(rng), rng.normal(size=3)
    return Trajectory(
        **random_columns(rng, count, numbers, 3),
        start_tip=rng.normal(size=3),
        start_axis=directions(rng, 1)[0],
        start_spin=float(rng.normal()),
        events=random_events(rng, count, events),
        operations=(next(names), next(names), next(names)),
        tools={number: Tool(number, next(names), *rng.uniform(0, 100, 3).tolist()) for number in numbers},
        machine_from_work=pose,
        machine=next(names),
        machine_fingerprint=rng.bytes(32).hex(),
        source=next(names),
    )


def everything(trajectory):
    """The content of a trajectory as something that can be compared with ==, floats by their bits."""
    arrays = (*TRAJECTORY_COLUMNS, "start_tip", "start_axis", "machine_from_work")
    plain = ("events", "operations", "tools", "machine", "machine_fingerprint", "source")
    return {
        **{name: (getattr(trajectory, name).dtype, getattr(trajectory, name).tobytes()) for name in arrays},
        **{name: getattr(trajectory, name) for name in plain},
        "values of events": np.array([event.value for event in trajectory.events], float).tobytes(),
        "start_spin": trajectory.start_spin.hex(),
    }
