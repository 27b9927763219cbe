# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings: wiring and communication of one machine's Turbo PMAC, and the set-up file made of them.

Input: the ``[controller]`` table of the machine file, and the stroke of the struts in mm. Output: settings with the
memory of the controller; and ASCII text of on-line commands that make axis values true strut lengths. The controls
engineer loads them once; they are separate from the programs, as a part program must not redefine the machine.
Positions are in encoder counts from motor zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal

from pkm_post.model import Diagnostics, Machine
from pkm_post.writing.controllers.pvt import settings as pvt
from pkm_post.writing.controllers.pvt.decimals import plain
from pkm_post.writing.controllers.pvt.settings import ROTARY_LETTERS, axis_definitions, check_stroke, stroke_counts
from pkm_post.writing.controllers.pvt.writer import comment_lines


@dataclass(frozen=True, kw_only=True)
class PmacSettings(pvt.PvtSettings):
    """Settings of the Turbo PMAC of one machine; it stores about 10 significant digits of a number.

    Attributes:
        memory_words: 48-bit words of controller memory free for the program.
    """

    KIND = "turbo_pmac"

    memory_words: int

    @property
    def time_base(self) -> int:
        """Address of the override that ``%`` sets, the default of Isx93 [TurboPMAC, Isx93]."""
        return 0x2000 + 0x100 * (self.coordinate_system - 1)


def settings_of(machine: Machine) -> tuple[PmacSettings | None, Diagnostics]:
    """Settings of a machine's controller, or None with diagnostics."""
    return pvt.settings_of(PmacSettings, machine)


def setup_text(settings: PmacSettings, machine_name: str, stroke: tuple[float, float]) -> str:
    """Write the set-up file of a machine with a stroke in mm.

        counts = counts_per_mm * (strut length - zero_length)

    Raises:
        ValueError: the stroke is not two increasing lengths.
    """
    check_stroke(stroke)
    # All lines with & and # come before the first assignment: some tools that read such files continue an expression
    # into a following line that begins with one of these.
    lines = [
        *comment_lines(f"Set-up of {machine_name}", settings.line_limit),
        "; Strut i is motor i. Axis values are joint-to-joint strut lengths in mm, speeds are in mm/s.",
        "CLOSE ; no program buffer may be open",
        *_axis_lines(settings),
        *_coordinate_system_lines(settings),
        *soft_limit_lines(settings, stroke),
        *_spindle_limits(settings),
        *_rollover_lines(settings),
    ]
    return "\n".join(lines) + "\n"


def _axis_lines(settings: PmacSettings) -> list[str]:
    return [
        f"&{settings.coordinate_system} ; the coordinate system that runs the program",
        "; #motor->SCALE LETTER OFFSET: counts = SCALE * strut length + OFFSET; the offset is counts at length zero",
        *axis_definitions(settings),
        *_spindle_definition(settings),
    ]


def _spindle_definition(settings: PmacSettings) -> list[str]:
    """The axis of the spindle, in turns; no offset, since the code that makes it an axis zeroes it."""
    axis = settings.spindle_axis
    if axis is None:
        return []
    return [
        "; The spindle, in turns: positive clockwise, seen from the spindle",
        f"#{axis.motor}->{plain(axis.counts_per_turn)}{axis.letter}",
    ]


def _coordinate_system_lines(settings: PmacSettings) -> list[str]:
    base = f"I{50 + settings.coordinate_system}"
    return [
        f"; I68 must be {settings.coordinate_system - 1} or more, or this coordinate system is not served",
        "; I42 may be 0 or 1: all intervals of the program are whole milliseconds",
        f"{base}90=1000 ; speeds are per 1000 ms, so mm/s",
        f"{base}50=0 ; no kinematics in the controller: the program gives strut lengths",
        f"{base}92=0 ; moves follow one another without a stop",
        f"{base}93=${settings.time_base:X} ; the time base is the override that % sets",
    ]


def soft_limit_lines(settings: PmacSettings, stroke: tuple[float, float]) -> list[str]:
    """The lines of the soft limits of all motors; the stroke in mm."""
    lines = ["; Soft limits: the stroke in counts. 0 would switch a limit off, so 1 or -1 stands for it"]
    for motor, (low, high) in enumerate(stroke_counts(settings, stroke), start=1):
        lines.append(f"I{motor}13={_limit(high, math.floor, 1)} ; strut {motor}, highest count")
        lines.append(f"I{motor}14={_limit(low, math.ceil, -1)} ; strut {motor}, lowest count")
    return lines


def _spindle_limits(settings: PmacSettings) -> list[str]:
    axis = settings.spindle_axis
    return [] if axis is None else [f"I{axis.motor}{end}=0 ; the spindle turns without end" for end in (13, 14)]


def _rollover_lines(settings: PmacSettings) -> list[str]:
    axis = settings.spindle_axis
    motors = [*enumerate(settings.letters, start=1), *([] if axis is None else [(axis.motor, axis.letter)])]
    return [
        f"I{motor}27=0 ; {letter} would be a rotary axis: no rollover, it is a length here"
        if motor <= len(settings.letters)
        else f"I{motor}27=0 ; {letter} would be a rotary axis: no rollover, it counts turns here"
        for motor, letter in motors
        if letter in ROTARY_LETTERS
    ]


def _limit(counts: Decimal, inward: Callable[[Decimal], int], instead_of_zero: int) -> int:
    return inward(counts) or instead_of_zero
