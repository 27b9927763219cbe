# SPDX-License-Identifier: LGPL-2.1-or-later
"""Post steps: the steps of posting in the user's language."""

from __future__ import annotations

import FreeCAD

translate = FreeCAD.Qt.translate
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

STEPS = {
    "reading": QT_TRANSLATE_NOOP("PostSteps", "Reading"),
    "trajectory": QT_TRANSLATE_NOOP("PostSteps", "Trajectory"),
    "reach and feed plan": QT_TRANSLATE_NOOP("PostSteps", "Reach and feed plan"),
    "collisions": QT_TRANSLATE_NOOP("PostSteps", "Collisions"),
    "interpolation": QT_TRANSLATE_NOOP("PostSteps", "Interpolation"),
    "motion program": QT_TRANSLATE_NOOP("PostSteps", "Motion program"),
    "certificate": QT_TRANSLATE_NOOP("PostSteps", "Certificate"),
    "report": QT_TRANSLATE_NOOP("PostSteps", "Report"),
    "also csv": QT_TRANSLATE_NOOP("PostSteps", "Table of the strut motion"),
    "also halstreamer": QT_TRANSLATE_NOOP("PostSteps", "Table for halstreamer"),
    "also linuxcnc": QT_TRANSLATE_NOOP("PostSteps", "G-code for LinuxCNC"),
    "": QT_TRANSLATE_NOOP("PostSteps", "Moving the files to their folder"),
}
"""Displayed name of each step, by its name in ``pkm_post.posting`` and ``pkm_post.options``."""


def step_text(step: str) -> str:
    """The displayed name of a step."""
    return translate("PostSteps", STEPS[step])
