# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rest pose: the pose with every joint in the middle of its cone, and its contradictions.

Input: the entries of a machine file in mm and rad, by name. Output: the rest axes of the twelve joints and the faults
of a geometry whose entries are well formed but inconsistent. In the rest pose the tool axis is vertical and {T} is
parallel to {M}, its origin above the tip by the tool and the spindle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from pkm_post.machine.description.forms import Array

Values = dict[str, Any]
Check = Callable[[Values], Iterator[tuple[str, str]]]
"""Yields the faulty entry and what was found there."""

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
    length = rest_distances(values)
    if values.get("struts.length_offset") is not None:
        length = length - values["struts.length_offset"]
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


CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    (POSE, _coincident),
    ((*POSE, "struts.stroke"), _outside_stroke),
    ((*POSE, "joints.base_rest", "joints.base_cone"), _outside_cone("base", 1.0)),
    ((*POSE, "joints.platform_rest", "joints.platform_cone"), _outside_cone("platform", -1.0)),
)
"""Each check with its required entries; it runs when all of them are present and well formed."""
