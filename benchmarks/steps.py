# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many points a program has: intervals chosen by error, beside fixed ones.

    python3 benchmarks/steps.py out/tapered_column.pkmt [--machine example_6tps] [--greedy 20]

Enters: a trajectory file, as ``make demo`` writes one. Leaves: for intervals by error and for fixed ones of some
lengths the number of points, and how far the controller's cubics between them take tip and axis off the planned
path; the rounding of corners is not in it, nor is what a cubic is ahead of the plan or behind it.
With ``--greedy`` also the points of the first so many seconds, and the fewest that a
search from the left finds for them, one widest interval after the other, by bisection of its end.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pkm_post.machine import (  # noqa: E402
    KnotState,
    ToolPoses,
    machine_named,  # noqa: E402
)
from pkm_post.machine.kinematics.strut_cubics import tool_deviation  # noqa: E402
from pkm_post.planning import interpolate, plan_feed  # noqa: E402 - the path comes first
from pkm_post.planning.fast_poses import fast_poses  # noqa: E402
from pkm_post.planning.interpolation import InterpolationCheck, poses_at  # noqa: E402
from pkm_post.planning.knots import even_marks  # noqa: E402
from pkm_post.writing import trajectory_file  # noqa: E402 - the path comes first

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
    """End of the widest interval from a start that holds, by doubling and bisection, whole ms."""
    least, most = start + 1, last + 1
    step = 1
    while most > last and least < last:
        step *= 2
        tried = min(start + step, last)
        least, most = (tried, most) if error(np.array([start]), np.array([tried]))[0] <= 1 else (least, tried)
    while most - least > 1:
        middle = (least + most) // 2
        least, most = (middle, most) if error(np.array([start]), np.array([middle]))[0] <= 1 else (least, middle)
    return least


def greedy(error, marks_ms, end_ms):
    """Number of points up to a time if each interval is the widest."""
    at, count = int(marks_ms[0]), 1
    while at < min(end_ms, marks_ms[-1]):
        at = widest(error, at, int(marks_ms[np.searchsorted(marks_ms, at, side="right")]))
        count += at <= end_ms
    return count


def main():
    """Compare."""
    parser = argparse.ArgumentParser()
    parser.add_argument("trajectory", type=Path)
    parser.add_argument("--machine", default="example_6tps")
    parser.add_argument("--greedy", type=float, default=0.0, metavar="SECONDS")
    chosen = parser.parse_args()
    trajectory, faults = trajectory_file.read(chosen.trajectory)
    machine, machine_faults = machine_named(chosen.machine)
    if trajectory is None or machine is None:
        sys.exit("\n".join(map(str, (*faults, *machine_faults))))
    feed_plan, _ = plan_feed(trajectory, machine, trajectory.tolerances)
    path, schedule, motion = feed_plan.path, feed_plan.schedule, interpolate(feed_plan).motion
    reported("by error", motion.time_ms, path, schedule, machine)
    if chosen.greedy:
        marks, until = even_marks(schedule.rests_ms), 1000 * chosen.greedy
        check = InterpolationCheck(path, schedule, machine, trajectory.tolerances, marks)
        least, ours = greedy(check.error, marks, until), np.count_nonzero(motion.time_ms <= until)
        print(f"first {chosen.greedy:g} s: {ours} points, {least} by a greedy search, ratio {ours / least:.2f}")
    for step in FIXED_MS:
        fixed = np.unique(np.concatenate([np.arange(0, schedule.rests_ms[-1], step), schedule.rests_ms]))
        reported(f"{step} ms", fixed, path, schedule, machine)


if __name__ == "__main__":
    main()
