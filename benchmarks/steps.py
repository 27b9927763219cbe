# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many points a program has: intervals chosen by error, beside fixed ones.

    python3 benchmarks/steps.py out/tapered_column.pkmt [--machine example_6tps] [--greedy 20]
    python3 benchmarks/steps.py

Enters: a trajectory file, as ``make demo`` writes one. Leaves: for intervals by error and for fixed ones of some
lengths the number of points, and how far the controller's cubics between them take tip and axis off the planned
path; the rounding of corners is not in it, nor is what a cubic is ahead of the plan or behind it.
With ``--greedy`` also the points of the first so many seconds, and those that a search from the left finds for them,
one widest interval after the other, by bisection of its end. Without a trajectory the same for some paths.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "benchmarks")]

import feed  # noqa: E402 - the path comes first
import memory  # noqa: E402
from machines import example  # noqa: E402
from programs import ON_PALLET, program  # noqa: E402

from pkm_post.machine import KnotState, ToolPoses, machine_named  # noqa: E402
from pkm_post.machine.kinematics.strut_cubics import tool_deviation  # noqa: E402
from pkm_post.model.certificate import Tolerances  # noqa: E402
from pkm_post.planning import interpolate, plan_feed  # noqa: E402
from pkm_post.planning.fast_poses import fast_poses  # noqa: E402
from pkm_post.planning.knots.choice import even_marks  # noqa: E402
from pkm_post.planning.knots.interpolation import InterpolationCheck  # noqa: E402
from pkm_post.planning.knots.places import poses_at  # noqa: E402
from pkm_post.toolpath.place import place  # noqa: E402
from pkm_post.writing import trajectory_file  # noqa: E402

GREEDY_PATHS = (
    "mixed",
    "arcs",
    "slot",
    "five axes, F9000",
    "scan, noise of 20 um",
    "cone, F9000",
    "zigzag",
    "pocket, F600",
)
FIXED_MS = (1, 2, 5, 10)
SHARES = np.sort(np.arange(1, 10) * (np.sqrt(5) - 1) / 2 % 1)
CHUNK = 4096
LEVER = np.degrees(1.0)
"""mm for each rad: a thousandth of a degree counts as much as a micrometre."""
LATE, LATE_S = 0.005, 0.0005
"""Share of an interval, and s, by which a place may be passed too early or too late."""


def across(start, end, path, schedule, machine):
    """Deviation of intervals at ``SHARES`` from the places of the plan that fit best, a little before or after.

    The square of the deviation is a parabola by that time, known from three values of it.
    """
    time, duration = (start[:, None] + (end - start)[:, None] * SHARES) / 1000, (end - start) / 1000
    ends = [KnotState.of(machine, poses_at(path, schedule, ms)) for ms in (start, end)]

    def off(shift):
        at = np.clip(time + shift, start[:, None] / 1000, end[:, None] / 1000)
        seen = fast_poses(path, schedule.at(at.ravel())[0])
        inside = ToolPoses(seen.tip, seen.axis, seen.spin, seen.tool_length)
        return tool_deviation(machine, *ends, inside, duration, SHARES)

    def best(shift, step):
        early, here, late = (by.tip**2 + (LEVER * by.axis) ** 2 for by in (off(shift + k * step) for k in (-1, 0, 1)))
        move = step / 2 * (early - late) / np.maximum(early - 2 * here + late, 1e-30)
        return np.clip(shift + move, -most, most)

    most = LATE * duration[:, None] + LATE_S
    raw, shifted = off(0.0), off(best(best(0.0 * time, most / 4), most / 64))
    return np.minimum(raw.tip, shifted.tip).max(), np.minimum(raw.axis, shifted.axis).max()


def reported(name, time_ms, path, schedule, machine):
    """One line of the table."""
    tip = axis = 0.0
    for first in range(0, len(time_ms) - 1, CHUNK):
        start, end = time_ms[first : first + CHUNK], time_ms[first + 1 : first + CHUNK + 1]
        start = start[: len(end)]
        found = across(start, end, path, schedule, machine)
        tip, axis = max(tip, found[0]), max(axis, found[1])
    print(f"{name:<12}{len(time_ms):>9} points   tip {tip:.6f} mm   axis {np.degrees(axis):.6f} degrees", flush=True)


def widest(error, start, last):
    """Ends of the widest intervals from starts that hold, by doubling and bisection, (N,) whole ms."""
    least, beyond = start + 1, last + 1
    while len(rows := np.flatnonzero((beyond - least > 1) & (least < last))):
        begin, held, end = start[rows], least[rows], last[rows]
        tried = np.where(beyond[rows] > end, np.minimum(2 * held - begin, end), (held + beyond[rows]) // 2)
        holds = error(begin, tried) <= 1
        least[rows], beyond[rows] = np.where(holds, tried, held), np.where(holds, beyond[rows], tried)
    return least


def greedy(error, marks_ms, end_ms):
    """Number of points up to a time if each interval is the widest; from all marks at once."""
    at, last, count = marks_ms[:-1], marks_ms[1:], 1
    while len(at):
        at = widest(error, at, last)
        count += np.count_nonzero(at <= end_ms)
        at, last = at[at < last], last[at < last]
    return count


def by_greedy(name, plan, until_ms=None):
    """Points of a plan up to a time, and those that a greedy search finds."""
    marks = even_marks(plan.schedule.rests_ms)
    until_ms = marks[-1] if until_ms is None else until_ms
    marks = marks[: np.searchsorted(marks, until_ms) + 1]
    check = InterpolationCheck(plan.path, plan.schedule, plan.machine, plan.tolerances, marks)
    ours = np.count_nonzero(interpolate(plan).motion.time_ms <= until_ms)
    least = greedy(check.error, marks, until_ms)
    print(f"{name:<38}{ours:>8}{least:>8}{ours / least:>7.2f}", flush=True)


def scanned(lines, axes, noise):
    """A scan of ``benchmarks/memory.py``, to four decimals, at F2400."""
    points = memory.scan(np.arange(lines), lines, axes)
    points[:, 2] += np.random.default_rng(1).uniform(-noise, noise, lines) + 50
    points = np.round(points, 4)
    axis = points[:, 3:] / np.linalg.norm(points[:, 3:], axis=1)[:, None] if axes == 5 else None
    return program(points[:, :3], axis, feed=40.0)


def table():
    """Points by greedy ones for some paths, without limits of jerk and with those of the example."""
    programs = {
        "scan, three axes, 6,000 lines": scanned(6000, 3, 0.0),
        "the same with noise of 2 um": scanned(6000, 3, 0.002),
        "scan, five axes, 3,000 lines": scanned(3000, 5, 0.0),
        **{name: feed.PATHS[name] for name in GREEDY_PATHS},
    }
    tolerances = Tolerances(1e-3, np.radians(1e-3))
    for kind, machine in (("", example()), (", jerk", machine_named("example_6tps")[0])):
        for name, made in programs.items():
            plan, _ = plan_feed(place(made, machine, ON_PALLET)[0], machine, tolerances)
            by_greedy(name + kind, plan)


def main():
    """Compare."""
    parser = argparse.ArgumentParser()
    parser.add_argument("trajectory", type=Path, nargs="?")
    parser.add_argument("--machine", default="example_6tps")
    parser.add_argument("--greedy", type=float, default=0.0, metavar="SECONDS")
    chosen = parser.parse_args()
    if chosen.trajectory is None:
        table()
        return
    trajectory, faults = trajectory_file.read(chosen.trajectory)
    machine, machine_faults = machine_named(chosen.machine)
    if trajectory is None or machine is None:
        sys.exit("\n".join(map(str, (*faults, *machine_faults))))
    feed_plan, _ = plan_feed(trajectory, machine, trajectory.tolerances)
    path, schedule, motion = feed_plan.path, feed_plan.schedule, interpolate(feed_plan).motion
    reported("by error", motion.time_ms, path, schedule, machine)
    if chosen.greedy:
        by_greedy(f"first {chosen.greedy:g} s", feed_plan, 1000 * chosen.greedy)
    for step in FIXED_MS:
        fixed = np.unique(np.concatenate([np.arange(0, schedule.rests_ms[-1], step), schedule.rests_ms]))
        reported(f"{step} ms", fixed, path, schedule, machine)


if __name__ == "__main__":
    main()
