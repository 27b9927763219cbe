# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare which arcs are taken with rs274, the interpreter of LinuxCNC, on arcs that nearly fit their end points.

    python3 tests/oracles/arcs_rs274.py [ARCS]      how many to compare
    python3 tests/oracles/arcs_rs274.py --golden    writes tests/data/arcs_rs274.json

Needs rs274 (Debian: linuxcnc-uspace), numpy and lark. The arcs are in mm and in inches, in all planes. Their radii at
start and end differ by about as much as they may: by 2 sqrt 2 hundredths of a millimetre or thousandths of an inch, by
a thousandth of the radius, or by a hundred times the first. A radius given as R is about half the chord. LinuxCNC
states these tolerances in interp_internal.hh.
"""

import json
import random
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "arcs_rs274.json"
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

from gcode_rs274 import after_a_move, ours  # noqa: E402 - the path comes first
from random_gcode import PLANES  # noqa: E402
from rs274_moves import output_of  # noqa: E402

CASES = 240
ROUNDED = {"G21": 0.01, "G20": 0.001}
"""By unit the step to which end points may have been rounded."""
HALF_CHORD = {"G21": 0.00127, "G20": 0.00005}
"""By unit how much less than half the chord R may be."""


def block(seed):
    """A block with an arc from the origin."""
    chance = random.Random(seed)
    unit = chance.choice(("G20", "G21"))
    plane, (first, second, _), (i, j) = chance.choice(PLANES)
    sense, angle = chance.choice(("G2", "G3")), chance.uniform(0.3, 6)
    radius = 10 ** chance.uniform(-1, 4.3)
    near = chance.choice((0.9, 0.99, 0.999, 1.001, 1.01, 1.1)) * chance.choice((-1, 1))
    if chance.random() < 0.2:
        chord = 2 * (radius + near * HALF_CHORD[unit])
        return f"{unit} {plane} {sense} {first}{chord:.10f} R{radius:.10f}"
    small = 2 * np.sqrt(2) * ROUNDED[unit]
    off = near * chance.choice((small, small, 100 * small, max(0.001 * radius, small)))
    centre = radius * np.array([np.cos(angle / 3), np.sin(angle / 3)])
    towards = np.array([np.cos(angle), np.sin(angle)])
    end = centre + max(radius + off, 1e-3) * towards
    words = f"{first}{end[0]:.7f} {second}{end[1]:.7f} {i}{centre[0]:.7f} {j}{centre[1]:.7f}"
    return f"{unit} {plane} {sense} {words}"


def is_taken(text):
    """Whether rs274 takes a block after a move to the origin."""
    return output_of(after_a_move(text)) is not None


def is_ours(text):
    """Whether the reader does."""
    return ours(after_a_move(text))[0] is not None


def compare(count):
    different = taken = 0
    for seed in range(count):
        expected = is_taken(block(seed))
        taken += expected
        if expected != is_ours(block(seed)):
            different += 1
            print(f"seed {seed}: taken by rs274: {expected}: {block(seed)}")
    print(f"{count} arcs, {taken} taken by rs274, {different} different")
    return different


def write_golden():
    rows = [json.dumps({"block": block(seed), "taken": is_taken(block(seed))}) for seed in range(CASES)]
    GOLDEN.write_text("[\n" + ",\n".join(rows) + "\n]\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    if sys.argv[1:] == ["--golden"]:
        write_golden()
    else:
        sys.exit(bool(compare(int(sys.argv[1]) if len(sys.argv) > 1 else 200)))
