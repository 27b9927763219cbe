# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margin colours: red out of limits, amber to green by margin; and their legend in the 3D view.

Takes margins; returns colours or Coin nodes. The legend has a camera of its own, so that it stays in its corner.
"""

from __future__ import annotations

import numpy as np
from pivy import coin

from pkm_post.freecad_gui.shapes import OUT
from pkm_post.geometry import Array

_NEAR, _FAR = np.array([1.0, 0.65, 0.0]), np.array([0.1, 0.65, 0.2])
_BAR = (-0.96, -0.92, -0.55, 0.15)
"""Left, right, bottom and top of the bar in the square from -1 to 1."""
_STEPS = 16
_SHEET_WIDTH = 0.27
_SHEET = (0.93, 0.93, 0.93)
"""Colour behind the legend, for contrast with any background."""


def colours_of(margin: Array) -> Array:
    """Colours (N, 3) of margins (N,): red below 0, then from amber at 0 to green at the largest."""
    top = largest(margin)
    share = np.clip(margin / top, 0.0, 1.0)[:, None]
    return np.where(margin[:, None] < 0.0, OUT, (1.0 - share) * _NEAR + share * _FAR)


def largest(margin: Array) -> float:
    """The margin that is fully green."""
    return max(float(margin.max(initial=0.0)), 1e-9)


def legend(title: str, top: float, unit: str) -> coin.SoSeparator:
    """A bar from 0 to the largest margin with red below it, in the lower left corner."""
    left, right, bottom, up = _BAR
    camera, light = coin.SoOrthographicCamera(), coin.SoLightModel()
    camera.viewportMapping = coin.SoCamera.LEAVE_ALONE
    camera.position, camera.height = (0.0, 0.0, 1.0), 2.0
    light.model = coin.SoLightModel.BASE_COLOR
    heights = np.linspace(bottom, up, _STEPS + 1)
    shares = np.linspace(0.0, 1.0, _STEPS + 1)
    below, sheet = np.array([bottom - 0.08, bottom]), np.array([bottom - 0.12, up + 0.12])
    node = coin.SoAnnotation()
    for child in (
        camera,
        light,
        *_quads(left - 0.02, left + _SHEET_WIDTH, sheet, np.tile(_SHEET, (2, 1))),
        *_quads(left, right, heights, colours_of(shares)),
        *_quads(left, right, below, np.tile(OUT, (2, 1))),
    ):
        node.addChild(child)
    texts = (
        (left, up + 0.06, title),
        (right + 0.02, up - 0.02, f"{top:.4g} {unit}".rstrip()),
        (right + 0.02, bottom - 0.01, "0"),
        (right + 0.02, bottom - 0.09, "out of limits"),
    )
    for x, y, text in texts:
        node.addChild(_text(x, y, text))
    return node


def _quads(left: float, right: float, heights: Array, colours: Array) -> tuple[coin.SoNode, ...]:
    points = [(x, float(y), 0.0) for y in heights for x in (left, right)]
    material, binding = coin.SoBaseColor(), coin.SoMaterialBinding()
    material.rgb.setValues(0, 2 * len(colours), np.repeat(colours, 2, axis=0).tolist())
    binding.value = coin.SoMaterialBinding.PER_VERTEX
    coordinates, mesh = coin.SoCoordinate3(), coin.SoQuadMesh()
    coordinates.point.setValues(0, len(points), points)
    mesh.verticesPerRow, mesh.verticesPerColumn = 2, len(heights)
    return coordinates, material, binding, mesh


def _text(x: float, y: float, text: str) -> coin.SoSeparator:
    separator, place, ink, words = coin.SoSeparator(), coin.SoTranslation(), coin.SoBaseColor(), coin.SoText2()
    place.translation = (x, y, 0.0)
    ink.rgb = (0.1, 0.1, 0.1)
    words.string = text
    for child in (place, ink, words):
        separator.addChild(child)
    return separator
