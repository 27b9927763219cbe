# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the tool strays between two blocks when angles or poses are interpolated instead of tip and tool axis.

The path of the column's first quadrant enters, with every point and with only every n-th one as a coarser program would
have them; for each way to interpolate, the largest deviations of tip and tool axis from the programmed move leave: the
tip along its line, the axis along the great circle. Angles are those of a rotary head, turn about z and tilt from z. A
table goes to the output, a picture to the file that is named. Run it in FreeCAD: ``tools/freecad -M "$PWD"
tools/run_script.py -- examples/tapered_column/interpolation.py PICTURE``. [paper section 5.2]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import pkm_post as pkm

Array = np.ndarray[Any, np.dtype[np.float64]]

STEPS = (1, 5, 10, 25, 50, 100)
"""Every n-th point of the path is a block."""
SHARES = np.linspace(0.0, 1.0, 21)[1:-1]
"""Shares of a block at which the deviation is measured."""


def by_axis(axis: Array) -> Array:
    """Tool axes between each two rows, along the great circle, (N - 1, S, 3)."""
    turn = angle_between(axis[:-1], axis[1:])[:, None, None]
    first, last = axis[:-1, None], axis[1:, None]
    share = SHARES[:, None]
    straight = first + share * (last - first)  # where the axis stands still
    with np.errstate(invalid="ignore"):
        along = (np.sin((1 - share) * turn) * first + np.sin(share * turn) * last) / np.sin(turn)
    return np.where(turn > 0, along, straight)


def angle_between(axis: Array, other: Array) -> Array:
    """Angles between unit vectors, rad."""
    return 2.0 * np.arcsin(np.linalg.norm(axis - other, axis=-1) / 2.0)


def by_angles(axis: Array) -> Array:
    """Tool axes between each two rows when the angles of a rotary head run evenly, (N - 1, S, 3)."""
    turn, tilt = np.unwrap(np.arctan2(axis[:, 1], axis[:, 0])), np.arccos(np.clip(axis[:, 2], -1.0, 1.0))
    turn, tilt = (angle[:-1, None] + SHARES * np.diff(angle)[:, None] for angle in (turn, tilt))
    return np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=-1)


def tip_by_pose(tip: Array, axis: Array, reach: float) -> Array:
    """Deviations of the tip when the platform's origin runs straight and the axis along the great circle, mm.

    Args:
        tip: (N, 3) tool tips.
        axis: (N, 3) unit tool axes.
        reach: from the tip to the platform's origin, mm.
    """
    origin = tip + reach * axis
    between = origin[:-1, None] + SHARES[:, None] * np.diff(origin, axis=0)[:, None]
    straight = tip[:-1, None] + SHARES[:, None] * np.diff(tip, axis=0)[:, None]
    return np.linalg.norm(between - reach * by_axis(axis) - straight, axis=-1)


def table(tip: Array, axis: Array, reach: float) -> list[tuple[int, float, float, float, float]]:
    """For each step: its number, the largest turn of the axis in a block, and the deviations.

    Returns:
        Rows of step, turn in degrees, deviation of the axis by angles in degrees, what that is at the platform in mm,
        and deviation of the tip by poses in mm.
    """
    rows = []
    for step in STEPS:
        some_tip, some_axis = tip[::step], axis[::step]
        turn = np.degrees(angle_between(some_axis[:-1], some_axis[1:])).max()
        wrong = np.degrees(angle_between(by_angles(some_axis), by_axis(some_axis))).max()
        pose = tip_by_pose(some_tip, some_axis, reach).max()
        rows.append((step, float(turn), float(wrong), float(np.radians(wrong) * reach), float(pose)))
    return rows


def first_quadrant() -> tuple[Array, Array, float]:
    """Tips, axes and distance from tip to platform of the passes of the first quadrant."""
    sys.path.insert(0, str(Path(__file__).parent))
    from build import Column, contacts, tool_path

    column = Column()
    machine = pkm.read_machine("example_6tps")
    tip, axis = tool_path(column, contacts(column))
    return tip, axis / np.linalg.norm(axis, axis=-1, keepdims=True), machine.spindle_nose + column.tool.length


def main() -> int:
    """Print the table and draw the picture."""
    rows = table(*first_quadrant())
    print("step  turn, deg  axis by angles, deg  at the platform, mm  tip by poses, mm")
    for step, turn, wrong, at_platform, pose in rows:
        print(f"{step:4d}{turn:11.3f}{wrong:21.5f}{at_platform:21.5f}{pose:18.5f}")
    draw(rows, Path(sys.argv[1]))
    return 0


def draw(rows: list[tuple[int, float, float, float, float]], picture: Path) -> None:
    """Draw the deviations by the turn of the axis in a block."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    columns = np.array(rows).T
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    FigureCanvasAgg(figure)
    panel = figure.subplots()
    panel.loglog(columns[1], 1000 * columns[3], "o-", label="angles interpolated: axis off, measured at the platform")
    panel.loglog(columns[1], 1000 * columns[4], "s-", label="poses interpolated: tip off")
    panel.axhline(1.0, color="0.3", linestyle="--", linewidth=0.8, label="tolerance of the tip in the example")
    panel.set_xlabel("turn of the tool axis in a block, degrees")
    panel.set_ylabel("deviation, micrometres")
    panel.grid(visible=True, which="both", linewidth=0.3)
    panel.legend()
    figure.savefig(picture, dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    sys.exit(main())
