# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plots: the report's picture.

Path in 3D with the tool axes, strut lengths and speeds over time with their limits, and the deviations that the
certificate found. Without matplotlib there is a warning instead of a picture.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Kind, Machine, Motion, Place, StrutMotion, Trajectory
from pkm_post.model.findings import Certificate, Tolerances

_LIMIT = {"color": "0.3", "linestyle": "--", "linewidth": 0.8}
_AXES_SHOWN = 150
_AXIS_DRAWN = 15.0
"""mm"""
_POINTS_SHOWN = 20000


def missing_matplotlib(picture: Path) -> tuple[Diagnostic, ...]:
    """The warning that a picture is not made, or nothing."""
    if importlib.util.find_spec("matplotlib") is None:
        return (Diagnostic("F102", Place(picture.name), "no module named matplotlib"),)
    return ()


def draw(
    path: Path,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    struts: StrutMotion,
    certificate: Certificate,
    tolerances: Tolerances,
) -> tuple[Diagnostic, ...]:
    """Draw the report's picture to a PNG file.

    Args:
        path: where it goes.
        trajectory: the programmed path.
        machine: its limits are drawn.
        motion: the planned motion.
        struts: the program as it was read back.
        certificate: what it was found to do.
        tolerances: what was asked for.
    """
    missing = missing_matplotlib(path)
    if missing:
        return missing
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 9), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subfigures(1, 2, width_ratios=[1, 1.25])
    _path(left.add_subplot(projection="3d"), trajectory, motion)
    lengths, speeds, deviations = right.subplots(3, 1, sharex=True)
    _lengths(lengths, struts, machine)
    _speeds(speeds, struts, machine)
    _deviations(deviations, certificate, tolerances)
    figure.suptitle(f"{trajectory.source} on {machine.name}: {certificate.duration:.1f} s, {len(struts)} points")
    figure.savefig(path, dpi=110, metadata={"Software": None})
    return ()


def _path(axes: Any, trajectory: Trajectory, motion: Motion) -> None:
    """The tip's way by operation, rapid moves thin, and some of the tool axes."""
    operation = trajectory.operation[motion.segment]
    rapid = trajectory.kind[motion.segment] == Kind.RAPID
    for number, name in enumerate(trajectory.operations):
        axes.plot(*_only(motion.tip, (operation == number) & ~rapid), linewidth=0.8, label=name)
    axes.plot(*_only(motion.tip, rapid), color="0.6", linewidth=0.6, linestyle=":", label="rapid")
    cutting = np.flatnonzero(~rapid)
    some = cutting[np.unique(np.linspace(0, len(cutting) - 1, _AXES_SHOWN).astype(int))] if len(cutting) else cutting
    ends = motion.tip[some] + _AXIS_DRAWN * motion.axis[some]
    for tip, end in zip(motion.tip[some], ends, strict=True):
        axes.plot(*np.column_stack([tip, end]), color="0.5", linewidth=0.4)
    axes.set_aspect("equal")
    axes.set(xlabel="x mm", ylabel="y mm", zlabel="z mm", title="tool tip and tool axis in the machine frame")
    axes.legend(fontsize="small", loc="upper left")


def _only(points: Array, chosen: Array) -> Array:
    """Coordinates of the chosen points, (3, N), with gaps where others were left out."""
    return np.where(chosen[:, None], points, np.nan).T


def _lengths(axes: Any, struts: StrutMotion, machine: Machine) -> None:
    rows = _shown(len(struts))
    for strut in range(6):
        axes.plot(struts.time_ms[rows] / 1000, struts.length[rows, strut], linewidth=0.8, label=f"strut {strut + 1}")
    for limit in machine.strut_stroke:
        axes.axhline(limit, **_LIMIT)
    axes.set(ylabel="strut length mm", title="as read back from the motion program; dashed: limits")
    axes.legend(fontsize="x-small", ncols=6, loc="center")


def _speeds(axes: Any, struts: StrutMotion, machine: Machine) -> None:
    rows = _shown(len(struts))
    axes.plot(struts.time_ms[rows] / 1000, struts.speed[rows], linewidth=0.6)
    for limit in (-machine.strut_speed, machine.strut_speed):
        axes.axhline(limit, **_LIMIT)
    axes.set(ylabel="strut speed mm/s")


def _deviations(axes: Any, certificate: Certificate, tolerances: Tolerances) -> None:
    rows = _shown(len(certificate.time))
    axes.plot(
        certificate.time[rows],
        certificate.tip_deviation[rows] / certificate.tip_tolerance[rows],
        linewidth=0.5,
        label="tip",
    )
    axes.plot(certificate.time[rows], certificate.axis_deviation[rows] / tolerances.axis, linewidth=0.5, label="axis")
    axes.axhline(1.0, **_LIMIT)
    told = f"tip {1000 * tolerances.tip:g} um, axis {np.degrees(tolerances.axis):g} degrees"
    axes.set(xlabel="time s", ylabel="deviation by tolerance", title=f"tolerances: {told}", ylim=(0, 1.1))
    axes.legend(fontsize="small", loc="center right")


def _shown(count: int) -> Array:
    """Rows to draw: all, or as many evenly spread ones as a picture can show."""
    return np.unique(np.linspace(0, count - 1, min(count, _POINTS_SHOWN)).astype(np.int64))
