# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long the search for the spin and the search for the position take.

    python3 benchmarks/spin.py [--poses 100000]

Enters: the number of poses of a path down a cone of elliptic section, five degrees of freedom moving. Leaves: seconds
by search, with what is left before and after. Nothing is asserted about times.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from programs import program  # noqa: E402 - the path comes first

from pkm_post.machine import (  # noqa: E402
    SpinPolicy,
    SpinRule,
    best_position,  # noqa: E402
    least_normalised_margins,  # noqa: E402
    machine_named,  # noqa: E402
)
from pkm_post.machine.spin.optimise import optimise_spin  # noqa: E402
from pkm_post.machine.spin.policy import OBJECTIVES  # noqa: E402
from pkm_post.toolpath.place import place  # noqa: E402


def path(poses):
    """A long way down the cone, off the middle of the machine."""
    turn, tilt = np.linspace(0, 400 * np.pi, poses), np.radians(15)
    position = np.column_stack([60 * np.cos(turn), 40 * np.sin(turn), np.linspace(80, 10, poses)])
    axis = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.full(poses, np.cos(tilt))])
    offset = np.eye(4)
    offset[:3, 3] = [60.0, 60.0, 180.0]
    machine, _ = machine_named("example_6tps")
    return machine, place(program(position, axis), machine, offset)[0]


def reported(name, seconds, before, after):
    """One line of the table: seconds, and the shares of stroke, joints and distance to singular poses."""
    shares = " -> ".join(" ".join(f"{share:.3f}" for share in left) for left in (before, after))
    print(f"{name:<22}{seconds:7.2f} s   {shares}", flush=True)


def main():
    """Run the searches."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--poses", type=int, default=100_000)
    machine, trajectory = path(parser.parse_args().poses)
    print(f"{len(trajectory)} poses; shares of stroke, joints and distance to singular poses, before and after")
    for objective in OBJECTIVES:
        begin = time.perf_counter()
        found = optimise_spin(trajectory, machine, SpinPolicy(SpinRule.OPTIMISED, objective=objective))
        seconds = time.perf_counter() - begin
        reported(
            f"spin, {objective}",
            seconds,
            least_normalised_margins(trajectory, machine),
            least_normalised_margins(found, machine),
        )
    begin = time.perf_counter()
    position = best_position(trajectory, machine)
    reported("position", time.perf_counter() - begin, position.before, position.after)


if __name__ == "__main__":
    main()
