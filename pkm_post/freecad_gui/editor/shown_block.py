# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shown block: the path of one block of a part program, drawn over the program's path in the 3D view.

It is a branch of the scene beside FreeCAD's own: no document is changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pivy import coin

from pkm_post.geometry import Array

_COLOUR = 1.0, 0.45, 0.0


class ShownBlock:
    """At most one block at a time, in one scene."""

    def __init__(self) -> None:
        self._places, self._lines, self._points = coin.SoCoordinate3(), coin.SoLineSet(), coin.SoPointSet()
        self._branch = coin.SoSeparator()
        pick, colour, style, light = coin.SoPickStyle(), coin.SoBaseColor(), coin.SoDrawStyle(), coin.SoLightModel()
        pick.style = coin.SoPickStyle.UNPICKABLE
        colour.rgb.setValue(*_COLOUR)
        style.lineWidth, style.pointSize = 5, 8
        light.model = coin.SoLightModel.BASE_COLOR
        for node in (pick, light, colour, style, self._places, self._lines, self._points):
            self._branch.addChild(node)
        self._root: Any = None

    def show(self, root: Any, ways: Sequence[Array]) -> None:
        """Draw polylines (n, 3) in a scene; ``root`` may be None to draw nothing."""
        if root is not self._root:
            self.remove()
        if root is not None and self._root is None:
            root.addChild(self._branch)
            self._root = root
        points = [tuple(map(float, point)) for way in ways for point in way]
        self._places.point.deleteValues(0)
        self._places.point.setValues(0, len(points), points)
        self._lines.numVertices.deleteValues(0)
        self._lines.numVertices.setValues(0, len(ways), [len(way) for way in ways])
        self._points.numPoints = len(points) if len(ways) == 1 else 0

    def remove(self) -> None:
        """Remove the drawing."""
        if self._root is not None:
            self._root.removeChild(self._branch)
            self._root = None
