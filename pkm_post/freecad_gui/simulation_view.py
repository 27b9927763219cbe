# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation view: marks the violations of a simulated job in 3D; a double click opens the player.

Takes a view object and sets its provider. Saved documents store the module of this class: module and class name are a
file format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD

from pkm_post.freecad_gui.context_menu import add_commands, add_entry
from pkm_post.freecad_gui.shapes import OUT, points_through
from pkm_post.freecad_gui.views import DrawnView

translate = FreeCAD.Qt.translate

_SIZE, _CHOSEN_SIZE = 7.0, 14.0


class SimulationView(DrawnView):
    """Marks the worst point of each problem.

    Attributes:
        chosen: number of the problem with a larger mark; None if there is none.
    """

    icon, mode = "simulate.svg", "Simulation"
    chosen: int | None = None

    def updateData(self, _obj: Any, name: str) -> None:
        """Redraw when the problems are complete: their texts are set last."""
        if name == "Problems":
            self.choose(None)

    def choose(self, number: int | None) -> None:
        """Mark one problem larger than the others."""
        self.chosen = number
        self.refresh()

    def refresh(self) -> None:
        """Draw the marks, if there are problems."""
        self._root.removeAllChildren()
        points = list(getattr(self.Object, "WorstPoints", ()))
        if points:
            self._root.addChild(points_through(points, OUT, _SIZE))
        if self.chosen is not None and self.chosen < len(points):
            self._root.addChild(points_through([points[self.chosen]], OUT, _CHOSEN_SIZE))

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the player."""
        from pkm_post.freecad_gui.player import open_player

        open_player(vobj.Object)
        return True

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add the player, and the other commands for the job."""
        add_entry(menu, translate("PKM_Simulate", "Open the player"), lambda: self.doubleClicked(vobj), self.icon)
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object.Job, "PKM_Reach", "PKM_Post")
