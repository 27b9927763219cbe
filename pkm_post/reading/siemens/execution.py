# SPDX-License-Identifier: LGPL-2.1-or-later
"""Execution: execute computed blocks in sequence.

Input: blocks in the order of execution. Output: their actions on the machine. Within a block the order is: modal codes,
tool, spindle and coolant, dwell, motion, stop.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.model import EventKind
from pkm_post.reading.siemens import codes
from pkm_post.reading.siemens.blocks import Block, Call
from pkm_post.reading.siemens.buffer import ABSOLUTE, RELATIVE
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.drilling import CYCLES, PATTERNS, drill, holes
from pkm_post.reading.siemens.frames import FRAMES, LENGTHS, frame_of
from pkm_post.reading.siemens.machine import SiemensMachine
from pkm_post.reading.siemens.modal_codes import (
    BUFFERED,
    DWELL_G,
    NAMES,
    PLACES,
    STOPS,
    g_code,
    m_code,
    name_alone,
    tool_offset,
    words,
)
from pkm_post.reading.siemens.one_hole import check_tapping
from pkm_post.reading.siemens.scan import LARGEST, PLAIN
from pkm_post.reading.siemens.state import BY_POINT, LINE, NO_MOTION, RAPID, TANGENT
from pkm_post.reading.siemens.swivel import resets, swivel

_MOTION_NAMES = {"CIP": BY_POINT, "CT": TANGENT}
_MODES = {"AC": ABSOLUTE, "DC": ABSOLUTE, "ACP": ABSOLUTE, "ACN": ABSOLUTE, "IC": RELATIVE}
_MOTION_G = range(4)
_SUPA = "SUPA"


def run_lines(machine: SiemensMachine, first: int, stop: int) -> None:
    """Execute the plain lines of a range of rows."""
    if machine.modal_call is None:
        machine.path.buffer.add_lines(first, stop)
        return
    for row in (first + np.flatnonzero(machine.lines.kind[first:stop] == PLAIN)).tolist():
        machine.path.buffer.add_lines(row, row + 1)
        words = machine.lines.words
        _call_modal(machine, row, any(name in words and not np.isnan(words[name][row]) for name in PLACES))


def carry_out(machine: SiemensMachine, block: Block) -> None:
    """Execute a block.

    Raises:
        BlockFault: it is not supported.
    """
    for name, value in block.words.items():
        if not isinstance(value, str) and abs(value) > LARGEST:
            raise BlockFault("G406", f"{name}{value:g}", block.columns[name])
    if _is_plain(machine, block):
        _add_motion(machine, block)
    else:
        machine.path.flush()
        statement = next((call for call in block.names if call.name in _STATEMENTS), None)
        if statement is not None:
            _refuse_others(block, statement)
            _STATEMENTS[statement.name](machine, block, statement)
            return
        _general(machine, block)
    _call_modal(machine, block.row, any(name in block.words for name in PLACES) and DWELL_G not in block.g)


def _refuse_others(block: Block, statement: Call) -> None:
    """Refuse other items in blocks of frames, cycles and the like, except words of frames and the cycle of MCALL."""
    names = len(block.names) > (2 if statement.name == "MCALL" else 1)
    if names or block.g or block.m or (block.words and statement.name not in FRAMES):
        raise BlockFault("G601", f"{statement.name} beside other words", statement.column)


def _is_plain(machine: SiemensMachine, block: Block) -> bool:
    """Whether a block has only words of a move, which go to the buffer."""
    return (
        not block.m
        and block.words.keys() <= BUFFERED
        and all(code in _MOTION_G for code in block.g)
        and all(call.name in _MOTION_NAMES for call in block.names)
    )


def _add_motion(machine: SiemensMachine, block: Block) -> None:
    motions = [code for code in block.g if code in _MOTION_G]
    motions += [_MOTION_NAMES[call.name] for call in block.names if call.name in _MOTION_NAMES]
    if len(motions) > 1:
        raise BlockFault("G403", "two motions")
    words = {name: block.number(name) for name in block.words if name in BUFFERED}
    modes = {name: _MODES[mode] for name, mode in block.modes.items()}
    machine.path.buffer.add_block(block.row, motions[0] if motions else NO_MOTION, words, modes)


def _call_modal(machine: SiemensMachine, row: int, has_place: bool) -> None:
    """Execute the cycle of MCALL after a block with motion."""
    if machine.modal_call is not None and has_place:
        machine.state.exact_path = True
        machine.path.flush()
        drill(machine, row, machine.modal_call)


def _check_groups(block: Block) -> None:
    """Refuse two codes that exclude each other."""
    for letter, given, groups in (("G", block.g, codes.G_GROUPS), ("M", block.m, codes.M_GROUPS)):
        for group in groups:
            here = [f"{letter}{code}" for code in dict.fromkeys(given) if code in group]
            if len(here) > 1:
                raise BlockFault("G403", " ".join(here), block.columns[here[1]])


def _general(machine: SiemensMachine, block: Block) -> None:
    _check_groups(block)
    is_compensated = bool(machine.state.side)
    once = {_SUPA for code in block.g if code in codes.SUPPRESSED}
    for call in block.names:
        if call.name == _SUPA:
            once.add(_SUPA)
        elif call.name not in _MOTION_NAMES:
            name_alone(machine, block, call)
    for code in block.g:
        if code not in _MOTION_G and code not in codes.SUPPRESSED and code not in (DWELL_G, codes.EXACT_STOP_ONCE):
            g_code(machine, block, code)
    words(machine, block)
    for code in block.m:
        m_code(machine, block, code)
    if "D" in block.words:
        tool_offset(machine, block, is_compensated)
    if DWELL_G in block.g:
        _dwell_block(machine, block)
    elif once:
        _in_machine(machine, block)
    else:
        _motion(machine, block)
    for code in block.m:
        if code in STOPS:
            machine.path.add_event(EventKind.STOP, STOPS[code])


def _motion(machine: SiemensMachine, block: Block) -> None:
    moves = block.words.keys() & BUFFERED
    if not (moves or any(code in _MOTION_G for code in block.g) or any(c.name in _MOTION_NAMES for c in block.names)):
        return
    feed = machine.state.feed
    if "FB" in block.words:
        if "F" in block.words:
            raise BlockFault("G403", "F with FB", block.columns["F"])
        block.words["F"] = block.number("FB")
    _add_motion(machine, block)
    if codes.EXACT_STOP_ONCE in block.g or "FB" in block.words:
        machine.path.flush(stops=codes.EXACT_STOP_ONCE in block.g)
    if "FB" in block.words:
        machine.state.feed = feed


def _dwell_block(machine: SiemensMachine, block: Block) -> None:
    """G4 F in seconds, or G4 S in turns of the spindle, in a block of its own [SiemensNC, G4]."""
    beside = [name for name in block.words if name in BUFFERED and name != "F"]
    if beside:
        raise BlockFault("G407", f"{beside[0]} beside G4", block.columns.get(beside[0], 0))
    if {"F", "S"} <= block.words.keys():
        raise BlockFault("G404", "S beside F of G4", block.columns.get("S", 0))
    if "F" in block.words:
        machine.dwell(block.row, block.number("F"))
    elif "S" in block.words:
        machine.dwell(block.row, machine.seconds_of_turns(block.number("S")))
    else:
        raise BlockFault("G405", "G4 without F or S")


def _in_machine(machine: SiemensMachine, block: Block) -> None:
    """SUPA, G53 and G153: words are machine coordinates, only in this block."""
    words = {name: block.number(name) for name in block.words if name in PLACES}
    zero, state = machine.options.machine_zero, machine.state
    unread = [name for name in block.words if name in (*BUFFERED, "FB") and name not in (*PLACES, "F")]
    unused = [name for name in unread if block.number(name) or state.is_tilted()]  # zero leaves an upright tool upright
    if unused:
        raise BlockFault("G404", f"{unused[0]} beside SUPA, G53 or G153", block.columns.get(unused[0], 0))
    if words and zero is None:
        raise BlockFault("G609", "SUPA, G53 or G153")
    for code in block.g:
        state.motion = code if code in _MOTION_G else state.motion
    if "F" in block.words:
        state.feed = block.number("F")
    if not words or zero is None:
        return
    if state.motion not in (RAPID, LINE):
        raise BlockFault("G439", "SUPA, G53 or G153 without G0 or G1 in force")
    target, known = state.frame.points(state.position).copy(), state.known.copy()
    mixed = state.frame.mixed()
    if mixed.any() and not known[mixed].all() and len(words) < len(PLACES):
        raise BlockFault("G416", "a turned coordinate system")
    for name, value in words.items():
        k = PLACES.index(name)
        relative = block.modes.get(name) == "IC" or (state.relative and name not in block.modes)
        target[k] = value * state.scale + (target[k] if relative else zero[k])
        known[k] |= not relative
    if known.all():
        machine.path.straight(block.row, state.frame.to_program(target), stops=codes.EXACT_STOP_ONCE in block.g)
    state.position, state.known = state.frame.to_program(target), known


def _frame(machine: SiemensMachine, block: Block, call: Call) -> None:
    state = machine.state
    if state.side:
        raise BlockFault("G419", call.name, call.column)
    scale = state.scale if call.name in LENGTHS else 1.0
    words = {name: block.number(name) * (scale if name in PLACES else 1.0) for name in block.words}
    state.set_frames(state.offset, state.swivel, frame_of(call.name, words, state.plane, state.programmed))
    if call.name in ("ROT", "AROT") and len(words) > 1:
        machine.notes.add("ROT about several axes: Z first, then the new Y, then the new X", block.row)


def _drill(machine: SiemensMachine, block: Block, call: Call) -> None:
    drill(machine, block.row, call)


def _holes(machine: SiemensMachine, block: Block, call: Call) -> None:
    holes(machine, block.row, call)


def _modal(machine: SiemensMachine, block: Block, call: Call) -> None:
    """MCALL without a cycle ends the modal call."""
    others = [other for other in block.names if other is not call]
    for other in others:
        if other.name in codes.TAPPING:
            raise BlockFault("G425", other.name, other.column)
        check_tapping(machine, other)
        if other.name not in CYCLES:
            raise BlockFault("G602", f"MCALL {other.name}: {', '.join(CYCLES)} are read", other.column)
    machine.path.flush()
    machine.modal_call = others[0] if others else None


def _swivel(machine: SiemensMachine, block: Block, call: Call) -> None:
    if machine.state.side:
        raise BlockFault("G419", call.name, call.column)
    if machine.state.traori and not (resets(call) and not machine.state.swivelled):
        raise BlockFault("G602", "CYCLE800 after TRAORI: write TRAFOOF first", call.column)
    if swivel(machine.state, call):
        machine.faults.add(block.row, "G610", call.name, call.column)


def _high_speed(machine: SiemensMachine, block: Block, call: Call) -> None:
    """CYCLE832(tolerance, machining, tolerance of the axis); machining 0 ends it [SiemensNC, CYCLE832]."""
    on = call.number(1, 0.0) % 10 != 0 and call.gives(0)
    machine.state.high_speed = on
    machine.state.contour_tolerance = call.number(0, 0.0) * machine.state.scale if on else 0.0
    if on and call.number(0) <= 0:
        raise BlockFault("G606", f"CYCLE832 with a tolerance of {call.number(0):g}", call.column)


_STATEMENTS: dict[str, Callable[[SiemensMachine, Block, Call], None]] = {
    "MCALL": _modal,
    **dict.fromkeys(FRAMES, _frame),
    **dict.fromkeys(CYCLES, _drill),
    **dict.fromkeys(PATTERNS, _holes),
    "CYCLE800": _swivel,
    "CYCLE832": _high_speed,
}
"""Names of statements that need a separate block."""
BUILT_IN = frozenset(
    {*_STATEMENTS, *_MOTION_NAMES, _SUPA, *NAMES, *codes.NOTED, *codes.SILENT, *codes.REFUSED, *codes.TAPPING}
)
"""Names of the language, which subprograms cannot have."""
