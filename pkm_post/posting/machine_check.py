# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine check: figures of a machine file to compare with the real machine.

Input: a machine. Output: rows of text, label and figure, and warnings when the home pose breaks limits. Home figures
use the tool of the rest pose; lengths in mm, angles in degrees.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.machine import (
    DISPLAY_UNITS,
    PosePath,
    ReachFinding,
    jacobian_of_tip,
    reach_findings,
    scaled_jacobian,
    stiffness_along,
    strut_lengths,
)
from pkm_post.model import Diagnostic, Diagnostics, Machine, Place
from pkm_post.writing import controller_settings

Rows = list[tuple[str, str]]
_SINGULAR = 1e-9
"""Smaller singular values are rounding errors."""


@dataclass(frozen=True)
class Home:
    """The machine at home with the tool of the rest pose.

    Attributes:
        lengths: (6,) counted strut lengths.
        singular_values: (6,) of the scaled Jacobian, from the largest to the smallest.
        turning_rate: about the tip, about any axis, within the strut speed, rad/s.
        stiffness: (3,) of the tip in x, y and z of {M}, N/mm; None if not stated, or if the pose is singular.
        findings: of all reach checks.
        count_at_tip: tip displacement by one count of each strut, mm; None where the pose is singular.
    """

    lengths: Array
    singular_values: Array
    turning_rate: float
    stiffness: Array | None
    findings: tuple[ReachFinding, ...]
    count_at_tip: float | None


def at_home(machine: Machine) -> Home:
    """Evaluate the machine at home."""
    spin, tool_length = np.array([machine.home_spin]), np.array([machine.rest_tool_length])
    pose = machine.home_tip[None], machine.home_axis[None], spin, tool_length
    path = PosePath.straight(*pose)
    values = np.linalg.svd(scaled_jacobian(machine, *pose)[0], compute_uv=False)
    stiffness = None
    if machine.strut_stiffness is not None and values[-1] > _SINGULAR:
        stiffness = stiffness_along(machine, path.rows(np.zeros(3, dtype=np.intp)), np.eye(3))
    return Home(
        lengths=strut_lengths(machine, *pose)[0],
        singular_values=values,
        turning_rate=float(machine.strut_speed / norm(jacobian_of_tip(machine, *pose)[0, :, 3:]).max()),
        stiffness=stiffness,
        count_at_tip=_count_at_tip(machine, pose),
        findings=reach_findings(machine, path),
    )


def machine_faults(machine: Machine, file: str) -> Diagnostics:
    """Faults of a well-formed machine that prevent posting: of its controller, home and tool change.

    Args:
        file: file name in messages.
    """
    _, faults = controller_settings(machine)
    of_controller = (replace(fault, place=Place(file)) for fault in faults)
    return (*of_controller, *home_faults(machine, file), *change_faults(machine, file))


def _count_at_tip(machine: Machine, pose: tuple[Array, ...]) -> float | None:
    """Largest tip displacement, mm, by one count of each strut, with the worst combination of signs."""
    jacobian = jacobian_of_tip(machine, *pose)[0]
    counts = machine.controller.get("counts_per_mm")
    if counts is None or np.linalg.cond(jacobian) > 1 / _SINGULAR:
        return None
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=6)))
    return float(norm((np.linalg.inv(jacobian)[:3] @ signs.T).T).max() / counts)


def home_faults(machine: Machine, file: str) -> Diagnostics:
    """Warnings for limits that the home pose breaks.

    Args:
        file: file name in messages.
    """
    return _broken_limits("M108", at_home(machine), file)


def change_faults(machine: Machine, file: str) -> Diagnostics:
    """Warnings for limits that the tool-change pose breaks with the tool of the rest pose.

    Args:
        file: file name in messages.
    """
    pose = machine.tool_change
    if pose is None:
        return ()
    tip = pose.tip(machine.rest_tool_length)
    there = replace(machine, home_tip=tip, home_axis=pose.axis, home_spin=pose.spin)
    return _broken_limits("M115", at_home(there), file)


def _broken_limits(code: str, standing: Home, file: str) -> Diagnostics:
    return tuple(
        Diagnostic(code, Place(file), f"{one.subject.name}: {one.subject.describe(int(one.part[0]), one.margin[0])}")
        for one in standing.findings
        if one.margin[0] < 0.0
    )


def machine_summary(machine: Machine) -> Rows:
    """Rows of the file's contents and derived figures."""
    home = at_home(machine)
    return [*_geometry(machine), *_limits(machine), *_tools(machine), *_bodies(machine), *_at_home(machine, home)]


def format_table(rows: Rows) -> str:
    """Format the rows as a table."""
    width = max(len(label) for label, _ in rows)
    return "\n".join(f"  {label.ljust(width)}  {figure}" for label, figure in rows)


def _geometry(machine: Machine) -> Iterator[tuple[str, str]]:
    yield "fingerprint", machine.fingerprint
    for label, joints, frame in (
        ("base joints", machine.base_joints, "{M}"),
        ("platform joints", machine.platform_joints, "{T}"),
    ):
        yield label, f"radius {_span(norm(joints[:, :2]))} mm, z {_span(joints[:, 2])} mm in {frame}"
    yield "joint kinds", f"{machine.base_joint_kind} at the base, {machine.platform_joint_kind} at the platform"
    yield "spindle nose", f"{machine.spindle_nose:.4f} mm below the origin of {{T}}"
    if machine.length_offset.any():
        yield "length offsets", ", ".join(f"{offset:.4f}" for offset in machine.length_offset) + " mm"
    if machine.screw_lead:
        yield "screw lead", f"{machine.screw_lead:g} mm, turns with the strut"


def _limits(machine: Machine) -> Iterator[tuple[str, str]]:
    least, most = machine.strut_stroke
    yield "stroke", f"{least:.4f} to {most:.4f} mm, {most - least:.4f} mm long"
    yield "strut speed", f"{machine.strut_speed:g} mm/s"
    yield "strut acceleration", f"{machine.strut_acceleration:g} mm/s^2"
    yield "strut jerk", f"{machine.strut_jerk:g} mm/s^3" if np.isfinite(machine.strut_jerk) else "no limit stated"
    gains = machine.velocity_gain
    yield (
        "velocity gains",
        "none stated: following errors are not looked at" if gains is None else f"{_span(gains)} 1/s",
    )
    rate = f"at most {machine.block_rate:g} in a second" if np.isfinite(machine.block_rate) else "no rate stated"
    yield "points", f"{machine.shortest_interval} ms apart or more, {rate}"
    yield "base cones", f"{_span(np.degrees(machine.base_cone), 2)} degrees"
    yield "platform cones", f"{_span(np.degrees(machine.platform_cone), 2)} degrees"
    yield "spindle", f"{machine.spindle_least_speed:g} to {machine.spindle_speed:g} 1/min"
    yield "work offsets", ", ".join(sorted(machine.work_offsets)) or "none"


def _tools(machine: Machine) -> Iterator[tuple[str, str]]:
    yield "largest tool", _up_to(machine.largest_tool_diameter, "diameter")
    yield "longest tool", _up_to(machine.longest_tool, "gauge length")
    up, down = machine.spin_up_time, machine.spin_down_time
    waits = f"{up:g} s to the highest speed, {up if down is None else down:g} s to rest" if up is not None else ""
    yield "spindle waits", waits or "none: the motion does not wait for the spindle"
    pose = machine.tool_change
    if pose is None:
        yield "tool change", "no pose stated: tools change where the tip stands"
        return
    nose = ", ".join(f"{value:g}" for value in pose.nose)
    yield "tool change", f"spindle nose at ({nose}) mm, tips free from z {pose.safe_height:g} mm upwards"


def _up_to(most: float, what: str) -> str:
    return f"{what} up to {most:g} mm" if np.isfinite(most) else "no limit stated"


def _bodies(machine: Machine) -> Iterator[tuple[str, str]]:
    parts = [("tube", machine.tube_radius), ("rod", machine.rod_radius)]
    struts = [f"{name} of radius {radius:g} mm" for name, radius in parts if radius]
    yield "strut bodies", ", ".join(struts) or "none stated: struts are not checked for interference"
    yield "bodies on the platform", ", ".join(body.name for body in machine.bodies) or "none stated"
    yield "fixtures", ", ".join(box.name for box in machine.fixtures) or "none stated"


def _at_home(machine: Machine, home: Home) -> Iterator[tuple[str, str]]:
    tip = ", ".join(f"{value:g}" for value in machine.home_tip)
    yield "home", f"tip at ({tip}) mm with a tool of {machine.rest_tool_length:g} mm"
    yield "  strut lengths", f"{_span(home.lengths)} mm"
    values = home.singular_values
    condition = f"{values[0] / values[-1]:.3f}" if values[-1] > _SINGULAR else "none, the pose is singular"
    yield "  condition", f"{condition}, with a length of {machine.characteristic_length:g} mm"
    yield "  smallest singular value", f"{values[-1]:.4f}, at least {machine.least_singular_value:g} is asked for"
    turning = f"{np.degrees(home.turning_rate):.1f} degrees/s about the tip, whatever the axis"
    yield "  turning rate of struts", turning
    if home.stiffness is not None:
        yield "  stiffness", ", ".join(f"{value / 1000.0:.1f}" for value in home.stiffness) + " N/um in x, y, z"
    if home.count_at_tip is not None:
        yield "  one count of each strut", f"moves the tip by {1000 * home.count_at_tip:.3f} um at most"
    for one in home.findings:
        shown, factor = DISPLAY_UNITS[one.subject.unit]
        if shown:  # the margin to singular poses is a bound; the value itself is listed above
            yield f"  room: {one.subject.name}", f"{one.margin[0] * factor:.3f} {shown}"


def _span(values: Array, decimals: int = 4) -> str:
    """Format the least and the greatest value, or the common value."""
    texts = list(dict.fromkeys(f"{value + 0.0:.{decimals}f}" for value in (values.min(), values.max())))
    return " to ".join(texts)
