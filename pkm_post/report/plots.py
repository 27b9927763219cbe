# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plots: the picture of the report, and that of a reach map.

The first shows the path in 3D with the tool axes, strut lengths and speeds over time with their limits, and the
deviations from the certificate; the second, horizontal slices with the angle by which the tool may tilt. Without
matplotlib there is a warning instead.
"""

from __future__ import annotations

import importlib
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import (
    Certificate,
    Diagnostic,
    Diagnostics,
    Kind,
    Machine,
    Motion,
    Place,
    StrutMotion,
    Tolerances,
    Trajectory,
)
from pkm_post.report.charts import decimated
from pkm_post.report.results import Results

_MATPLOTLIB = ("matplotlib.backends.backend_agg", "matplotlib.figure", "mpl_toolkits.mplot3d")
"""Required modules; the last provides 3D axes."""
_LIMIT = {"color": "0.3", "linestyle": "--", "linewidth": 0.8}
_AXES_SHOWN = 150
_AXIS_DRAWN = 15.0
"""mm"""
_PATH = (0.03, 0.02, 0.87, 0.88)
_PLOTS_OVER_TIME = {"left": 0.09, "right": 0.99, "bottom": 0.06, "top": 0.92, "hspace": 0.16}
"""Shares of the subfigure; an automatic layout takes as long as drawing it."""


def missing_matplotlib(picture: Path) -> Diagnostics:
    """Warn if no picture can be drawn.

    The import may raise anything, as with a matplotlib built for another NumPy.
    """
    try:
        for module in _MATPLOTLIB:
            importlib.import_module(module)
    except Exception as fault:
        return (Diagnostic("F102", Place(picture.name), f"{type(fault).__name__}: {fault}"),)
    return ()


def draw_report(path: Path, results: Results) -> Diagnostics:
    """Draw the picture of the report to a PNG file; a missing matplotlib is a warning."""
    trajectory, machine, motion, struts = results.trajectory, results.machine, results.motion, results.struts
    missing = missing_matplotlib(path)
    if missing:
        return missing
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 9))
    FigureCanvasAgg(figure)
    left, right = figure.subfigures(1, 2, width_ratios=[1, 1.25])
    _path(left.add_axes(_PATH, projection="3d"), trajectory, motion)
    lengths, speeds, deviations = right.subplots(3, 1, sharex=True, gridspec_kw=_PLOTS_OVER_TIME)
    _lengths(lengths, struts, machine)
    _speeds(speeds, struts, machine)
    _deviations(deviations, results.certificate, results.tolerances)
    title = f"{trajectory.source} on {machine.name}: {results.certificate.duration:.1f} s, {len(struts)} points"
    figure.suptitle(title, parse_math=False)
    save(figure, path, dpi=110, pil_kwargs={"compress_level": 1})
    return ()


def save(figure: Any, path: Path, **how: Any) -> None:
    """Save a picture; characters that the font lacks are drawn as boxes, without a warning."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", r"Glyph \d+ .* missing", UserWarning)
        figure.savefig(path, metadata={"Software": None}, **how)


def _path(axes: Any, trajectory: Trajectory, motion: Motion) -> None:
    """Draw the path of the tip by operation, rapid moves thin, and some of the tool axes."""
    operation = trajectory.operation[motion.segment]
    rapid = trajectory.kind[motion.segment] == Kind.RAPID
    for number, name in enumerate(trajectory.operations):
        axes.plot(*_only(motion.tip, (operation == number) & ~rapid), linewidth=0.8, label=name)
    axes.plot(*_only(motion.tip, rapid), color="0.6", linewidth=0.6, linestyle=":", label="rapid")
    cutting = np.flatnonzero(~rapid)
    some = cutting[np.unique(np.linspace(0, len(cutting) - 1, _AXES_SHOWN).astype(int))] if len(cutting) else cutting
    ends = motion.tip[some] + _AXIS_DRAWN * motion.axis[some]
    gaps = np.full_like(ends, np.nan)
    axes.plot(*np.stack([motion.tip[some], ends, gaps], axis=1).reshape(-1, 3).T, color="0.5", linewidth=0.4)
    axes.set_aspect("equal")
    axes.set(xlabel="x mm", ylabel="y mm", zlabel="z mm", title="tool tip and tool axis in the machine frame")
    for name in axes.legend(fontsize="small", loc="upper left").get_texts():
        name.set_parse_math(False)


def _only(points: Array, chosen: Array) -> Array:
    """Coordinates of the chosen points, (3, N), with a gap after each run of them."""
    kept = chosen.copy()
    kept[1:] |= chosen[:-1]
    return np.where(chosen[kept, None], points[kept], np.nan).T


def _lengths(axes: Any, struts: StrutMotion, machine: Machine) -> None:
    for strut, line in enumerate(struts.length.T, 1):
        axes.plot(*decimated(struts.time_ms / 1000, line), linewidth=0.8, label=f"strut {strut}")
    for limit in machine.strut_stroke:
        axes.axhline(limit, **_LIMIT)
    axes.set(ylabel="strut length mm", title="as read back from the motion program; dashed: limits")
    axes.legend(fontsize="x-small", ncols=6, loc="center")


def _speeds(axes: Any, struts: StrutMotion, machine: Machine) -> None:
    for line in struts.speed.T:
        axes.plot(*decimated(struts.time_ms / 1000, line), linewidth=0.6)
    for limit in (-machine.strut_speed, machine.strut_speed):
        axes.axhline(limit, **_LIMIT)
    axes.set(ylabel="strut speed mm/s")


def _deviations(axes: Any, certificate: Certificate, tolerances: Tolerances) -> None:
    by_tolerance = {
        "tip": certificate.tip_deviation / certificate.tip_tolerance,
        "axis": certificate.axis_deviation / tolerances.axis,
    }
    for name, line in by_tolerance.items():
        axes.plot(*decimated(certificate.time, line), linewidth=0.5, label=name)
    axes.axhline(1.0, **_LIMIT)
    limits = f"tip {1000 * tolerances.tip:g} um, axis {np.degrees(tolerances.axis):g} degrees"
    axes.set(xlabel="time s", ylabel="deviation by tolerance", title=f"tolerances: {limits}", ylim=(0, 1.1))
    axes.legend(fontsize="small", loc="center right")


_MOST_LEVELS = 6


def draw_reach(path: Path, machine: str, tip: Array, cone: Array) -> Diagnostics:
    """Draw a reach map on a grid to a PNG file.

    Args:
        machine: name of the machine.
        tip: (N, 3) grid points in {M}, mm.
        cone: (N,) half angles, rad; negative for unreachable points.
    """
    degrees = np.where(cone < 0, np.nan, np.degrees(cone))
    return draw_levels(path, f"Reach of {machine}", "widest cone of the tool axis, degrees", tip, degrees)


def draw_levels(path: Path, title: str, label: str, tip: Array, values: Array) -> Diagnostics:
    """Draw values on a grid to a PNG file, with a panel per height.

    Args:
        title: heading, shown as it is.
        label: name of the values, with their unit.
        tip: (N, 3) grid points in {M}, mm.
        values: (N,) from 0; NaN for missing ones.
    """
    missing = missing_matplotlib(path)
    if missing:
        return missing
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    heights = np.unique(tip[:, 2])
    shown = heights[np.unique(np.linspace(0, len(heights) - 1, _MOST_LEVELS).astype(np.int64))]
    figure = Figure(figsize=(4.2 * min(3, len(shown)), 4.0 * -(-len(shown) // 3)), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(-(-len(shown) // 3), min(3, len(shown)), squeeze=False, sharex=True, sharey=True)
    for panel in panels.ravel()[len(shown) :]:
        panel.remove()
    for panel, height in zip(panels.ravel(), shown, strict=False):
        level = tip[:, 2] == height
        image = _level(panel, tip[level], values[level], float(np.nanmax(values, initial=1.0)))
        panel.set_title(f"z = {height:g} mm")
    figure.colorbar(image, ax=panels.ravel().tolist()[: len(shown)], label=label)
    figure.suptitle(title, parse_math=False)
    save(figure, path, dpi=90)
    return ()


def _level(panel: Any, tip: Array, values: Array, highest: float) -> Any:
    x, y = np.unique(tip[:, 0]), np.unique(tip[:, 1])
    order = np.lexsort([tip[:, 0], tip[:, 1]])
    field = values[order].reshape(len(y), len(x))
    panel.set_aspect("equal")
    panel.set_xlabel("x, mm")
    panel.set_ylabel("y, mm")
    return panel.pcolormesh(x, y, field, vmin=0.0, vmax=highest, shading="nearest")
