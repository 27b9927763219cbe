# SPDX-License-Identifier: LGPL-2.1-or-later
"""Setup: known data of a job beside its motions: part, stock, fixtures and tools.

Meshes are in the work frame {C}, in mm. Unknown items are None or missing; they are not checked, and the certificate
states that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from pkm_post.model.columns import Array, freeze


@dataclass(frozen=True)
class Mesh:
    """The surface of a solid.

    Attributes:
        source: origin for messages: the name of a file or of an object.
        triangles: (T, 3, 3) corners in {C}, anticlockwise as seen from outside.
        assumed: whether it is a default, such as the box CAM puts around a model: nothing about it is certain.
    """

    source: str
    triangles: Array
    assumed: bool = False

    def __post_init__(self) -> None:
        freeze(self, len(self.triangles), {"triangles": (np.float64, (3, 3))})


@dataclass(frozen=True)
class Shank:
    """Shape of a tool above its cutting edges.

    Attributes:
        start: height above the tip where the cutting edges end and the shank begins, mm.
        diameter: mm.
    """

    start: float
    diameter: float


@dataclass(frozen=True)
class Setup:
    """Solids on the table, and tool shapes above the cutting edges.

    Attributes:
        part: the finished part.
        stock: the stock before the first operation.
        fixtures: clamps, vice and other fixed solids.
        shanks: by tool number, where known.
        unknown_corners: numbers of tools with unknown corner radius.
    """

    part: Mesh | None = None
    stock: Mesh | None = None
    fixtures: tuple[Mesh, ...] = ()
    shanks: Mapping[int, Shank] = field(default_factory=dict)
    unknown_corners: frozenset[int] = frozenset()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to collide with."""
        return self.part is None and self.stock is None and not self.fixtures


NOTHING_KNOWN = Setup()
"""Setup of a program without further data."""
