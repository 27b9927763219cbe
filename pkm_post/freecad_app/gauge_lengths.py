# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gauge lengths: the gauge length of each tool of a job, its storage, and its input as text.

Takes a job; returns a row for each of its tool controllers, in mm. Lengths that the user sets are stored in the
document. A gauge length is never guessed: the row gives the length of the tool bit for comparison, but part of the bit
is inside its holder, and the holder counts.

Typed lengths are text with or without a unit. Inputs that FreeCAD's own fields misread are refused here, since a wrong
length does harm: their ``12,5 cm`` is 1250 mm, their ``4 1/2 in`` is 4 mm, and on ``abc`` they keep the previous value.
FreeCAD drops non-ASCII letters.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
from Path.Base.Util import toolControllerForOp

from pkm_post.freecad_app.document import document_name, members
from pkm_post.freecad_app.job import is_active
from pkm_post.freecad_app.tools import bit_length, gauge_length, set_gauge_length
from pkm_post.model import Diagnostic, Phrase, Place
from pkm_post.options import LONGEST_TOOL

_DIGITS = 9
"""Significant digits shown: nanometres of a metre."""
_MICRO = "µ"
"""The only non-ASCII letter in FreeCAD's units of length."""
_USUAL = "100 mm"
"""A length typical of a tool; a number without a unit is in the display unit of this length."""


@dataclass(frozen=True)
class ToolRow:
    """A tool controller of a job.

    Attributes:
        name: name of the object in its document.
        number, label: of the tool controller.
        length: gauge length in mm; 0 if unknown.
        bit_length: length of the tool bit only, in mm; 0 if not stated.
        in_use: whether an active operation uses it.
    """

    name: str
    number: int
    label: str
    place: Place
    length: float
    bit_length: float
    in_use: bool

    def missing_length(self, found: str = "") -> Diagnostic:
        """The diagnostic of posting for a tool without a gauge length; ``found`` is the input given instead."""
        tool = f"T{self.number}"
        return Diagnostic("J113", self.place, Phrase("{}, {}", tool, found) if found else tool)


def tool_rows(job: Any) -> tuple[ToolRow, ...]:
    """The tool controllers of a job, in tree order."""
    used = {
        controller.Name
        for operation in members(job.Operations)
        if is_active(operation) and (controller := toolControllerForOp(operation))
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
        for controller in members(job.Tools)
    )


def store_gauge_lengths(job: Any, lengths: Mapping[str, float]) -> None:
    """Store gauge lengths in the tool controllers of a job; controllers that already have them are not touched.

    Args:
        lengths: mm, by the names of the tool controllers; 0 to clear one.

    Raises:
        ValueError: a length is negative.
    """
    for name, mm in lengths.items():
        if not mm >= 0.0:
            raise ValueError(f"expected gauge lengths of 0 or more, got {mm} mm for {name}")
    for controller in members(job.Tools):
        if lengths.get(controller.Name, gauge_length(controller)) != gauge_length(controller):
            set_gauge_length(controller, lengths[controller.Name])


def parse_length(text: str, point: str = ".") -> float | None:
    """The typed length, mm; None if it is not above 0 and up to ``LONGEST_TOOL``.

    Args:
        text: such as ``120``, ``120 mm``, ``4.5 in`` or ``3*40 mm``.
        point: decimal separator in the user's language; a full stop is always accepted. A comma that is not the
            decimal separator is invalid.
    """
    text = text.replace(point, ".")
    if not text.strip() or "," in text or not text.replace(_MICRO, "").isascii():
        return None
    try:
        quantity = App.Units.Quantity(text)
    except ValueError:  # raised for a syntax error
        return None
    if quantity.Unit not in (App.Units.Unit(), App.Units.Length):
        return None
    _, usual, _ = App.Units.Quantity(_USUAL).getUserPreferred()
    mm = float(quantity.Value * (1.0 if quantity.Unit == App.Units.Length else usual))
    return mm if 0.0 < mm <= LONGEST_TOOL else None


def format_length(mm: float, point: str = ".", digits: int = _DIGITS) -> str:
    """A length in the unit that FreeCAD is set to, with all its digits or the first ones."""
    _, factor, unit = App.Units.Quantity(f"{mm!r} mm").getUserPreferred()
    return f"{mm / factor:.{digits}g} {unit}".replace(".", point)
