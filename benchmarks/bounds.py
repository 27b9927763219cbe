# SPDX-License-Identifier: LGPL-2.1-or-later
"""What rough forms bring: the processor time of a whole post with each of them, and without it.

    python3 benchmarks/bounds.py [--lines 50000] [--axes 3 5] [--noise 0 0.002]

Three computations have a rough form beside the exact one. It bounds the exact one from the safe side, and decides
where that is needed at all: so the results are the same with and without it, but for the places of stations. The
parts are those of benchmarks/memory.py. Each post is a process of its own; the table has the processor time of the
post without a form, divided by that with all of them. Nothing is asserted.
"""

import argparse
import itertools
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import memory
import numpy as np

REPOSITORY = Path(__file__).resolve().parents[1]


def without_rough_limits():
    """Feed limits are computed at stations on every segment (planning/rough_limits.py)."""
    from pkm_post.planning import feed_plan

    feed_plan.below_feed = lambda path, *_: np.ones(len(path.feed), dtype=bool)


def without_groups():
    """Every check of the reach follows the path, none is settled by bounds around a few poses (machine/reach)."""
    from pkm_post.machine.reach import path_checks

    path_checks.unproven_checks = lambda machine, way, checks_for: tuple(range(len(checks_for(1.0))))


def without_cubics():
    """The certificate has no cubics of the tool, only forward kinematics (certificate/tool_spline.py)."""
    from pkm_post.certificate import tool_spline

    tool_spline._MOST_CHANGE = -1.0


WITHOUT = {
    "all forms": lambda: None,
    "no rough feed limits": without_rough_limits,
    "no groups of poses": without_groups,
    "no cubics of the tool": without_cubics,
}


def post(path, axes, form):
    """Post a file without one of the forms, and print the processor time; the whole life of a process."""
    from pkm_post.posting.post_file import post_file
    from pkm_post.reading.part_program import ReadingOptions

    WITHOUT[form]()
    reading = ReadingOptions(axis_words="vector" if axes == 5 else "none")
    words, began = f"{memory.LENGTH} {memory.PLACE}", time.process_time()
    post_file(path, memory.roomy_machine(path.parent), path.parent, reading=reading, arguments=words)
    print(time.process_time() - began)


def seconds(path, axes, form):
    """Processor time of a post in a new process."""
    command = [sys.executable, __file__, "--post", path, "--axes", axes, "--without", form]
    return float(subprocess.run([*map(str, command)], check=True, capture_output=True, text=True).stdout)


def main():
    """Post all programs with and without each form."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", type=int, default=50_000)
    parser.add_argument("--axes", type=int, nargs="+", choices=(3, 5), default=[3, 5])
    parser.add_argument("--noise", type=float, nargs="+", default=[0.0, 0.002], metavar="MM")
    parser.add_argument("--post", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--without", choices=WITHOUT, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    sys.path.insert(0, str(REPOSITORY))
    if chosen.post:
        post(chosen.post, chosen.axes[0], chosen.without)
        return
    for axes, noise in itertools.product(chosen.axes, chosen.noise):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "scan.ngc")
            memory.write_scan(path, chosen.lines, axes, noise)
            taken = {form: seconds(path, axes, form) for form in WITHOUT}
        print(f"{chosen.lines} lines, {axes} axes, noise of {noise:g} mm: {taken['all forms']:.2f} s")
        for form, each in taken.items():
            print(f"  {form:<24}{each / taken['all forms']:6.2f}", flush=True)


if __name__ == "__main__":
    main()
