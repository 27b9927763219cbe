# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contradictions: entries of a machine file that are well formed but cannot all be true.

Input: the entries in mm and rad, by name; None for omitted ones, malformed ones are absent. Output: a fault for each
failed check. A check runs when all its entries are present.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from pkm_post.machine.description.faults import EntryFault
from pkm_post.machine.description.spindle_axis import AXIS_CHECKS
from pkm_post.model import Array, ToolChange

Values = dict[str, Any]
Check = Callable[[Values], Iterator[tuple[str, str]]]
"""Yields the faulty entry and its finding."""

COINCIDENT = 1e-3
"""mm: joint centres closer than this leave the strut direction undefined."""
CONE_TOLERANCE = 1e-9
SIDES = ("base", "platform")
POSE = ("base.joints", "platform.joints", "platform.spindle_nose", "joints.rest_pose", "joints.rest_tool_length")


def rest_struts(values: Values) -> Array:
    """Struts in the rest pose, from base joint to platform joint: p_i + tip + (nose + tool) z - b_i.

    Returns:
        (6, 3) in mm, in {M} and, as {T} is parallel to it, in {T}.
    """
    height = values["platform.spindle_nose"] + values["joints.rest_tool_length"]
    origin = values["joints.rest_pose"] + np.array([0.0, 0.0, height])
    return np.asarray(values["platform.joints"] + origin - values["base.joints"])


def rest_axes(values: Values) -> tuple[Array, Array]:
    """Rest axes as the file states them, else along the struts.

    Returns:
        (6, 3) unit axes of the base joints in {M}, and (6, 3) of the platform joints in {T}.
    """
    along = rest_struts(values) / rest_distances(values)[:, None]
    base, platform = values["joints.base_rest"], values["joints.platform_rest"]
    return (along if base is None else base), (-along if platform is None else platform)


def rest_distances(values: Values) -> Array:
    """Distances of the joint centres in the rest pose, (6,) in mm."""
    return np.asarray(np.linalg.norm(rest_struts(values), axis=1))


def rest_twists(values: Values) -> tuple[Array, Array]:
    """Twist between the halves of each strut in the rest pose, as in ``kinematics.screw``.

    Returns:
        (6,) in rad, and (2, 6) sines of the angles between the strut and the fixed axes of its base and platform joint.
    """
    along = rest_struts(values) / np.maximum(rest_distances(values), COINCIDENT)[:, None]
    first = np.cross(values["joints.base_axes"], along)
    second = np.cross(values["joints.platform_axes"], along)
    twist = np.arctan2((along * np.cross(first, second)).sum(axis=1), (first * second).sum(axis=1))
    return twist, np.linalg.norm([first, second], axis=2)


def _rest_lengths(values: Values) -> Array:
    """Lengths as the controller counts them, (6,) in mm."""
    length = rest_distances(values) - _length_offsets(values)
    if values.get("struts.screw_lead") and all(values.get(f"joints.{side}_axes") is not None for side in SIDES):
        length = length + values["struts.screw_lead"] * rest_twists(values)[0] / (2.0 * np.pi)
    return length


def _coincident(values: Values) -> Iterator[tuple[str, str]]:
    length = rest_distances(values)
    if struts := np.flatnonzero(length < COINCIDENT).tolist():
        yield "joints.rest_pose", each(struts, "both joints of strut {} are at one place", length)


def _outside_stroke(values: Values) -> Iterator[tuple[str, str]]:
    length = _rest_lengths(values)
    least, most = values["struts.stroke"]
    outside = (rest_distances(values) >= COINCIDENT) & ((length < least) | (length > most))
    if struts := np.flatnonzero(outside).tolist():
        lengths = each(struts, "strut {} is {:.4f} mm long", length)
        yield "joints.rest_pose", f"{lengths}, the stroke is {least:.4f} to {most:.4f} mm"


def _outside_cone(side: str, sign: float) -> Check:
    def check(values: Values) -> Iterator[tuple[str, str]]:
        length = rest_distances(values)
        along = sign * rest_struts(values) / np.maximum(length, COINCIDENT)[:, None]
        swing = np.arccos(np.clip((along * values[f"joints.{side}_rest"]).sum(axis=1), -1.0, 1.0))
        cone = values[f"joints.{side}_cone"]
        if joints := np.flatnonzero((length >= COINCIDENT) & (swing > cone + CONE_TOLERANCE)).tolist():
            swings = each(joints, "joint {} swings {:.2f} deg", np.degrees(swing))
            cones = ", ".join(f"{angle:.2f}" for angle in dict.fromkeys(np.degrees(cone[joints]).tolist()))
            yield f"joints.{side}_rest", f"in the rest pose {swings}, the cone is {cones} deg"

    return check


def each(rows: list[int], words: str, quantity: Array) -> str:
    """Format the same text for each row, with its number from 1 and its quantity."""
    return ", ".join(words.format(row + 1, quantity[row]) for row in rows)


_REST_CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    (POSE, _coincident),
    ((*POSE, "struts.stroke"), _outside_stroke),
    ((*POSE, "joints.base_rest", "joints.base_cone"), _outside_cone("base", 1.0)),
    ((*POSE, "joints.platform_rest", "joints.platform_cone"), _outside_cone("platform", -1.0)),
)
"""Each check with its required entries; it runs when all of them are present and well formed."""


_LEAST_ACROSS = 1e-6
"""Least sine of the angle between a strut and the fixed axis of its joint; below, the second axis is undefined."""


def partner(stated: str, needed: str) -> tuple[tuple[str, ...], Check]:
    """Check that an entry has its partner."""

    def check(values: Values) -> Iterator[tuple[str, str]]:
        if _is_left_out(values, needed):
            yield needed, f"needed with {stated}"

    return (stated,), check


def _is_left_out(values: Values, entry: str) -> bool:
    return entry in values and values[entry] is None


def _long_tube(values: Values) -> Iterator[tuple[str, str]]:
    tube, least = values["struts.tube_length"], values["struts.stroke"][0] + _length_offsets(values).min()
    if tube > least:
        yield "struts.tube_length", f"{tube:.4f} mm is more than the shortest strut, {least:.4f} mm"


def _gap(values: Values) -> Iterator[tuple[str, str]]:
    both = values["struts.tube_length"] + values["struts.rod_length"]
    most = values["struts.stroke"][1] + _length_offsets(values).max()
    if both < most:
        yield "struts.rod_length", f"tube and rod are {both:.4f} mm together, the longest strut {most:.4f} mm"


def _length_offsets(values: Values) -> Array:
    """By how much the joints of the struts are farther apart than the stroke counts, (6,) or (1,) mm."""
    offsets = values.get("struts.length_offset")
    return np.asarray([0.0] if offsets is None else offsets)


def _screw_without_axes(values: Values) -> Iterator[tuple[str, str]]:
    if values["struts.screw_lead"] == 0.0:
        return
    for side in SIDES:
        if values[f"joints.{side}_kind"] != "universal":
            yield f"joints.{side}_kind", "a screw that turns with its strut needs universal joints at both ends"
        if _is_left_out(values, f"joints.{side}_axes"):
            yield f"joints.{side}_axes", "needed with struts.screw_lead"


def _screw_twisted_at_rest(values: Values) -> Iterator[tuple[str, str]]:
    if values["struts.screw_lead"] == 0.0 or np.any(rest_distances(values) < COINCIDENT):
        return
    twist, across = rest_twists(values)
    for side, sine in zip(SIDES, across, strict=True):
        if struts := np.flatnonzero(sine < _LEAST_ACROSS).tolist():
            yield f"joints.{side}_axes", each(struts, "in the rest pose strut {} is parallel to its axis", twist)
    far = np.abs(twist) >= np.pi / 2.0
    if struts := np.flatnonzero(far & np.all(across >= _LEAST_ACROSS, axis=0)).tolist():
        found = each(struts, "strut {} twists by {:.2f} deg", np.degrees(twist))
        yield "joints.platform_axes", f"in the rest pose {found}, the most is a right angle; turn an axis round"


def _slow_spindle(values: Values) -> Iterator[tuple[str, str]]:
    least, most = values["spindle.least_speed"], values["spindle.speed"]
    if least > most:
        yield "spindle.least_speed", f"{least:g} is above the highest speed, {most:g}"


_STRUT_CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    partner("struts.tube_radius", "struts.tube_length"),
    partner("struts.tube_length", "struts.tube_radius"),
    partner("struts.rod_radius", "struts.rod_length"),
    partner("struts.rod_length", "struts.rod_radius"),
    (("struts.stroke", "struts.tube_length"), _long_tube),
    (("struts.stroke", "struts.tube_length", "struts.rod_length"), _gap),
    (("struts.screw_lead", "joints.base_kind", "joints.platform_kind"), _screw_without_axes),
    ((*POSE, "struts.screw_lead", "joints.base_axes", "joints.platform_axes"), _screw_twisted_at_rest),
    (("spindle.least_speed", "spindle.speed"), _slow_spindle),
)
"""Each check with its required entries."""


_STRUTS = 6
_BEYOND_REACH = 10
"""In units of the longest strut."""


def _fast_approach(values: Values) -> Iterator[tuple[str, str]]:
    """Yield an approach speed above the strut speed: a strut that moves alone gets the combined speed of all six."""
    approach, most = values["controller.approach_speed"], values["struts.speed"]
    if approach > most:
        yield "controller.approach_speed", f"{approach:g} mm/s, struts.speed is {most:g} mm/s"


def _short_lines(values: Values) -> Iterator[tuple[str, str]]:
    """Yield a line limit below a move with one digit before the point of each speed: ``A750.000000:0.0000``."""
    length, speed = values["controller.length_decimals"], values["controller.speed_decimals"]
    digits = len(str(int(values["struts.stroke"][0])))
    least = _STRUTS * (len("A") + digits + len(".") + length + len(":0.") + speed) + (_STRUTS - 1)
    if least > values["controller.line_limit"]:
        decimals = f"{length} and {speed} decimals"
        found = f"{values['controller.line_limit']} characters, a move with {decimals} has at least {least}"
        yield "controller.line_limit", found


def _far(entry: str) -> Check:
    """Check that a position is not far beyond reach: planning the path to it would take too long."""

    def check(values: Values) -> Iterator[tuple[str, str]]:
        away = float(np.linalg.norm(values[entry] - values["base.joints"].mean(axis=0)))
        most = _BEYOND_REACH * values["struts.stroke"][1]
        if away > most:
            yield entry, f"{away:.4f} mm from the middle of the base joints, no strut reaches beyond {most:.4f} mm"

    return check


_LIMIT_CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    (("controller.approach_speed", "struts.speed"), _fast_approach),
    (
        ("controller.line_limit", "controller.length_decimals", "controller.speed_decimals", "struts.stroke"),
        _short_lines,
    ),
    *(((entry, "base.joints", "struts.stroke"), _far(entry)) for entry in ("tool_path.home_tip", "tool_change.nose")),
)
"""Each check with its required entries."""


_NOSE, _AXIS, _SPIN, _HEIGHT = (f"tool_change.{key}" for key in ("nose", "axis", "spin", "safe_height"))
_HOME = ("tool_path.home_tip", "tool_path.home_axis", "tool_path.home_spin")
_SAME = 1e-6
"""mm, and as much in unit axes: poses closer than this are equal."""


def tool_change(values: Values) -> ToolChange | None:
    """Tool-change pose, or None if the file states none."""
    if values[_NOSE] is None:
        return None
    return ToolChange(values[_NOSE], np.asarray(values[_AXIS]), values[_SPIN], values[_HEIGHT])


def _low_nose(values: Values) -> Iterator[tuple[str, str]]:
    nose, height = float(values[_NOSE][2]), values[_HEIGHT]
    if nose <= height:
        yield _HEIGHT, f"{height:.4f} mm is not below the spindle nose at a tool change, {nose:.4f} mm"


def _spun_on_the_spot(values: Values) -> Iterator[tuple[str, str]]:
    """Home and tool change with the same tool axis on one line: some tool may have the same tip in both."""
    axis, home = np.asarray(values[_AXIS]), np.asarray(values[_HOME[1]])
    away = np.cross(values[_HOME[0]] - values[_NOSE], axis)
    if max(np.abs(away).max(), np.abs(home - axis).max()) < _SAME and values[_SPIN] != values[_HOME[2]]:
        yield _SPIN, "on the line of the home pose the spin has to be tool_path.home_spin"


_TOOL_CHANGE_CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    partner(_NOSE, _HEIGHT),
    partner(_HEIGHT, _NOSE),
    ((_NOSE, _HEIGHT), _low_nose),
    ((_NOSE, _AXIS, _SPIN, *_HOME), _spun_on_the_spot),
    partner("spindle.spin_down_time", "spindle.spin_up_time"),
)
"""Each check with its required entries."""


_CHECKS = AXIS_CHECKS + _REST_CHECKS + _STRUT_CHECKS + _LIMIT_CHECKS + _TOOL_CHANGE_CHECKS


def contradictions(values: Values) -> list[EntryFault]:
    """Faults from all cross-checks of the readable entries."""
    return [
        EntryFault("M103" if values[entry] is None else "M106", tuple(entry.split(".")), found)
        for needs, check in _CHECKS
        if all(values.get(need) is not None for need in needs)
        for entry, found in check(values)
    ]
