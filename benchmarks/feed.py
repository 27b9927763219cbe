# SPDX-License-Identifier: LGPL-2.1-or-later
"""How near to the fastest motion plans are: their times by a lower bound, for some paths.

    python3 benchmarks/feed.py

Leaves: for each path the number of moves and of stations, the planned time in whole milliseconds, and that by two
bounds: the fastest profile on 24 times as many stations under the same planned limits, and under the whole limits of
the machine. The path with its rounded corners is the same in all three.
"""

import dataclasses
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from machines import example  # noqa: E402 - the path comes first
from programs import ON_PALLET, cone, program, square_with_arc  # noqa: E402

from pkm_post.model import Kind  # noqa: E402
from pkm_post.model.certificate import Tolerances  # noqa: E402
from pkm_post.planning.feed_plan import plan_feed  # noqa: E402
from pkm_post.planning.profile.acceleration_limits import limits_within  # noqa: E402
from pkm_post.planning.profile.fastest_profile import Steps, ceilings  # noqa: E402
from pkm_post.planning.speed_limits import PLANNED_SHARE  # noqa: E402
from pkm_post.planning.speed_profile import cell_times  # noqa: E402
from pkm_post.toolpath.place import place  # noqa: E402

PARTS = 24
"""Cells of the bound in each half blend; between blends four times as many, closer at the ends."""
SPEEDS, TIP = 0.95, 0.98
"""Shares of speeds and of the tip acceleration that are planned."""


def pocket():
    """Rings of a pocket, inside out, with a stop where the next begins."""
    rings = [[[-r, -r], [r, -r], [r, r], [-r, r], [-r, -r]] for r in np.arange(3.0, 24.0, 3.0)]
    flat = np.concatenate(rings)
    return program(np.column_stack([flat, np.full(len(flat), 60.0)]), feed=10.0)


def slow_stops():
    """Moves of 5 mm at F60."""
    x = np.arange(0.0, 21.0, 5.0)
    return program(np.column_stack([x, 0 * x, 60 + 0 * x]), feed=1.0)


def zigzag(feed=100.0):
    """Moves of 2 mm there and back."""
    x = np.arange(100) * 0.2 - 10
    return program(np.column_stack([x, np.where(np.arange(100) % 2, 2.0, 0.0), np.full(100, 60.0)]), feed=feed)


def scan(noise, feed=100.0):
    """Chords of 0.2 mm, each point off by some noise."""
    x = np.tile(np.concatenate([np.linspace(-30, 30, 301), np.linspace(30, -30, 301)]), 2)
    y, off = np.repeat(np.arange(4.0), 301), np.random.default_rng(1).uniform(-noise, noise, 1204)
    return program(np.column_stack([x, y, 60 + np.sin(x / 9) + off]), feed=feed)


def arcs():
    """Half circles of 20 mm radius that join smoothly."""
    centre, turn = np.full((4, 3), np.nan), np.full((4, 3), np.nan)
    centre[1:] = [[20, 0, 60], [60, 0, 60], [100, 0, 60]]
    turn[1:] = [[0, 0, -1], [0, 0, 1], [0, 0, -1]]
    ends = [[0, 0, 60], [40, 0, 60], [80, 0, 60], [120, 0, 60]]
    return program(ends, kind=[Kind.RAPID, *3 * [Kind.ARC]], centre=centre, turn=turn, feed=150.0)


def slot():
    """Half circles of 3 mm radius that advance."""
    count = 31
    x, y = 0.5 * np.arange(count), np.where(np.arange(count) % 2, 6.0, 0.0)
    position = np.column_stack([x, y, np.full(count, 60.0)])
    centre, turn = np.full((count, 3), np.nan), np.full((count, 3), np.nan)
    centre[1:] = (position[1:] + position[:-1]) / 2
    turn[1:] = [0, 0, 1]
    return program(position, kind=[Kind.RAPID, *[Kind.ARC] * (count - 1)], centre=centre, turn=turn, feed=60.0)


def smooth_five_axes(feed):
    """Two turns of a curve on which all five axes move."""
    turn = np.linspace(0, 4 * np.pi, 1200)
    tilt = np.radians(12 + 6 * np.sin(3 * turn))
    position = np.column_stack([50 * np.cos(turn), 35 * np.sin(turn), 60 + 8 * np.sin(2 * turn)])
    axis = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    return program(position, axis, feed=feed)


PATHS = {
    "mixed": square_with_arc(),
    "arcs": arcs(),
    "slot": slot(),
    "five axes, F1800": smooth_five_axes(30.0),
    "five axes, F9000": smooth_five_axes(150.0),
    "scan, F6000": scan(0.0),
    "scan, noise of 20 um": scan(0.02),
    "cone, F9000": dataclasses.replace(cone(), feed=np.where(cone().kind == Kind.RAPID, np.nan, 150.0)),
    "zigzag": zigzag(),
    "pocket, F600": pocket(),
    "moves of 5 mm, F60": slow_stops(),
}


def dense(path):
    """Segments, path lengths on them, and rests, of many stations."""
    even, graded = np.linspace(0, 1, PARTS + 1)[1:], (1 - np.cos(np.pi * np.linspace(0, 1, 4 * PARTS + 1)[1:])) / 2
    extent, entry, leave = (one[:, None] for one in (path.segments.extent, path.blend[:-1], path.blend[1:]))
    u = np.concatenate([entry * even, entry + (extent - entry - leave) * graded, extent - leave * (1 - even)], axis=1)
    u[:, -1] = extent[:, 0]
    segment, u = np.repeat(np.arange(len(u)), u.shape[1]), u.ravel()
    s, last = path.starts[segment] + u, np.append(segment[1:] != segment[:-1], True)
    kept = np.append(np.diff(s) > 1e-12 * s[-1], True) & (s > 0)
    segment, u, rest = segment[kept], u[kept], (last & path.rests[segment + 1])[kept]
    return np.append(0, segment), np.append(0.0, u), np.append(True, rest)


def bound(path, machine, share):
    """The time of the fastest profile on many stations, s."""
    segment, u, rest = dense(path)
    s, limits = path.starts[segment] + u, limits_within(path, machine, segment, u)
    limits.table[rest] = 0.0
    shares = np.full(len(s) - 1, share)
    steps = Steps(s, rest, limits, ceilings(s, limits, np.arange(len(s) - 1), shares), shares)
    return float(cell_times(s, steps.fastest_profile()).sum())


def whole(machine):
    """The machine with limits of which the planned shares are the whole limits of this one."""
    return dataclasses.replace(
        machine,
        strut_speed=machine.strut_speed / SPEEDS,
        axis_speed=machine.axis_speed / SPEEDS,
        tip_acceleration=machine.tip_acceleration / TIP,
    )


def main():
    """Print the table."""
    machine, tolerances = example(), Tolerances(1e-3, np.radians(1e-3))
    print(f"{'path':<22}{'moves':>7}{'stations':>10}{'planned, s':>12}{'same limits':>13}{'whole limits':>14}")
    for name, made in PATHS.items():
        trajectory, _ = place(made, machine, ON_PALLET)
        feed_plan, _ = plan_feed(trajectory, machine, tolerances)
        path, law, planned = feed_plan.path, feed_plan.schedule.law, feed_plan.schedule.rests_ms[-1] / 1000
        ratios = planned / bound(path, machine, PLANNED_SHARE), planned / bound(path, whole(machine), 1.0)
        row = f"{name:<22}{len(path.feed):>7}{len(law.s):>10}{planned:>12.3f}{ratios[0]:>13.3f}{ratios[1]:>14.3f}"
        print(row, flush=True)


if __name__ == "__main__":
    main()
