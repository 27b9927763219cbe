# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deviation map: a surface coloured by excess material, in blue, and gouge depth, in red; with a legend.

Takes points, their triangles, and distances in mm; returns Coin nodes. The legend stays in the lower left corner of
the view; its numbers are in the units of the user.
"""

from __future__ import annotations

import FreeCAD
import numpy as np
from pivy import coin

from pkm_post.freecad_app.surface_check import Checked
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.margin_colours import colour_bar, coloured_surface
from pkm_post.freecad_gui.shapes import OUT, group, points_through
from pkm_post.geometry import Array

translate = FreeCAD.Qt.translate

GOUGE, RIGHT, LEFT = np.array([0.85, 0.0, 0.0]), np.array([0.25, 0.7, 0.3]), np.array([0.2, 0.4, 0.95])
_MARK_SIZE = 11.0
_SHARES = np.linspace(-1.0, 1.0, 17)
_SMALLEST = 1e-6
"""mm: the least scale."""


def deviation_colours(values: Array, gouge: float, left: float) -> Array:
    """Colours (V, 3) of distances from the part (V,): green at 0, blue where material is left, red where it is gouged.

    Args:
        values: positive where material is left, negative inside the part, mm.
        gouge: depth of full red, mm.
        left: distance of full blue, mm.
    """
    scale = np.where(values < 0.0, gouge, left)
    share = np.clip(np.abs(values) / scale, 0.0, 1.0)[:, None]
    return (1.0 - share) * RIGHT + share * np.where(values[:, None] < 0.0, GOUGE, LEFT)


def deviation_legend(gouge: float, left: float) -> coin.SoSeparator:
    """The bar of these colours, labelled in the user's units; scales in mm."""
    colours = deviation_colours(_SHARES, 1.0, 1.0)
    texts = (
        (1.0, translate("DeviationMap", "left: {}").format(amount_text(left, "mm"))),
        (0.5, "0"),
        (0.0, translate("DeviationMap", "gouged: {}").format(amount_text(gouge, "mm"))),
    )
    return colour_bar(translate("DeviationMap", "distance from the part"), colours, texts)


def measured_map(measured: Checked, tolerance: float) -> coin.SoSeparator:
    """The deviations of a path from the faces of a model, with the deepest gouge marked if it exceeds a tolerance.

    Args:
        measured: the points with their distances.
        tolerance: acceptable gouge depth and excess, mm.
    """
    values = np.where(measured.depth > 0.0, -measured.depth, np.nan_to_num(measured.left, nan=0.0))
    gouge, left = max(measured.gouge, tolerance, _SMALLEST), max(measured.excess, tolerance, _SMALLEST)
    surface = coloured_surface(measured.points, measured.triangles, deviation_colours(values, gouge, left))
    if measured.gouge <= tolerance:
        return group(surface, deviation_legend(gouge, left))
    mark = points_through([tuple(measured.gouge_point.tolist())], OUT, _MARK_SIZE)
    return group(surface, mark, deviation_legend(gouge, left))
