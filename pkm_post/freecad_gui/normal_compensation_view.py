# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation view: how the dress-up looks in the tree, its base below it.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from typing import Any

from pkm_post.freecad_gui.context_menu import add_commands
from pkm_post.freecad_gui.views import View


class NormalCompensationView(View):
    """The icon of the dress-up, and its base as its child. That the base goes back is up to the object itself."""

    icon = "normal_compensation.svg"

    def claimChildren(self) -> list[Any]:
        """The operation below."""
        return [] if self.Object.Base is None else [self.Object.Base]

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """What can be made of the operation."""
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object, "PKM_Mirror", "PKM_Rotate")
