# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command actions: the effect of each command on the selected object.

Changes to a document are recorded in macros, as the call into ``freecad_app`` that makes them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import FreeCAD
import FreeCADGui
from PySide import QtCore

from pkm_post.freecad_app.document import is_job, is_simulation, job_of
from pkm_post.freecad_gui.observers import view_of

_A_MOMENT = 50
"""ms between two checks whether a document is still recomputing."""


def _do(module: str, call: str, operation: FreeCAD.DocumentObject) -> None:
    FreeCADGui.addModule(module)
    subject = f"FreeCAD.getDocument({operation.Document.Name!r}).getObject({operation.Name!r})"
    FreeCADGui.doCommand(f"{module}.{call.format(subject)}")


def mirror(operation: FreeCAD.DocumentObject) -> None:
    """Add a mirrored copy of an operation."""
    _do("pkm_post.freecad_app.symmetry", "create_mirror({}, normal=(0, 1, 0))", operation)


def rotate(operation: FreeCAD.DocumentObject) -> None:
    """Add a rotated copy of an operation."""
    _do("pkm_post.freecad_app.symmetry", "create_rotation({}, axis=(0, 0, 1), angle=3.141592653589793)", operation)


def compensate(operation: FreeCAD.DocumentObject) -> None:
    """Add Normal Compensation on top of an operation."""
    _do("pkm_post.freecad_app.normal_compensation", "create_normal_compensation({})", operation)


def finish(item: FreeCAD.DocumentObject) -> None:
    """Add the operation for the selected faces, and open its panel at the end of the command."""
    module, job = "pkm_post.freecad_app.surface_finish", job_of(item)
    document = f"FreeCAD.getDocument({job.Document.Name!r})"
    chosen = ", ".join(f"({document}.getObject({name!r}), {faces!r})" for name, faces in _selected_faces(job))
    FreeCADGui.addModule(module)
    FreeCADGui.doCommand(f"{module}.create_surface_finish({document}.getObject({job.Name!r}), [{chosen}], fit=True)")
    made = job.Operations.Group[-1]
    made.ViewObject.Proxy.deleteOnReject = True  # by Cancel of the panel that opens now
    QtCore.QTimer.singleShot(0, lambda: made.ViewObject.Document.setEdit(made.ViewObject, 0))


def _selected_faces(job: FreeCAD.DocumentObject) -> Iterator[tuple[str, list[str]]]:
    """Yield each object of the job with selected faces, and their names; for a body, its last feature."""
    for each in FreeCADGui.Selection.getSelectionEx():
        faces = [name for name in each.SubElementNames if name.startswith("Face")]
        bodies = [other for other in each.Object.InList if getattr(other, "Tip", None) == each.Object]
        if faces and not is_job(each.Object) and job_of(each.Object) == job:
            yield (bodies or [each.Object])[0].Name, faces


def machine(job: FreeCAD.DocumentObject | None) -> None:
    """Add a machine to the document, for the selected job if there is one."""
    module = "pkm_post.freecad_app.machine_object"
    FreeCADGui.addModule(module)
    document = FreeCAD.ActiveDocument if job is None else job.Document
    subject = f"FreeCAD.getDocument({document.Name!r})"
    chosen = "" if job is None else f", job={subject}.getObject({job.Name!r})"
    FreeCADGui.doCommand(f"{module}.create_machine({subject}{chosen})")
    _when_computed(document, lambda: _show_whole(document.Name))


def _show_whole(name: str) -> None:
    """Fit the whole document, with the new machine, into the view."""
    view = view_of(name) if name in FreeCAD.listDocuments() else None
    if view is not None:
        view.fitAll()


def _create_on_machine(job: FreeCAD.DocumentObject, module: str, call: str) -> None:
    """Add an object for a job and, if there is one, the machine of the document."""
    from pkm_post.freecad_app.reach_object import machine_for

    machine, document = machine_for(job), f"FreeCAD.getDocument({job.Document.Name!r})"
    FreeCADGui.addModule(module)
    chosen = "" if machine is None else f", machine={document}.getObject({machine.Name!r})"
    FreeCADGui.doCommand(f"{module}.{call}({document}.getObject({job.Name!r}){chosen})")


def reach(job: FreeCAD.DocumentObject) -> None:
    """Add the reach checks of a job, on its machine in the document if there is one."""
    _create_on_machine(job, "pkm_post.freecad_app.reach_object", "create_reach")


def stiffness(job: FreeCAD.DocumentObject) -> None:
    """Open the stiffness panel of a job."""
    from pkm_post.freecad_gui.stiffness_panel import open_panel

    open_panel(job)


def simulate(item: FreeCAD.DocumentObject) -> None:
    """Add the simulation of a job if it has none, and open its player at the end of the command."""
    from pkm_post.freecad_gui.player import open_player

    if not is_simulation(item) and _simulation_of(item) is None:
        _create_on_machine(item, "pkm_post.freecad_app.simulation_object", "create_simulation")
    shown = item if is_simulation(item) else _simulation_of(item)
    _when_computed(item.Document, lambda: open_player(shown))


def _simulation_of(job: FreeCAD.DocumentObject) -> FreeCAD.DocumentObject | None:
    return next((other for other in job.InList if is_simulation(other)), None)


def post(job: FreeCAD.DocumentObject) -> None:
    """Open the post panel of a job."""
    from pkm_post.freecad_gui.post_panel import open_panel

    open_panel(job)


def edit(item: FreeCAD.DocumentObject | None) -> None:
    """Open the editor with the selected part program."""
    from pkm_post.freecad_gui.editor import open_editor

    open_editor(item)


def control(_item: FreeCAD.DocumentObject | None) -> None:
    """Open the numerical control panel."""
    from pkm_post.freecad_gui.control_panel import open_control

    open_control()


def example(_item: FreeCAD.DocumentObject | None) -> None:
    """Make the example, and show it in CAM."""
    FreeCADGui.activateWorkbench("CAMWorkbench")
    FreeCADGui.addModule("pkm_post.freecad_app.example")
    FreeCADGui.doCommand("pkm_post.freecad_app.example.create_example()")
    FreeCADGui.activeView().viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")


def install_packages(_item: FreeCAD.DocumentObject | None) -> None:
    """Ask which of the missing packages to install."""
    from pkm_post.freecad_gui.package_install import open_question

    open_question()


def _when_computed(document: FreeCAD.Document, task: Callable[[], Any]) -> None:
    """Run a task once GUI and document are idle: timers fire even during the progress bar of a recompute."""

    def try_it() -> None:
        if document.Recomputing:
            QtCore.QTimer.singleShot(_A_MOMENT, try_it)
        else:
            task()

    QtCore.QTimer.singleShot(0, try_it)
