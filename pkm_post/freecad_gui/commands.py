# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands: one row for each; a row names the call into ``freecad_app`` that does the work.

Every command runs in one transaction, so that one undo takes it back, and is written into macros as that call.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import FreeCAD
import FreeCADGui
from PySide import QtCore

from pkm_post.freecad_app.kinds import is_job, is_operation, is_simulation
from pkm_post.freecad_app.transaction import transaction
from pkm_post.freecad_gui.workbench import ICONS

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP
translate = FreeCAD.Qt.translate


@dataclass(frozen=True)
class Command:
    """A command as FreeCAD wants it.

    Attributes:
        name: its name in FreeCAD.
        icon: file name in resources/icons.
        text: menu text.
        tip: what it does, in a sentence.
        selectable: whether an object can be its subject.
        action: does it to the object selected.
        keys: keyboard shortcut; all begin with P, K, since CAM has P and one other key.
        alone: whether it can be done without a selection as well; the action gets None then.
    """

    name: str
    icon: str
    text: str
    tip: str
    selectable: Callable[[FreeCAD.DocumentObject], bool]
    action: Callable[[FreeCAD.DocumentObject], None]
    keys: str
    alone: bool = False

    def GetResources(self) -> dict[str, str]:
        """Texts, icon and shortcut. FreeCAD itself translates the texts, anew when another language is chosen."""
        return {
            "Pixmap": str(ICONS / self.icon),
            "MenuText": self.text,
            "ToolTip": self.tip,
            "StatusTip": self.tip,
            "Accel": self.keys,
        }

    def IsActive(self) -> bool:
        """Whether exactly one object is selected that the command is for, or none if it needs none."""
        selected = FreeCADGui.Selection.getSelection()
        if self.alone and not selected:
            return FreeCAD.ActiveDocument is not None
        return len(selected) == 1 and self.selectable(selected[0])

    def Activated(self) -> None:
        """Run the command; on a fault everything is as before."""
        subject = next(iter(FreeCADGui.Selection.getSelection()), None)
        document = subject.Document if subject else FreeCAD.ActiveDocument
        with transaction(document, translate(self.name, self.text)):
            self.action(subject)
        document.recompute()


@dataclass(frozen=True)
class WindowCommand(Command):
    """A command that opens a window: it needs no document and changes none. Its action gets what is selected."""

    def IsActive(self) -> bool:
        """Always."""
        return True

    def Activated(self) -> None:
        """Open the window."""
        self.action(next(iter(FreeCADGui.Selection.getSelection()), None))


@dataclass(frozen=True)
class PanelCommand(Command):
    """A command whose object is edited in a panel at once: that ends the transaction, so that both are one step."""

    def Activated(self) -> None:
        """Add the object and open its panel; on a fault everything is as before."""
        (subject,) = FreeCADGui.Selection.getSelection()
        document, before = subject.Document, set(subject.Document.Objects)
        document.openTransaction(translate(self.name, self.text))
        try:
            self.action(subject)
            document.recompute()
            (made,) = set(document.Objects) - before
            FreeCADGui.getDocument(document.Name).setEdit(made.ViewObject, 0)
        except BaseException:
            document.abortTransaction()
            raise


def _do(module: str, call: str, operation: FreeCAD.DocumentObject) -> None:
    FreeCADGui.addModule(module)
    subject = f"FreeCAD.getDocument({operation.Document.Name!r}).getObject({operation.Name!r})"
    FreeCADGui.doCommand(f"{module}.{call.format(subject)}")


def _mirror(operation: FreeCAD.DocumentObject) -> None:
    _do("pkm_post.freecad_app.symmetry", "create_mirror({}, normal=(0, 1, 0))", operation)


def _rotate(operation: FreeCAD.DocumentObject) -> None:
    _do("pkm_post.freecad_app.symmetry", "create_rotation({}, axis=(0, 0, 1), angle=3.141592653589793)", operation)


def _compensate(operation: FreeCAD.DocumentObject) -> None:
    _do("pkm_post.freecad_app.normal_compensation", "create_normal_compensation({})", operation)


def _job_of(item: FreeCAD.DocumentObject) -> FreeCAD.DocumentObject | None:
    """A job itself, or the job whose model an object is, as clone or as original."""
    if is_job(item):
        return item
    jobs = [other for other in item.Document.Objects if is_job(other)]
    models = [(job, clone) for job in jobs for clone in job.Model.Group]
    return next((job for job, clone in models if item in (clone, job.Proxy.baseObject(job, clone))), None)


def _finish(item: FreeCAD.DocumentObject) -> None:
    """Add the operation over the faces that are selected, and open its panel when the command is done."""
    module, document = "pkm_post.freecad_app.surface_finish", f"FreeCAD.getDocument({item.Document.Name!r})"
    job, subject = (f"{document}.getObject({each.Name!r})" for each in (_job_of(item), item))
    names = [name for each in FreeCADGui.Selection.getSelectionEx() for name in each.SubElementNames]
    faces = [] if is_job(item) else [name for name in names if name.startswith("Face")]
    FreeCADGui.addModule(module)
    chosen = f"[({subject}, {faces!r})]" if faces else "[]"
    FreeCADGui.doCommand(f"{module}.create_surface_finish({job}, {chosen})")
    made = _job_of(item).Operations.Group[-1]
    QtCore.QTimer.singleShot(0, lambda: made.ViewObject.Document.setEdit(made.ViewObject, 0))


def _machine(job: FreeCAD.DocumentObject | None) -> None:
    """Add a machine to the document, for the selected job if there is one."""
    module = "pkm_post.freecad_app.machine_object"
    FreeCADGui.addModule(module)
    document = FreeCAD.ActiveDocument if job is None else job.Document
    subject = f"FreeCAD.getDocument({document.Name!r})"
    chosen = "" if job is None else f", job={subject}.getObject({job.Name!r})"
    FreeCADGui.doCommand(f"{module}.create_machine({subject}{chosen})")


def _create_on_machine(job: FreeCAD.DocumentObject, module: str, call: str) -> None:
    """Add what is made of a job and, if there is one, the machine of the document."""
    from pkm_post.freecad_app.reach_object import machine_for

    machine, document = machine_for(job), f"FreeCAD.getDocument({job.Document.Name!r})"
    FreeCADGui.addModule(module)
    chosen = "" if machine is None else f", machine={document}.getObject({machine.Name!r})"
    FreeCADGui.doCommand(f"{module}.{call}({document}.getObject({job.Name!r}){chosen})")


def _reach(job: FreeCAD.DocumentObject) -> None:
    """Add the checks of a job, on its machine in the document if there is one."""
    _create_on_machine(job, "pkm_post.freecad_app.reach_object", "create_reach")


def _simulate(item: FreeCAD.DocumentObject) -> None:
    """Add the simulation of a job if there is none yet, and open its player when the command is done."""
    from pkm_post.freecad_gui.player import open_player

    if not is_simulation(item) and _simulation_of(item) is None:
        _create_on_machine(item, "pkm_post.freecad_app.simulation_object", "create_simulation")
    shown = item if is_simulation(item) else _simulation_of(item)
    QtCore.QTimer.singleShot(0, lambda: open_player(shown))


def _simulation_of(job: FreeCAD.DocumentObject) -> FreeCAD.DocumentObject | None:
    return next((other for other in job.InList if is_simulation(other)), None)


def _post(job: FreeCAD.DocumentObject) -> None:
    """Open the panel that posts a job."""
    from pkm_post.freecad_gui.post_panel import open_panel

    open_panel(job)


def _edit(item: FreeCAD.DocumentObject | None) -> None:
    """Open the editor, with the part program that is selected."""
    from pkm_post.freecad_gui.editor import open_editor

    open_editor(item)


def _control(_item: FreeCAD.DocumentObject | None) -> None:
    """Open the panel of numerical control."""
    from pkm_post.freecad_gui.control_panel import open_control

    open_control()


COMMANDS = (
    PanelCommand(
        "PKM_Mirror",
        "mirror.svg",
        QT_TRANSLATE_NOOP("PKM_Mirror", "Mirror operation"),
        QT_TRANSLATE_NOOP("PKM_Mirror", "Add the mirror image of the selected operation: plane, climb milling, report"),
        is_operation,
        _mirror,
        "P, K, M",
    ),
    PanelCommand(
        "PKM_Rotate",
        "rotate.svg",
        QT_TRANSLATE_NOOP("PKM_Rotate", "Rotate operation"),
        QT_TRANSLATE_NOOP("PKM_Rotate", "Add the selected operation turned, once or several times about an axis"),
        is_operation,
        _rotate,
        "P, K, R",
    ),
    Command(
        "PKM_NormalCompensation",
        "normal_compensation.svg",
        QT_TRANSLATE_NOOP("PKM_NormalCompensation", "Normal Compensation"),
        QT_TRANSLATE_NOOP(
            "PKM_NormalCompensation",
            "Take the points of the selected operation for contact points on the model, and let the cutter touch there",
        ),
        is_operation,
        _compensate,
        "P, K, N",
    ),
    Command(
        "PKM_SurfaceFinish",
        "surface_finish.svg",
        QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Surface Finish (5-axis)"),
        QT_TRANSLATE_NOOP(
            "PKM_SurfaceFinish", "Cover the selected faces of a job's model with passes of a leaning tool"
        ),
        lambda item: _job_of(item) is not None,
        _finish,
        "P, K, F",
    ),
    Command(
        "PKM_Machine",
        "machine.svg",
        QT_TRANSLATE_NOOP("PKM_Machine", "Machine"),
        QT_TRANSLATE_NOOP("PKM_Machine", "Add the machine around the part, with the work offset of the selected job"),
        is_job,
        _machine,
        "P, K, H",
        alone=True,
    ),
    Command(
        "PKM_Reach",
        "reach.svg",
        QT_TRANSLATE_NOOP("PKM_Reach", "Reach"),
        QT_TRANSLATE_NOOP("PKM_Reach", "Check whether the machine can follow the selected job, and colour its way"),
        is_job,
        _reach,
        "P, K, C",
    ),
    Command(
        "PKM_Simulate",
        "simulate.svg",
        QT_TRANSLATE_NOOP("PKM_Simulate", "Simulate"),
        QT_TRANSLATE_NOOP("PKM_Simulate", "Play the planned motion of the selected job on its machine"),
        lambda item: is_job(item) or is_simulation(item),
        _simulate,
        "P, K, S",
    ),
    WindowCommand(
        "PKM_Editor",
        "program.svg",
        QT_TRANSLATE_NOOP("PKM_Editor", "Program editor"),
        QT_TRANSLATE_NOOP("PKM_Editor", "Edit G-code or CL data, with its faults told while it is typed"),
        lambda item: True,
        _edit,
        "P, K, E",
    ),
    Command(
        "PKM_Post",
        "pkm_post.svg",
        QT_TRANSLATE_NOOP("PKM_Post", "Post to a hexapod"),
        QT_TRANSLATE_NOOP("PKM_Post", "Write the certified motion program of the selected job"),
        is_job,
        _post,
        "P, K, P",
    ),
    WindowCommand(
        "PKM_Control",
        "control.svg",
        QT_TRANSLATE_NOOP("PKM_Control", "Numerical control"),
        QT_TRANSLATE_NOOP("PKM_Control", "Operate a machine, or a simulated one: look, home, jog, run programs"),
        lambda item: True,
        _control,
        "P, K, O",
    ),
)


def register() -> None:
    """Make the commands known to FreeCAD."""
    for command in COMMANDS:
        FreeCADGui.addCommand(command.name, command)
