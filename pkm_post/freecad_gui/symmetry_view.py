# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry view: how mirrored and turned operations look in the tree.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

ICONS = Path(__file__).parents[2] / "resources" / "icons"


class SymmetryView:
    """The icon of a symmetric operation. The base stays where it is in the tree: the copy stands beside it."""

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Remember the object that is shown; called for new and for restored ones."""
        self.Object = vobj.Object

    def getIcon(self) -> str:
        """A mirror for operations with a plane, a turn for those with an angle."""
        return str(ICONS / ("rotate.svg" if hasattr(self.Object, "Angle") else "mirror.svg"))

    def claimChildren(self) -> list[Any]:
        """No children: the base has its own place in the job."""
        return []

    def dumps(self) -> None:
        """Nothing is saved."""

    def loads(self, state: object) -> None:
        """Nothing was saved."""
