# SPDX-License-Identifier: LGPL-2.1-or-later
"""Controller file: axis definitions, limits, look-ahead, variables, and both kinematic programs, in one text.

Input: a machine and settings of the export. Output: ASCII text for the controller, loaded once by the controls
engineer. Axis X Y Z in mm, A B C in degrees, feeds in mm/s. Sources beside those of ``dialects``: Turbo PMAC Software
Reference, Isx13 (p. 177), Isx20 and Isx50 (p. 181); Turbo PMAC User Manual, "Setting Up Lookahead" (p. 310 to 315);
Power PMAC User's Manual, "Lookahead" (p. 790 to 794).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

from pkm_post.model import Machine
from pkm_post.writing.controllers import power_pmac
from pkm_post.writing.controllers.pmac import settings as turbo_settings
from pkm_post.writing.controllers.power_pmac import PowerPmacSettings
from pkm_post.writing.controllers.pvt.decimals import exact, plain
from pkm_post.writing.controllers.pvt.settings import PvtSettings
from pkm_post.writing.controllers.pvt.writer import comment_lines
from pkm_post.writing.kinematics.dialects import POWER, TURBO, KinematicDialect, rendered, run_time_error
from pkm_post.writing.kinematics.programs import forward_program, inverse_program
from pkm_post.writing.kinematics.variables import STRUTS, QVariable, parameters

MOST_STEPS = 9
"""Steps of the forward program; below the default limit of ten jumps back of a Power PMAC (UM p. 517)."""
TOLERANCE = {"turbo_pmac": 1e-6, "power_pmac": 1e-9}
"""mm of strut length where the forward program ends: some tens of roundings of 36-bit and 53-bit numbers."""
_HOME_COMPLETE = {strut: f"Y:${0xC0 + 0x80 * (strut - 1):06X},10,1" for strut in STRUTS}
"""Home-complete bits of motors 1 to 6 [Turbo PMAC User Manual, p. 261, and suggested M-variables Mxx45]."""
_RUN_TIME_ERROR = 0x203F
"""Address of the run-time error bits, 0x100 apart for each coordinate system [suggested M-variables Msx82]."""


@dataclass(frozen=True)
class Export:
    """Settings of an export.

    Attributes:
        segment_time: of the coarse interpolation, whole ms.
        tool_length: initial gauge length, mm.
        home_lengths: counted strut lengths at home with that tool, mm; for controllers that home with them.
        program: name and text of a posted program, for a project with a program instead of the kinematics.
    """

    segment_time: int
    tool_length: float
    home_lengths: tuple[float, ...] = ()
    program: tuple[str, str] | None = None


def parameters_of(machine: Machine, kind: str, export: Export) -> list[QVariable]:
    """The variables that the programs of a machine read, with their initial values."""
    return parameters(machine, export.tool_length, TOLERANCE[kind], MOST_STEPS)


def lookahead_segments(machine: Machine, export: Export) -> int:
    """Segments of the slowest stop, plus a third: Isx20 and LHDistance.

    4/3 v / (2 a T), rounded up [Turbo PMAC Software Reference, Isx20; Power PMAC User's Manual, p. 791].
    """
    stop = machine.strut_speed / machine.strut_acceleration * 1000.0
    return math.ceil(round(4.0 / 3.0 * stop / (2.0 * export.segment_time), 9))


def turbo_text(machine: Machine, settings: turbo_settings.PmacSettings, export: Export) -> str:
    """The file for a Turbo PMAC."""
    system, base = settings.coordinate_system, f"I{50 + settings.coordinate_system}"
    error, segments = run_time_error(system), lookahead_segments(machine, export)
    variables = parameters_of(machine, settings.KIND, export)
    screw = machine.screw_lead != 0.0
    homed = {f"homed{strut}": f"M{strut}45" for strut in STRUTS}
    programs = _programs(variables, TURBO, system, screw, homed)
    lines = [
        *_heading(machine, settings, TURBO),
        "CLOSE ; no program buffer may be open",
        "DELETE GATHER",
        f"&{system} ; the coordinate system of the six struts",
        *(f"#{strut}->I" for strut in STRUTS),
        *(f"{name}->{_HOME_COMPLETE[strut]}" for strut, name in zip(STRUTS, homed.values(), strict=True)),
        f"M{error}->Y:${_RUN_TIME_ERROR + 0x100 * (system - 1):06X},22,1 ; run-time error",
        f"DEFINE LOOKAHEAD {2 * segments},{_OUTPUTS} ; segments, synchronous outputs; not kept over a reset",
        "CLOSE",
        f"{base}50=0 ; kinematics stay off until both programs are there",
        "I15=0 ; angles in degrees: true for all programs of the controller",
        f"{base}90=1000 ; speeds are per 1000 ms, so mm/s",
        f"{base}13={export.segment_time} ; segmentation, ms",
        f"{base}20={segments} ; look-ahead, segments",
        *turbo_settings.soft_limit_lines(settings, machine.strut_stroke),
        *_turbo_rates(machine, settings),
        *_variable_lines(variables, TURBO),
        "CLOSE",
        "OPEN FORWARD",
        "CLEAR",
        *programs[0],
        "CLOSE",
        "OPEN INVERSE",
        "CLEAR",
        *programs[1],
        "CLOSE",
        f"{base}50=1 ; the kinematic programs take effect",
    ]
    return "\n".join(lines) + "\n"


_OUTPUTS = 50
"""Synchronous assignments that the look-ahead buffer holds, as in the example of the User Manual (p. 315)."""


def power_text(machine: Machine, settings: PowerPmacSettings, export: Export) -> str:
    """The file for a Power PMAC."""
    system = settings.coordinate_system
    segments = lookahead_segments(machine, export)
    variables = parameters_of(machine, settings.KIND, export)
    screw = machine.screw_lead != 0.0
    homed = {"homed": f"Coord[{system}].HomeComplete"}
    programs = _programs(variables, POWER, system, screw, homed)
    fastest = max(machine.rapid_speed, machine.feed_speed)
    lines = [
        *_heading(machine, settings, POWER),
        f"&{system} // the coordinate system of the six struts",
        *(f"#{strut}->I" for strut in STRUTS),
        f"Coord[{system}].FeedTime=1000 // speeds are per 1000 ms, so mm/s",
        f"Coord[{system}].MaxFeedrate={plain(fastest)} // mm/s",
        f"Coord[{system}].SegMoveTime={export.segment_time} // segmentation, ms",
        f"Coord[{system}].LHDistance={segments} // look-ahead, segments",
        *power_pmac.soft_limit_lines(settings, machine.strut_stroke),
        *_power_rates(machine, settings),
        *_variable_lines(variables, POWER),
        f"define lookahead {2 * segments} // segments; not kept over a reset",
        "open forward",
        "if (D0>0) callsub 100;",
        "D0=$1C7 // positions of A B C X Y Z",
        "N100:",
        *programs[0],
        "return",
        "close",
        "open inverse",
        *programs[1],
        "close",
    ]
    return "\n".join(lines) + "\n"


def _heading(machine: Machine, settings: PvtSettings, dialect: KinematicDialect) -> list[str]:
    texts = (
        f"Kinematics of {machine.name} in the controller",
        f"machine file SHA-256 {machine.fingerprint}",
        "X Y Z of the tool tip in mm, A B C in degrees, in the work frame; feeds in mm/s. Strut i is motor i.",
        "Not tried on a controller: the sign-off sheet beside this file comes first.",
    )
    return [line for text in texts for line in comment_lines(text, settings.line_limit, dialect.comment)]


def _programs(
    variables: Sequence[QVariable], dialect: KinematicDialect, system: int, screw: bool, homed: dict[str, str]
) -> tuple[list[str], list[str]]:
    """Lines of the forward and of the inverse program."""
    numbers = {variable.name: variable.number for variable in variables}
    conditions = tuple(f"{name}=1" for name in homed)
    forward = rendered(forward_program(screw, conditions), dialect, numbers, system, forward=True, literal=homed)
    return forward, rendered(inverse_program(screw), dialect, numbers, system, forward=False)


def _variable_lines(variables: Sequence[QVariable], dialect: KinematicDialect) -> list[str]:
    return [
        f"Q{variable.number}={plain(variable.value)}"
        + (f" {dialect.comment} {variable.meaning}" if variable.meaning else "")
        for variable in variables
    ]


def _turbo_rates(machine: Machine, settings: PvtSettings) -> list[str]:
    """Highest speed in counts/ms and acceleration in counts/ms^2 of each motor, for look-ahead and rapid moves."""
    speed, acceleration = _rates(machine, settings)
    lines = ["; Look-ahead keeps the motors within these speeds, counts/ms, and accelerations, counts/ms^2"]
    for strut in STRUTS:
        lines += [f"I{strut}16={plain(speed)}", f"I{strut}17={plain(acceleration)}"]
    return lines


def _power_rates(machine: Machine, settings: PvtSettings) -> list[str]:
    """Highest speed in units/ms and inverse of the highest acceleration in ms^2/unit of each motor."""
    speed, acceleration = _rates(machine, settings)
    inverse = Decimal(repr(float(1 / acceleration)))
    lines = ["// Look-ahead keeps the motors within these speeds, units/ms, and inverse accelerations, ms^2/unit"]
    for strut in STRUTS:
        lines += [f"Motor[{strut}].MaxSpeed={plain(speed)}", f"Motor[{strut}].InvAmax={plain(inverse)}"]
    return lines


def _rates(machine: Machine, settings: PvtSettings) -> tuple[Decimal, Decimal]:
    scale = abs(exact(settings.counts_per_mm))
    return scale * exact(machine.strut_speed) / 1000, scale * exact(machine.strut_acceleration) / 1000000


def counts(settings: PvtSettings, lengths: Sequence[float]) -> list[Decimal]:
    """Counts of the six motors at counted strut lengths, mm."""
    scale = exact(settings.counts_per_mm)
    pairs = zip(lengths, settings.zero_length, strict=True)
    return [scale * (exact(float(length)) - exact(zero)) for length, zero in pairs]
