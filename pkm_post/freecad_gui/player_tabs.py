# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tabs of the player: the commands of a simulated job, and the values of its motion at a time.

A click in the listing goes to a command, and playing marks the active one. The model holds CAM's commands and formats a
line only when it is visible. Positions in the readout are of the tool tip in the work frame {C}, as in the program, in
the user's units.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import FreeCAD
import numpy as np
from PySide import QtCore, QtWidgets

from pkm_post.freecad_app.fixtures import operation_named
from pkm_post.freecad_app.frames import apply
from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.quantities import length_text, speed_text, time_text
from pkm_post.geometry import Array

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


_STRUTS = 6


@dataclass(frozen=True)
class DroValues:
    """The values of the readout at a time.

    Attributes:
        tip: (3,) tool tip in {C}, mm.
        axis: (3,) unit tool axis in {C}.
        lengths: (6,) strut lengths, mm.
        feed: speed of the tip, mm/s.
        programmed_feed: programmed speed of the tip, mm/s.
        operation: name of the operation.
        line: number of its command.
        time_left: time to the end, s.
    """

    tip: Array
    axis: Array
    lengths: Array
    feed: float
    programmed_feed: float
    operation: str
    line: int
    time_left: float


def dro_values_at(simulation: Simulation, seconds: float, override: float = 1.0) -> DroValues:
    """The values of the readout at a time.

    Args:
        seconds: time in the plan, s.
        override: share of the planned speed.
    """
    tip, axis, _, _ = simulation.pose_at(np.array([seconds]))
    lengths, _ = simulation.struts_at(np.array([seconds]))
    work_from_machine = np.linalg.inv(simulation.trajectory.machine_from_work)
    block = simulation.block_at(seconds)
    place = simulation.trajectory.place(block)
    return DroValues(
        tip=apply(work_from_machine, tip)[0],
        axis=(axis @ work_from_machine[:3, :3].T)[0],
        lengths=lengths[0],
        feed=simulation.feed_at(seconds) * override,
        programmed_feed=float(simulation.trajectory.feed[block]),
        operation=place.operation,
        line=place.line,
        time_left=(simulation.duration - seconds) / override,
    )


class Readout(QtWidgets.QWidget):
    """The tab: one line per value."""

    def __init__(self) -> None:
        super().__init__()
        names = (
            *"XYZIJK",
            *(translate("PKM_Simulate", "Strut {}").format(number + 1) for number in range(_STRUTS)),
            translate("PKM_Simulate", "Feed"),
            translate("PKM_Simulate", "Asked"),
            translate("PKM_Simulate", "Line"),
            translate("PKM_Simulate", "Left"),
        )
        self.fields = [QtWidgets.QLabel() for _ in names]
        grid = QtWidgets.QGridLayout(self)
        grid.setContentsMargins(4, 4, 4, 4)
        grid.setVerticalSpacing(1)
        for row, (name, field) in enumerate(zip(names, self.fields, strict=True)):
            half = (len(names) + 1) // 2
            grid.addWidget(QtWidgets.QLabel(name), row % half, row // half * 2)
            grid.addWidget(field, row % half, row // half * 2 + 1)
            field.setSizePolicy(QtWidgets.QSizePolicy.Policy.Ignored, QtWidgets.QSizePolicy.Policy.Preferred)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)

    def show_values(self, values: DroValues) -> None:
        """Show other values."""
        texts = (
            *(length_text(value) for value in values.tip),
            *(f"{value:z.5f}" for value in values.axis),
            *(length_text(value) for value in values.lengths),
            speed_text(values.feed),
            speed_text(values.programmed_feed),
            f"{values.operation}, {values.line}",
            time_text(values.time_left),
        )
        for field, text in zip(self.fields, texts, strict=True):
            field.setText(text)
            field.setToolTip(text)
