# SPDX-License-Identifier: LGPL-2.1-or-later
"""Marks: points that are visible through the part.

Takes points in mm and a colour; returns a Coin node.
"""

from __future__ import annotations

from collections.abc import Sequence

from pivy import coin

from pkm_post.freecad_gui.lathe import Colour

Point = Sequence[float]

OUT: Colour = (0.85, 0.0, 0.0)
"""Colour for violated limits."""


def marks(points: Sequence[Point], colour: Colour, size: float) -> coin.SoSeparator:
    """Points drawn over everything else.

    Args:
        points: their positions.
        colour: of all of them.
        size: of each, pixels.
    """
    separator, light, ink, style = coin.SoAnnotation(), coin.SoLightModel(), coin.SoBaseColor(), coin.SoDrawStyle()
    light.model, style.pointSize = coin.SoLightModel.BASE_COLOR, size
    ink.rgb = colour
    coordinates, node = coin.SoCoordinate3(), coin.SoPointSet()
    coordinates.point.setValues(0, len(points), [tuple(point) for point in points])
    for child in (light, ink, style, coordinates, node):
        separator.addChild(child)
    return separator
