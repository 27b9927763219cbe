# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare 2D cutter compensation with rs274, the interpreter of LinuxCNC, on contours made at random.

    python3 tests/oracles/side_rs274.py [CONTOURS]    how many to compare
    python3 tests/oracles/side_rs274.py --golden      writes tests/data/side_rs274.json

Needs rs274 (Debian: linuxcnc-uspace), numpy and lark. rs274 compensates in G17 and G18. It goes round outer corners by
arcs; up to a turn of 0.05 rad it joins the offset ends and cuts into the part, so such turns are not made here. It
begins a contour beside the end of the start-up block, or, at an inner corner, where both offsets meet. It looks at
neighbouring moves alone: it takes contours that cut into a part further on, and blocks that it has to pass backwards.
"""

import json
import random
import sys
from pathlib import Path

import numpy as np
from rs274_moves import rs274

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "side_rs274.json"
sys.path[:0] = [str(ROOT)]

CASES = 280
TOLERANCE = 1e-3
"""mm: both the end points of the programs and what rs274 prints have four decimals, and arcs fit by that much."""
LETTERS = {"G17": ("X", "Y", "Z", "I", "J"), "G18": ("Z", "X", "Y", "K", "I")}


def program(seed):
    """G-code of a contour that wanders on, of lines, arcs and helices in turn and depth of chance."""
    chance = random.Random(seed)
    plane = chance.choice(("G17", "G17", "G18"))
    first, second, depth, i, j = LETTERS[plane]
    radius = round(chance.uniform(1.5, 5), 3)
    heading = chance.uniform(-3.1, 3.1)
    here = np.array([round(chance.uniform(-20, 20), 4), round(chance.uniform(-20, 20), 4)])
    go = np.array([np.cos(heading), np.sin(heading)])
    begin = np.round(here - 20 * go, 4)
    side = chance.choice(("G41.1", "G42.1"))
    lines = [f"G21 G90 G40 {plane} G0 {first}{begin[0]:.4f} {second}{begin[1]:.4f} {depth}5"]
    lines += [f"{side} D{2 * radius:g} G1 {first}{here[0]:.4f} {second}{here[1]:.4f} F300"]
    count = chance.randint(2, 5)
    for index in range(count):
        length = chance.uniform(9, 35)
        down = f" {depth}{-index - 1}" if chance.random() < 0.3 else ""
        if chance.random() < 0.45:
            turn, size = chance.choice((-1, 1)), chance.uniform(radius + 0.5, 25)
            angle = min(length / size, 2.5)
            centre = np.round(turn * size * np.array([-np.sin(heading), np.cos(heading)]), 4)
            spoke = -centre
            cosine, sine = np.cos(turn * angle), np.sin(turn * angle)
            end = here + centre + [cosine * spoke[0] - sine * spoke[1], sine * spoke[0] + cosine * spoke[1]]
            here, heading = np.round(end, 4), heading + turn * angle
            words = f"{i}{centre[0]:.4f} {j}{centre[1]:.4f}"
            code = "G3" if turn > 0 else "G2"
            lines += [f"{code} {first}{here[0]:.4f} {second}{here[1]:.4f}{down} {words}"]
        else:
            here = np.round(here + length * np.array([np.cos(heading), np.sin(heading)]), 4)
            lines += [f"G1 {first}{here[0]:.4f} {second}{here[1]:.4f}{down}"]
        if index < count - 1:
            heading += chance.choice((-1, 1)) * chance.uniform(0.06, 2.6)
    away = here + 20 * np.array([np.cos(heading), np.sin(heading)])
    lines += [f"G40 G1 {first}{away[0]:.4f} {second}{away[1]:.4f}"]
    return "\n".join([*(f"N{n} {line}" for n, line in enumerate(lines, 1)), "M2", ""])


def compensated(text):
    """What the product makes of it: the moves as rs274 has them, or None, and the diagnostics."""
    from pkm_post.model import Tool
    from pkm_post.reading.gcode import ReadOptions, read
    from pkm_post.toolpath.compensation.contour_offset import offset_contours
    from pkm_post.toolpath.compensation.offset_options import OffsetOptions

    nothing = (0.0, 0.0, 0.0)
    options = ReadOptions(default_tool=Tool(0, "", 0.0, 0.0, 0.0), work_offsets={"G54": (*nothing, 0.0)})
    given, faults = read(text.encode(), "part.ngc", options)
    assert given is not None, "\n".join(map(str, faults))
    moved, faults = offset_contours(given, OffsetOptions(corners="arc"))
    if moved is None:
        return None, faults
    moves = []
    for row in range(len(moved)):
        centre = [*moved.arc_centre[row], *moved.arc_axis[row]] if moved.kind[row] == 2 else []
        moves.append([int(moved.kind[row]), *moved.position[row].tolist(), *map(float, centre)])
    return moves, faults


def plain(found):
    """Moves of ``gcode_rs274.rs274`` as rows [kind, x, y, z] or [2, x, y, z, centre, axis]."""
    return [
        [kind, *np.round(place, 4).tolist(), *([*np.round(arc[0], 4), *np.round(arc[1], 4)] if arc else [])]
        for kind, place, _, arc in found
    ]


def difference(expected, moves):
    """The largest difference of two tables of moves in mm, infinite where they are not of one form."""
    if [move[0] for move in expected] != [move[0] for move in moves]:
        return float("inf")
    worst = 0.0
    for one, other in zip(expected, moves, strict=True):
        worst = max(worst, *np.abs(np.subtract(one[1:4], other[1:4])))
        if one[0] == 2:
            axis = np.array(one[7:])
            off = np.subtract(one[4:7], other[4:7])
            worst = max(worst, *np.abs(off - (off @ axis) * axis), *np.abs(axis - other[7:]))
    return float(worst)


def compare(count):
    """Compare so many contours; what rs274 and the product refuse is reported by the codes of the product."""
    refused, worst, same = {}, 0.0, 0
    for seed in range(count):
        text = program(seed)
        expected, (moves, faults) = rs274(text), compensated(text)
        if expected is None or moves is None:
            codes = sorted({fault.code for fault in faults} - {"N205"})
            refused.setdefault((expected is not None, moves is not None, *codes), []).append(seed)
            continue
        off = difference(plain(expected), moves)
        worst, same = max(worst, off), same + (off < TOLERANCE)
        if off >= TOLERANCE:
            print(f"seed {seed}: {off} mm\n{text}")
    print(f"{count} contours, {same} the same, largest difference {worst:.6f} mm")
    for (theirs, ours, *codes), seeds in refused.items():
        print(f"{len(seeds)} taken by rs274: {theirs}, by us: {ours}", *codes, "such as", seeds[:8])
    return count - same - sum(map(len, refused.values()))


def write_golden():
    rows = []
    for seed in range(CASES):
        text = program(seed)
        expected = rs274(text)
        rows.append(json.dumps({"program": text, "moves": expected and plain(expected)}))
    GOLDEN.write_text("[\n" + ",\n".join(rows) + "\n]\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    if sys.argv[1:] == ["--golden"]:
        write_golden()
    else:
        sys.exit(bool(compare(int(sys.argv[1]) if len(sys.argv) > 1 else 200)))
