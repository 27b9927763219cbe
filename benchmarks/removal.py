# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a frame of the player costs where material is removed: the tapered column, twenty frames per second of motion.

    tools/freecad -M "$PWD" tools/run_script.py -- benchmarks/removal.py [--resolution coarse medium] [--frames 400]

Enters: resolutions of the stock, and how many frames are played from the first cut on. Leaves: milliseconds of the
processor for a frame, cutting and meshing apart, the frames for which both take less than the 50 ms between two of
them, and how often cutting the whole column at once takes as long as playing it. Seconds are those of the processor:
the clock says more of what else the computer does. Drawing is not measured.
"""

import argparse
import sys
import time
from pathlib import Path as FilePath

import numpy as np

ROOT = FilePath(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples" / "tapered_column")]

from build import build  # noqa: E402

from pkm_post.freecad_app.material import RESOLUTIONS, material_of, step_of  # noqa: E402
from pkm_post.freecad_app.simulation import simulate_job  # noqa: E402
from pkm_post.removal import brick_surfaces  # noqa: E402

FRAME = 0.05
"""s."""


def main() -> None:
    """Build the column, plan its motion, play a part of it at each resolution."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--resolution", nargs="+", choices=RESOLUTIONS, default=["coarse", "medium"])
    parser.add_argument("--frames", type=int, default=400)
    chosen = parser.parse_args()
    _, job = build()
    plan = simulate_job(job)
    print(f"{plan.duration:.0f} s of motion")
    for name in chosen.resolution:
        played(plan, name, chosen.frames)


def played(plan, name, frames) -> None:
    """Play some frames at one resolution, then the rest at once."""
    step = step_of(plan.setup.stock, RESOLUTIONS[name])
    begin = time.process_time()
    material = material_of(plan, step)
    made = time.process_time() - begin
    replay = material.replay
    seconds = first_cut(replay)
    cut, meshed = [], []
    for _ in range(frames):
        seconds += FRAME
        begin = time.process_time()
        bricks = replay.go_to(seconds)
        middle = time.process_time()
        sum(len(surface.faces) for surface in brick_surfaces(replay.stock, bricks))
        cut.append(middle - begin)
        meshed.append(time.process_time() - middle)
    both = 1000 * (np.array(cut) + meshed)
    begin = time.process_time()
    replay.go_to(plan.duration)
    whole = (time.process_time() - begin) / (plan.duration - seconds)
    print(
        f"{name}: {step:g} mm, {replay.stock.field.size} nodes and {len(replay.path.seconds)} poses in {made:.1f} s; "
        f"cutting {1000 * np.mean(cut):.1f}, meshing {1000 * np.mean(meshed):.1f} ms a frame, most {both.max():.1f}; "
        f"{100 * np.mean(both < 1000 * FRAME):.0f} % in time; cutting is {1 / whole:.1f} times as fast as the motion"
    )


def first_cut(replay):
    """The time at which material is first taken, s."""
    for seconds in replay.path.seconds.tolist():
        if len(replay.go_to(seconds)):
            return seconds
    raise ValueError("nothing is cut")


if __name__ == "__main__":
    main()
