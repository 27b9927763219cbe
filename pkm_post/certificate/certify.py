# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certify: decide whether a program does what was programmed, within tolerances and limits.

Enters: the strut motion read back from the written program, the trajectory read back from its file, the machine, and
the planned motion, which says for each knot where on the trajectory it ought to be. Leaves: a certificate, and a
diagnostic for everything that does not hold.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.playback import INSTANTS, Played, play
from pkm_post.geometry.vectors import Array
from pkm_post.model import Diagnostic, Machine, Motion, Place, StrutMotion, Trajectory
from pkm_post.model.findings import Certificate, Finding, Tolerances

_FEED_SHARE = 1.01
"""How far the cubic may swing about the planned speed where the acceleration changes."""
_FEED_ROUNDING = 0.05
"""mm/s: what rounding lengths to six decimals can do to the speed within one millisecond, with room to spare."""


def certify(
    struts: StrutMotion,
    program_name: str,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    tolerances: Tolerances,
) -> tuple[Certificate | None, tuple[Diagnostic, ...]]:
    """Play a program and compare it with the trajectory it was made from.

    Args:
        struts: the program, read back.
        program_name: names the program in diagnostics.
        trajectory: what was programmed.
        machine: geometry and limits.
        motion: the plan; program and plan must have the same knots.
        tolerances: what was asked for.
    """
    faults = _structure_faults(struts, program_name, motion)
    if faults:
        return None, faults
    played = play(struts, machine, TrajectoryRuler(trajectory, tolerances), motion)
    findings = tuple(_findings(played, struts, trajectory, machine, motion, tolerances))
    certificate = Certificate(
        findings=findings,
        duration=float(struts.time_ms[-1]) / 1000,
        intervals=len(struts) - 1,
        instants=INSTANTS * (len(struts) - 1),
        time=struts.time_ms[:-1] / 1000,
        tip_deviation=played.tip,
        axis_deviation=played.axis,
    )
    return certificate, tuple(finding.diagnostic() for finding in findings if not finding.holds)


def _structure_faults(struts: StrutMotion, program_name: str, motion: Motion) -> tuple[Diagnostic, ...]:
    """What makes a comparison pointless: other knots, other events, or motion at the ends."""
    place = Place(program_name)
    faults = []
    if not np.array_equal(struts.time_ms, motion.time_ms):
        found = f"{len(struts)} points in {struts.time_ms[-1]} ms, planned {len(motion)} in {motion.time_ms[-1]} ms"
        faults.append(Diagnostic("V110", place, found))
    if struts.events != motion.events:
        faults.append(Diagnostic("V109", place, f"{len(struts.events)} events, the job has {len(motion.events)}"))
    if struts.speed[[0, -1]].any():
        faults.append(Diagnostic("V105", place, f"last speeds {struts.speed[-1].tolist()} mm/s"))
    return tuple(faults)


def _findings(
    played: Played,
    struts: StrutMotion,
    trajectory: Trajectory,
    machine: Machine,
    motion: Motion,
    tolerances: Tolerances,
) -> Iterator[Finding]:
    def worst(code: str, name: str, unit: str, values: Array, limit: float, sign: float = 1.0) -> Finding:
        """The finding where sign * (value - limit) is largest; sign -1 for what must not fall below its limit."""
        row = int(np.argmax(sign * np.where(np.isnan(values), sign * np.inf, values)))
        value = float(values[row])
        holds = sign * value <= sign * limit
        place = trajectory.place(int(motion.segment[row + 1]))
        return Finding(code, name, unit, value, limit, holds, float(struts.time_ms[row]) / 1000, place)

    shortest, longest = machine.strut_stroke
    excess = played.tip_speed - _feed_ceiling(trajectory, motion)
    yield worst("V107", "instants without a pose", "", 1.0 - played.found, 0.0)
    yield worst("V101", "deviation of the tool tip", "mm", played.tip, tolerances.tip)
    yield worst("V102", "deviation of the tool axis", "degrees", np.degrees(played.axis), math.degrees(tolerances.axis))
    yield worst("V108", "tip speed above the feed", "mm/s", excess, 0.0)
    yield worst("V103", "strut speed", "mm/s", played.strut_speed, machine.strut_speed)
    yield worst("V104", "strut acceleration", "mm/s^2", played.strut_acceleration, machine.strut_acceleration)
    yield worst("V106", "shortest strut", "mm", played.shortest, shortest, -1.0)
    yield worst("V106", "longest strut", "mm", played.longest, longest)


def _feed_ceiling(trajectory: Trajectory, motion: Motion) -> Array:
    """Highest tip speed each interval may have: that of the fastest segment it touches, (K,)."""
    first, last = motion.segment[:-1], motion.segment[1:]
    # reduceat over pairs (first, last + 1): the maxima of the ranges are every second result.
    bounds = np.column_stack([first, last + 1]).ravel()
    fastest = np.maximum.reduceat(np.append(trajectory.feed, 0.0), bounds)[::2]
    return fastest * _FEED_SHARE + _FEED_ROUNDING
