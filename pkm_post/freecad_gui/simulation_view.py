# SPDX-License-Identifier: LGPL-2.1-or-later
"""Simulation view: where a simulated job cannot be followed, marked in 3D; a double click opens the player.

A view object enters and gets its provider. Saved documents name this class by its module: place and name are a file
format.
"""

from __future__ import annotations

from typing import Any

import FreeCAD

from pkm_post.freecad_gui.context_menu import add_commands, add_entry
from pkm_post.freecad_gui.marks import OUT, marks
from pkm_post.freecad_gui.views import DrawnView

translate = FreeCAD.Qt.translate

_SIZE, _CHOSEN_SIZE = 7.0, 14.0


class SimulationView(DrawnView):
    """Marks the worst point of each problem.

    Attributes:
        chosen: number of the problem that is marked larger; None if none is.
    """

    icon, mode = "simulate.svg", "Simulation"
    chosen: int | None = None

    def updateData(self, _obj: Any, name: str) -> None:
        """Draw anew when the problems are told: their texts are set last."""
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
            self._root.addChild(marks(points, OUT, _SIZE))
        if self.chosen is not None and self.chosen < len(points):
            self._root.addChild(marks([points[self.chosen]], OUT, _CHOSEN_SIZE))

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the player."""
        from pkm_post.freecad_gui.player import open_player

        open_player(vobj.Object)
        return True

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """The player, and what else there is to do with the job."""
        add_entry(menu, translate("PKM_Simulate", "Open the player"), lambda: self.doubleClicked(vobj), self.icon)
        super().setupContextMenu(vobj, menu)
        add_commands(menu, vobj.Object.Job, "PKM_Reach", "PKM_Post")
