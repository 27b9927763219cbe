# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modal codes: effects of G and M codes, words and names.

Input: codes and words of a block. Output: the state of the machine, and events of tool, spindle and coolant.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pkm_post.model import EventKind
from pkm_post.reading.gcode.tools import leaning_side
from pkm_post.reading.siemens import codes
from pkm_post.reading.siemens.blocks import Block, Call
from pkm_post.reading.siemens.diagnostics import BlockFault
from pkm_post.reading.siemens.frames import ProgrammableFrame, about
from pkm_post.reading.siemens.machine import SiemensMachine
from pkm_post.reading.siemens.scan import PLAIN_WORDS

BUFFERED = frozenset({*PLAIN_WORDS, "A2", "B2", "C2", "I1", "J1", "K1", "AR", "TURN"})
"""Words of moves."""
PLACES = ("X", "Y", "Z")
DWELL_G = 4
STOPS = {0: 0.0, 1: 1.0}
ENDS, RETURNS = (2, 30), 17
_COOLANT = {7: 2.0, 8: 1.0, 9: 0.0}
_SPINDLE = {3: 1.0, 4: -1.0, 5: 0.0}
ORIENTED_STOP = 19
"""M19 stops the spindle at an angle, if the machine file has it."""
_METRIC_ISO = 21


def words(machine: SiemensMachine, block: Block) -> None:
    """Execute the words of a block that are not part of a move; refuse unknown ones.

    Raises:
        BlockFault: a word is unknown or its value invalid.
    """
    for name in block.words:
        if name in codes.REFUSED:
            raise BlockFault("G602", f"{name}=: {codes.REFUSED[name]}", block.columns[name])
        if name in codes.NOTED:
            machine.notes.add(f"{name}: {codes.NOTED[name]}", block.row)
        elif name == "H":
            machine.notes.add("H: a function of the machine", block.row)
        elif name in _WORDS:
            _WORDS[name](machine, block)
        elif name not in BUFFERED and name not in ("D", "FB"):
            raise BlockFault("G404", name, block.columns[name])


def _contour_tolerance(machine: SiemensMachine, block: Block) -> None:
    """CTOL= in the active unit; a negative value restores that of the machine [SiemensNC, CTOL]."""
    machine.state.contour_tolerance = max(block.number("CTOL"), 0.0) * machine.state.scale


def _speed(machine: SiemensMachine, block: Block) -> None:
    if DWELL_G in block.g:
        return
    if block.number("S") < 0:
        raise BlockFault("G406", f"S{block.number('S'):g}", block.columns["S"])
    before = machine.state.spindle()
    machine.state.speed = block.number("S")
    if machine.state.spindle() != before and not any(code in _SPINDLE for code in block.m):
        machine.path.add_event(EventKind.SPINDLE, machine.state.spindle())


def _tool(machine: SiemensMachine, block: Block) -> None:
    machine.state.selected = machine.tools.number(block.words["T"])
    if not machine.tools.has_change:
        _change_tool(machine)


def tool_offset(machine: SiemensMachine, block: Block, is_compensated: bool) -> None:
    """D0 cancels the tool offset, any other D activates it.

    ``is_compensated`` is whether cutter compensation was on before the block, as it is not in ``G41 D1``.

    Raises:
        BlockFault: D is not the number of a cutting edge.
    """
    value = block.number("D")
    if value < 0 or value != round(value):
        raise BlockFault("G406", f"D{value:g}", block.columns["D"])
    if is_compensated:
        raise BlockFault("G419", f"D{value:g}", block.columns["D"])
    machine.state.has_offset = value > 0


def _change_tool(machine: SiemensMachine) -> None:
    number = machine.state.selected
    if number is None:
        raise BlockFault("G405", "M6 without T")
    if machine.tools.tool(number) is None:
        raise BlockFault("G411", f"T{number}")
    machine.state.tool = number
    machine.state.has_offset = True
    machine.state.sense = 0.0  # a tool change leaves the spindle stopped until M3 or M4 [NGC 3.6.3]
    machine.path.add_event(EventKind.TOOL_CHANGE, float(number))


def m_code(machine: SiemensMachine, block: Block, code: int) -> None:
    """Execute an M code.

    Raises:
        BlockFault: it is unknown, or lacks a word.
    """
    if code == 6:  # noqa: PLR2004 - M6
        _change_tool(machine)
    elif code in _SPINDLE:
        if _SPINDLE[code] and np.isnan(machine.state.speed):
            raise BlockFault("G405", f"M{code} without S", block.columns[f"M{code}"])
        machine.state.sense = _SPINDLE[code]
        machine.path.add_event(EventKind.SPINDLE, machine.state.spindle())
    elif code in _COOLANT:
        machine.state.coolant = _COOLANT[code]
        machine.path.add_event(EventKind.COOLANT, _COOLANT[code])
    elif code in machine.options.functions:
        if block.words.keys() & BUFFERED:
            raise BlockFault("G437", f"M{code}", block.columns.get(f"M{code}", 0))
        if code == ORIENTED_STOP:
            machine.state.sense = 0.0
            machine.path.add_event(EventKind.SPINDLE, 0.0)
        machine.path.add_event(EventKind.FUNCTION, float(code))
    elif code not in (*STOPS, *ENDS, RETURNS, *codes.SILENT_M):
        _leave_out(machine, block, f"M{code}", codes.REFUSED.get(f"M{code}"))


def _leave_out(machine: SiemensMachine, block: Block, word: str, why: str | None) -> None:
    """Skip a code that the user has named, or refuse it."""
    column = block.columns.get(word, 0)
    if why is not None:
        raise BlockFault("G602", f"{word}: {why}", column)
    if word not in machine.options.left_out or any(name in block.words for name in PLACES if word[0] == "G"):
        raise BlockFault("G401", word, column)
    machine.notes.add(f"{word}, left out as chosen", block.row)


def g_code(machine: SiemensMachine, block: Block, code: int) -> None:
    """Activate a G code.

    Raises:
        BlockFault: it is unknown, or not allowed here.
    """
    state = machine.state
    if code in codes.PLANES:
        _refuse_with_compensation(machine, block, code)
        state.plane = codes.PLANES[code]
    elif code in codes.SIDES:
        _compensate(machine, block, code)
    elif code in (90, 91):
        state.relative = code == 91  # noqa: PLR2004 - G91
    elif code in codes.UNITS:
        state.set_unit(*codes.UNITS[code])
    elif code in codes.FEED_MODES:
        if code != state.feed_mode:
            state.feed_mode, state.feed = code, np.nan
    elif code in codes.WORK_OFFSETS:
        _refuse_with_compensation(machine, block, code)
        _work_offset(machine, block, code)
    elif code == codes.EXACT_STOP:
        state.stops = True
    elif code in codes.CONTINUOUS:
        state.stops, state.smoothing = False, code
    elif code == _METRIC_ISO and state.scale != 1:
        raise BlockFault("G401", "G21 where inches are in force", block.columns["G21"])
    elif code in codes.NOTED_G:
        machine.notes.add(f"G{code}: {codes.NOTED_G[code]}", block.row)
    elif code in codes.TAPPING_G:
        raise BlockFault("G425", f"G{code}", block.columns[f"G{code}"])
    else:
        _leave_out(machine, block, f"G{code}", codes.REFUSED_G.get(code))


def _refuse_with_compensation(machine: SiemensMachine, block: Block, code: int) -> None:
    if machine.state.side:
        raise BlockFault("G419", f"G{code}", block.columns[f"G{code}"])


def _compensate(machine: SiemensMachine, block: Block, code: int) -> None:
    state = machine.state
    state.side = codes.SIDES[code]
    if not state.side:
        machine.path.radius = 0.0  # an uncompensated tool may have an unknown diameter
        return
    tool = machine.tools.tool(state.tool)
    if tool is None:
        raise BlockFault("G411", "no tool in the spindle")
    if tool.side_angle:
        raise BlockFault("G411", leaning_side(tool))
    machine.path.radius = tool.diameter / 2


def _work_offset(machine: SiemensMachine, _: Block, code: int) -> None:
    """Activate a settable offset; without known offsets, the only one with motion in a program is {C} itself.

    An unknown offset is a fault only if the program moves in it, since many programs end with G500.
    """
    state, places = machine.state, machine.options.work_offsets
    if places and f"G{code}" not in places:
        state.unplaced = f"G{code}"
        return
    if places:
        x, y, z, degrees = places[f"G{code}"]
        turn = about(2, degrees)
        state.set_frames(ProgrammableFrame(turn, np.array([x, y, z]), turn), state.swivel, state.programmed)
    elif not state.has_moved or state.system is None:
        state.system = code
    state.unplaced = "" if places or code == state.system else f"G{code} after G{state.system}"


def name_alone(machine: SiemensMachine, block: Block, call: Call) -> None:
    """Activate a name, or note that it has no effect.

    Raises:
        BlockFault: it is unknown or unsupported.
    """
    state, name = machine.state, call.name
    if name in NAMES:
        NAMES[name](machine, block, call)
    elif name in codes.NOTED:
        state.compressor |= name.startswith("COMP")
        machine.notes.add(f"{name}: {codes.NOTED[name]}", block.row)
    elif name in codes.SILENT:
        state.compressor &= name != "COMPOF"
    elif name in codes.TAPPING:
        raise BlockFault("G425", name, call.column)
    elif name in codes.REFUSED:
        raise BlockFault("G602", f"{name}: {codes.REFUSED[name]}", call.column)
    else:
        raise BlockFault("G603", name, call.column)


def _traori(machine: SiemensMachine, block: Block, call: Call) -> None:
    """The first transformation; with a tilted tool the tip position is known only after X, Y and Z."""
    if machine.state.swivelled:
        raise BlockFault("G602", "TRAORI after CYCLE800: write CYCLE800() first", call.column)
    if call.number(0, 1.0) != 1:
        raise BlockFault("G602", f"TRAORI({call.number(0, 1.0):g}): only the first transformation is read", call.column)
    machine.state.traori = True


def _trafoof(machine: SiemensMachine, block: Block, call: Call) -> None:
    machine.state.traori = False


def _angles(machine: SiemensMachine, block: Block, call: Call) -> None:
    machine.state.angles = call.name


def _reference(machine: SiemensMachine, block: Block, call: Call) -> None:
    """ORIWKS and ORIMKS: the frame of the tool axis and of its interpolation."""
    machine.state.in_machine_frame = call.name == "ORIMKS"
    machine.notes.add(f"{call.name}: {codes.NOTED[call.name]}", block.row)


_WORDS: dict[str, Callable[[SiemensMachine, Block], None]] = {
    "CTOL": _contour_tolerance,
    "S": _speed,
    "T": _tool,
}
NAMES: dict[str, Callable[[SiemensMachine, Block, Call], None]] = {
    "TRAORI": _traori,
    "TRAFOOF": _trafoof,
    "ORIEULER": _angles,
    "ORIRPY": _angles,
    "ORIWKS": _reference,
    "ORIMKS": _reference,
}
"""Names that activate a mode."""
