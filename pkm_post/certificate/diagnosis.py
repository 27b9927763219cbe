# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fault causes: whether a limit is violated by the plan, or by the decimals of the printed program.

Input: a certificate, and its program. Output: a diagnostic for each finding that does not hold. A program that equals
its printed plan is played again with the exact lengths and speeds of the plan; findings that then hold are due to the
decimals, and more decimals are tried until they hold. Units: mm, mm/s.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import strut_state
from pkm_post.model import (
    Certificate,
    Diagnostic,
    Diagnostics,
    Finding,
    Machine,
    Motion,
    StrutMotion,
    in_pieces,
    intervals_at,
)

Decimals = tuple[int, int]
"""Decimals of lengths and of speeds."""
Measured = Callable[[StrutMotion], Certificate]

_DECIMALS = ("length_decimals", "speed_decimals")
_MOST_DECIMALS = 9
"""Most decimals that a machine file may state."""
_MORE = (1, 2, 3, 4, 5)
_HALF_DIGIT = 0.51
"""Largest deviation of a program from its plan by rounding, in units of the last decimal."""
_OF_KNOTS = ("V101", "V102", "V103", "V104", "V108", "V110", "V113", "V114")
"""Findings that more knots would improve."""
_LITTLE = 0.01
"""Relative difference that is not worth reporting."""
_AT_ONCE = 2048


def diagnose(
    certificate: Certificate, struts: StrutMotion, machine: Machine, motion: Motion, measured: Measured
) -> Diagnostics:
    """A diagnostic for each finding that does not hold.

    Args:
        certificate: certificate of the program.
        struts: the program, read back.
        machine: states the decimals.
        motion: the plan.
        measured: plays another program with the same knots.
    """
    if certificate.holds:
        return ()
    length, speed = in_pieces(len(motion), _AT_ONCE, lambda rows: strut_state(machine, motion.poses(rows))[:2])
    exact = replace(struts, length=length, speed=speed)
    decimals = _as_printed(struts, exact, machine)
    if decimals is None:
        return tuple(row.diagnostic() for row in certificate.findings if not row.holds)
    pairs = tuple(zip(certificate.findings, measured(exact).findings, strict=True))
    planned = [number for number, (_, plan) in enumerate(pairs) if plan.holds]
    is_rounding = any(plan.holds and not row.holds for row, plan in pairs)
    enough = _enough(exact, decimals, planned, measured) if is_rounding else None
    faults = ((row, _diagnostic(row, plan, decimals, enough)) for row, plan in pairs if not row.holds)
    return tuple(_of_short_intervals(fault, row.time, struts, machine) for row, fault in faults)


def _of_short_intervals(fault: Diagnostic, time: float, struts: StrutMotion, machine: Machine) -> Diagnostic:
    """The same diagnostic, or that of an interval too short to split on this controller."""
    row = intervals_at(struts.time_ms, 1000 * time)
    interval = int(np.diff(struts.time_ms[row : row + 2])[0])
    if fault.code not in _OF_KNOTS or not 1 < interval < 2 * machine.shortest_interval:
        return fault
    found = (
        f"{fault.found}, in an interval of {interval} ms; controller.shortest_interval is {machine.shortest_interval}"
    )
    return replace(fault, code="V119", found=found)


def _as_printed(struts: StrutMotion, exact: StrutMotion, machine: Machine) -> Decimals | None:
    """The decimals of the program; None if it differs from its printed plan."""
    if not all(name in machine.controller for name in _DECIMALS):
        return None
    length, speed = (int(machine.controller[name]) for name in _DECIMALS)
    off = np.abs(struts.length - exact.length).max(), np.abs(struts.speed - exact.speed).max()
    near = (most <= _HALF_DIGIT * 10.0**-digits + 1e-9 for most, digits in zip(off, (length, speed), strict=True))
    return (length, speed) if all(near) else None


def _enough(exact: StrutMotion, decimals: Decimals, planned: list[int], measured: Measured) -> Decimals | None:
    """The fewest of the tried decimals with which all findings hold that hold without rounding."""
    for more in _further(decimals):
        length, speed = (np.round(one, digits) for one, digits in zip((exact.length, exact.speed), more, strict=True))
        found = measured(replace(exact, length=_without_sign(length), speed=_without_sign(speed))).findings
        if all(found[number].holds for number in planned):
            return more
    return None


def _further(decimals: Decimals) -> Iterator[Decimals]:
    """More decimals for lengths, for speeds, for both; then still more."""
    length, speed = decimals
    for more in _MORE:
        tried = (length + more, speed), (length, speed + more), (length + more, speed + more)
        yield from (one for one in tried if max(one) <= _MOST_DECIMALS)


def _without_sign(values: Array) -> Array:
    return np.asarray(values + 0.0)


def _diagnostic(row: Finding, plan: Finding, decimals: Decimals, enough: Decimals | None) -> Diagnostic:
    """The fault, with its value without rounding if that differs, and the decimals that would suffice."""
    fault = row.diagnostic()
    if plan.holds or abs(row.value - plan.value) > _LITTLE * abs(row.value):
        fault = replace(fault, found=f"{fault.found}; {plan.value:.6g} {row.unit} without rounding".rstrip())
    if not plan.holds:
        return fault
    return replace(fault, code="V118", found=f"{fault.found}; {_advice(decimals, enough)}")


def _advice(decimals: Decimals, enough: Decimals | None) -> str:
    if enough is None:
        return f"{decimals[0]} and {decimals[1]} decimals are too few, and {_MORE[-1]} more of both as well"
    pairs = zip(_DECIMALS, decimals, enough, strict=True)
    changed = (f"controller.{name} = {there}" for name, here, there in pairs if here != there)
    return f"it holds with {' and '.join(changed)}"
