# SPDX-License-Identifier: LGPL-2.1-or-later
"""Player lists: the problems of a simulation and the times of its operations, for clicking.

Takes a simulation; emits the number of the clicked problem or operation.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.simulation import Problem, Simulation

translate = FreeCAD.Qt.translate

_RED = QtGui.QColor(200, 0, 0)
_MOST_SHOWN = 1000
_WIDTH = 380
"""Initial width, pixels."""


class PlayerLists(QtWidgets.QTabWidget):
    """Two lists as tabs."""

    problem = QtCore.Signal(int)
    operation = QtCore.Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.problems, self.operations = QtWidgets.QListWidget(), QtWidgets.QListWidget()
        for rows, wanted in ((self.problems, self.problem), (self.operations, self.operation)):
            rows.itemClicked.connect(_sender(rows, wanted))
            self.addTab(rows, "")

    def sizeHint(self) -> QtCore.QSize:
        """Wide enough for most lines, and no taller than the curves beside it."""
        return QtCore.QSize(_WIDTH, 120)

    def take(self, simulation: Simulation) -> None:
        """Show another simulation; the tab of its problems if there are any."""
        moving, dwelling = simulation.operation_times()
        times = (moving + dwelling).tolist()
        _fill(self.problems, [_told(problem) for problem in simulation.problems[:_MOST_SHOWN]])
        for row in range(self.problems.count()):
            self.problems.item(row).setForeground(QtGui.QBrush(_RED))
        names = simulation.trajectory.operations
        _fill(self.operations, [f"{name}: {seconds:.1f} s" for name, seconds in zip(names, times, strict=True)])
        self.setTabText(0, translate("PKM_Simulate", "Problems: {}").format(len(simulation.problems)))
        self.setTabText(1, translate("PKM_Simulate", "Operations: {:.1f} s").format(sum(times)))
        self.setCurrentIndex(0 if simulation.problems else 1)


def _told(problem: Problem) -> str:
    place = problem.worst_place
    return f"{problem.worst_time:.3f} s  {place.operation}, {place.line}: {problem.text}"


def _fill(rows: Any, texts: list[str]) -> None:
    rows.clear()
    rows.addItems(texts)
    for number, text in enumerate(texts):
        rows.item(number).setToolTip(text)


def _sender(rows: Any, wanted: Any) -> Any:
    return lambda item: wanted.emit(rows.row(item))
