# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture of a reach map: horizontal slices, each with the angle by which the tool may tilt."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Diagnostic
from pkm_post.report.plots import missing_matplotlib, save

_MOST_LEVELS = 6


def draw_reach(path: Path, machine: str, tip: Array, cone: Array) -> tuple[Diagnostic, ...]:
    """Draw a reach map on a grid to a PNG file.

    Args:
        path: path of the file.
        machine: name of the machine.
        tip: (N, 3) grid points in {M}, mm.
        cone: (N,) half angles, rad; negative for unreachable points.
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
    degrees = np.where(cone < 0, np.nan, np.degrees(cone))
    for panel in panels.ravel()[len(shown) :]:
        panel.remove()
    for panel, height in zip(panels.ravel(), shown, strict=False):
        level = tip[:, 2] == height
        image = _level(panel, tip[level], degrees[level], float(np.nanmax(degrees, initial=1.0)))
        panel.set_title(f"z = {height:g} mm")
    figure.colorbar(image, ax=panels.ravel().tolist()[: len(shown)], label="widest cone of the tool axis, degrees")
    figure.suptitle(f"Reach of {machine}", parse_math=False)
    save(figure, path, dpi=90)
    return ()


def _level(panel: Any, tip: Array, degrees: Array, highest: float) -> Any:
    x, y = np.unique(tip[:, 0]), np.unique(tip[:, 1])
    order = np.lexsort([tip[:, 0], tip[:, 1]])
    field = degrees[order].reshape(len(y), len(x))
    panel.set_aspect("equal")
    panel.set_xlabel("x, mm")
    panel.set_ylabel("y, mm")
    return panel.pcolormesh(x, y, field, vmin=0.0, vmax=highest, shading="nearest")
