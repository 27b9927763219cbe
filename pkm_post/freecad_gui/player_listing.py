# SPDX-License-Identifier: LGPL-2.1-or-later
"""Listing: the commands of a simulated job: a click goes to a command, and playing marks the active one.

Takes a simulation and its job. The model holds CAM's commands and formats a line only when it is visible.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.fixtures import operation_named
from pkm_post.freecad_app.simulation import Simulation

translate = FreeCAD.Qt.translate


class ProgramLines(QtCore.QAbstractListModel):
    """One row for each command of each operation, in order of motion."""

    def __init__(self, simulation: Simulation, job: Any, parent: QtCore.QObject) -> None:
        super().__init__(parent)
        self._names = simulation.trajectory.operations
        operations = [operation_named(job, name) for name in self._names]
        self._commands = [[] if each is None else each.Path.Commands for each in operations]
        self._begin = np.cumsum([0, *(len(each) + 1 for each in self._commands)])

    def rowCount(self, _parent: Any = None) -> int:
        """A title and its commands for each operation."""
        return int(self._begin[-1])

    def data(self, index: Any, role: int = QtCore.Qt.ItemDataRole.DisplayRole) -> Any:
        """The text of a row."""
        if role != QtCore.Qt.ItemDataRole.DisplayRole or not index.isValid():
            return None
        operation, line = self.place(index.row())
        return f"{line}  {self._commands[operation][line - 1].toGCode()}" if line else f"({self._names[operation]})"

    def place(self, row: int) -> tuple[int, int]:
        """The operation of a row, and the number of its command; 0 for its title."""
        operation = int(np.searchsorted(self._begin, row, side="right")) - 1
        return operation, row - int(self._begin[operation])

    def row_of(self, operation: int, line: int) -> int:
        """The row of a command."""
        return int(self._begin[operation]) + min(line, len(self._commands[operation]))


class Listing(QtWidgets.QListView):
    """The tab."""

    wanted = QtCore.Signal(float)
    """Time at which the clicked command begins, s."""

    def __init__(self) -> None:
        super().__init__()
        self._simulation: Simulation | None = None
        self.setUniformItemSizes(True)
        self.setLayoutMode(QtWidgets.QListView.LayoutMode.Batched)
        self.setSelectionMode(QtWidgets.QAbstractItemView.SelectionMode.SingleSelection)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.clicked.connect(lambda index: self.wanted.emit(self._time_of(index.row())))

    def take(self, simulation: Simulation, job: Any) -> None:
        """List another simulation."""
        self._simulation = simulation
        self.setModel(ProgramLines(simulation, job, self))

    def show_time(self, seconds: float) -> None:
        """Mark the command that is active at a time."""
        trajectory = self._simulation.trajectory
        block = self._simulation.block_at(seconds)
        row = self.model().row_of(int(trajectory.operation[block]), int(trajectory.line[block]))
        if row != self.currentIndex().row():
            index = self.model().index(row, 0)
            self.setCurrentIndex(index)
            self.scrollTo(index, QtWidgets.QAbstractItemView.ScrollHint.EnsureVisible)

    def _time_of(self, row: int) -> float:
        return self._simulation.line_begins(*self.model().place(row))
