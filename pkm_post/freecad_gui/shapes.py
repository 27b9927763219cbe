# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes: bodies of revolution and visible points for the 3D view, built once and moved only by transforms.

Takes profiles and points in mm; returns Coin nodes. All drawn machine parts are round.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pivy import coin

from pkm_post.geometry import Array
from pkm_post.model import Shank, Tool
from pkm_post.toolpath import Cutter

Colour = tuple[float, float, float]
"""Red, green and blue from 0 to 1."""

_CIRCLE_SIDES = 32
_ARC_STEPS = 8
_CREASE = 0.6
"""rad: crease angle below which the faces of a surface are shaded as one, so that it looks round."""


def material(colour: Colour) -> coin.SoMaterial:
    """The material of a body."""
    node = coin.SoMaterial()
    node.diffuseColor = colour
    node.specularColor = (0.08, 0.08, 0.08)
    node.shininess = 0.3
    return node


def revolved(profile: Array) -> coin.SoSeparator:
    """A profile revolved about z.

    Args:
        profile: (N, 2) radii and heights in mm.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, _CIRCLE_SIDES + 1)
    radius, height = profile.T
    points = np.empty((len(profile), len(angle), 3))
    points[..., 0] = radius[:, None] * np.cos(angle)
    points[..., 1] = radius[:, None] * np.sin(angle)
    points[..., 2] = height[:, None]
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.creaseAngle = _CREASE
    coordinates, mesh = coin.SoCoordinate3(), coin.SoQuadMesh()
    coordinates.point.setValues(0, points.size // 3, points.reshape(-1, 3).tolist())
    mesh.verticesPerColumn, mesh.verticesPerRow = len(profile), len(angle)
    return group(hints, coordinates, mesh)


def cylinder(radius: float, start: float, end: float) -> coin.SoSeparator:
    """A closed cylinder about z, between two heights."""
    place, node = coin.SoTransform(), coin.SoCylinder()
    place.translation = (0.0, 0.0, (start + end) / 2.0)
    place.rotation = coin.SbRotation(coin.SbVec3f(0, 1, 0), coin.SbVec3f(0, 0, 1))  # Coin's cylinder is about y
    node.radius, node.height = radius, end - start
    return group(place, node)


def beam(start: Array, end: Array, radius: float) -> coin.SoSeparator:
    """A cylinder between two points, with spherical ends."""
    way = end - start
    length = float(np.linalg.norm(way))
    bar = (cylinder(radius, 0.0, length),) if length > 0.0 else ()
    return group(pointing(start, way if length > 0.0 else (0, 0, 1)), ball(radius), *bar)


def ball(radius: float) -> coin.SoSeparator:
    """A sphere."""
    node = coin.SoSphere()
    node.radius = radius
    return group(node)


def cutter(diameter: float, corner_radius: float, length: float) -> coin.SoSeparator:
    """A cutter with its tip at the origin and a straight shank of its length."""
    radius = diameter / 2.0
    corner = min(corner_radius, radius)
    angle = np.linspace(0.0, np.pi / 2.0, _ARC_STEPS + 1)
    arc = np.column_stack([radius - corner + corner * np.sin(angle), corner * (1.0 - np.cos(angle))])
    return revolved(np.vstack([(0.0, 0.0), arc, (radius, length), (0.0, length)]))


def mill(tool: Tool, shank: Shank | None) -> coin.SoSeparator:
    """A tool of known diameter with its tip at the origin: its cutting part, and its shank up to the gauge length.

    Args:
        tool: with its angles and corner radius.
        shank: None if it is unknown: the side then goes up to the gauge length.
    """
    outline = Cutter.of(tool)
    top = tool.length if shank is None else min(shank.start, tool.length)
    angle = np.linspace(outline.corner_start, outline.corner_end, _ARC_STEPS + 1)
    radius = outline.radial_offset + outline.corner_radius * np.sin(angle)
    height = outline.axial_offset - outline.corner_radius * np.cos(angle)
    side = max(radius[-1] + max(top - height[-1], 0.0) * np.tan(tool.side_angle), 0.0)
    upper = side if shank is None else shank.diameter / 2.0
    above = [(side, top), (upper, top), (upper, tool.length), (0.0, tool.length)]
    return revolved(np.vstack([(0.0, 0.0), np.column_stack([np.maximum(radius, 0.0), height]), above]))


def group(*children: coin.SoNode) -> coin.SoSeparator:
    """Nodes whose state does not leak."""
    separator = coin.SoSeparator()
    for child in children:
        separator.addChild(child)
    return separator


def pointing(start: Sequence[float], direction: Sequence[float]) -> coin.SoTransform:
    """A transform that maps z to a direction and the origin to a point."""
    node = coin.SoTransform()
    aim(node, start, direction)
    return node


def aim(node: coin.SoTransform, start: Sequence[float], direction: Sequence[float]) -> None:
    """Set a transform to map z to a direction and the origin to a point."""
    node.translation = tuple(float(value) for value in start)
    node.rotation = coin.SbRotation(coin.SbVec3f(0, 0, 1), coin.SbVec3f(*(float(value) for value in direction)))


Point = Sequence[float]

OUT: Colour = (0.85, 0.0, 0.0)
"""Colour for violated limits."""


def segments(start: Array, end: Array, colour: Colour, width: float = 1.0) -> coin.SoSeparator:
    """Straight lines between points.

    Args:
        start: (N, 3) their beginnings.
        end: (N, 3) their ends.
        colour: of all of them.
        width: of all of them, pixels.
    """
    light, ink, coordinates, lines = coin.SoLightModel(), coin.SoBaseColor(), coin.SoCoordinate3(), coin.SoLineSet()
    style = coin.SoDrawStyle()
    light.model, style.lineWidth = coin.SoLightModel.BASE_COLOR, width
    ink.rgb = colour
    points = np.stack([start, end], axis=1).reshape(-1, 3)
    coordinates.point.setValues(0, len(points), points.tolist())
    lines.numVertices.setValues(0, len(start), [2] * len(start))
    return group(light, style, ink, coordinates, lines)


def fade(node: coin.SoNode, transparency: float) -> None:
    """Give all materials of a scene the same transparency, 0 to 1."""
    search = coin.SoSearchAction()
    search.setType(coin.SoMaterial.getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.apply(node)
    paths = search.getPaths()
    for number in range(paths.getLength()):
        paths[number].getTail().transparency = transparency


def points_through(points: Sequence[Point], colour: Colour, size: float) -> coin.SoSeparator:
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
