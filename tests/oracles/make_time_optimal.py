# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make tests/data/time_optimal.json: the shortest times in which paths of the tests can be run, by TOPP-RA.

    PYTHONPATH=.:tests python3 tests/oracles/make_time_optimal.py

Needs the packages toppra and scipy (the numbers in the repository are from toppra 0.6.10). Limited are the rates and
accelerations of the six struts, and the rate of path length by the feed, with the whole limits of the machine; grid
points divide the cells of a coarse plan into 16 parts each. H. Pham, Q.-C. Pham, IEEE Transactions on Robotics 34
(2018), 645-659.
"""

import json
from pathlib import Path

import numpy as np
import toppra
from planning.time_optimal_paths import LIMITS, PATHS, stations_of
from toppra.algorithm import TOPPRA
from toppra.constraint import DiscretizationType, JointAccelerationConstraint, JointVelocityConstraint
from toppra.interpolator import AbstractGeometricPath

from pkm_post.machine import strut_rates

TARGET = Path(__file__).resolve().parents[1] / "data" / "time_optimal.json"
PARTS = 16
"""Parts of each cell of the plan."""


class StrutPath(AbstractGeometricPath):
    """Six strut lengths and the path length itself, by path length, with exact derivatives."""

    def __init__(self, machine, path):
        self._machine, self._path = machine, path

    def __call__(self, position, order=0):
        s = np.atleast_1d(position)
        struts = strut_rates(self._machine, self._path.at(s))[order]
        own = (s, np.ones_like(s), np.zeros_like(s))[order]
        found = np.column_stack([struts, own])
        return found[0] if np.ndim(position) == 0 else found

    @property
    def dof(self):
        return 7

    @property
    def path_interval(self):
        return np.array([0.0, self._path.starts[-1]])

    @property
    def waypoints(self):
        return None


def shortest_time(machine, path, marks):
    """The time of the fastest way from rest to rest, s."""
    speed = np.append(np.full(6, machine.strut_speed), path.feed.max())
    acceleration = np.append(np.full(6, machine.strut_acceleration), 1e9)
    limits = [np.column_stack([-limit, limit]) for limit in (speed, acceleration)]
    constraints = [
        JointVelocityConstraint(limits[0]),
        JointAccelerationConstraint(limits[1], DiscretizationType.Interpolation),
    ]
    cells = np.unique(marks.s)
    grid = np.unique(np.interp(np.arange(0, len(cells) - 1 + 1 / PARTS, 1 / PARTS), np.arange(len(cells)), cells))
    solved = TOPPRA(constraints, StrutPath(machine, path), gridpoints=grid, parametrizer="ParametrizeConstAccel")
    _, speeds, _ = solved.compute_parameterization(0.0, 0.0)
    return float(np.sum(2 * np.diff(grid) / (speeds[1:] + speeds[:-1])))


def main():
    toppra.setup_logging("ERROR")
    found = {}
    for name in PATHS:
        for limits in LIMITS:
            machine, path, marks = stations_of(name, limits)
            found[f"{name}, {limits}"] = round(shortest_time(machine, path, marks), 4)
            print(name, limits, found[f"{name}, {limits}"])
    TARGET.write_text(json.dumps(found, indent=1) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
