# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish view: the operation in the tree, and its panel.

Takes a view object and sets CAM's own provider for operations, with the icon and page of this one. Saved documents
store the module of this class: module and class name are a file format.
"""

from __future__ import annotations

from typing import Any

import Path.Op.Gui.Base as CamGui
import Path.Op.Gui.Selection as CamSelection

from pkm_post.freecad_gui.context_menu import add_commands, add_switch
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.surface_finish_panel import SurfaceFinishPage

_ICON = str(ICONS / "surface_finish.svg")


class SurfaceFinishView(CamGui.ViewProvider):
    """CAM's provider: a double click opens CAM's panel with faces, heights and the page of this operation."""

    def __init__(self, vobj: Any) -> None:
        resources = CamGui.CommandResources("Surface Finish", None, SurfaceFinishPage, "", "", None, "")
        super().__init__(vobj, resources)
        self.OpIcon, self.deleteOnReject = _ICON, False  # else CAM's panel begins without the faces it was made for
        vobj.Proxy = self

    def getSelectionFactory(self) -> Any:
        """Allow picking faces, as in CAM's own surface operation."""
        return CamSelection.select("Surface")

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add CAM's own entry, which opens the panel, and the commands for the operation."""
        super().setupContextMenu(vobj, menu)
        add_switch(menu, vobj.Object)
        add_commands(menu, vobj.Object, "PKM_Mirror", "PKM_Rotate")

    def dumps(self) -> None:
        """Save nothing: the path of the icon differs between computers."""

    def loads(self, state: object) -> None:
        """Restore the state of a new, accepted operation."""
        self.OpName, self.OpIcon = "Surface Finish", _ICON
        self.OpPageModule, self.OpPageClass = SurfaceFinishPage.__module__, SurfaceFinishPage.__name__
        self.deleteOnReject = False
        self.panel = None
