# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of docs/feed.md: a corner, a noisy scan, and the feed along a trajectory, on the example machine.

    python3 benchmarks/feed_pictures.py FOLDER TRAJECTORY

Enters: a trajectory file, such as that of the tapered column (`make demo`). Leaves: feed_corner.png, feed_scan.png and
feed_column.png in the folder. Units of the plots as they say.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from machines import example  # noqa: E402 - the path comes first
from programs import ON_PALLET, program  # noqa: E402

from pkm_post.geometry import hermite_accelerations  # noqa: E402
from pkm_post.model import Tolerances  # noqa: E402
from pkm_post.planning import interpolate, plan_feed  # noqa: E402
from pkm_post.planning.knots.places import poses_at  # noqa: E402
from pkm_post.toolpath.place import place  # noqa: E402
from pkm_post.writing import trajectory_file  # noqa: E402

FINE, WIDE = Tolerances(1e-3, np.radians(1e-3)), Tolerances(1e-2, np.radians(1e-2))
UM = 1000.0
"""Micrometres in a millimetre."""


def planned(made, tolerances):
    """Trajectory and feed plan of a program on the pallet."""
    trajectory, _ = place(made, example(), ON_PALLET)
    feed_plan, _ = plan_feed(trajectory, example(), tolerances)
    return trajectory, feed_plan


def panels(size, *titles):
    """A figure with plots beside one another."""
    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    axes = np.atleast_1d(figure.subplots(1, len(titles)))
    for panel, title in zip(axes, titles, strict=True):
        panel.set_title(title, fontsize=10)
        panel.grid(visible=True, linewidth=0.3)
    return figure, axes


def corner():
    """A right angle at F6000: the path about it, and the acceleration as planned and as cubics play it."""
    trajectory, feed_plan = planned(program([[0, 0, 60], [10, 0, 60], [10, 10, 60]], feed=100.0), WIDE)
    path, schedule, machine = feed_plan.path, feed_plan.schedule, example()
    at = schedule.joint_time[-2] * UM
    fine = np.linspace(at - 12, at + 12, 2401)
    poses, knots = poses_at(path, schedule, fine), interpolate(feed_plan).motion
    figure, (left, right) = panels((9, 3.6), "path", "acceleration of the tip")
    ends = trajectory.tip[-2]
    off = UM * (poses.tip - ends)
    left.plot([-40, 0, 0], [0, 0, 40], color="0.5", linestyle="--", label="programmed")
    left.plot(off[:, 0], off[:, 1], label="planned")
    points = UM * (knots.tip - ends)
    left.plot(points[:, 0], points[:, 1], "o", markersize=4, label="points of the program")
    left.set(xlim=(-40, 10), ylim=(-10, 40), xlabel="x, um", ylabel="y, um", aspect="equal")
    left.legend(fontsize=8)
    planned_rate = np.gradient(poses.tip_1, fine / UM, axis=0)
    right.plot(fine - at, np.linalg.norm(planned_rate, axis=1), label="planned", linewidth=0.9)
    time, played = of_cubics(knots)
    right.plot(UM * time - at, played, label="played", linewidth=0.9)
    right.axhline(machine.tip_acceleration, color="0.3", linestyle="--", linewidth=0.8, label="limit")
    right.set(xlim=(-12, 12), ylim=(0, None), xlabel="ms from the corner", ylabel="mm/s^2")
    right.legend(fontsize=8)
    return figure


def of_cubics(motion):
    """Times, s, and sizes of the acceleration that cubics between points have, at both ends of each."""
    time = motion.time_ms / UM
    rows = motion.tip[:-1], motion.tip_rate[:-1], motion.tip[1:], motion.tip_rate[1:]
    ends = hermite_accelerations(*rows, np.diff(time))
    return np.repeat(time, 2)[1:-1], np.linalg.norm(np.stack(ends, axis=1).reshape(-1, 3), axis=1)


def scan():
    """Chords of 0.2 mm off by up to 5 um at F6000: path and feed with two tolerances."""
    x, off = np.linspace(-20, 20, 201), np.random.default_rng(1).uniform(-0.005, 0.005, 201)
    made = program(np.column_stack([x, 0 * x, 60 + off]), feed=100.0)
    figure, (left, right) = panels((9, 3.6), "a part of the path", "feed")
    for tolerances, name in ((FINE, "tolerance 1 um"), (WIDE, "tolerance 10 um")):
        trajectory, feed_plan = planned(made, tolerances)
        end = feed_plan.schedule.rests_ms[-1]
        poses = poses_at(feed_plan.path, feed_plan.schedule, np.arange(0, end, 0.05))
        z = UM * (poses.tip[:, 2] - trajectory.tip[:, 2].mean() + off.mean())
        cut = poses.segment > 0
        left.plot(poses.tip[cut, 0], z[cut], label=name, linewidth=0.9)
        feed = 60 * np.linalg.norm(poses.tip_1[cut], axis=1)
        right.plot(poses.tip[cut, 0], feed, label=f"{name}: {cut.sum() / 20:.0f} ms", linewidth=0.9)
    left.plot(x, UM * off, "k.", markersize=3, label="programmed")
    left.set(xlim=(0, 3), ylim=(-6, 6), xlabel="x, mm", ylabel="z, um")
    right.set(ylim=(0, None), xlabel="x, mm", ylabel="mm/min")
    for panel in (left, right):
        panel.legend(fontsize=8)
    return figure


def column(file):
    """The feed along a trajectory: asked, possible and planned, of the middle of its time."""
    trajectory, _ = trajectory_file.read(file)
    feed_plan, _ = plan_feed(trajectory, example(), FINE)
    study = interpolate(feed_plan).feed
    figure, (panel,) = panels((9, 3.2), "feed along the tapered column")
    for name in ("possible", "programmed", "planned"):
        feed = np.where(study.cutting, 60 * getattr(study, name), np.nan)
        panel.plot(study.time, feed, label=name, linewidth=0.8)
    panel.set(ylim=(0, 2 * 60 * study.programmed[study.cutting].max()), xlabel="s", ylabel="mm/min")
    panel.legend(fontsize=8, loc="upper right")
    return figure


def main():
    """Draw the three pictures."""
    folder, file = Path(sys.argv[1]), Path(sys.argv[2])
    for name, figure in (("corner", corner()), ("scan", scan()), ("column", column(file))):
        figure.savefig(folder / f"feed_{name}.png", dpi=80, metadata={"Software": None})


if __name__ == "__main__":
    main()
