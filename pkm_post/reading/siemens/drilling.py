# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drilling: CYCLE81, 82, 83, 84, 85 and 89 at the tool position, and rows and circles of holes.

Input: calls with their arguments, in the active unit. Output: moves and dwells [SiemensCycles, drilling cycles]. All
start at RFP + SDIS and return to RTP; the depth is DP, or RFP - DPR if DPR is given. Motion code and feed are restored
after a cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.cycles import MOST_STROKES
from pkm_post.reading.gcode.frames import PLANES
from pkm_post.reading.gcode.tool_axes import shown_axis
from pkm_post.reading.siemens.blocks import Call
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.machine import SiemensMachine
from pkm_post.reading.siemens.one_hole import CYCLE as TAPPING
from pkm_post.reading.siemens.one_hole import MODES, NAMES, Drill, Hole, check_tapping, tap
from pkm_post.reading.siemens.state import LINE, RAPID

_ALONG = 1 - 1e-12
_CHIP_RETRACT = 1.0
"""Retract of CYCLE83 to break a chip if _VRT is 0, mm [SiemensCycles, CYCLE83]."""
_LEAST_GAP, _MOST_GAP, _GAP_PER_DEPTH, _SHALLOW = 0.6, 7.0, 50.0, 30.0
"""Distance of CYCLE83 before the depth reached, mm: 0.6 up to 30 mm of depth, then a fiftieth, up to 7."""
_INVERSE_TIME = 93


def drill(machine: SiemensMachine, row: int, call: Call) -> None:
    """Execute a drilling cycle at the tool position.

    Raises:
        BlockFault: its arguments are invalid.
    """
    check_tapping(machine, call)
    state = machine.state
    if state.side:
        raise BlockFault("G419", call.name, call.column)
    normal = np.eye(3)[PLANES[state.plane][2]]
    if state.is_tilted() and abs(float(state.frame.directions(normal) @ state.axis)) < _ALONG:
        raise BlockFault("G429", f"tool axis {shown_axis(state.axis)}", call.column)
    if not state.known.all():
        raise BlockFault("G416", call.name, call.column)
    if state.feed_mode == _INVERSE_TIME:
        raise BlockFault("G441", f"{call.name} with inverse time feed (G93)", call.column)
    strokes, modes = CYCLES[call.name]
    in_turns = _checked_modes(machine, call, modes)
    before = machine.begin_cycle()
    hole = _hole(call, modes)
    one = Drill(machine, row, call)
    one.to(RAPID, hole.start)
    strokes(one, hole, in_turns)
    one.to(RAPID, hole.retract)
    machine.end_cycle(before)


def _checked_modes(machine: SiemensMachine, call: Call, first: int) -> bool:
    """Check _GMODE, _DMODE and _AMODE after the arguments of a cycle; return whether dwells are in turns."""
    if call.arguments is not None and len(call.arguments) > first + 3:
        raise BlockFault("G418", f"{call.name} with {len(call.arguments)} arguments", call.column)
    geometry, plane, alternative = (int(call.number(first + place, 0.0)) for place in range(3))
    if geometry:
        raise BlockFault("G602", f"{call.name} with _GMODE={geometry}", call.column)
    named = {1: 170, 2: 180, 3: 190}.get(plane % 10)
    if named not in (None, machine.state.plane):
        raise BlockFault("G602", f"{call.name} in another plane (_DMODE={plane})", call.column)
    if alternative >= 100 or alternative % 10 > 2 or alternative // 10 > 2:  # noqa: PLR2004 - digits of _AMODE
        raise BlockFault("G602", f"{call.name} with _AMODE={alternative}", call.column)
    return alternative // 10 == 2  # noqa: PLR2004 - turns


def _hole(call: Call, modes: int) -> Hole:
    """The heights; _AMODE defines whether the depth is absolute or relative."""
    retract, reference, clearance = call.number(0), call.number(1), abs(call.number(2, 0.0))
    alternative = int(call.number(modes + 2, 0.0)) % 10
    if alternative != 1 and call.gives(4) and (call.number(4) or not call.gives(3) or alternative):
        bottom = reference - abs(call.number(4))
    elif alternative == 2:  # noqa: PLR2004 - relative
        bottom = reference - abs(call.number(3))
    else:
        bottom = call.number(3)
    if not retract >= reference + clearance:
        raise BlockFault("G418", f"{call.name}: RTP {retract:g} is below RFP + SDIS", call.column)
    if not reference > bottom:
        raise BlockFault("G418", f"{call.name}: the depth {bottom:g} is not below RFP {reference:g}", call.column)
    return Hole(retract, reference, reference + clearance, bottom)


def _simple(one: Drill, hole: Hole, in_turns: bool) -> None:
    """CYCLE81 and CYCLE82: feed down, dwell DTB."""
    one.to(LINE, hole.bottom)
    one.dwell(one.call.number(5, 0.0), in_turns)


def _ream(one: Drill, hole: Hole, in_turns: bool) -> None:
    """CYCLE85: down with FFR, dwell, up with RFF."""
    feeds = one.call.number(6, 0.0), one.call.number(7, 0.0)
    one.to(LINE, hole.bottom, feeds[0] or math.nan)
    one.dwell(one.call.number(5, 0.0), in_turns)
    one.to(LINE, hole.start, feeds[1] or math.nan)


def _bore(one: Drill, hole: Hole, in_turns: bool) -> None:
    """CYCLE89: feed down, dwell, feed up."""
    one.to(LINE, hole.bottom)
    one.dwell(one.call.number(5, 0.0), in_turns)
    one.to(LINE, hole.start)


def _depths(call: Call, hole: Hole) -> Iterator[float]:
    """The depths of CYCLE83: the first one, then strokes decreasing by DAM down to DAM, the last two equal."""
    amount = call.number(7, 0.0)
    first = _first_depth(call, hole)
    stroke, depth = hole.reference - first, first
    if not stroke > 0:
        raise BlockFault("G418", f"CYCLE83: the first depth {first:g} is not below RFP", call.column)
    if amount < 0:
        raise BlockFault("G602", f"CYCLE83 with a factor of degression (DAM={amount:g})", call.column)
    if (hole.reference - hole.bottom) / (min(amount, stroke) or stroke) > MOST_STROKES:
        raise BlockFault("G418", f"CYCLE83: more than {MOST_STROKES} strokes", call.column)
    while depth > hole.bottom:
        yield depth
        rest = depth - hole.bottom
        stroke = max(stroke - amount, amount) if amount else stroke
        if stroke < rest < 2 * amount:
            stroke = rest / 2
        depth -= stroke
    yield hole.bottom


def _first_depth(call: Call, hole: Hole) -> float:
    if call.number(6, 0.0):
        return max(hole.reference - abs(call.number(6)), hole.bottom)
    return max(call.number(5), hole.bottom) if call.gives(5) else hole.bottom


def _deep(one: Drill, hole: Hole, in_turns: bool) -> None:
    """CYCLE83: strokes with a retract after each, by 1 mm to break chips or to the start to remove them."""
    call, scale = one.call, one.machine.state.scale
    removes, factor = call.number(11, 0.0) != 0, call.number(10, 0.0) or 1.0
    feed = one.machine.state.feed
    total = (hole.reference - hole.bottom) * scale
    automatic = _LEAST_GAP if total <= _SHALLOW else min(total / _GAP_PER_DEPTH, _MOST_GAP)
    gap = call.number(16, 0.0) or automatic / scale
    retract = call.number(14, 0.0) or _CHIP_RETRACT / scale
    for place, depth in enumerate(_depths(call, hole)):
        one.to(LINE, depth, feed * factor if not place else feed)
        last = depth == hole.bottom
        one.dwell(call.number(15, 0.0) if last and call.number(15, 0.0) else call.number(8, 0.0), in_turns)
        if last:
            return
        if removes:
            one.to(RAPID, hole.start)
            one.dwell(call.number(9, 0.0), in_turns)
            one.to(RAPID, min(depth + gap, hole.start))
        else:
            one.to(LINE, depth + retract, feed)


CYCLES: dict[str, tuple[Callable[[Drill, Hole, bool], None], int]] = {
    "CYCLE81": (_simple, 6),
    "CYCLE82": (_simple, 6),
    "CYCLE83": (_deep, 17),
    TAPPING: (tap, MODES),
    "CYCLE85": (_ream, 8),
    "CYCLE89": (_bore, 6),
}
"""Strokes of each cycle, and the place of _GMODE among its arguments, from 0."""
PATTERNS = ("HOLES1", "HOLES2")


def holes(machine: SiemensMachine, row: int, call: Call) -> None:
    """Execute the modal cycle at the holes of a pattern.

    Raises:
        BlockFault: no cycle is modal, or the arguments are invalid.
    """
    if machine.modal_call is None:
        raise BlockFault("G418", f"{call.name} without MCALL of a drilling cycle before it", call.column)
    first, second, _ = PLANES[machine.state.plane]
    before = machine.begin_cycle()
    here = machine.state.position[[first, second]] / machine.state.scale
    for place in _row(call, here) if call.name == PATTERNS[0] else _circle(call):
        machine.move(row, RAPID, {NAMES[first]: float(place[0]), NAMES[second]: float(place[1])})
        machine.path.flush()
        drill(machine, row, machine.modal_call)
    machine.end_cycle(before)


def _count(call: Call, index: int) -> int:
    number = call.number(index)
    if not 1 <= number <= MOST_STROKES or number != round(number):
        raise BlockFault("G418", f"{call.name} with {number:g} holes", call.column)
    return round(number)


def _row(call: Call, here: Array) -> Array:
    """HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM), from the end nearer to the tool, (n, 2)."""
    angle = math.radians(call.number(2, 0.0))
    along = call.number(3, 0.0) + call.number(4, 0.0) * np.arange(_count(call, 5))
    places = np.array([call.number(0), call.number(1)]) + along[:, None] * [math.cos(angle), math.sin(angle)]
    nearer = np.hypot(*(places[-1] - here)) < np.hypot(*(places[0] - here))
    return places[::-1] if nearer else places


def _circle(call: Call) -> Array:
    """HOLES2(CPA, CPO, RAD, STA1, INDA, NUM), (n, 2); INDA 0 spreads them evenly."""
    count = _count(call, 5)
    step = call.number(4, 0.0) or 360 / count
    angles = np.radians(call.number(3, 0.0) + step * np.arange(count))
    centre = np.array([call.number(0), call.number(1)])
    return centre + call.number(2) * np.column_stack([np.cos(angles), np.sin(angles)])
