# SPDX-License-Identifier: LGPL-2.1-or-later
"""Swivel: CYCLE800, a plane turned in space with the tool along its normal.

Input: the arguments (_FR, _TC, _ST, _MODE, _X0, _Y0, _Z0, _A, _B, _C, _X1, _Y1, _Z1, _DIR, ...). Output: the frame of
the plane in the state: shifted to X0 Y0 Z0, turned axis by axis about new axes, shifted to X1 Y1 Z1
[SiemensCycles, CYCLE800]. The bits of _MODE name the axes: two each for _A, _B and _C, from the lowest, 1 X, 2 Y, 3 Z;
the two above them are 0 for turns axis by axis; other kinds are refused. The digits of _ST define, from the lowest,
whether the plane adds to the previous one, whether the tip follows, and whether the tool is aligned, which is refused.
Without arguments, or with data set "0", the plane is reset.
"""

from __future__ import annotations

import numpy as np

from pkm_post.reading.siemens.blocks import Call
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.frames import ProgrammableFrame, about, turned
from pkm_post.reading.siemens.state import UPRIGHT, State

_DATA_SET, _STATUS, _MODE, _BEFORE, _ANGLES, _BEHIND, _DIRECTION = 1, 2, 3, 4, 7, 10, 13
_KINDS = ("axis by axis", "by solid angles", "by projection angles", "by rotary axes")
_EPSILON = 1e-12


def swivel(state: State, call: Call) -> bool:
    """Execute CYCLE800; return whether the tool turns, so that its tip position is lost.

    Raises:
        BlockFault: this kind of call is not supported.
    """
    if resets(call):
        return _set(state, ProgrammableFrame(), turns=state.swivelled)
    if not state.programmed.is_plain():
        raise BlockFault("G602", "CYCLE800 while TRANS, ROT, SCALE or MIRROR is in force", call.column)
    status = int(call.number(_STATUS, 0.0))
    if status // 100 % 10:
        raise BlockFault("G602", f"CYCLE800 that aligns the tool (_ST={status})", call.column)
    plane = _plane(state, call)
    frame = state.swivel.then(plane) if status % 10 else plane
    return _set(state, frame, turns=call.number(_DIRECTION, 0.0) != 0)


def resets(call: Call) -> bool:
    """Whether a call has no arguments or the data set "0"."""
    given = call.arguments or ()
    data_set = given[_DATA_SET] if len(given) > _DATA_SET else None
    return not any(value is not None for value in given) or str(data_set) in ("0", "0.0")


def _plane(state: State, call: Call) -> ProgrammableFrame:
    mode = int(call.number(_MODE, 57.0))
    kind = mode >> 6
    if kind:
        raise BlockFault("G602", f"CYCLE800 {_KINDS[kind & 3]} (_MODE={mode})", call.column)
    turn = np.eye(3)
    for place in range(3):
        degrees = call.number(_ANGLES + place, 0.0)
        axis = (mode >> (2 * place)) & 3
        if degrees and not axis:
            raise BlockFault("G606", f"_MODE={mode} names no axis for angle {place + 1}", call.column)
        if degrees:
            turn = turn @ about(axis - 1, degrees)
    before, behind = (
        ProgrammableFrame(shift=state.scale * np.array([call.number(first + place, 0.0) for place in range(3)]))
        for first in (_BEFORE, _BEHIND)
    )
    return before.then(turned(turn)).then(behind)


def _set(state: State, frame: ProgrammableFrame, turns: bool) -> bool:
    """Activate a plane; return whether the tool turns with it."""
    state.set_frames(state.offset, frame, state.programmed)
    if not turns:
        return False
    axis = state.frame.directions(UPRIGHT)
    lost = bool(np.abs(axis - state.axis).max() > _EPSILON)
    state.axis = axis
    state.swivelled = not frame.is_unturned()
    if lost:
        state.rotary = np.zeros(3)
        state.lose_position()
    return lost
