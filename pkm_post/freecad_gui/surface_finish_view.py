# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish view: how the operation looks in the tree, and its panel.

A view object enters and gets CAM's own provider of operations, with the icon and the page of this one. Saved documents
name this class by its module: place and name are a file format.
"""

from __future__ import annotations

from typing import Any

import Path.Op.Gui.Base as CamGui
import Path.Op.Gui.Selection as CamSelection

from pkm_post.freecad_gui.context_menu import add_commands, add_switch
from pkm_post.freecad_gui.surface_finish_panel import SurfaceFinishPage
from pkm_post.freecad_gui.workbench import ICONS

_ICON = str(ICONS / "surface_finish.svg")


class SurfaceFinishView(CamGui.ViewProvider):
    """CAM's provider: double click opens CAM's panel with faces, heights and the page of this operation."""

    def __init__(self, vobj: Any) -> None:
        resources = CamGui.CommandResources("Surface Finish", None, SurfaceFinishPage, "", "", None, "")
        super().__init__(vobj, resources)
        self.OpIcon = _ICON
        vobj.Proxy = self

    def getSelectionFactory(self) -> Any:
        """Faces can be picked, as for CAM's own surface operation."""
        return CamSelection.select("Surface")

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """CAM's own entry, which opens the panel, and what can be made of the operation."""
        super().setupContextMenu(vobj, menu)
        add_switch(menu, vobj.Object)
        add_commands(menu, vobj.Object, "PKM_Mirror", "PKM_Rotate")

    def dumps(self) -> None:
        """Nothing is saved: where the icon lies is another place on another computer."""

    def loads(self, state: object) -> None:
        """Be as a new one that has been accepted."""
        self.OpName, self.OpIcon = "Surface Finish", _ICON
        self.OpPageModule, self.OpPageClass = SurfaceFinishPage.__module__, SurfaceFinishPage.__name__
        self.deleteOnReject = False
        self.panel = None
