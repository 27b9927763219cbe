# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry view: how mirrored and turned operations look in the tree, and their panel.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from typing import Any

import FreeCADGui

from pkm_post.freecad_gui.views import View
from pkm_post.freecad_gui.workbench import ICONS


class SymmetryView(View):
    """The icon of a symmetric operation. The base stays where it is in the tree: the copy stands beside it."""

    def getIcon(self) -> str:
        """A mirror for operations with a plane, a turn for those with an angle."""
        return str(ICONS / ("rotate.svg" if hasattr(self.Object, "Angle") else "mirror.svg"))

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the panel."""
        return bool(vobj.Document.setEdit(vobj, 0))

    def setEdit(self, vobj: Any, _mode: int = 0) -> bool:
        """Open the panel."""
        from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

        FreeCADGui.Control.showDialog(SymmetryPanel(vobj.Object))
        return True

    def unsetEdit(self, _vobj: Any, _mode: int = 0) -> bool:
        """Close the panel."""
        FreeCADGui.Control.closeDialog()
        return True
