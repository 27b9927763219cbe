# SPDX-License-Identifier: LGPL-2.1-or-later
"""Symmetry view: mirrored and rotated operations in the tree, and their panel.

Takes a view object and sets its provider. Saved documents store the module of this class: module and class name are a
file format.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD

from pkm_post.freecad_gui.context_menu import add_commands, add_entry
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.verdict_icons import with_verdict
from pkm_post.freecad_gui.views import PanelView

translate = FreeCAD.Qt.translate


class SymmetryView(PanelView):
    """The icon of a symmetric operation. The base keeps its place in the tree, beside the copy."""

    def getIcon(self) -> Any:
        """A mirror icon for operations with a plane, a rotation icon for those with an angle; with the verdict."""
        return with_verdict(str(self._icon_file()), getattr(self, "Object", None))

    def _icon_file(self) -> Path:
        return ICONS / ("rotate.svg" if hasattr(getattr(self, "Object", None), "Angle") else "mirror.svg")

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the panel, and further copies."""
        add_entry(menu, translate("SymmetryPanel", "Edit"), lambda: self.doubleClicked(vobj), self._icon_file().name)
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object, "PKM_Mirror", "PKM_Rotate")

    def make_panel(self, obj: Any) -> Any:
        """The panel with the plane or the axis."""
        from pkm_post.freecad_gui.symmetry_panel import SymmetryPanel

        return SymmetryPanel(obj)
