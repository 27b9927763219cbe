# SPDX-License-Identifier: LGPL-2.1-or-later
"""System variables: the tool position and the modal codes after the blocks executed so far.

Input: the executed blocks. Output: values of the variables that a program can read, in the program's units: #5420 to
#5422 of LinuxCNC, #5001 to #5043 and #4001 to #4130 of Fanuc controls. The blocks are resolved by the same functions as
after execution. A value that is unknown, or follows a faulty block, cannot be read.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pkm_post.model import Array
from pkm_post.reading.gcode.adapt import adapted
from pkm_post.reading.gcode.blocks import Blocks
from pkm_post.reading.gcode.checks import check
from pkm_post.reading.gcode.codes import FURTHER_OFFSET, NONE, Group
from pkm_post.reading.gcode.diagnostics import BlockDiagnostics
from pkm_post.reading.gcode.events import dwell_words
from pkm_post.reading.gcode.flavours import flavour_on_machine
from pkm_post.reading.gcode.modal import Modal, modal_state
from pkm_post.reading.gcode.options import ReadOptions
from pkm_post.reading.gcode.parameters import ExecutionFault
from pkm_post.reading.gcode.position_tracker import PositionTracker
from pkm_post.reading.gcode.resolve import block_states
from pkm_post.reading.gcode.scaling import SCALING

_GROUPS = {
    4001: Group.MOTION,
    4002: Group.PLANE,
    4003: Group.DISTANCE,
    4005: Group.FEED_MODE,
    4006: Group.UNIT,
    4007: Group.SIDE,
    4008: Group.LENGTH,
    4010: Group.RETRACT,
    4014: Group.SYSTEM,
}
"""Variables with the codes of the previous block [Fanuc, custom macro, modal information]."""
_WORDS = {4107: "D", 4109: "F", 4111: "H", 4119: "S", 4120: "T"}
"""Variables with the last words."""
_OFFSET_INCLUDED = 5021
"""From this number on, coordinates refer to the spindle nose while an offset is active."""
_NO_OFFSETS = {Group.LENGTH: 490, Group.SIDE: 400}


@dataclass(frozen=True)
class _State:
    """The machine after some blocks.

    Attributes:
        position: (3,) coordinates of the tool in the program, mm.
        known: (3,) which of them are known; none under G68, G68.2, G51 and G51.1, where controls may count others.
        work: (3,) the place in {C}, mm.
        has_work: whether it is known.
        modal: codes of the blocks.
    """

    position: Array
    known: Array
    work: Array
    has_work: bool
    modal: Modal


@dataclass(frozen=True)
class ExecutedBlocks:
    """The blocks executed so far, and their read options."""

    blocks: Blocks
    options: ReadOptions

    def coordinate(self, axis: int, number: int) -> float:
        """A coordinate of the tool in the work frame of the program.

        Raises:
            ExecutionFault: the coordinate is unknown.
        """
        state = self._state_for(number)
        if not state.known[axis] or (number in range(_OFFSET_INCLUDED, 5100) and self._has_offsets(state.modal)):
            raise ExecutionFault("G303", f"#{number}: the place of the tool")
        return float(state.position[axis]) / self._unit(state.modal)

    def machine_coordinate(self, axis: int, number: int) -> float:
        """A coordinate of the tool from the zero of the machine.

        Raises:
            ExecutionFault: the coordinate is unknown.
        """
        state, zero = self._state_for(number), self.options.machine_zero
        if zero is None or not state.has_work or self._has_offsets(state.modal):
            raise ExecutionFault("G303", f"#{number}: the place of the tool on the machine")
        return float(state.work[axis] - zero[axis]) / self._unit(state.modal)

    def code(self, number: int) -> float:
        """The code of a group, or the last word of a letter.

        Raises:
            ExecutionFault: there is none.
        """
        modal = self._state_for(number).modal
        if number in _GROUPS:
            code = int(_last(modal.active[_GROUPS[number]]))
            if code > FURTHER_OFFSET:
                return code / 10
        words = self.blocks.word(_WORDS.get(number, ""))
        given = words[~np.isnan(words)]
        if not len(given):
            raise ExecutionFault("G303", f"#{number}")
        return float(given[-1])

    def _unit(self, modal: Modal) -> float:
        return float(_last(modal.scale))

    def _has_offsets(self, modal: Modal) -> bool:
        return any(_last(modal.active[group]) != code for group, code in _NO_OFFSETS.items())

    def _state_for(self, number: int) -> _State:
        if not len(self.blocks):
            raise ExecutionFault("G303", f"#{number}, before the first block")
        return self._state

    @cached_property
    def _state(self) -> _State:
        options = self.options
        flavour = flavour_on_machine(options)
        blocks, _ = adapted(self.blocks, flavour, options.left_out, options.unit)
        faults = BlockDiagnostics(blocks)
        modal = modal_state(blocks, options, flavour)
        check(blocks, modal, options, faults)
        if faults.has_errors():
            return _State(np.zeros(3), np.zeros(3, np.bool_), np.zeros(3), False, modal)
        states = block_states(blocks, modal, options, faults)
        dwells = dwell_words(blocks, modal, options)
        tracker = PositionTracker(blocks, modal, states.tools, states.spindle, dwells, states.lost, options, faults)
        tracker.motions()
        frame, scalings = tracker.frame, modal.programmed[Group.SCALING]
        is_scaled = bool((scalings[scalings != NONE][-1:] == SCALING).any())
        is_placed = not (is_scaled or frame.is_tilted or faults.has_errors())
        return _State(
            position=tracker.position,
            known=tracker.known & (is_placed and not frame.is_turned),
            work=frame.to_work(tracker.position),
            has_work=is_placed and bool(tracker.known.all()),
            modal=modal,
        )


def _last(column: Array) -> Array:
    return column[-1]
