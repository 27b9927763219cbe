# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compare the reading of G-code with rs274, the interpreter of LinuxCNC, on programs made at random.

    python3 tests/oracles/gcode_rs274.py [PROGRAMS]    how many to compare
    python3 tests/oracles/gcode_rs274.py --golden      writes tests/data/gcode_rs274.json

Needs rs274 (Debian: linuxcnc-uspace), numpy and lark. rs274 says the moves in program coordinates and in the program's
units; here they are taken to machine coordinates in mm: local offset, rotation, work offset, length offset.
"""

import json
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "gcode_rs274.json"
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "gcode")]

LENGTHS = {1: 10.0, 2: 25.5, 3: 40.0}
CALL = re.compile(r"^\s*\d+ N(\S+)\s+(\w+)\((.*)\)\s*$")
PRINTED = 5e-5
"""rs274 prints four decimals, in the units of the program."""
INCH = 25.4


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


def rs274(text):
    """Points in mm, (n, 3), with the kind (0 rapid, 1 line, 2 arc), feed in mm/min and arc centre of each, or None."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder)
        (path / "part.ngc").write_text(text)
        (path / "var").write_text("")
        # The table is in inches whatever the machine is.
        rows = [f"T{n} P{n} Z{length / INCH:.9f} D{n / INCH:.9f} ;\n" for n, length in LENGTHS.items()]
        (path / "tools").write_text("".join(rows))
        command = ["rs274", "-t", path / "tools", "-v", path / "var", "-g", path / "part.ngc"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    return moves(run.stdout) if run.returncode == 0 else None


def moves(output):
    """The moves in the output of rs274, without those that stay in place."""
    local, origin, tool, angle, scale, plane, feed = np.zeros(3), np.zeros(3), np.zeros(3), 0.0, 1.0, 1, 0.0
    found = []
    for line in output.splitlines():
        match = CALL.match(line)
        if not match:
            continue
        _, name, text = match.groups()
        if name == "USE_LENGTH_UNITS":
            now = INCH if "INCHES" in text else 1.0
            scale = now
            continue
        if name == "SELECT_PLANE":
            plane = {"XY": 1, "YZ": 2, "XZ": 3}[text.split("_")[-1]]
            continue
        values = [float(number) for number in re.findall(r"-?\d+\.\d+|-?\d+", text)]
        if name == "SET_G92_OFFSET":
            local = np.array(values[:3]) * scale
        elif name == "SET_G5X_OFFSET":
            origin = np.array(values[1:4]) * scale
        elif name == "SET_XY_ROTATION":
            angle = np.radians(values[0])
        elif name == "USE_TOOL_LENGTH_OFFSET":
            tool = np.array(values[:3]) * scale
        elif name == "SET_FEED_RATE":
            feed = values[0] * scale
        if name not in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"):
            continue
        cosine, sine = np.cos(angle), np.sin(angle)
        turn = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])

        def machine(point, turn=turn, local=local, origin=origin, tool=tool):
            return turn @ (point + local) + origin + tool

        centre = None
        if name == "ARC_FEED":
            axes = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}[plane]
            point, middle = np.zeros(3), np.zeros(3)
            point[list(axes)] = values[0] * scale, values[1] * scale, values[5] * scale
            middle[list(axes)] = values[2] * scale, values[3] * scale, values[5] * scale
            across = np.eye(3)[axes[2]]
            centre = [machine(middle).tolist(), (turn @ across * np.sign(values[4])).tolist(), abs(int(values[4]))]
        else:
            point = np.array(values[:3]) * scale
        place = machine(point)
        kind = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED").index(name)
        found.append((kind, place.tolist(), None if kind == 0 else feed, centre))
    return found


def program(seed):
    """A program of moves, arcs, cycles and offsets in a fixed order of chance."""
    chance = random.Random(seed)
    # When an angle is set with G10 L2 while G92 is in force, rs274 loses the place of the tool.
    local = chance.random() < 0.5
    lines = ["G21 G90 G94 G17 G40 G49 G54 G98 F300 S1000 M3", "G0 X1 Y2 Z30"]

    def number(low, high):
        return f"{chance.uniform(low, high):.3f}"

    def words(letters, low=-30, high=30):
        chosen = [letter for letter in letters if chance.random() < 0.6] or [letters[0]]
        return " ".join(letter + number(low, high) for letter in chosen)

    def arc():
        plane, (first, second, third), (i, j) = chance.choice((
            ("G17", "XYZ", "IJ"), ("G18", "ZXY", "KI"), ("G19", "YZX", "JK"),
        ))  # fmt: skip
        sense = chance.choice(("G2", "G3"))
        helix = f" {third}{number(-3, 3)}" if chance.random() < 0.5 else ""
        if chance.random() < 0.4:
            dx, dy = chance.uniform(-9, 9), chance.uniform(-9, 9)
            radius = chance.choice((-1, 1)) * (np.hypot(dx, dy) / 2 + chance.uniform(0.01, 9))
            return [f"{plane} G91", f"{sense} {first}{dx:.3f} {second}{dy:.3f}{helix} R{radius:.3f}", "G90 G17"]
        radius, begin, end = chance.uniform(1, 9), chance.uniform(0, 6), chance.uniform(0, 6)
        ends = [radius * (np.cos(end) - np.cos(begin)), radius * (np.sin(end) - np.sin(begin))]
        turns = chance.choice(("", "", " P2", " P3"))
        full = chance.random() < 0.2
        end = "" if full else f" {first}{ends[0]:.4f} {second}{ends[1]:.4f}"
        centre = f" {i}{-radius * np.cos(begin):.4f} {j}{-radius * np.sin(begin):.4f}"
        return [f"{plane} G91", f"{sense}{end}{helix}{centre}{turns}", "G90 G17"]

    def cycle():
        code = chance.choice(("G73", "G81", "G82", "G83", "G84", "G85", "G86", "G89"))
        extra = {"G73": " Q2.5", "G83": " Q3.1"}.get(code, "" if code in ("G81", "G85") else " P0.5")
        plane, depth, across = chance.choice((("G17", "Z", "XY"), ("G18", "Y", "XZ"), ("G19", "X", "YZ")))
        if code == "G84":
            # The rs274 at hand swaps the coordinates of its feeds in the other planes.
            plane, depth, across = "G17", "Z", "XY"
        block = f"{plane} {chance.choice(('G98', 'G99'))} {code} {words(across)} {depth}-9.2 R{number(-5, 8)}{extra}"
        out = [block + chance.choice(("", " L2")), words(across), f"{words(across)} {depth}-11", "G80 G17"]
        if chance.random() < 0.3:
            out = [
                f"{plane} G91 {code} {words(across)} {depth}-{number(5, 9)} R-{number(0, 3)}{extra} L3",
                "G80 G90 G17",
            ]
        return out

    def feed():
        block = f"G93 G1 {words('XYZ')} F{number(1, 9)}"
        return [block, f"G94 F{number(100, 900)}"]

    choices = (
        lambda: [f"{chance.choice(('G0', 'G1'))} {words('XYZ')}"],
        lambda: [f"G1 {words('XYZ')} F{number(50, 900)}", words("XYZ"), words("XYZ")],
        lambda: ["G91", f"G1 {words('XYZ', -5, 5)}", words("XYZ", -5, 5), "G90"],
        lambda: ["G20", f"G1 {words('XYZ', -1, 1)} F{number(5, 30)}", f"X{number(-1, 1)}", "G21"],
        arc,
        arc,
        cycle,
        feed,
        lambda: [f"{chance.choice(('G92', 'G52'))} {words('XYZ')}" if local else "G92.1"],
        lambda: [chance.choice(("G92.1", "G92.2", "G92.3"))],
        lambda: [f"G10 L2 P{chance.randint(1, 3)} {words('XYZ')}" + ("" if local else f" R{number(-60, 60)}")],
        lambda: [f"G10 L20 P{chance.randint(0, 3)} {words('XYZ')}"],
        lambda: [chance.choice(("G54", "G55", "G56", "G59.3"))],
        lambda: [chance.choice(("G43 H1", "G43 H2", "G43.2 H3", "G49", f"G43.1 Z{number(0, 9)}"))],
        lambda: [f"G53 {chance.choice(('G0', 'G1'))} X{number(-9, 9)} Y{number(-9, 9)} Z{number(0, 9)}"],
        lambda: [chance.choice(("G28", "G28 Z5", "G28.1", "G30", "G30 X1 Y2", "G30.1"))],
    )
    for _ in range(25):
        lines += chance.choice(choices)()
    return "\n".join([*(f"N{n} {line}" for n, line in enumerate(lines, 1)), "M2", ""])


def options():
    from pkm_post.gcode.options import ReadOptions
    from pkm_post.model import Tool

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
    from pkm_post.gcode.resolve import resolve
    from pkm_post.gcode.scan import scan

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
