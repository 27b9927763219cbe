# SPDX-License-Identifier: LGPL-2.1-or-later
"""Setup: what is known of a job beside its motions: the part, the stock it is cut from, what holds it, and the tools.

Meshes are in the work frame {C}, in mm. What is not known is None or missing; then it is not checked, and the
certificate says so.
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
        source: where it comes from, as messages call it: the name of a file or of an object.
        triangles: (T, 3, 3) corners in {C}, anticlockwise as seen from outside.
        assumed: whether it was not chosen, such as the box CAM puts around a model: nothing about it is certain.
    """

    source: str
    triangles: Array
    assumed: bool = False

    def __post_init__(self) -> None:
        freeze(self, len(self.triangles), {"triangles": (np.float64, (3, 3))})


@dataclass(frozen=True)
class Shank:
    """What a tool is above its cutting edges.

    Attributes:
        start: height above the tip where the cutting edges end and the shank begins, mm.
        diameter: mm.
    """

    start: float
    diameter: float


@dataclass(frozen=True)
class Setup:
    """What is on the table, and what the tools are like above their cutting edges.

    Attributes:
        part: as it is to be in the end.
        stock: as it is before the first operation.
        fixtures: clamps, vice and whatever else stands still.
        shanks: by tool number, of the tools of which it is known.
        unknown_corners: numbers of tools whose corner radius is not known.
    """

    part: Mesh | None = None
    stock: Mesh | None = None
    fixtures: tuple[Mesh, ...] = ()
    shanks: Mapping[int, Shank] = field(default_factory=dict)
    unknown_corners: frozenset[int] = frozenset()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing that could be run into."""
        return self.part is None and self.stock is None and not self.fixtures


NOTHING_KNOWN = Setup()
"""The setup of a program that comes alone."""
