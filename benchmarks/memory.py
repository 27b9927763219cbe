# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much memory posting takes, and how soon it can be stopped: a file of G-code to a certified program, by step.

    python3 benchmarks/memory.py [--lines 100000 1000000] [--axes 3 5] [--noise 0 0.002] [--jerk] [--repository DIR]

Enters: numbers of lines. Leaves, for each of them and for each step: the most memory that the process had in it, what
it had when the step began, seconds by the clock and of the processor, and the most seconds of the processor, of all
threads, between two calls of progress, each of which may stop the run. The part is a surface of sine waves, scanned
line by line in chords of some 0.3 mm; with five axes the tool leans by the normal of the surface. Each job is posted by
a process of its own. ``--noise`` moves each point up or down, as a probe does, which makes many more points of the
motion. With ``--jerk`` the machine has the limits of jerk of the example, else none. ``--repository`` measures another
version of PKM Post with the same files. Nothing is asserted.

Linux alone tells the most memory of a step (/proc/self/clear_refs).
"""

import argparse
import itertools
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

CHORD = 0.3
"""mm from one point of a line to the next."""
WIDTH = 120.0
"""mm: length of the lines of the scan."""
AT_ONCE = 100_000
"""Lines of G-code that are written at once."""
LENGTH = "--tool-length=1=120"
PLACE = "--work-offset=0,0,200"


def write_scan(path, lines, axes, noise):
    """Write a program of so many lines."""
    move = "G1 X%.4f Y%.4f Z%.4f" + (" I%.6f J%.6f K%.6f" if axes == 5 else "")
    chance = np.random.default_rng(1)
    heading = ["G21 G90 G17", "T1 M6", "G43.5 H1" if axes == 5 else "G43 H1", "S9000 M3"]
    with path.open("w", encoding="ascii") as file:
        file.writelines(f"{line}\n" for line in heading)
        first = scan(np.arange(1), lines, axes)[0]
        first[2] = 40.0
        file.write((move % tuple(first)).replace("G1", "G0") + "\n")
        for begin in range(0, lines, AT_ONCE):
            points = scan(np.arange(begin, min(begin + AT_ONCE, lines)), lines, axes)
            points[:, 2] += chance.uniform(-noise, noise, len(points))
            feeds = itertools.chain([" F2400\n"] if begin == 0 else [], itertools.repeat("\n"))
            file.writelines(move % tuple(point) + feed for point, feed in zip(points, feeds, strict=False))
        file.write("G91 G0 Z10\nM5\nM2\n")


def scan(rows, lines, axes):
    """Points of the scan, with tool axes where there are five axes, (N, 3) or (N, 6)."""
    on_a_line = round(WIDTH / CHORD)
    line, place = np.divmod(rows, on_a_line)
    x = np.where(line % 2 == 0, place, on_a_line - 1 - place) * CHORD - WIDTH / 2
    y = (line / max(1, (lines - 1) // on_a_line) - 0.5) * WIDTH
    z = 10 + 4 * np.sin(x / 15) * np.cos(y / 20)
    slope_x, slope_y = 4 / 15 * np.cos(x / 15) * np.cos(y / 20), -np.sin(x / 15) * np.sin(y / 20) / 5
    normal = np.column_stack([-slope_x / 2, -slope_y / 2, np.ones_like(x)])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return np.column_stack([x, y, z, normal] if axes == 5 else [x, y, z])


class Meter:
    """Memory and time, step by step."""

    def __init__(self):
        self.steps, self.gaps, self.called = [], {}, time.process_time()

    def begins(self, name, _=0.0):
        """A step begins, and the one before it ends; or the same step goes on."""
        called = time.process_time()
        of_step = self.steps[-1][0] if self.steps else name
        self.gaps[of_step] = max(self.gaps.get(of_step, 0.0), called - self.called)
        self._remember(name)
        self.called = time.process_time()

    def _remember(self, name):
        if self.steps and self.steps[-1][0] == name:
            return
        now, most = memory("VmRSS"), memory("VmHWM")
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
        self.steps.append((name, now, most, time.perf_counter(), time.process_time()))

    def report(self):
        """A line for each step."""
        for (name, now, _, *begin), (_, _, most, *end) in itertools.pairwise(self.steps):
            clock, processor = (after - before for after, before in zip(end, begin, strict=True))
            line(name, most, now, clock, processor, self.gaps[name])
        clock, processor = (self.steps[-1][column] - self.steps[0][column] for column in (3, 4))
        line("all", max(step[2] for step in self.steps), self.steps[0][1], clock, processor, max(self.gaps.values()))


def line(name, most, now, clock, processor, gap):
    """One line of the table."""
    print(f"{name:<22}{most:9.0f} {now:9.0f} {clock:9.2f} {processor:9.2f} {gap:9.2f}", flush=True)


def memory(entry):
    """What Linux says of the memory of this process, MB."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(re.search(rf"{entry}:\s+(\d+) kB", status)[1]) * 1024 / 1e6


def roomy_machine(folder, jerk=False):
    """The example machine, its limits of jerk if wished for, with a controller whose memory its file does not limit."""
    from pkm_post.machine import find_machine

    text = find_machine("example_6tps").read_text(encoding="utf-8")
    text = text if jerk else re.sub(r"(?m)^(tip_)?jerk = .*\n", "", text)
    path = Path(folder) / "roomy.toml"
    text = re.sub("(?m)^memory_words = .*\n", "", text).replace('"turbo_pmac"', '"power_pmac"')
    path.write_text(text, encoding="utf-8")
    return path


def post(path, axes, jerk):
    """Post a file and print what that took; the whole life of a process."""
    from pkm_post.model import Refused
    from pkm_post.posting.post_file import post_file
    from pkm_post.reading.part_program import ReadingOptions

    meter = Meter()
    reading = ReadingOptions(axis_words="vector" if axes == 5 else "none")
    folder, words = Path(path).parent, f"{LENGTH} {PLACE}"
    try:
        post_file(path, roomy_machine(folder, jerk), folder, reading=reading, progress=meter.begins, arguments=words)
    except Refused as refused:
        raise SystemExit(refused) from refused
    meter.report()


def main():
    """Post programs of all sizes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", type=int, nargs="+", default=[100_000, 1_000_000])
    parser.add_argument("--axes", type=int, nargs="+", choices=(3, 5), default=[3, 5])
    parser.add_argument("--noise", type=float, nargs="+", default=[0.0], metavar="MM")
    parser.add_argument("--jerk", action="store_true")
    parser.add_argument("--repository", type=Path, default=Path(__file__).resolve().parents[1])
    parser.add_argument("--post", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    sys.path.insert(0, str(chosen.repository))
    if chosen.post:
        post(chosen.post, chosen.axes[0], chosen.jerk)
        return
    for axes, lines, noise in itertools.product(chosen.axes, chosen.lines, chosen.noise):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "scan.ngc")
            write_scan(path, lines, axes, noise)
            print(f"{lines} lines, {axes} axes, noise of {noise:g} mm")
            print(f"{'step':<22}{'most MB':>9} {'before':>9} {'clock s':>9} {'cpu s':>9} {'gap s':>9}", flush=True)
            command = [sys.executable, __file__, "--post", path, "--axes", axes, "--repository", chosen.repository]
            subprocess.run([*map(str, command), *(["--jerk"] if chosen.jerk else [])], check=True)


if __name__ == "__main__":
    main()
