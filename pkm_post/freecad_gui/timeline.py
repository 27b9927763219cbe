# SPDX-License-Identifier: LGPL-2.1-or-later
"""Timeline: operations, tool changes and findings of a simulated motion as bands over time; a click goes there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import FreeCAD
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import shown
from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_gui.theme import theme

translate = FreeCAD.Qt.translate

_TOOL, _FINDING = "#ad7fa8", "#cc0000"
_HEIGHT, _FINDINGS = 26, 8
"""Pixels: height of the widget, and of the findings band at its lower edge."""


@dataclass(frozen=True)
class TimelineBand:
    """A time interval.

    Attributes:
        start: s.
        end: s.
    """

    start: float
    end: float
    text: str


def operation_bands(simulation: Simulation) -> list[TimelineBand]:
    """One band per consecutive run of blocks of an operation."""
    operation, ends = simulation.trajectory.operation, simulation.motion.joint_time
    last = np.append(np.flatnonzero(np.diff(operation)), len(operation) - 1)
    starts = np.append(0.0, ends[last[:-1]])
    names = simulation.trajectory.operations
    return [
        TimelineBand(*row)
        for row in zip(starts.tolist(), ends[last].tolist(), (names[n] for n in operation[last]), strict=True)
    ]


def tool_changes(simulation: Simulation) -> list[TimelineBand]:
    """The times of tool changes."""
    tool = simulation.trajectory.tool
    rows = np.flatnonzero(np.diff(tool))
    times = simulation.motion.joint_time[rows].tolist()
    return [TimelineBand(at, at, f"T{number}") for at, number in zip(times, tool[rows + 1].tolist(), strict=True)]


def finding_bands(simulation: Simulation) -> list[TimelineBand]:
    """The problems, each from its start to its worst moment."""
    return [TimelineBand(problem.time, problem.worst_time, shown(problem.text)) for problem in simulation.problems]


class Timeline(QtWidgets.QWidget):
    """The widget.

    Attributes:
        operations: bands of the operations.
        tools: times of tool changes.
        findings: bands of the problems.
    """

    wanted = QtCore.Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.operations: list[TimelineBand] = []
        self.tools: list[TimelineBand] = []
        self.findings: list[TimelineBand] = []
        self._duration, self._seconds = 1.0, 0.0
        self.setFixedHeight(_HEIGHT)
        self.setMinimumWidth(100)

    def take(self, simulation: Simulation) -> None:
        """Show another simulation."""
        self._duration = max(simulation.duration, 1e-9)
        self.operations, self.tools = operation_bands(simulation), tool_changes(simulation)
        self.findings = finding_bands(simulation)
        self.update()

    def show_time(self, seconds: float) -> None:
        """Move the cursor."""
        self._seconds = seconds
        self.update()

    def mousePressEvent(self, event: Any) -> None:
        """Go to the clicked time."""
        self.wanted.emit(self._time_at(event))

    def event(self, event: Any) -> bool:
        """Show a tooltip for the time under the mouse."""
        if event.type() == QtCore.QEvent.Type.ToolTip:
            self.setToolTip(self.text_at(event.pos().x() / max(self.width(), 1) * self._duration))
        return bool(super().event(event))

    def text_at(self, seconds: float) -> str:
        """The labels of the bands at or near a time, one per line."""
        room = 3.0 / max(self.width(), 1) * self._duration
        near = [
            band.text
            for bands in (self.operations, self.tools, self.findings)
            for band in bands
            if band.start - room <= seconds <= band.end + room
        ]
        return "\n".join(near)

    def paintEvent(self, _event: Any) -> None:
        """Paint the bands and the cursor."""
        painter, colours = QtGui.QPainter(self), theme()
        for number, band in enumerate(self.operations):
            area = self._area(band, 0, _HEIGHT - _FINDINGS)
            painter.fillRect(area, QtGui.QColor(colours.bands[number % 2]))
            painter.setPen(QtGui.QColor(colours.band_ink))
            painter.drawText(area.adjusted(3, 0, -3, 0), QtCore.Qt.AlignmentFlag.AlignVCenter, band.text)
        for band in self.findings:
            painter.fillRect(self._area(band, _HEIGHT - _FINDINGS, _FINDINGS), QtGui.QColor(_FINDING))
        for band in self.tools:
            painter.fillRect(self._area(band, 0, _HEIGHT), QtGui.QColor(_TOOL))
        painter.setPen(QtGui.QPen(QtGui.QColor(colours.cursor), 2))
        x = self._x(self._seconds)
        painter.drawLine(x, 0, x, _HEIGHT)
        painter.end()

    def _area(self, band: TimelineBand, top: int, height: int) -> Any:
        left = self._x(band.start)
        return QtCore.QRect(left, top, max(self._x(band.end) - left, 2), height)

    def _x(self, seconds: float) -> int:
        return round(seconds / self._duration * (self.width() - 1))

    def _time_at(self, event: Any) -> float:
        position = event.position().x() if hasattr(event, "position") else event.x()
        return min(max(position / max(self.width() - 1, 1), 0.0), 1.0) * self._duration
