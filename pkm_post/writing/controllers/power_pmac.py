# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power PMAC: motion programs written and read back, and the set-up they rely on.

Input: the ``[controller]`` table of a machine, strut motion in mm, mm/s and whole ms, and the text of programs.
Output: text with the words and the frame of the Power PMAC, and strut motion. The memory for programs is configured in
the controller's own project: the machine file does not state it, and a motion is never cut into parts. The grammar is
independent of the writer, so that the reader detects a fault of the writer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from pkm_post.model import Diagnostics, Machine, StrutMotion
from pkm_post.system import result_files
from pkm_post.writing.controllers.pvt import reader, writer
from pkm_post.writing.controllers.pvt import settings as pvt
from pkm_post.writing.controllers.pvt.codes import event_faults
from pkm_post.writing.controllers.pvt.decimals import plain
from pkm_post.writing.controllers.pvt.parts import stated_part as stated_part
from pkm_post.writing.controllers.pvt.settings import (
    APPROACH_RAMP_MS,
    ROTARY_LETTERS,
    axis_definitions,
    check_stroke,
    stroke_counts,
)
from pkm_post.writing.controllers.pvt.syntax import (
    FLOW_FROM_MODES,
    PRINTABLE,
    START,
    Flow,
    ProgramGrammar,
    body_forms,
    line_form,
)
from pkm_post.writing.controllers.pvt.writer import Keywords, comment_lines

SETUP_SUFFIX = result_files.SETUPS["power_pmac"]


@dataclass(frozen=True, kw_only=True)
class PowerPmacSettings(pvt.PvtSettings):
    """Settings of the Power PMAC of one machine; it stores numbers as doubles."""

    KIND = "power_pmac"


def settings_of(machine: Machine) -> tuple[PowerPmacSettings | None, Diagnostics]:
    """Settings of a machine's controller, or None with diagnostics."""
    return pvt.settings_of(PowerPmacSettings, machine)


def faults(motion: StrutMotion, settings: PowerPmacSettings, file: str) -> Diagnostics:
    """The reasons why a motion cannot be written for this controller; ``file`` is the name of the job."""
    return event_faults(motion, settings.codes, file)


KEYWORDS = Keywords(comment="//", linear="linear", dwell="dwell", interval="pvt", close="close")


def program_text(motion: StrutMotion, settings: PowerPmacSettings, heading: Sequence[str]) -> str:
    """Write a motion as a motion program; as ``pvt.writer.program_text``."""
    return writer.program_text(motion, settings, KEYWORDS, _opening(settings), heading)


def program_parts(motion: StrutMotion, settings: PowerPmacSettings, heading: Sequence[str]) -> tuple[str, ...]:
    """Write a motion, always as one part."""
    return (program_text(motion, settings, heading),)


def buffer_opening(settings: PowerPmacSettings) -> str:
    """The line that opens and clears the program: everything before its modes and moves."""
    return f"open prog {settings.program}\n"


def _opening(settings: PowerPmacSettings) -> str:
    speed = plain(settings.approach_speed)
    return (
        f"{buffer_opening(settings)}abs\nfrax({','.join(settings.letters)})\n"
        f"linear\nta{APPROACH_RAMP_MS} ts0 F{speed}\n"
    )


_FLOW: Flow = {START: {"comment": START, "open": "cleared"}, **FLOW_FROM_MODES}
"""Opening a program clears it."""


def _grammar(settings: PowerPmacSettings) -> ProgramGrammar:
    """The grammar of the programs of a Power PMAC."""
    forms = {
        "comment": line_form("a comment", "//", PRINTABLE),
        "open": line_form(f"open prog {settings.program}", "open prog ", str(settings.program)),
        **body_forms(settings, str.lower),
    }
    return ProgramGrammar(forms, _FLOW, (APPROACH_RAMP_MS, 0, settings.approach_speed))


_COMMENT = "//"
_LIMIT_DECIMALS = 4
"""Decimals of a soft limit in mm, at least."""


def setup_text(settings: PowerPmacSettings, machine_name: str, stroke: tuple[float, float]) -> str:
    """Write the set-up file of a machine with a stroke in mm.

        motor units = counts_per_mm * (strut length - zero_length)

    Raises:
        ValueError: the stroke is not two increasing lengths.
    """
    check_stroke(stroke)
    lines = [
        *comment_lines(f"Set-up of {machine_name}", settings.line_limit, _COMMENT),
        "// Strut i is motor i. Axis values are joint-to-joint strut lengths in mm, speeds are in mm/s.",
        f"&{settings.coordinate_system} // the coordinate system that runs the program",
        "// #motor->SCALE LETTER OFFSET: motor units = SCALE * strut length + OFFSET",
        *axis_definitions(settings),
        *_coordinate_system_lines(settings),
        *soft_limit_lines(settings, stroke),
    ]
    return "\n".join(lines) + "\n"


def _coordinate_system_lines(settings: PowerPmacSettings) -> list[str]:
    system = f"Coord[{settings.coordinate_system}]"
    rollover = [
        f"{system}.PosRollover[{ROTARY_LETTERS.index(letter)}]=0 // {letter} is a length here, not an angle"
        for letter in settings.letters
        if letter in ROTARY_LETTERS
    ]
    return [
        f"{system}.FeedTime=1000 // speeds are per 1000 ms, so mm/s",
        f"{system}.SegMoveTime=0 // no segmentation: each interval is one cubic",
        f"{system}.NoBlend=0 // moves follow one another without a stop",
        f"{system}.pDesTimeBase={system}.DesTimeBase.a // the time base is the override that % sets",
        *rollover,
    ]


def soft_limit_lines(settings: PowerPmacSettings, stroke: tuple[float, float]) -> list[str]:
    """The lines of the soft limits of all motors; the stroke in mm.

    A motor unit may be a count, a millimetre or a metre, and limits may have decimals. They are cut inward by less than
    1e-4 mm: whole large units could make the higher limit the lower one, which switches both off.
    """
    step = Decimal(1).scaleb(min(0, Decimal(repr(settings.counts_per_mm)).adjusted() - _LIMIT_DECIMALS))
    lines = ["// Soft limits: the stroke in motor units. They act while the higher one is above the lower one"]
    for motor, (low, high) in enumerate(stroke_counts(settings, stroke), start=1):
        most, least = math.floor(high / step) * step, math.ceil(low / step) * step
        lines.append(f"Motor[{motor}].MaxPos={plain(most)} // strut {motor}")
        lines.append(f"Motor[{motor}].MinPos={plain(least)} // strut {motor}")
    return lines


def read_parts(texts: Sequence[tuple[str, str]], settings: PowerPmacSettings) -> tuple[StrutMotion | None, Diagnostics]:
    """Read a motion program; as ``pvt.reader.read_parts``."""
    return reader.read_parts(texts, _grammar(settings), settings)
