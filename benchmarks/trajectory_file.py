# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast a trajectory file is opened and walked through, beside decoding the same program from G-code, in one run.

    python3 benchmarks/trajectory_file.py [--blocks 1000000]
    python3 benchmarks/trajectory_file.py --memory 1000000 10000000

Enters: a number of blocks. Leaves: seconds by way of getting at all segments, and how many times faster it is than
``gcode.read`` of the text. The files were just written, so both are in memory; seconds are of the processor, so that
other processes and waiting for the disk do not count. A walk in C needs a compiler, cc or gcc.

With ``--memory``, each size is written by a process of its own that has made a trajectory before; printed is how much
more memory that process took for writing. Nothing is asserted.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(ROOT), str(HERE)]

from decode import OPTIONS, PROGRAMS, write_program  # noqa: E402 - the path comes first

from pkm_post.machine import find_machine  # noqa: E402
from pkm_post.machine.description.reader import read_machine  # noqa: E402
from pkm_post.model import Kind, Trajectory  # noqa: E402
from pkm_post.model.trajectory import TRAJECTORY_COLUMNS  # noqa: E402
from pkm_post.reading import gcode  # noqa: E402
from pkm_post.toolpath.place import place  # noqa: E402
from pkm_post.writing import trajectory_file  # noqa: E402
from pkm_post.writing.trajectory_file.layout import HEADER, SEGMENT  # noqa: E402

REPEATS = 5
"""Runs of all but the slowest; the fastest counts, as the others were disturbed."""


def shortest(action, repeats=REPEATS):
    """The shortest processor time of an action in s, and what it returned."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        result = action()
        times.append(time.process_time() - start)
    return min(times), result


def value(result):
    """The value of a step that must not fail here."""
    found, diagnostics = result
    if found is None:
        raise SystemExit("\n".join(map(str, diagnostics)))
    return found


def mapped(path):
    """The segments of a file as records that are read where they lie; nothing is checked but the layout."""
    header = np.fromfile(path, HEADER, 1)[0]
    offset, count, size = header["segments"].item()
    if size != SEGMENT.itemsize:
        raise SystemExit(f"records of {size} bytes")
    return np.memmap(path, SEGMENT, "r", offset, (count,))


def look(path):
    """Time at the feed of every segment, and the corner of all tips: one visit to each record."""
    segments = mapped(path)
    return float((segments["length"] / segments["feed"]).sum()), segments["tip"].max(axis=0).tolist()


def checksum(path):
    """The checksum of all bytes."""
    return zlib.crc32(np.memmap(path, np.uint8, "r"))


def walks_in_c(path, folder):
    """Seconds of a look at each segment, and of the pose in the middle of each, in C; None without a compiler."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if not compiler:
        return None
    made = folder / "walk"
    source, include = HERE / "walk_trajectory.c", ROOT / "resources" / "trajectory"
    subprocess.run([compiler, "-std=c11", "-O2", "-I", include, source, "-o", made, "-lm"], check=True)
    runs = [subprocess.run([made, path], check=True, capture_output=True, text=True).stdout for _ in range(REPEATS)]
    return np.array([run.split()[:2] for run in runs], dtype=float).min(axis=0).tolist()


def print_speed(blocks):
    """Seconds by way, for a program with three axes and one with five."""
    machine = value(read_machine(find_machine("example_6tps")))
    for name, program in PROGRAMS.items():
        with tempfile.TemporaryDirectory() as made:
            folder = Path(made)
            write_program(folder / "part.ngc", program, blocks)
            text, path = (folder / "part.ngc").read_bytes(), folder / "part.pkmt"
            decoding, decoded = shortest(lambda text=text: value(gcode.read(text, "part.ngc", OPTIONS)), 2)
            placed = value(place(decoded, machine, machine.work_offsets["G54"]))
            writing, _ = shortest(lambda placed=placed, path=path: trajectory_file.write(placed, path), 2)
            print(
                f"{name}: {blocks:,} lines of {len(text) / 1e6:.0f} MB, {len(placed):,} segments of"
                f" {path.stat().st_size / 1e6:.0f} MB"
            )
            rows = {"G-code decoded": decoding, "trajectory written": writing}
            rows["read, everything checked"] = shortest(lambda path=path: value(trajectory_file.read(path)), 2)[0]
            rows["checksum of all bytes"] = shortest(lambda path=path: checksum(path))[0]
            rows["mapped and walked, numpy"] = shortest(lambda path=path: look(path))[0]
            in_c = walks_in_c(path, folder)
            if in_c:
                rows["mapped and walked, C"], rows["the same with poses, C"] = in_c
        for what, seconds in rows.items():
            print(f"  {what:26}{seconds:10.4f} s {decoding / seconds:9.1f} times as fast as decoding")


def lines_to(count):
    """A trajectory of so many short lines, all from other lines of a source, at rest at its end."""
    here = np.zeros((count, 3))
    here[:, 0] = np.arange(1, count + 1)
    no_arc = np.full((count, 3), np.nan)
    ones = np.ones(count)
    columns = dict.fromkeys(TRAJECTORY_COLUMNS, np.zeros(count))
    columns |= {"kind": np.full(count, Kind.LINE), "tip": here, "axis": np.tile([0.0, 0.0, 1.0], (count, 1))}
    columns |= {"feed": ones, "length": ones, "line": np.arange(count), "arc_centre": no_arc, "arc_axis": no_arc}
    columns["exact_stop"] = np.arange(count) == count - 1
    tool = OPTIONS.default_tool
    pose = {"start_tip": np.zeros(3), "start_axis": np.array([0.0, 0.0, 1.0]), "start_spin": 0.0}
    machine = {"machine_from_work": np.eye(4), "machine": "none", "machine_fingerprint": "0" * 64}
    return Trajectory(**columns, **pose, **machine, events=(), operations=("",), tools={0: tool}, source="")


def print_memory(count):
    """Write a trajectory and print the memory that took; the whole life of a process."""
    trajectory = lines_to(count)
    columns = sum(getattr(trajectory, name).nbytes for name in TRAJECTORY_COLUMNS)
    before = _resident()
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        trajectory_file.write(trajectory, Path(folder, "part.pkmt"))
        seconds = time.perf_counter() - start
        size = Path(folder, "part.pkmt").stat().st_size
    more = max(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 - before, 0)
    print(
        f"{count:12,} {columns / 1e6:12.0f} {size / 1e6:9.0f} {more / 1e6:14.0f} {count / seconds:12,.0f}", flush=True
    )


def _resident():
    """Memory of this process now, bytes; the peak is reset to it (Linux)."""
    Path("/proc/self/clear_refs").write_text("5")
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize()


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blocks", type=int, default=1_000_000)
    parser.add_argument("--memory", type=int, nargs="+", metavar="SEGMENTS", help="measure memory instead of speed")
    parser.add_argument("--write", type=int, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.write:
        print_memory(arguments.write)
    elif arguments.memory:
        print(
            f"{'segments':>12} {'columns MB':>12} {'file MB':>9} {'for writing MB':>14} {'segments/s':>12}", flush=True
        )
        for count in arguments.memory:
            # Else what was freed while the trajectory was made would be used again, and not be counted.
            environment = os.environ | {"MALLOC_MMAP_THRESHOLD_": "65536"}
            subprocess.run([sys.executable, __file__, "--write", str(count)], check=True, env=environment)
    else:
        print_speed(arguments.blocks)


if __name__ == "__main__":
    main()
