# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness panel: stiffness at the tool tip along a job and over the table, in the 3D view and in rows.

Takes a job; colours its path and, if wanted, the table from amber, the softest place, to green, the stiffest. A click
on a row shows the softest place of an operation, with the machine there. The document does not change.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui
import numpy as np
from pivy import coin
from PySide import QtGui, QtWidgets

from pkm_post.freecad_app.core_texts import exception_text
from pkm_post.freecad_app.frames import apply
from pkm_post.freecad_app.job_setup import stiffness_of
from pkm_post.freecad_app.reach_object import machine_for
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.finding_view import FindingView
from pkm_post.freecad_gui.icons import ICONS
from pkm_post.freecad_gui.margin_colours import colour_bar, coloured_path, coloured_surface, colours_of
from pkm_post.freecad_gui.observers import DeletionWatch, OnceClosed, is_panel_open, scene_graph_of, show_panel
from pkm_post.freecad_gui.undrawn import Undrawn
from pkm_post.freecad_gui.verdict import FindingRows, Verdict
from pkm_post.geometry import Array
from pkm_post.machine import StiffnessMap
from pkm_post.model import Refused
from pkm_post.posting import SoftestPlace, StiffnessStudy

translate = FreeCAD.Qt.translate

NAME = "PkmStiffnessPanel"
_SHARES = np.linspace(0.0, 1.0, 17)
_ALIKE = 1e-6
"""N/mm: a smaller range gets one colour."""


class StiffnessPanel:
    """The task panel.

    Attributes:
        found: the maps; None if the job was refused.
        summary: the range over the job, or why there is none.
        rows: the softest place of each operation.
        table: whether the map over the table is shown.
    """

    def __init__(self, job: Any) -> None:
        self._document = job.Document.Name
        self.form = QtWidgets.QWidget()
        self.form.setObjectName(NAME)
        self.form.setWindowTitle(translate("StiffnessPanel", "Stiffness of {}").format(job.Label))
        self.form.setWindowIcon(QtGui.QIcon(str(ICONS / "stiffness.svg")))
        self.summary, self.rows, self.table = Verdict(), FindingRows(), QtWidgets.QCheckBox()
        self.table.setText(translate("StiffnessPanel", "Show the table: tool upright, lowest height of the job"))
        layout = QtWidgets.QVBoxLayout(self.form)
        for part in (self.summary, self.rows, self.table):
            layout.addWidget(part)
        layout.addStretch()
        self._view, self._drawn = FindingView(job), coin.SoSeparator()
        self.found: StiffnessStudy | None = None
        try:
            self.found = stiffness_of(job, machine_for(job))
        except Refused as refused:
            self.summary.say(exception_text(refused), False)
        self.table.setEnabled(self.found is not None)
        self.table.toggled.connect(lambda _on: self._draw())
        self.rows.picked.connect(self._show_softest)
        self._graph = scene_graph_of(self._document)
        self._graph.addChild(self._drawn)
        # the legend of Reach is in the same corner
        self._reach = Undrawn(self._document, [each.Name for each in job.InList if hasattr(each, "Violations")])
        self._watch = DeletionWatch(self.reject, self._document, job.Name)
        self._close = OnceClosed(self.form, self._release)
        self._fill()
        self._draw()

    def _fill(self) -> None:
        if self.found is None:
            self.rows.take(())
            return
        least = self.found.job.stiffness[:, 0]
        text = translate("StiffnessPanel", "Stiffness of the tool tip in the softest direction: {} to {}")
        self.summary.say(text.format(*(amount_text(float(value), "N/mm") for value in (least.min(), least.max()))))
        self.rows.take([(_row(each), None, "") for each in self.found.softest()])

    def _draw(self) -> None:
        """Draw the path of the job and the table in colours, with one legend."""
        self._drawn.removeAllChildren()
        if self.found is None:
            return
        work_from_machine = np.linalg.inv(self.found.trajectory.machine_from_work)
        along, table = self.found.job.stiffness[:, 0], self.found.table
        values = np.append(along, table.least[table.reached]) if self.table.isChecked() else along
        low, top = float(values.min()), float(values.max())
        if self.table.isChecked():
            self._drawn.addChild(_surface(table, work_from_machine, _colours(table.least, low, top)))
        points = apply(work_from_machine, self.found.job.tip).tolist()
        self._drawn.addChild(coloured_path(points, _colours(along, low, top)))
        texts = ((1.0, amount_text(top, "N/mm")), (0.0, amount_text(low, "N/mm")))
        self._drawn.addChild(colour_bar(translate("StiffnessPanel", "stiffness"), _colours(_SHARES, 0.0, 1.0), texts))

    def _show_softest(self, row: int) -> None:
        assert self.found is not None
        softest = self.found.softest()[row]
        self._view.show(softest.operation, softest.line)

    def getStandardButtons(self) -> Any:
        """Only Close: the panel changes nothing."""
        return QtWidgets.QDialogButtonBox.StandardButton.Close

    def reject(self) -> bool:
        """Close the panel, and remove the colours from the view."""
        self._close()
        FreeCADGui.Control.closeDialog()
        return True

    def _release(self) -> None:
        """Remove the colours from the view, and stop following the document."""
        self._watch.end()
        self._view.end()
        self._graph.removeChild(self._drawn)
        self._reach.end()


def open_panel(job: Any) -> StiffnessPanel | None:
    """Show the panel for a job; None if another task panel is open."""
    if is_panel_open(translate("StiffnessPanel", "Stiffness")):
        return None
    panel = StiffnessPanel(job)
    show_panel(panel)
    return panel


def _row(each: SoftestPlace) -> str:
    along = ", ".join(f"{value:z.2f}" for value in each.direction.tolist())
    text = translate("StiffnessPanel", "{}, line {}: {} along ({}) of the machine")
    return text.format(each.operation, each.line, amount_text(each.stiffness, "N/mm"), along)


def _colours(stiffness: Array, low: float, top: float) -> Array:
    """Colours (N, 3) from amber at the lowest to green at the highest stiffness; NaN is amber, but not drawn."""
    return colours_of(np.nan_to_num(stiffness, nan=low) - low, max(top - low, _ALIKE))


def _surface(table: StiffnessMap, work_from_machine: Array, colours: Array) -> coin.SoSeparator:
    """The table cells with all four corners in reach, in the work frame."""
    side = round(len(table.tip) ** 0.5)
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = (each.ravel() for each in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    whole = table.reached[np.stack([a, b, c, d])].all(axis=0)
    triangles = np.vstack([np.column_stack([a, b, c])[whole], np.column_stack([a, c, d])[whole]])
    return coloured_surface(apply(work_from_machine, table.tip), triangles, colours)
