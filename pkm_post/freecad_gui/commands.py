# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands: a table with one row per command."""

from __future__ import annotations

from collections.abc import Sequence

import FreeCAD
import FreeCADGui

from pkm_post.freecad_app.document import is_operation, is_simulation, job_of
from pkm_post.freecad_gui import command_actions
from pkm_post.freecad_gui.command import Command, JobPanelCommand, PanelCommand, WindowCommand, exactly_one, job_or

QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

COMMANDS = (
    PanelCommand(
        "PKM_Mirror",
        "mirror.svg",
        QT_TRANSLATE_NOOP("PKM_Mirror", "Mirror operation"),
        QT_TRANSLATE_NOOP("PKM_Mirror", "Add the mirror image of the selected operation: plane, climb milling, report"),
        exactly_one(is_operation),
        command_actions.mirror,
        "P, K, M",
    ),
    PanelCommand(
        "PKM_Rotate",
        "rotate.svg",
        QT_TRANSLATE_NOOP("PKM_Rotate", "Rotate operation"),
        QT_TRANSLATE_NOOP("PKM_Rotate", "Add copies of the selected operation, rotated about an axis"),
        exactly_one(is_operation),
        command_actions.rotate,
        "P, K, R",
    ),
    Command(
        "PKM_NormalCompensation",
        "normal_compensation.svg",
        QT_TRANSLATE_NOOP("PKM_NormalCompensation", "Normal Compensation"),
        QT_TRANSLATE_NOOP(
            "PKM_NormalCompensation",
            "Treat the points of the selected operation as contact points of the cutter with the model",
        ),
        exactly_one(is_operation),
        command_actions.compensate,
        "P, K, N",
        "compensation.md",
    ),
    Command(
        "PKM_SurfaceFinish",
        "surface_finish.svg",
        QT_TRANSLATE_NOOP("PKM_SurfaceFinish", "Surface Finish (5-axis)"),
        QT_TRANSLATE_NOOP(
            "PKM_SurfaceFinish", "Cover the selected faces of a job's model with passes of a leaning tool"
        ),
        job_or(lambda item: job_of(item) is not None),
        command_actions.finish,
        "P, K, F",
        "surface-finish.md",
        computes=False,
    ),
    Command(
        "PKM_Machine",
        "machine.svg",
        QT_TRANSLATE_NOOP("PKM_Machine", "Machine"),
        QT_TRANSLATE_NOOP("PKM_Machine", "Add the machine around the part, with the work offset of the job"),
        job_or(),
        command_actions.machine,
        "P, K, H",
        alone=True,
    ),
    Command(
        "PKM_Reach",
        "reach.svg",
        QT_TRANSLATE_NOOP("PKM_Reach", "Reach"),
        QT_TRANSLATE_NOOP("PKM_Reach", "Check whether the machine can follow the job, and colour its path"),
        job_or(),
        command_actions.reach,
        "P, K, C",
        "reach.md",
    ),
    JobPanelCommand(
        "PKM_Stiffness",
        "stiffness.svg",
        QT_TRANSLATE_NOOP("PKM_Stiffness", "Stiffness"),
        QT_TRANSLATE_NOOP("PKM_Stiffness", "Show the stiffness of the tool tip along the job and over the table"),
        job_or(),
        command_actions.stiffness,
        "P, K, T",
        "reach.md",
        computes=False,
    ),
    Command(
        "PKM_Simulate",
        "simulate.svg",
        QT_TRANSLATE_NOOP("PKM_Simulate", "Simulate"),
        QT_TRANSLATE_NOOP("PKM_Simulate", "Play the planned motion of the job on its machine"),
        job_or(is_simulation),
        command_actions.simulate,
        "P, K, S",
    ),
    WindowCommand(
        "PKM_Editor",
        "program.svg",
        QT_TRANSLATE_NOOP("PKM_Editor", "Program editor"),
        QT_TRANSLATE_NOOP("PKM_Editor", "Edit G-code or CL data, with faults shown as you type"),
        exactly_one(lambda item: True),
        command_actions.edit,
        "P, K, E",
    ),
    JobPanelCommand(
        "PKM_Post",
        "pkm_post.svg",
        QT_TRANSLATE_NOOP("PKM_Post", "Post to a hexapod"),
        QT_TRANSLATE_NOOP("PKM_Post", "Write the certified motion program of the job"),
        job_or(),
        command_actions.post,
        "P, K, P",
    ),
    WindowCommand(
        "PKM_Control",
        "control.svg",
        QT_TRANSLATE_NOOP("PKM_Control", "Numerical control"),
        QT_TRANSLATE_NOOP("PKM_Control", "Operate a real or simulated machine: monitor, home, jog, run programs"),
        exactly_one(lambda item: True),
        command_actions.control,
        "P, K, O",
        "numerical-control.md",
    ),
    WindowCommand(
        "PKM_Example",
        "example.svg",
        QT_TRANSLATE_NOOP("PKM_Example", "New from example"),
        QT_TRANSLATE_NOOP("PKM_Example", "Make a document with a blade and the job that finishes it on a hexapod"),
        exactly_one(lambda item: True),
        command_actions.example,
        "P, K, X",
        "tutorial-blade.md",
        beside=False,
    ),
    WindowCommand(
        "PKM_InstallPackages",
        "packages.svg",
        QT_TRANSLATE_NOOP("PKM_InstallPackages", "Install packages"),
        QT_TRANSLATE_NOOP("PKM_InstallPackages", "Install the optional Python packages that are missing here"),
        exactly_one(lambda item: True),
        command_actions.install_packages,
        "P, K, I",
    ),
)


GROUPS = (
    ("PKM_SurfaceFinish", "PKM_NormalCompensation", "PKM_Mirror", "PKM_Rotate"),
    ("PKM_Machine", "PKM_Reach", "PKM_Stiffness", "PKM_Simulate", "PKM_Post"),
    ("PKM_Editor", "PKM_Control"),
    ("PKM_Example", "PKM_InstallPackages"),
)
"""Names by purpose: operations, one job, programs and the machine, the rest."""


def grouped(groups: Sequence[Sequence[str]] = GROUPS) -> list[str]:
    """The names, with separators between the groups, as FreeCAD takes them for menus and tool bars."""
    return [name for number, group in enumerate(groups) for name in ([] if number == 0 else ["Separator"]) + [*group]]


def register() -> None:
    """Register the commands with FreeCAD."""
    for command in COMMANDS:
        FreeCADGui.addCommand(command.name, command)
