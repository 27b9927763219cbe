# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast G-code is read: this reader next to others, on the same generated programs, in one run.

    python3 benchmarks/decode.py [--blocks 200000] [--memory 1000000 2000000 4000000 10000000]

Enters: nothing but numbers of blocks. Leaves: lines per second of each reader, and its ratio to this one, whose
first step is ``scan`` and whose whole is ``read``; for a 3-axis program (modal G1, four decimals) and a 5-axis program
with the tool axis as I J K (G1 in every block). Readers that are not installed are left out; slow ones read the
beginning of the program. Nothing is asserted about times.

With ``--memory``, each size is read from a file by a process of its own. The most memory is reported that it had, with
Python, numpy and the text of the program, and per row what it had more than at its beginning; and the time of the
processor, which others on the machine do not change as much as the time of the clock.
"""

import argparse
import importlib.util
import random
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "reading" / "gcode")]

from by_block import scan_by_block  # noqa: E402

from pkm_post.model import Tool  # noqa: E402
from pkm_post.reading.gcode import ReadOptions, read  # noqa: E402 - the path comes first
from pkm_post.reading.gcode.scan import scan  # noqa: E402

LAP = 100_000
"""Lines after which a program for ``--memory`` repeats itself."""

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


def write_program(path, program, blocks):
    """A program of so many lines, the same ones over and over between heading and end."""
    lines = program(min(blocks, LAP), random.Random(1))
    heading, body, end = lines[:4], lines[4:-1], lines[-1:]
    with path.open("w") as file:
        file.write(_text(heading))
        left = blocks - len(heading) - len(end)
        while left > 0:
            file.write(_text(body[:left]))
            left -= len(body)
        file.write(_text(end))


def read_file(path):
    """Read a program and print what it took; the whole life of a process."""
    before = _peak()
    text = Path(path).read_bytes()
    start = time.process_time()
    program, reported = read(text, path, OPTIONS)
    took = time.process_time() - start
    if program is None:
        raise SystemExit("\n".join(map(str, reported)))
    rows, peak = len(program), _peak()
    print(
        f"{rows:12,} {len(text) / 1e6:9.0f} {peak:9.0f} {(peak - before) / rows * 1e6:10.0f} {took / rows * 1e6:10.2f}"
    )


def _peak():
    """The most memory this process had so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def print_memory(sizes):
    """Memory by number of blocks."""
    for name, program in PROGRAMS.items():
        print(f"{name}\n{'rows':>12} {'text MB':>9} {'peak MB':>9} {'bytes/row':>10} {'us/row':>10}", flush=True)
        for blocks in sizes:
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, "part.ngc")
                write_program(path, program, blocks)
                subprocess.run([sys.executable, __file__, "--read", str(path)], check=True)


def _text(lines):
    return "\n".join(lines) + "\n"


def _expect(result):
    value, diagnostics = result
    if value is None:
        raise SystemExit("\n".join(map(str, diagnostics)))


PROGRAMS = {"3-axis": three_axes, "5-axis IJK": five_axes}


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blocks", type=int, default=200_000)
    parser.add_argument("--memory", type=int, nargs="+", metavar="BLOCKS", help="measure memory instead of speed")
    parser.add_argument("--read", metavar="FILE", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.read:
        read_file(arguments.read)
    elif arguments.memory:
        print_memory(arguments.memory)
    else:
        print_speed(arguments.blocks)


def print_speed(blocks):
    """Lines per second of all readers."""
    for name, program in PROGRAMS.items():
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
