# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make tests/data/jerk_limited.json: the shortest times in which paths can be run with limits of jerk.

    PYTHONPATH=.:tests:tests/planning python3 tests/oracles/make_jerk_limited.py

Needs scipy (the numbers in the repository are from scipy 1.16, HiGHS). Speed squared x at the nodes of a fine grid, its
slope and curvature as differences of nodes: no spline, no third law but beside rests. Limited are rates, accelerations
and jerks of the six struts, with the whole limits of the machine, and the rate of path length by the feed. Each jerk is
limited by the tangent of J / sqrt(x), and the time by its slope, at the x of the round before; each round is a linear
programme, with narrower bounds about that x from round to round. Limits hold at nodes only, so the times are a little
too short rather than too long.
"""

import dataclasses
import json
from pathlib import Path

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix, diags, vstack
from time_optimal_paths import PATHS, stations_of

from pkm_post.machine import strut_rates

TARGET = Path(__file__).resolve().parents[1] / "data" / "jerk_limited.json"
CASES = (("struts weak", 1e5), ("struts strong", 2e4))
"""Limits of speed and acceleration, and the jerk in mm/s^3."""
ROUNDS = 26


def grid(marks):
    """Nodes: two in each cell between stations, and geometrically from rests and from where blends begin and end."""
    rests = marks.s[[0, -1]]
    slow = np.concatenate([rests, marks.edges])
    near = np.geomspace(0.005, 20, 36)
    added = (slow[:, None] + np.concatenate([-near, near])).ravel()
    nodes = np.unique(np.concatenate([marks.s, (marks.s[1:] + marks.s[:-1]) / 2, added]))
    nodes = nodes[(nodes >= rests[0]) & (nodes <= rests[1])]
    return nodes[np.append(True, np.diff(nodes) > 1e-3)]


def differences(s):
    """Matrices that make acceleration and its change by path length, at the nodes under way, of x at all nodes."""
    h = np.diff(s)
    before, after = h[:-1], h[1:]
    count = len(s) - 2
    half_before, half_after = (
        diags([-1 / (2 * one), 1 / (2 * one)], [shift, shift + 1], shape=(count, len(s)))
        for one, shift in ((before, 0), (after, 1))
    )
    share = (before / (before + after))[:, None]
    change = diags(2 / (before + after)) @ (half_after - half_before)
    slope = half_before.multiply(1 - share) + half_after.multiply(share)
    return csr_matrix(slope), csr_matrix(change)


def shortest_time(machine, path, marks):
    """The time of the fastest way from rest to rest, s."""
    s = grid(marks)
    _, first, second = strut_rates(machine, path.at(s))
    third = np.gradient(second, s, axis=0)
    h, inner = np.diff(s), slice(1, -1)
    slope, change = differences(s)
    identity = csr_matrix(diags([np.ones(len(s) - 2)], [1], shape=(len(s) - 2, len(s))))

    def of(k, a, x):
        each = [
            diags(k[inner, i]) @ change + diags(a[inner, i]) @ slope + diags(x[inner, i]) @ identity for i in range(6)
        ]
        return vstack(each).tocsr()[:, 1:-1]

    accelerations, jerks = of(0 * first, first, second), of(first, 3 * second, third)
    beside = (4.5 * machine.strut_jerk / np.abs(first[[0, -1]]).max(axis=1) * h[[0, -1]] ** 2) ** (2 / 3)
    ceiling = np.minimum(path.feed.max(), machine.strut_speed / np.abs(first).max(axis=1))[inner] ** 2
    ceiling[[0, -1]] = np.minimum(ceiling[[0, -1]], beside)
    away = np.minimum(s, s[-1] - s)[inner]
    weight, x = (h[1:] + h[:-1]) / 2, ceiling / 20 * np.minimum(8 * away / s[-1], 1) ** (4 / 3)
    best = np.inf
    for number in range(ROUNDS):
        limit, tangent = (
            np.tile(1.5 * machine.strut_jerk / np.sqrt(x), 6),
            np.tile(0.5 * machine.strut_jerk / x**1.5, 6),
        )
        every = csr_matrix(vstack([identity[:, 1:-1]] * 6))
        lean = diags(tangent) @ every
        room = np.full(accelerations.shape[0], machine.strut_acceleration)
        wide = 1 + 2 * 0.75 ** max(number - 12, 0)
        found = linprog(
            -0.5 * weight * x**-1.5 * x,
            A_ub=vstack([accelerations, -accelerations, jerks + lean, lean - jerks]) @ diags(x),
            b_ub=np.concatenate([room, room, limit, limit]),
            bounds=np.column_stack([np.full(len(x), 1e-4), np.minimum(wide, ceiling / x)]),
            method="highs-ipm",
        )
        if found.x is None:
            break
        x = x * found.x
        speed = np.sqrt(x)
        time = 2 * (h[1:-1] / (speed[1:] + speed[:-1])).sum() + 3 * (h[0] / speed[0] + h[-1] / speed[-1])
        best = min(best, time)
        print("   ", number, round(float(time), 5), flush=True)
    return best


def main():
    found = {}
    for name in PATHS:
        for limits, jerk in CASES:
            machine, path, marks = stations_of(name, limits)
            machine = dataclasses.replace(machine, strut_jerk=jerk)
            found[f"{name}, {limits}, {jerk:g}"] = round(float(shortest_time(machine, path, marks)), 4)
            print(name, limits, jerk, found[f"{name}, {limits}, {jerk:g}"], flush=True)
    TARGET.write_text(json.dumps(found, indent=1) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
