# SPDX-License-Identifier: LGPL-2.1-or-later
"""One hole: heights and moves common to the cycles, and tapping by CYCLE84, with the spindle as an axis.

A tapped hole is feed moves down and up, at the speeds SST and SST1, between the events of a thread [SiemensCycles,
CYCLE84]. The lead is PIT in the unit given by _PTAB, or that of the metric coarse thread MPIT [ISO 261]; its sign is
the hand of the thread. Arguments are in the active unit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pkm_post.model import EventKind
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.siemens.blocks import Call
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.machine import SiemensMachine
from pkm_post.reading.siemens.state import LINE

NAMES = ("X", "Y", "Z")


@dataclass(frozen=True)
class Hole:
    """Heights of a cycle, in the active unit: retraction plane, reference plane, start of the feed, bottom."""

    retract: float
    reference: float
    start: float
    bottom: float


class Drill:
    """One hole at the tool position."""

    def __init__(self, machine: SiemensMachine, row: int, call: Call) -> None:
        self.machine, self.row, self.call = machine, row, call
        self._normal = NAMES[PLANES[machine.state.plane][2]]

    def to(self, motion: int, height: float, feed: float = math.nan) -> None:
        """Move along the normal of the plane."""
        words = {self._normal: height} | ({} if math.isnan(feed) else {"F": feed})
        self.machine.move(self.row, motion, words)

    def dwell(self, value: float, in_turns: bool = False) -> None:
        """Wait some seconds or, for a negative value, spindle turns [SiemensCycles, DTB]."""
        if value < 0 or (in_turns and value):
            self.machine.dwell(self.row, self.machine.seconds_of_turns(abs(value)))
        elif value:
            self.machine.dwell(self.row, value)


CYCLE = "CYCLE84"
MODES = 21
"""Place of _GMODE among its arguments, from 0."""
_SDAC, _MPIT, _PIT, _POSS, _SST, _SST1, _AXIS, _PTAB, _VARI = 6, 7, 8, 9, 10, 11, 12, 13, 15
_COARSE = {
    3: 0.5, 3.5: 0.6, 4: 0.7, 5: 0.8, 6: 1.0, 7: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5,
    22: 2.5, 24: 3.0, 27: 3.0, 30: 3.5, 33: 3.5, 36: 4.0, 39: 4.0, 42: 4.5, 45: 4.5, 48: 5.0,
}  # fmt: skip
"""Lead in mm of metric coarse threads by their size [ISO 261]."""
_INCH = 25.4
_PER_MINUTE = 94
_SENSES = {3: 1.0, 4: -1.0, 5: 0.0}
_SAME = 1e-6
"""mm: largest difference of a lead by size and a lead by value."""
_DECIMALS = 9


def check_tapping(machine: SiemensMachine, call: Call) -> None:
    """Refuse the cycle if the spindle cannot be an axis.

    Raises:
        BlockFault: it cannot.
    """
    if call.name == CYCLE and not machine.options.spindle_axis:
        raise BlockFault("G425", call.name, call.column)


def tap(one: Drill, hole: Hole, in_turns: bool) -> None:
    """Down to the depth, dwell DTB, and up to RFP + SDIS; then set the spindle according to SDAC.

    Raises:
        BlockFault: the arguments are invalid.
    """
    machine, call = one.machine, one.call
    state = machine.state
    down, up = call.number(_SST), call.number(_SST1, 0.0) or call.number(_SST)
    for place, name in ((_POSS, "POSS"), (_VARI, "_VARI"), (_AXIS, "_AXN")):
        value = call.number(place, 0.0)
        if value and not (place == _AXIS and value == 3):  # noqa: PLR2004 - the third axis
            raise BlockFault("G602", f"{CYCLE} with {name}={value:g}", call.column)
    if not (down > 0 and up > 0):
        raise BlockFault("G418", f"{CYCLE}: SST {down:g} and SST1 {up:g}", call.column)
    lead = _lead(call, state.scale)
    machine.path.add_event(EventKind.SPINDLE_AXIS, round(lead, _DECIMALS))
    mode, state.feed_mode = state.feed_mode, _PER_MINUTE
    per_turn = abs(lead) / state.feed_scale
    one.to(LINE, hole.bottom, per_turn * down)
    one.dwell(call.number(5, 0.0), in_turns)
    one.to(LINE, hole.start, per_turn * up)
    machine.path.add_event(EventKind.SPINDLE_AXIS, 0.0)
    state.feed_mode = mode
    _turn_on(machine, call)


def _lead(call: Call, scale: float) -> float:
    """The lead in mm, signed; ``scale`` is the active unit, mm."""
    size, value, unit = call.number(_MPIT, 0.0), call.number(_PIT, 0.0), int(call.number(_PTAB, 0.0))
    if abs(size) not in (0, *_COARSE):
        raise BlockFault("G418", f"{CYCLE}: no metric coarse thread has the size MPIT {size:g}", call.column)
    if unit not in (0, 1, 2, 3) or (value and not unit and scale != 1):  # editions differ on 0 in inches
        raise BlockFault("G602", f"{CYCLE} with _PTAB={unit}", call.column)
    by_size = (1 if size > 0 else -1) * _COARSE[abs(size)] if size else 0.0
    by_value = 0.0
    if value:
        by_value = {0: value, 1: value, 2: _INCH / value, 3: value * _INCH}[unit]
    if not (by_size or by_value) or (by_size and by_value and abs(by_size - by_value) > _SAME):
        raise BlockFault("G418", f"{CYCLE}: MPIT {size:g} and PIT {value:g}", call.column)
    return by_value or by_size


def _turn_on(machine: SiemensMachine, call: Call) -> None:
    """Restore the spindle, or set it by SDAC: 3 for M3, 4 for M4, 5 for M5."""
    state, sense = machine.state, call.number(_SDAC, 0.0)
    if sense and sense not in _SENSES:
        raise BlockFault("G418", f"{CYCLE}: SDAC {sense:g}", call.column)
    was_on, state.sense = bool(state.sense), _SENSES.get(int(sense), state.sense)
    if state.sense and not state.speed > 0:
        raise BlockFault("G405", f"M{sense:g} without S", call.column)
    if state.sense or was_on:
        machine.path.add_event(EventKind.SPINDLE, state.spindle())
