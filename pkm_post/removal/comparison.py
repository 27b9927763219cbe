# SPDX-License-Identifier: LGPL-2.1-or-later
"""Comparison: excess stock on the part, and gouges in it. Units: mm, mm^3."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.removal.mesh_distance import mesh_distances
from pkm_post.removal.stock import Stock, shares
from pkm_post.removal.surface import brick_surfaces

REACH = 6.0
"""Steps up to which distances from the part are measured."""


@dataclass(frozen=True)
class Comparison:
    """A stock and a part.

    Attributes:
        left: volume of the stock outside the part, mm^3.
        gouged: volume of the part outside the stock, mm^3.
        thickest: largest distance of the surface of the stock from the part, outside it, mm; at most ``limit``.
        deepest: largest distance inside it, mm; at most ``limit``.
        limit: largest measured distance, mm.
    """

    left: float
    gouged: float
    thickest: float
    deepest: float
    limit: float


def part_distances(stock: Stock, triangles: Array) -> Array:
    """Distances of the nodes of a stock from the part, (B, 512), negative inside, up to ``REACH`` steps.

    Args:
        triangles: (T, 3, 3) of the part in {C}, anticlockwise as seen from outside.
    """
    return mesh_distances(stock.grid, triangles, REACH * stock.grid.step)


def compare(stock: Stock, part: Array) -> Comparison:
    """Compare a stock with the part.

    Args:
        part: from ``part_distances``.
    """
    cell, limit = stock.grid.step**3, REACH * stock.grid.step
    more = shares(stock.field, stock.grid.step) - shares(part, stock.grid.step)
    found = brick_surfaces(stock, np.flatnonzero(stock.on_surface), part)
    values = np.concatenate([np.zeros(1), *(surface.values for surface in found)])
    return Comparison(
        left=float(np.maximum(more, 0.0).sum(dtype=np.float64) * cell),
        gouged=float(np.maximum(-more, 0.0).sum(dtype=np.float64) * cell),
        thickest=float(min(values.max(), limit)),
        deepest=float(min(abs(values.min()), limit)),
        limit=limit,
    )
