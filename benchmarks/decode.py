# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast G-code is read: this reader next to others, on the same generated programs, in one run.

    python3 benchmarks/decode.py [--blocks 200000]

Enters: nothing but the number of blocks. Leaves: lines per second of each reader, and its ratio to this one, whose
first step is ``scan`` and whose whole is ``read``; for a 3-axis program (modal G1, four decimals) and a 5-axis program
with the tool axis as I J K (G1 in every block). Readers that are not installed are left out; slow ones read the
beginning of the program. Nothing is asserted about times.
"""

import argparse
import importlib.util
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pkm_post.gcode import ReadOptions, read  # noqa: E402 - the path comes first
from pkm_post.gcode.scan import scan, scan_by_block  # noqa: E402
from pkm_post.model import Tool  # noqa: E402

SLICE = 5000
"""Lines that the slow readers read."""

REPEATS = 5
"""Runs of the fast readers; the fastest counts, as the others were disturbed."""

OPTIONS = ReadOptions(default_tool=Tool(0, "end mill", 6.0, 0.0, 80.0), axis_words="vector")


def three_axes(blocks, chance):
    """A 3-axis program, as lines."""
    lines = ["G21 G90 G17", "G1 X0.0000 Y0.0000 Z0.0000 F600"]
    for number in range(3, blocks):
        feed = f" F{chance.randint(100, 3000)}" if chance.random() < 0.03 else ""
        x, y, z = (chance.uniform(-100, 100) for _ in "XYZ")
        lines.append(f"N{number} X{x:.4f} Y{y:.4f} Z{z:.4f}{feed}")
    return [*lines, "M2"]


def five_axes(blocks, chance):
    """A 5-axis program with the tool axis as I J K, as lines."""
    lines = ["G21 G90 G17", "T1 M6", "G43.5 H1", "G1 X0.0000 Y0.0000 Z0.0000 I0.000000 J0.000000 K1.000000 F600"]
    for number in range(5, blocks):
        x, y, z = (chance.uniform(-100, 100) for _ in "XYZ")
        i, j = chance.uniform(-0.5, 0.5), chance.uniform(-0.5, 0.5)
        k = (1 - i * i - j * j) ** 0.5
        lines.append(f"N{number} G1 X{x:.4f} Y{y:.4f} Z{z:.4f} I{i:.6f} J{j:.6f} K{k:.6f}")
    return [*lines, "M2"]


def seconds(action, repeats=1):
    """The shortest time of an action, in s."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def by_scan(lines):
    """This reader's first step."""
    text = _text(lines).encode()
    return len(lines), seconds(lambda: _expect(scan(text, "benchmark.ngc")), REPEATS)


def by_read(lines):
    """All steps of this reader, to the program with its meaning."""
    text = _text(lines).encode()
    return len(lines), seconds(lambda: _expect(read(text, "benchmark.ngc", OPTIONS)), REPEATS)


def by_lark(lines):
    """Every line through lark."""
    some = lines[:SLICE]
    return len(some), seconds(lambda: _expect(scan_by_block(_text(some), "benchmark.ngc")))


def by_pygcode(lines):
    """The lines as objects of pygcode."""
    if importlib.util.find_spec("pygcode") is None:
        return None
    import pygcode

    some = lines[:SLICE]
    return len(some), seconds(lambda: [pygcode.Line(line) for line in some])


def by_rs274(lines):
    """The interpreter of LinuxCNC, with its full meaning; it refuses I J K of a tool axis."""
    with tempfile.TemporaryDirectory() as folder:
        program, parameters, tools = (Path(folder, name) for name in ("part.ngc", "part.var", "part.tbl"))
        program.write_text(_text(lines))
        parameters.write_text("")
        tools.write_text("T1 P1 Z0 D0.25 ;\n")
        command = ["rs274", "-g", "-t", str(tools), "-v", str(parameters), str(program)]
        try:
            start = time.perf_counter()
            run = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
        except FileNotFoundError:
            return None
        return (len(lines), time.perf_counter() - start) if run.returncode == 0 else None


READERS = {"scan": by_scan, "read": by_read, "lark alone": by_lark, "pygcode": by_pygcode, "rs274": by_rs274}


def _text(lines):
    return "\n".join(lines) + "\n"


def _expect(result):
    value, diagnostics = result
    if value is None:
        raise SystemExit("\n".join(map(str, diagnostics)))


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blocks", type=int, default=200_000)
    blocks = parser.parse_args().blocks
    for name, program in (("3-axis", three_axes), ("5-axis IJK", five_axes)):
        lines = program(blocks, random.Random(1))
        print(f"{name}: {len(lines)} lines, {len(_text(lines)) / 1e6:.1f} MB")
        print(f"  {'reader':12} {'lines/s':>12} {'scan is':>12}{'read is':>12} times as fast")
        rates = {}
        for reader, measure in READERS.items():
            measured = measure(lines)
            if measured is None:
                print(f"  {reader:12} not installed, or does not read this program")
                continue
            rates[reader] = measured[0] / measured[1]
            ratios = [f"{rates[ours] / rates[reader]:12.2f}" for ours in ("scan", "read") if ours in rates]
            print(f"  {reader:12} {rates[reader]:12,.0f} {''.join(ratios)}")


if __name__ == "__main__":
    main()
