# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margin colours: red out of limits, amber to green by margin; coloured lines and surfaces, and their legend.

Takes margins; returns colours or Coin nodes. The legend has a camera of its own, so that it stays in its corner.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import FreeCAD
import FreeCADGui
import numpy as np
from pivy import coin
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_gui.shapes import OUT, group
from pkm_post.freecad_gui.theme import theme
from pkm_post.geometry import Array

translate = FreeCAD.Qt.translate

_NEAR, _FAR = np.array([1.0, 0.65, 0.0]), np.array([0.1, 0.65, 0.2])
_CORNER = (-0.97, -0.6, 0.0)
"""Lower left corner of a bar; the sides of the view are at -1 and 1."""
_LINES, _BAR_WIDTH, _ROOM = 12, 1.4, 0.6
"""Height of the bar in lines of text; its width and padding, in line heights."""
_STEPS = 20
_BELOW = 0.1
"""Share of the bar for violations."""
_LINE_WIDTH = 3.0


def colours_of(margin: Array, top: float = 0.0) -> Array:
    """Colours (N, 3) of margins (N,): red below 0, amber at 0 to green at ``top``, by default the largest."""
    top = top or largest(margin)
    share = np.clip(margin / top, 0.0, 1.0)[:, None]
    return np.where(margin[:, None] < 0.0, OUT, (1.0 - share) * _NEAR + share * _FAR)


def largest(margin: Array) -> float:
    """The margin that is fully green."""
    return max(float(margin.max(initial=0.0)), 1e-9)


def legend(title: str, top: str) -> coin.SoSeparator:
    """A bar from 0 to the largest margin with red below it, in the lower left corner.

    Args:
        title: the quantity of the margins.
        top: the largest margin as text.
    """
    shares = np.linspace(-_BELOW, 1.0, _STEPS + 1)
    texts = ((1.0, top), (_BELOW, "0"), (0.0, translate("PKM_Reach", "out of limits")))
    return colour_bar(title, colours_of(shares), texts)


def colour_bar(title: str, colours: Array, texts: Sequence[tuple[float, str]]) -> coin.SoSeparator:
    """A bar of colours with texts beside it, in the lower left corner, sized by FreeCAD's font.

    Args:
        title: above the bar.
        colours: (N, 3) from below, evenly spaced.
        texts: each with its height as a share of the bar.
    """
    camera, place, sheet = coin.SoOrthographicCamera(), coin.SoTranslation(), coin.SoImage()
    camera.viewportMapping = coin.SoCamera.LEAVE_ALONE
    camera.position, camera.height = (0.0, 0.0, 1.0), 2.0
    place.translation = _CORNER
    pixels = _pixels(_drawn(title, colours, texts))
    sheet.image.setValue(coin.SbVec2s(pixels.shape[1], pixels.shape[0]), 3, pixels.tobytes())
    sheet.horAlignment, sheet.vertAlignment = coin.SoImage.LEFT, coin.SoImage.BOTTOM
    node = coin.SoAnnotation()
    for child in (camera, place, sheet):
        node.addChild(child)
    return node


def coloured_path(points: Sequence[Sequence[float]], colours: Array) -> coin.SoSeparator:
    """A line through points, with a colour at each.

    Args:
        points: N positions.
        colours: (N, 3).
    """
    light, style = coin.SoLightModel(), coin.SoDrawStyle()
    light.model, style.lineWidth = coin.SoLightModel.BASE_COLOR, _LINE_WIDTH
    colour, binding = coin.SoBaseColor(), coin.SoMaterialBinding()
    colour.rgb.setValues(0, len(colours), colours.tolist())
    binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    coordinates, lines = coin.SoCoordinate3(), coin.SoIndexedLineSet()
    coordinates.point.setValues(0, len(points), points)
    lines.coordIndex.setValues(0, len(points) + 1, [*range(len(points)), -1])
    return group(light, style, colour, binding, coordinates, lines)


def coloured_surface(points: Array, triangles: Array, colours: Array) -> coin.SoSeparator:
    """Triangles with a colour at each point, drawn just in front of coincident surfaces.

    Args:
        points: (N, 3).
        triangles: (T, 3) rows of points.
        colours: (N, 3).
    """
    light, hints, offset = coin.SoLightModel(), coin.SoShapeHints(), coin.SoPolygonOffset()
    light.model = coin.SoLightModel.BASE_COLOR
    hints.vertexOrdering = coin.SoShapeHints.UNKNOWN_ORDERING  # both sides are visible
    offset.factor, offset.units = -2.0, -2.0
    ink, binding = coin.SoBaseColor(), coin.SoMaterialBinding()
    ink.rgb.setValues(0, len(colours), colours.tolist())
    binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    coordinates, faces = coin.SoCoordinate3(), coin.SoIndexedFaceSet()
    coordinates.point.setValues(0, len(points), points.tolist())
    rows = np.column_stack([triangles, np.full(len(triangles), -1)]).ravel()
    if len(rows):
        faces.coordIndex.setValues(0, len(rows), rows.tolist())
    return group(light, hints, offset, ink, binding, coordinates, faces)


def _drawn(title: str, colours: Array, texts: Sequence[tuple[float, str]]) -> QtGui.QImage:
    """A bar with its texts, drawn by Qt: Coin's own fonts may lack Chinese."""
    font, ratio = QtWidgets.QApplication.font(), FreeCADGui.getMainWindow().devicePixelRatioF()
    metrics, look = QtGui.QFontMetricsF(font), theme()
    line = metrics.height()
    room, left = _ROOM * line, (2 * _ROOM + _BAR_WIDTH) * line
    beside = max(metrics.horizontalAdvance(text) for _, text in texts)
    width = room + max(room + metrics.horizontalAdvance(title), left + beside)
    area = QtCore.QRectF(room, 2.5 * room + line, _BAR_WIDTH * line, _LINES * line)
    size = (math.ceil(ratio * length) for length in (width, area.bottom() + 1.5 * room))
    image = QtGui.QImage(*size, QtGui.QImage.Format.Format_RGB888)
    image.setDevicePixelRatio(ratio)
    image.fill(QtGui.QColor(look.ground))
    painter = QtGui.QPainter(image)
    painter.setFont(font)
    painter.setPen(QtGui.QColor(look.ink))
    painter.fillRect(area, _gradient(area, colours))
    painter.drawText(QtCore.QPointF(room, room + metrics.ascent()), title)
    for share, text in texts:
        middle = area.bottom() - share * area.height()
        painter.drawText(QtCore.QPointF(left, middle + (metrics.ascent() - metrics.descent()) / 2), text)
    painter.end()
    return image


def _gradient(area: QtCore.QRectF, colours: Array) -> QtGui.QLinearGradient:
    """Colours from bottom to top of an area."""
    gradient = QtGui.QLinearGradient(area.bottomLeft(), area.topLeft())
    for share, colour in zip(np.linspace(0.0, 1.0, len(colours)).tolist(), colours.tolist(), strict=True):
        gradient.setColorAt(share, QtGui.QColor.fromRgbF(*colour))
    return gradient


def _pixels(image: QtGui.QImage) -> Array:
    """Pixels of an image, (height, width, 3), bottom row first, as in Coin."""
    rows = np.frombuffer(image.constBits(), dtype=np.uint8).reshape(image.height(), image.bytesPerLine())
    return np.ascontiguousarray(rows[::-1, : 3 * image.width()].reshape(image.height(), image.width(), 3))
