# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program end: check the state in which a program leaves the machine.

Enters: a program in {C}. Leaves: warnings about a spindle left running and a tool left low. Truncated programs end like
this, and so do programs that leave both to the operator. Lengths in mm.

The tool must return to the level of the last retract: the last rapid move that rises along the tool axis, or else the
first move, the approach.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import dot
from pkm_post.model import Diagnostic, EventKind, Kind, Program

_HEIGHT = 1e-3
"""mm; smaller height differences are rounding errors."""
_SAME_AXIS = 1 - 1e-9


def end_warnings(program: Program) -> tuple[Diagnostic, ...]:
    """Warnings about the end of a program of at least one row."""
    return (*_turning(program), *_low(program))


def _turning(program: Program) -> Iterator[Diagnostic]:
    speeds = [event.value for event in program.events if event.kind is EventKind.SPINDLE]
    if speeds and speeds[-1]:
        yield Diagnostic("V130", program.place(len(program) - 1), f"{abs(speeds[-1]):g} rpm")


def _low(program: Program) -> Iterator[Diagnostic]:
    """Warn of a tool that ends below its last retract, measured along the final tool axis."""
    axis, last = program.tool_axis[-1], len(program) - 1
    retract = _last_retract(program)
    below = float(dot(program.position[retract] - program.position[-1], axis))
    has_cut = bool((program.kind[retract + 1 :] != Kind.RAPID).any())
    comparable = has_cut or float(dot(program.tool_axis[retract], axis)) > _SAME_AXIS
    if below > _HEIGHT and comparable:
        at = program.place(retract)
        found = f"{below:.6g} mm lower than after the retract in line {at.line}" if at.line else f"{below:.6g} mm lower"
        yield Diagnostic("V131", program.place(last), found)


def _last_retract(program: Program) -> int:
    """The row of the last rapid move that rises along its tool axis, or else the first row."""
    rapid = np.flatnonzero(program.kind[1:] == Kind.RAPID) + 1
    rise = dot(program.position[rapid] - program.position[rapid - 1], program.tool_axis[rapid])
    rising = rapid[rise > _HEIGHT]
    return int(rising[-1]) if len(rising) else 0
