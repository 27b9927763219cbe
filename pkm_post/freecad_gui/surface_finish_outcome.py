# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surface Finish outcome: the result of the operation, at the top of its page, and as a coloured map on the part.

Takes the operation; shows in green or red whether it gouges, then its findings from the study of the whole job. The
study runs in the background, and is shared with Reach and Simulation. Documents store the worst values, not the map: a
button recomputes the map of an operation from an earlier session.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui

from pkm_post.freecad_app.arguments import POST_PROCESSORS
from pkm_post.freecad_app.document import job_of
from pkm_post.freecad_app.fixtures import operation_named
from pkm_post.freecad_app.job_setup import placed_job
from pkm_post.freecad_app.job_study import JobStudy
from pkm_post.freecad_app.reach_object import machine_for, violations_of
from pkm_post.freecad_app.user_units import amount_text
from pkm_post.freecad_gui.background import BackgroundCall
from pkm_post.freecad_gui.deviation_map import measured_map
from pkm_post.freecad_gui.finding_view import FindingView
from pkm_post.freecad_gui.observers import RecomputeWatch, scene_graph_of
from pkm_post.freecad_gui.verdict import FindingRows, Verdict
from pkm_post.model import Diagnostic, Refused, errors

translate = FreeCAD.Qt.translate


class SurfaceFinishOutcome:
    """The displayed result of an operation while its page is open.

    Args:
        verdict: the line for it.
        findings: the rows for its findings.
        again: the button to recompute a missing map.
    """

    def __init__(self, obj: Any, verdict: Verdict, findings: FindingRows, again: Any) -> None:
        self._obj, self._verdict, self._rows, self._again = obj, verdict, findings, again
        self._document, self._map, self._task = obj.Document.Name, None, None
        self._study: JobStudy | None = None
        self._graph: Any = None
        self._found: list[Diagnostic] = []
        self._view = FindingView(job_of(obj))
        self._watch = RecomputeWatch(self.show, self._document)
        findings.picked.connect(self._show_finding)
        again.clicked.connect(lambda: self._measure_again())

    def show(self) -> None:
        """Show the last result, and start checking the job."""
        self._strike()
        self._stop()
        self._rows.take(())
        obj, measured = self._obj, self._obj.Proxy.measured
        if measured is not None:
            self._map = measured_map(measured, obj.ChordTolerance.Value)
            self._graph = scene_graph_of(self._document)
            self._graph.addChild(self._map)
        self._verdict.say(*_verdict(obj))
        self._again.setVisible(measured is None and obj.CheckSpacing.Value > 0.0 and "Touched" not in obj.State)
        if obj.isValid() and obj.Path.Size and job_of(obj).PostProcessor in POST_PROCESSORS:
            self._check()

    def end(self) -> None:
        """Remove the map, and stop checking."""
        self._watch.end()
        self._stop()
        self._view.end()
        self._strike()

    def _measure_again(self) -> None:
        """Recompute the operation: the watch of recomputes shows the result."""
        self._obj.touch()
        self._obj.Document.recompute()

    def _check(self) -> None:
        job = job_of(self._obj)
        try:
            placed = placed_job(job, machine_for(job))
        except Refused as refused:
            self._take(refused.diagnostics)
            return
        self._task = BackgroundCall(placed.study, FreeCADGui.getMainWindow())
        self._task.finished.connect(self._task.deleteLater)
        self._task.finished.connect(self._checked)
        self._task.start()

    def _checked(self) -> None:
        task, self._task = self._task, None
        if task is not None:
            self._study = task.value()
            self._take(violations_of(self._study))

    def _take(self, found: Any) -> None:
        """Show the findings of this operation, and whether the machine can follow it."""
        job = job_of(self._obj)
        self._found = [each for each in found if operation_named(job, each.place.operation) in (None, self._obj)]
        self._rows.take_faults(self._found)
        text, holds = _verdict(self._obj)
        if holds is not False:
            follows = not errors(self._found)
            said = _follows() if follows else translate("SurfaceFinish", "The machine cannot follow")
            self._verdict.say(f"{text}\n{said}", follows)

    def _show_finding(self, row: int) -> None:
        found = self._found[row]
        self._view.show(found.place.operation, found.place.line, found.code)

    def _stop(self) -> None:
        """Detach a running check, so that the GUI does not wait for it; its result is dropped."""
        if self._task is not None:
            self._task.finished.disconnect(self._checked)
            self._task = None

    def _strike(self) -> None:
        if self._graph is not None:
            self._graph.removeChild(self._map)
        self._graph = self._map = None


def _follows() -> str:
    return translate("SurfaceFinish", "The machine can follow")


def _verdict(obj: Any) -> tuple[str, bool | None]:
    if not obj.isValid():
        return obj.getStatusString(), False
    if not obj.Path.Size or "Touched" in obj.State:
        return translate("SurfaceFinish", "Not computed yet: Apply computes it"), None
    if obj.MaximumGouge < 0.0:
        return translate("SurfaceFinish", "Gouges are not checked: set a distance of check points"), None
    text = translate(
        "SurfaceFinish",
        "No gouge: {} at the deepest, between the points at most {} deeper; {} left at most, at points {} apart",
    )
    values = (obj.MaximumGouge, obj.UnseenGouge, obj.MaximumExcess, obj.CheckSpacing.Value)
    return text.format(*(amount_text(float(value), "mm") for value in values)), True
