# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut plot: lengths and speeds of the six struts over time, with a cursor; a click selects a time.

Takes a simulation. The curves are drawn once per widget size, from the minimum and maximum in each pixel column, so
that long motions cost no more than short ones; a cursor move repaints only the strips at its old and new position.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD
import numpy as np
from PySide import QtCore, QtGui, QtWidgets

from pkm_post.freecad_app.simulation import Simulation
from pkm_post.freecad_app.user_units import local, scale_of
from pkm_post.freecad_gui.theme import theme
from pkm_post.geometry import Array

translate = FreeCAD.Qt.translate

_MARGIN_LEFT, _MARGIN, _GAP = 64, 6, 18
_STRIP = 5
"""Width of the strip repainted for the cursor, pixels."""


class StrutPlot(QtWidgets.QWidget):
    """The widget.

    Args:
        go_to: callback for the clicked time, s.
    """

    def __init__(self, simulation: Simulation, go_to: Callable[[float], None]) -> None:
        super().__init__()
        self._simulation, self._go_to = simulation, go_to
        self._seconds, self._override = 0.0, 1.0
        self._curves: Any = None
        self.setMinimumSize(200, 100)

    def take(self, simulation: Simulation) -> None:
        """Draw another simulation."""
        self._simulation = simulation
        self._redraw()

    def show_override(self, share: float) -> None:
        """Draw the speeds at a feed override; 1 is as planned."""
        self._override = share
        self._redraw()

    def show_time(self, seconds: float) -> None:
        """Move the cursor."""
        before, self._seconds = self._cursor(), seconds
        for x in {before, self._cursor()}:
            self.update(x - _STRIP // 2, 0, _STRIP, self.height())

    def _redraw(self) -> None:
        self._curves = None
        self.update()

    def _cursor(self) -> int:
        """Cursor position, pixels from the left."""
        share = self._seconds / max(self._simulation.duration, 1e-9)
        return _MARGIN_LEFT + round(share * (self._width() - 1))

    def resizeEvent(self, _event: Any) -> None:
        """Discard the curves of the previous size."""
        self._curves = None

    def changeEvent(self, event: Any) -> None:
        """Redraw in the colours of another theme."""
        if event.type() == QtCore.QEvent.Type.StyleChange:
            self._redraw()
        super().changeEvent(event)

    def mousePressEvent(self, event: Any) -> None:
        """Go to the clicked time."""
        position = event.position().x() if hasattr(event, "position") else event.x()
        share = (position - _MARGIN_LEFT) / max(self._width(), 1)
        self._go_to(min(max(share, 0.0), 1.0) * self._simulation.duration)

    def paintEvent(self, _event: Any) -> None:
        """Paint curves and cursor."""
        if self._curves is None:
            self._curves = self._drawn()
        painter = QtGui.QPainter(self)
        painter.drawPixmap(0, 0, self._curves)
        painter.setPen(QtGui.QPen(QtGui.QColor(theme().cursor), 2))
        x = self._cursor()
        painter.drawLine(x, _GAP, x, self.height() - _MARGIN)
        painter.end()

    def _width(self) -> int:
        return max(self.width() - _MARGIN_LEFT - _MARGIN, 2)

    def _drawn(self) -> Any:
        ratio = self.devicePixelRatioF()
        pixmap = QtGui.QPixmap(self.size() * ratio)
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(QtGui.QColor(theme().ground))
        painter = QtGui.QPainter(pixmap)
        height = (self.height() - 2 * _GAP - _MARGIN) // 2
        lengths, speeds = self._simulation.envelope(self._width())
        machine = self._simulation.machine
        limits = machine.strut_stroke, (-machine.strut_speed, machine.strut_speed)
        titles = translate("PKM_Simulate", "Lengths, {}"), translate("PKM_Simulate", "Speeds, {}")
        scales = scale_of(machine.strut_stroke[1], "mm"), scale_of(machine.strut_speed, "mm/s")
        curves = lengths, speeds * self._override
        for number, (values, ends, title, scale) in enumerate(zip(curves, limits, titles, scales, strict=True)):
            top = _GAP + number * (height + _GAP)
            area = QtCore.QRect(_MARGIN_LEFT, top, self._width(), height)
            factor, unit = scale
            ends = ends[0] / factor, ends[1] / factor
            _draw_curves(painter, area, values / factor, ends, title.format(unit))
        painter.end()
        return pixmap


def _draw_curves(painter: Any, area: Any, values: Array, limits: tuple[float, float], title: str) -> None:
    """Draw one diagram: frame, title, nearby limits, a curve per strut."""
    low, high = float(values.min()), float(values.max())
    room = 0.05 * (high - low) or 1.0
    low, high = low - room, high + room
    colours = theme()
    painter.setPen(QtGui.QPen(QtGui.QColor(colours.faint)))
    painter.drawRect(area)
    painter.setPen(QtGui.QPen(QtGui.QColor(colours.ink)))
    painter.drawText(area.left(), area.top() - 4, title)
    right = QtCore.Qt.AlignmentFlag.AlignRight
    for text, y in ((local(f"{high:.5g}"), area.top()), (local(f"{low:.5g}"), area.bottom() - 14)):
        painter.drawText(QtCore.QRect(0, y, _MARGIN_LEFT - 6, 16), right, text)
    scale = area.height() / (high - low)
    for limit in limits:
        if low < limit < high:
            painter.setPen(QtGui.QPen(QtGui.QColor(colours.limit), 1, QtCore.Qt.PenStyle.DashLine))
            y = round(area.bottom() - (limit - low) * scale)
            painter.drawLine(area.left(), y, area.right(), y)
    rows = np.rint(area.bottom() - (values - low) * scale).astype(int)
    for strut, colour in enumerate(colours.struts):
        painter.setPen(QtGui.QPen(QtGui.QColor(colour)))
        least, largest = rows[0, :, strut].tolist(), rows[1, :, strut].tolist()
        painter.drawLines([
            QtCore.QLine(area.left() + x, y0, area.left() + x, y1)
            for x, (y0, y1) in enumerate(zip(least, largest, strict=True))
        ])  # fmt: skip
        painter.drawText(area.left() + 4 + 14 * strut, area.bottom() - 4, str(strut + 1))
