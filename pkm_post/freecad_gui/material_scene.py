# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material scene: the surface of a stock in the 3D view, brick by brick; only cut bricks are redrawn.

Takes the stock and the numbers of changed bricks; keeps a Coin node. Colours: by the cutting operation, or by distance
from the part, from blue for excess over green to red for gouges.
"""

from __future__ import annotations

import numpy as np
from pivy import coin

from pkm_post.freecad_app.material import Material
from pkm_post.freecad_gui.deviation_map import deviation_colours, deviation_legend
from pkm_post.freecad_gui.shapes import group
from pkm_post.geometry import Array
from pkm_post.removal import BrickSurface, brick_surfaces

_BLANK = (0.72, 0.60, 0.42)
_CREASE = 0.5


class MaterialScene:
    """The surface of a stock.

    Attributes:
        root: the node to add to a view.
        scale: distance from the part for full colour, mm; 0 shows the material without comparison.
    """

    def __init__(self, material: Material) -> None:
        self.material, self.scale = material, 0.0
        self._bricks: dict[int, _Brick] = {}
        hints, look = coin.SoShapeHints(), coin.SoMaterial()
        hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE  # not solid: a section shows the inner side
        hints.creaseAngle = _CREASE
        look.diffuseColor = _BLANK
        look.specularColor = (0.1, 0.1, 0.1)
        self._all = coin.SoSeparator()
        self._all.renderCaching = coin.SoSeparator.OFF
        self._legend = coin.SoSeparator()
        self.root = group(hints, look, self._all, self._legend)
        self.show_all()

    def show_all(self) -> None:
        """Draw all bricks on the surface, and the colour legend."""
        self._legend.removeAllChildren()
        if self.scale > 0.0:
            self._legend.addChild(deviation_legend(self.scale, self.scale))
        passed = self.material.replay.stock.on_surface
        gone = np.array([brick for brick in self._bricks if not passed[brick]], dtype=np.int64)
        self.show(np.concatenate([np.flatnonzero(passed), gone]))

    def show(self, bricks: Array) -> None:
        """Redraw changed bricks."""
        compared = self.material.part_distances if self.scale > 0.0 else None
        for surface in brick_surfaces(self.material.replay.stock, bricks, compared):
            self._draw(surface)

    def _draw(self, surface: BrickSurface) -> None:
        drawn = self._bricks.get(surface.brick)
        if drawn is None:
            if not len(surface.faces):
                return
            drawn = self._bricks[surface.brick] = _Brick()
            self._all.addChild(drawn.shape)
        drawn.take(surface, self.scale)


class _Brick:
    """The surface in one brick."""

    def __init__(self) -> None:
        self.shape, self._vertices = coin.SoIndexedFaceSet(), coin.SoVertexProperty()
        self._vertices.normalBinding = coin.SoVertexProperty.PER_VERTEX_INDEXED
        self.shape.vertexProperty = self._vertices

    def take(self, surface: BrickSurface, scale: float) -> None:
        """Show another surface."""
        vertices = self._vertices
        corners = np.column_stack([surface.faces, np.full(len(surface.faces), -1)]).ravel()
        self.shape.coordIndex.setNum(0)
        for field, values in ((vertices.vertex, surface.points), (vertices.normal, surface.normals)):
            field.setNum(len(values))
            if len(values):
                field.setValues(0, len(values), values.tolist())
        if len(corners):
            self.shape.coordIndex.setValues(0, len(corners), corners.tolist())
        self._colour(surface.values, scale)

    def _colour(self, values: Array, scale: float) -> None:
        vertices = self._vertices
        if not scale or not len(values):
            vertices.materialBinding = coin.SoVertexProperty.OVERALL
            vertices.orderedRGBA.setNum(0)
            return
        parts = (255 * deviation_colours(values, scale, scale)).astype(np.uint32)
        packed = (parts[:, 0] << 24) | (parts[:, 1] << 16) | (parts[:, 2] << 8) | np.uint32(255)
        vertices.materialBinding = coin.SoVertexProperty.PER_VERTEX_INDEXED
        vertices.orderedRGBA.setNum(len(packed))
        vertices.orderedRGBA.setValues(0, len(packed), packed.tolist())
