# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast cutters are compensated: points per second of each service, on generated paths.

    python3 benchmarks/compensation.py [--points 1000000]

Enters: nothing but the number of points. Leaves: the time of each service, the shortest of some runs, and points per
second: tips from contacts, shifts from one cutter to another, a program with normals, a contour in the plane, feet on a
bicubic surface, and material left on a surface; the last two with fewer points. Nothing is asserted about times.
"""

import argparse
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pkm_post.geometry.nurbs import NurbsSurface  # noqa: E402
from pkm_post.geometry.projection import nearest_on_nurbs  # noqa: E402
from pkm_post.model import Event, EventKind, Kind, Program, Tool  # noqa: E402
from pkm_post.toolpath.compensation.compensate import compensate_tips  # noqa: E402 - the path comes first
from pkm_post.toolpath.compensation.contact import size_changes, tip_from_contact, tip_offsets  # noqa: E402 - the path comes first
from pkm_post.toolpath.compensation.contour_offset import offset_contours  # noqa: E402 - the path comes first
from pkm_post.toolpath.compensation.cutter import Cutter  # noqa: E402 - the path comes first
from pkm_post.toolpath.compensation.offset_options import OffsetOptions  # noqa: E402 - the path comes first
from pkm_post.toolpath.compensation.stock_left import stock_left  # noqa: E402 - the path comes first

REPEATS = 3
"""Runs of each service; the fastest counts, as the others were disturbed."""

BALL, SMALLER_BALL = Cutter.apt(10.0, 5.0), Cutter.apt(9.9, 4.95)
BULL_NOSE, SMALLER_BULL_NOSE = Cutter.apt(16.0, 4.0, h=40.0), Cutter.apt(15.9, 3.9, h=40.0)


def waves(x, y):
    """Points and unit normals of a wavy surface."""
    z = 3 * np.sin(x / 9) * np.cos(y / 9)
    slope_x, slope_y = np.cos(x / 9) * np.cos(y / 9) / 3, -np.sin(x / 9) * np.sin(y / 9) / 3
    normal = np.column_stack([-slope_x, -slope_y, np.ones(len(x))])
    return np.column_stack([x, y, z]), normal / np.linalg.norm(normal, axis=1)[:, None]


def contacts(count, stepover=0.5):
    """A zigzag over the surface: contact points, normals, and axes that lean by 15 degrees and sideways with it."""
    lines = max(1, round(np.sqrt(count / 4)))
    along = np.linspace(0, stepover * lines, -(-count // lines))
    x = np.concatenate([along[:: 1 if line % 2 == 0 else -1] for line in range(lines)])[:count]
    y = np.repeat(stepover * np.arange(lines), len(along))[:count]
    points, normals = waves(x, y)
    axes = normals + np.tan(np.radians(15)) * np.array([1.0, 0.0, 0.3])
    return points, normals, axes / np.linalg.norm(axes, axis=1)[:, None]


def program_of(points, axes, **more):
    """A program of straight moves."""
    count = len(points)
    blank = np.full((count, 3), np.nan)
    kind = np.full(count, Kind.LINE)
    columns = (kind, points, axes, np.full(count, 30.0), blank, blank, np.zeros(count), np.arange(count) + 1)
    events, tools = (Event(0, EventKind.TOOL_CHANGE, 1),), {1: Tool(1, "ball", 10.0, 5.0, 100.0)}
    return Program(*columns, events, ("Finish",), tools, "benchmark", **more)


def contour(count):
    """A program round a star with rounded corners, to be offset to the left by 2 mm, with straight leads."""
    turn = np.linspace(0, -2 * np.pi, count - 2)
    radius = 200 + 20 * np.cos(5 * turn)
    star = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(len(turn))])
    points = np.vstack([[230.0, 15.0, 0.0], star, [230.0, -15.0, 0.0]])
    offset = np.full(len(points), 2.0)
    offset[[0, -1]] = 0.0
    return program_of(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), side_offset=offset)


def sheet(poles=30):
    """A bicubic surface of many spans."""
    knots = np.concatenate([[0.0] * 3, np.linspace(0, 1, poles - 2), [1.0] * 3])
    middles = np.array([knots[row + 1 : row + 4].mean() for row in range(poles)])
    u, v = np.meshgrid(100 * middles, 100 * middles, indexing="ij")
    points, _ = waves(u.ravel(), v.ravel())
    return NurbsSurface((3, 3), (knots, knots), points.reshape(poles, poles, 3), np.ones((poles, poles)))


def seconds(action):
    """The shortest time of an action, in s."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def report(service, count, action):
    """Measure and print one line."""
    taken = seconds(lambda: expect(action()))
    print(f"{service:44} {count:>9,} points {taken:8.3f} s {count / taken:>12,.0f} points/s", flush=True)


def expect(result):
    """Stop when a service refuses its input."""
    if isinstance(result, tuple) and result[0] is None:
        raise SystemExit("\n".join(map(str, result[1])))


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    count = parser.parse_args().points
    points, normals, axes = contacts(count)
    for name, cutter, other in (("ball", BALL, SMALLER_BALL), ("bull nose", BULL_NOSE, SMALLER_BULL_NOSE)):
        report(
            f"tips from contacts, {name}", count, lambda cutter=cutter: tip_from_contact(points, normals, axes, cutter)
        )
        shift = partial(
            tip_offsets, points, normals, axes, size_changes(cutter, other), (cutter, other), lambda row: row
        )
        report(f"shifts to a worn cutter, {name}", count, shift)
    program = program_of(points, axes, normal=normals)
    report("program with normals, to a worn ball", count, lambda: compensate_tips(program, BALL, SMALLER_BALL))
    star = contour(count)
    report("contour in the plane, offset by 2 mm", count, lambda: offset_contours(star, OffsetOptions()))
    few = max(1, count // 10)
    surface = sheet()
    u, v = np.random.default_rng(1).uniform(0, 1, (2, few))
    beside = surface.points(u, v) + [0.0, 0.0, 0.05]
    report("feet on a bicubic surface", few, lambda: nearest_on_nurbs(surface, beside))
    fewer = max(1, count // 100)
    path_points, path_normals, path_axes = contacts(fewer)
    tips, _ = tip_from_contact(path_points, path_normals, path_axes, BULL_NOSE)
    within = path_points[:, 0].max() * np.random.default_rng(2).uniform(0.1, 0.9, (2, fewer))
    some, their_normals = waves(*within)
    report(
        f"material left by {fewer:,} moves of a bull nose",
        fewer,
        lambda: stock_left(tips, path_axes, BULL_NOSE, some, their_normals, tolerance=2e-3),
    )


if __name__ == "__main__":
    main()
