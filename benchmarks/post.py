# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long posting takes: a CAM job to a certified motion program, beside FreeCAD's own text post of the same job.

    tools/freecad -M "$PWD" tools/run_script.py -- benchmarks/post.py [--commands 50000 200000]

Enters: numbers of commands. Leaves: seconds of each step, of all steps, of the text post ``linuxcnc``, by the clock and
of the processor, their ratios, and the most memory that the process had. Seconds of the processor are those of all
threads; they say more than the clock where others use the machine. The job is a smooth surface of sine waves, scanned
line by line, with three decimals and the tolerances that are taken if nothing is said. Nothing is asserted about times.
"""

import argparse
import itertools
import re
import resource
import sys
import tempfile
import time
from pathlib import Path as FilePath

import FreeCAD as App
import numpy as np
import Part
import Path.Main.Job
import Path.Op.Custom
from Path.Post.Processor import PostProcessorFactory

sys.path.insert(0, str(FilePath(__file__).resolve().parents[1]))

from pkm_post.freecad_app.post_job import post_job  # noqa: E402
from pkm_post.freecad_app.tools import set_gauge_length  # noqa: E402 - the path comes first
from pkm_post.machine import find_machine  # noqa: E402
from pkm_post.options.choices import Options  # noqa: E402

WIDTH = 120.0
"""mm: side of the square that is scanned."""
STEP = 0.4
"""mm between two points."""


def scan(commands):
    """The lines of G-code of a scan with so many feed moves."""
    on_a_line = int(WIDTH / STEP) + 1
    rows = -(-commands // on_a_line)
    x = np.tile(np.concatenate([np.linspace(-60, 60, on_a_line), np.linspace(60, -60, on_a_line)]), rows // 2 + 1)
    y = np.repeat(np.linspace(-60, 60, rows), on_a_line)
    x, y = x[:commands], y[:commands]
    z = 10 + 4 * np.sin(x / 15) * np.cos(y / 20)
    lines = [
        f"G0 X{x[0]:.3f} Y{y[0]:.3f} Z40",
        *(f"G1 X{a:.3f} Y{b:.3f} Z{c:.3f} F40" for a, b, c in zip(x, y, z, strict=True)),
    ]
    return [*lines, "G0 Z40"]


def new_job(document, commands):
    """A job with one operation of so many commands."""
    box = document.addObject("Part::Feature", "Stock")
    box.Shape = Part.makeBox(120, 120, 10, App.Vector(-60, -60, 0))
    job = Path.Main.Job.Create("Job", [box], None)
    controller = job.Tools.Group[0]
    controller.SpindleSpeed, controller.SpindleDir = 9000, "Forward"
    set_gauge_length(controller, 120)
    operation = Path.Op.Custom.Create("Scan", parentJob=job)
    operation.ToolController = controller
    operation.Gcode = scan(commands)
    document.recompute()
    return job


def roomy_machine(folder):
    """The example machine with a controller whose memory takes every program of the benchmark."""
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    path = FilePath(folder) / "roomy.toml"
    path.write_text(re.sub("(?m)^memory_words = .*", f"memory_words = {1 << 24}", text), encoding="utf-8")
    return path


class Stopwatch:
    """Seconds by the clock and of the processor, step by step."""

    def __init__(self):
        self.steps = []

    def begins(self, name, _=0.0):
        """A step begins, and the one before it ends; further calls within a step are passed over."""
        if self.steps and self.steps[-1][0] == name:
            return
        self.steps.append((name, np.array([time.perf_counter(), time.process_time()])))

    def reported(self):
        """A line for each step; the seconds of all of them."""
        for (name, begin), (_, end) in itertools.pairwise(self.steps):
            if name:
                line(name, end - begin)
        return self.steps[-1][1] - self.steps[0][1]


def line(name, seconds, more=""):
    """One line of the table."""
    print(f"{name:<22}{seconds[0]:7.2f} s {seconds[1]:7.2f} s   {more}".rstrip(), flush=True)


def post(job, folder, options):
    """Post to a certified program; seconds."""
    watch = Stopwatch()
    post_job(job, roomy_machine(folder), folder, options, progress=watch.begins)
    watch.begins("")
    return watch.reported()


def post_as_text(job):
    """Post with the stock post-processor; seconds."""
    watch = Stopwatch()
    watch.begins("linuxcnc text post")
    PostProcessorFactory.get_post_processor(job, "linuxcnc").export()
    watch.begins("")
    return watch.reported()


def main():
    """Post jobs of all sizes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--commands", type=int, nargs="+", default=[50_000, 200_000])
    offset = np.eye(4)
    offset[2, 3] = 200.0
    for commands in parser.parse_args().commands:
        document = App.newDocument("benchmark")
        job = new_job(document, commands)
        print(f"{f'{commands} commands':<22}{'clock':>9} {'processor':>11}")
        with tempfile.TemporaryDirectory() as folder:
            ours = post(job, folder, Options(work_offset=offset))
        line("all", ours, f"{commands / ours[0] / 1000:.1f} k commands/s")
        stock = post_as_text(job)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
        ratio = stock / ours
        print(f"{'ratio':<22}{ratio[0]:7.2f}   {ratio[1]:7.2f}     most memory so far {memory:.2f} GiB", flush=True)
        App.closeDocument(document.Name)


if __name__ == "__main__":
    main()
