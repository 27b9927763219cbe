# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normal Compensation view: the dress-up in the tree, with its base below it.

Takes a view object and sets its provider. Saved documents store the module of this class: module and class name are a
file format.
"""

from __future__ import annotations

from typing import Any

from pkm_post.freecad_gui.context_menu import add_commands
from pkm_post.freecad_gui.views import View


class NormalCompensationView(View):
    """The icon of the dress-up, and its base as its child. The object itself restores its base on deletion."""

    icon = "normal_compensation.svg"

    def claimChildren(self) -> list[Any]:
        """The base operation."""
        return [] if self.Object.Base is None else [self.Object.Base]

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the commands for the operation."""
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object, "PKM_Mirror", "PKM_Rotate")
