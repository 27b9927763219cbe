# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare the reading of G-code with rs274, the interpreter of LinuxCNC, on programs made at random.

    python3 tests/oracles/gcode_rs274.py [PROGRAMS]    how many to compare
    python3 tests/oracles/gcode_rs274.py --golden      writes tests/data/gcode_rs274.json

Needs rs274 (Debian: linuxcnc-uspace), numpy and lark.
"""

import json
import re
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "gcode_rs274.json"
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

from random_gcode import program  # noqa: E402 - the path comes first
from rs274_moves import INCH, LENGTHS, rs274  # noqa: E402

PRINTED = 5e-5
"""rs274 prints four decimals, in the units of the program."""

BLOCKS = (
    "G2 X10.02 Y10 I0 J10",
    "G2 X10.027 Y10 I0 J10",
    "G2 X10.03 Y10 I0 J10",
    "G2 X10.05 Y10 I0 J10",
    "G2 X100.05 Y100 I0 J100",
    "G2 X100.09 Y100 I0 J100",
    "G2 X100.11 Y100 I0 J100",
    "G2 X10002.8 Y10000 I0 J10000",
    "G2 X10002.9 Y10000 I0 J10000",
    "G2 X10 R5",
    "G2 X10 R4.9995",
    "G2 X10 R4.9988",
    "G2 X10 R4.9987",
    "G2 X10 R4.9985",
    "G2 X10 R4.99",
    "G2 X0 Y0 I0 J0",
    "G2 I5",
    "G2 X0 R5",
    "G2 Z1 I5 P0",
    "G2 X1 Y1 Z1 R5 P2",
    "G0",
    "G2 Z1",
    "G53 X1 Y1",
    "G81 X1 Z-1 R1 L0",
    "G83 X1 Z-1 R1 Q0",
    "G82 X1 Z-1 R1",
    "G84 X1 Z-1 R1",
    "G93 G1 X1",
    "G1 X1 F0",
    "G92",
    "G52",
    "G10 L2 P1",
    "G10 L2 P10 X1",
    "G4 P-1",
    "G4",
    "S-1",
    "G41 D1 G1 X1",
    "G43",
    "G43.2",
    "G43.1",
    "G0 X1 I1",
    "G64 P0.1 Q0.1",
    "T1",
    "M48 M9 M5 M1",
    "G61.1 G1 X1",
    "G90.1 G2 X1 Y1 I1 J0",
    "G90.1 G2 X1 Y1 I1",
    "G17 G2 X2 K1 I1",
    "G19 G2 Y2 J1",
    "G18 G2 X2 I1",
    "G98 G99",
    "G91 G81 X1 Z-1 R1",
    "X1",
    "G81 Z-1 R1",
    "G81 R1 X1",
    "G1 G28 X1",
    "G28.1 X1",
    "G92.1 X1",
    "G80 X1",
    "G95 S100 M3 G1 X1 F1",
    "G97 S10",
    "M2 G1 X1",
    "G92 X1 G4 P1",
    "M0 M1",
    "G20 G1 X1 F1",
    "H1",
    "D1",
    "P1",
    "L1",
    "Q1",
    "G40 D1",
    "G54 P1",
    "G1 X1 R1",
    "G81 X1 Y1 Z-1 R1 Q1",
    "G81 X1 Y1 Z-1 R1 P1",
    "M30",
    "M60",
)
"""Blocks after a move to X0 Y0 Z0: some that rs274 takes and some that it refuses."""


def after_a_move(block):
    return f"N1 G21 G90 F100 G0 X0 Y0 Z0\nN2 {block}\nN3 M2\n"


def options():
    from pkm_post.model import Tool
    from pkm_post.reading.gcode.options import ReadOptions

    nothing = (0.0, 0.0, 0.0)
    offsets = {f"G{system}": (*nothing, 0.0) for system in (54, 55, 56, 57, 58, 59, 59.1, 59.2, 59.3)}
    return ReadOptions(
        tools={n: Tool(n, "", float(n), 0.0, length) for n, length in LENGTHS.items()},
        default_tool=Tool(0, "", 0.0, 0.0, 0.0),
        work_offsets=offsets,
        home=nothing,
        second_home=nothing,
        start=nothing,
    )


def ours(text):
    """The same of the reader, or the diagnostics."""
    from pkm_post.reading.gcode.resolve import resolve
    from pkm_post.reading.gcode.scan import scan

    blocks, faults = scan(text, "part.ngc")
    if blocks is not None:
        read, faults = resolve(blocks, options())
    return (None, faults) if blocks is None or read is None else (read, ())


def difference(expected, read):
    """Words for the first difference, empty if there is none."""
    row, here = 0, np.full(3, np.inf)
    tolerance = 4 * INCH * PRINTED
    for kind, place, feed, arc in expected:
        if arc is None and np.abs(here - place).max() < tolerance:
            continue
        while row < len(read) and read.kind[row] != 2 and np.abs(read.position[row] - here).max() < tolerance:
            row += 1
        last = row + (arc[2] if arc else 1) - 1
        if last >= len(read):
            return f"row {row}: only {len(read)} rows"
        here = read.position[last]
        if read.kind[last] != kind or np.abs(here - place).max() > tolerance:
            return f"line {read.line[last]}: {read.kind[last]} {here} where rs274 has {kind} {place}"
        if feed is not None and abs(read.feed[last] * 60 - feed) > 1e-3 * feed + 0.1:
            return f"line {read.line[last]}: feed {read.feed[last] * 60} where rs274 has {feed}"
        if arc:
            centre, axis = np.array(arc[0]), np.array(arc[1])
            off = read.arc_centre[last] - centre
            off -= (off @ axis) * axis
            if np.abs(off).max() > tolerance or read.arc_axis[last] @ axis < 1 - 1e-6:
                return (
                    f"line {read.line[last]}: arc {read.arc_centre[last]} {read.arc_axis[last]} where rs274 has {arc}"
                )
        row = last + 1
    rest = [place for place in read.position[row:] if np.abs(place - here).max() > tolerance]
    return f"{len(rest)} rows more" if rest else ""


def compare(count):
    refused = different = 0
    for seed in range(count):
        text = program(seed)
        expected = rs274(text)
        read, faults = ours(text)
        if expected is None:
            refused += 1
            continue
        why = str(faults[0]) if read is None else difference(expected, read)
        if why:
            different += 1
            if different < 6:
                print(f"seed {seed}: {why}")
                print(text.splitlines()[int(re.search(r"line (\d+)", why).group(1)) - 1] if "line" in why else "")
    print(f"{count} programs, {refused} refused by rs274, {different} different")
    return different


def write_golden():
    cases = [(text, found) for text in map(program, range(40)) if (found := rs274(text)) is not None][:24]
    GOLDEN.parent.mkdir(exist_ok=True)
    rows = [json.dumps({"program": text, "moves": found}) for text, found in cases]
    rows += [json.dumps({"block": block, "accepted": rs274(after_a_move(block)) is not None}) for block in BLOCKS]
    GOLDEN.write_text("[\n" + ",\n".join(rows) + "\n]\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    if sys.argv[1:] == ["--golden"]:
        write_golden()
    else:
        sys.exit(bool(compare(int(sys.argv[1]) if len(sys.argv) > 1 else 200)))
