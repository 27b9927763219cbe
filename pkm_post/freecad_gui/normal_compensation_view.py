# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation view: how the dress-up looks in the tree, its base below it.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

ICONS = Path(__file__).parents[2] / "resources" / "icons"


class NormalCompensationView:
    """The icon of the dress-up, and its base as its child. That the base goes back is up to the object itself."""

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self

    def attach(self, vobj: Any) -> None:
        """Remember the object that is shown; called for new and for restored ones."""
        self.Object = vobj.Object

    def getIcon(self) -> str:
        """A cutter on a curved surface."""
        return str(ICONS / "normal_compensation.svg")

    def claimChildren(self) -> list[Any]:
        """The operation below."""
        return [] if self.Object.Base is None else [self.Object.Base]

    def dumps(self) -> None:
        """Nothing is saved."""

    def loads(self, state: object) -> None:
        """Nothing was saved."""
