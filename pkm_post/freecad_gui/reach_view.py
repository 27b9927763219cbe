# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reach view: the tool path coloured by the margin of a check, with its legend and its worst point.

Takes a view object and sets its provider. Saved documents store the module of this class: module and class name are a
file format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
from pivy import coin

from pkm_post.freecad_app.reach_object import WORST, check_names
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.axis_vectors import axis_vectors, is_tilted
from pkm_post.freecad_gui.context_menu import add_commands, add_entry
from pkm_post.freecad_gui.margin_colours import coloured_path, colours_of, largest, legend
from pkm_post.freecad_gui.preferences import every_nth
from pkm_post.freecad_gui.shapes import OUT, points_through
from pkm_post.freecad_gui.views import DrawnView, PanelView

translate = FreeCAD.Qt.translate

_MARK_SIZE = 11.0
_WORST_IN_LIMITS = (0.1, 0.2, 0.8)


class ReachView(DrawnView, PanelView):
    """Draws the path. A double click opens the findings."""

    icon, mode = "reach.svg", "Reach"
    _axes: Any = None

    def updateData(self, _obj: Any, name: str) -> None:
        """Redraw when the margins are set, which are the last property."""
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
        self._root.addChild(coloured_path(points, colours_of(margin)))
        self._axes = coin.SoSeparator()
        self._root.addChild(self._axes)
        self.show_axes()
        worst, is_out, unit = _worst(obj, points, margin)
        self._root.addChild(points_through([worst], OUT if is_out else _WORST_IN_LIMITS, _MARK_SIZE))
        shown = coin.SoType.fromName("SkipBoundingGroup")
        corner = shown.createInstance() if shown.canCreateInstance() else coin.SoGroup()
        corner.addChild(legend(*_legend_texts(obj, largest(margin), unit)))
        self._root.addChild(corner)

    def show_axes(self) -> None:
        """Draw the tool axes of a five-axis path, at the preferred spacing."""
        if self._axes is None:
            return  # nothing is drawn
        self._axes.removeAllChildren()
        study, every = self.Object.Proxy.study, every_nth()
        if study is not None and every and is_tilted(study.reach.trajectory):
            self._axes.addChild(axis_vectors(study.reach.trajectory, every))

    def mark(self, point: Any) -> None:
        """Mark a point instead of the worst one, until the next redraw."""
        self.refresh()
        self._root.addChild(points_through([point], OUT, _MARK_SIZE))

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the findings, and the other commands for the job."""
        add_entry(menu, translate("PKM_Reach", "Open the findings"), lambda: self.doubleClicked(vobj), self.icon)
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object.Job, "PKM_Simulate", "PKM_Post")

    def make_panel(self, obj: Any) -> Any:
        """The panel with the findings."""
        from pkm_post.freecad_gui.reach_panel import ReachPanel

        return ReachPanel(obj)


def _legend_texts(obj: Any, top: float, unit: str) -> tuple[str, str]:
    """Title and largest margin in the user's language and units."""
    if obj.ColourBy == WORST:
        share = translate("PKM_Reach", "{} of the largest").format(amount_text(top, ""))
        return translate("PKM_Reach", "worst check"), share
    return check_names(obj)[list(obj.Checks).index(obj.ColourBy)], amount_text(top, unit)


def _worst(obj: Any, points: list[tuple[float, ...]], margin: Any) -> tuple[Any, bool, str]:
    """Point of the least shown margin, whether it is violated, and the unit of the margins."""
    if obj.ColourBy == WORST:
        row = int(np.argmin(margin))
        return points[row], bool(margin[row] < 0.0), ""
    chosen = list(obj.Checks).index(obj.ColourBy)
    return obj.WorstPoints[chosen], obj.LeastMargins[chosen] < 0.0, obj.Units[chosen]
