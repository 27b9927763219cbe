# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach view: the tool path coloured by the margin of a check, with its legend and its worst point.

Takes a view object and sets its provider. Saved documents store the module of this class: module and class name are a
file format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np
from pivy import coin

from pkm_post.freecad_app.reach_object import WORST
from pkm_post.freecad_gui.context_menu import add_commands, add_entry
from pkm_post.freecad_gui.margin_colours import colours_of, largest, legend
from pkm_post.freecad_gui.shapes import OUT, points_through
from pkm_post.freecad_gui.views import DrawnView

translate = FreeCAD.Qt.translate

_LINE_WIDTH, _MARK_SIZE = 3.0, 11.0
_WORST_IN_LIMITS = (0.1, 0.2, 0.8)


class ReachView(DrawnView):
    """Draws the path. A double click opens the findings."""

    icon, mode = "reach.svg", "Reach"
    _panel: Any = None

    def updateData(self, _obj: Any, name: str) -> None:
        """Redraw when the path has its margins: these are set last."""
        if name in ("Margins", "Points"):
            self.refresh()

    def refresh(self) -> None:
        """Draw the path, if there is one."""
        self._root.removeAllChildren()
        obj = self.Object
        margin = np.array(getattr(obj, "Margins", ()))
        points = [tuple(point) for point in getattr(obj, "Points", ())]
        if not len(margin) or len(points) != len(margin) or obj.ColourBy not in (WORST, *obj.Checks):
            return
        self._root.addChild(_way(points, margin))
        worst, is_out, unit = _worst(obj, points, margin)
        self._root.addChild(points_through([worst], OUT if is_out else _WORST_IN_LIMITS, _MARK_SIZE))
        shown = coin.SoType.fromName("SkipBoundingGroup")
        corner = shown.createInstance() if shown.canCreateInstance() else coin.SoGroup()
        corner.addChild(legend(str(obj.ColourBy), largest(margin), unit))
        self._root.addChild(corner)

    def mark(self, point: Any) -> None:
        """Mark another point than the worst one, until the path is drawn again."""
        self.refresh()
        self._root.addChild(points_through([point], OUT, _MARK_SIZE))

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the findings."""
        return bool(vobj.Document.setEdit(vobj, 0))

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the findings, and the other commands for the job."""
        add_entry(menu, translate("PKM_Reach", "Open the findings"), lambda: self.doubleClicked(vobj), self.icon)
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object.Job, "PKM_Simulate", "PKM_Post")

    def setEdit(self, vobj: Any, _mode: int = 0) -> bool:
        """Open the findings."""
        from pkm_post.freecad_gui.reach_panel import ReachPanel

        self._panel = ReachPanel(vobj.Object)
        FreeCADGui.Control.showDialog(self._panel)
        return True

    def unsetEdit(self, _vobj: Any, _mode: int = 0) -> bool:
        """Close the findings; the machine takes its own pose again."""
        if self._panel is not None:
            self._panel.end()
            self._panel = None
        FreeCADGui.Control.closeDialog()
        return True


def _worst(obj: Any, points: list[tuple[float, ...]], margin: Any) -> tuple[Any, bool, str]:
    """Point of the least margin that is shown, whether it is out of limits, and the unit of the margins."""
    if obj.ColourBy == WORST:
        row = int(np.argmin(margin))
        return points[row], bool(margin[row] < 0.0), "of the largest"
    chosen = list(obj.Checks).index(obj.ColourBy)
    return obj.WorstPoints[chosen], obj.LeastMargins[chosen] < 0.0, obj.Units[chosen]


def _way(points: list[tuple[float, ...]], margin: Any) -> coin.SoSeparator:
    separator, light, style = coin.SoSeparator(), coin.SoLightModel(), coin.SoDrawStyle()
    light.model, style.lineWidth = coin.SoLightModel.BASE_COLOR, _LINE_WIDTH
    colour, binding = coin.SoBaseColor(), coin.SoMaterialBinding()
    colour.rgb.setValues(0, len(margin), colours_of(margin).tolist())
    binding.value = coin.SoMaterialBinding.PER_VERTEX_INDEXED
    coordinates, lines = coin.SoCoordinate3(), coin.SoIndexedLineSet()
    coordinates.point.setValues(0, len(points), points)
    lines.coordIndex.setValues(0, len(points) + 1, [*range(len(points)), -1])
    for child in (light, style, colour, binding, coordinates, lines):
        separator.addChild(child)
    return separator
