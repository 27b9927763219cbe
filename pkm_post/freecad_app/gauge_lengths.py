# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge lengths: what a job says of how far each of its tools stands out of the spindle, and where it is kept.

A job enters; a row for each of its tool controllers leaves, in mm. What is chosen for some of them goes into the
document. A gauge length is never guessed: the length of the tool bit stands in the row to compare it with, but part of
the bit is in its holder, and the holder counts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from Path.Base.Util import opProperty, toolControllerForOp

from pkm_post.freecad_app.job import document_name
from pkm_post.freecad_app.tools import bit_length, gauge_length, set_gauge_length
from pkm_post.model import Diagnostic, Place


@dataclass(frozen=True)
class ToolRow:
    """A tool controller of a job.

    Attributes:
        name: of the object in its document.
        number, label: of the tool controller.
        place: what diagnostics name.
        length: gauge length in mm; 0 if it is not known.
        bit_length: length of the tool bit alone in mm; 0 if it does not say.
        in_use: whether an active operation takes it.
    """

    name: str
    number: int
    label: str
    place: Place
    length: float
    bit_length: float
    in_use: bool

    def unknown(self, found: str = "") -> Diagnostic:
        """What posting says of a tool whose gauge length is not known, and what was given in place of one."""
        return Diagnostic("J113", self.place, f"T{self.number}{found and ', '}{found}")


def tool_rows(job: Any) -> tuple[ToolRow, ...]:
    """The tool controllers of a job, in the order of its tree."""
    used = {
        controller.Name
        for operation in job.Operations.Group
        if opProperty(operation, "Active") is not False and (controller := toolControllerForOp(operation))
    }
    source = document_name(job.Document)
    return tuple(
        ToolRow(
            controller.Name,
            int(controller.ToolNumber),
            controller.Label,
            Place(source, controller.Label),
            gauge_length(controller),
            bit_length(controller),
            controller.Name in used,
        )
        for controller in job.Tools.Group
    )


def keep_gauge_lengths(job: Any, lengths: Mapping[str, float]) -> None:
    """Let tool controllers of a job keep their gauge lengths; those that have them already are not touched.

    Args:
        job: the job.
        lengths: mm, by the names of the tool controllers; 0 for one that is not known any more.

    Raises:
        ValueError: a length below zero.
    """
    for name, mm in lengths.items():
        if not mm >= 0.0:
            raise ValueError(f"expected gauge lengths of 0 or more, got {mm} mm for {name}")
    for controller in job.Tools.Group:
        if lengths.get(controller.Name, gauge_length(controller)) != gauge_length(controller):
            set_gauge_length(controller, lengths[controller.Name])
