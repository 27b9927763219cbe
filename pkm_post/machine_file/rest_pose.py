# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rest pose: where every joint stands in the middle of its cone, and what contradicts it.

Enters: the entries of a machine file in mm and rad, by name. Leaves: the rest axes of the twelve joints and the faults
of a geometry whose entries are well formed each but do not fit together. In the rest pose the tool axis is vertical
and {T} is parallel to {M}, its origin above the tip by the tool and the spindle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from pkm_post.machine_file.faults import Fault
from pkm_post.machine_file.forms import Array

Values = dict[str, Any]
Check = Callable[[Values], Iterator[tuple[str, str]]]
"""Gives the entry at fault and what was found there."""

COINCIDENT = 1e-3
"""Joint centres nearer than this (mm) give a strut no direction."""
CONE_TOLERANCE = 1e-9
_POSE = ("base.joints", "platform.joints", "platform.spindle_nose", "joints.rest_pose", "joints.rest_tool_length")


def rest_struts(values: Values) -> Array:
    """The struts in the rest pose, from base joint to platform joint: p_i + tip + (nose + tool) z - b_i.

    Returns:
        (6, 3) in mm, in {M}, and as {T} is parallel to it, in {T}.
    """
    height = values["platform.spindle_nose"] + values["joints.rest_tool_length"]
    origin = values["joints.rest_pose"] + np.array([0.0, 0.0, height])
    return np.asarray(values["platform.joints"] + origin - values["base.joints"])


def rest_axes(values: Values) -> tuple[Array, Array]:
    """Rest axes as the file states them, else along the struts.

    Returns:
        (6, 3) unit axes of the base joints in {M}, and (6, 3) of the platform joints in {T}.
    """
    struts = rest_struts(values)
    along = struts / np.linalg.norm(struts, axis=1, keepdims=True)
    base, platform = values["joints.base_rest"], values["joints.platform_rest"]
    return (along if base is None else base), (-along if platform is None else platform)


def _coincident(values: Values) -> Iterator[tuple[str, str]]:
    length = np.linalg.norm(rest_struts(values), axis=1)
    if struts := np.flatnonzero(length < COINCIDENT).tolist():
        yield "joints.rest_pose", _each(struts, "both joints of strut {} are at one place", length)


def _outside_stroke(values: Values) -> Iterator[tuple[str, str]]:
    length = np.linalg.norm(rest_struts(values), axis=1)
    least, most = values["struts.stroke"]
    outside = (length >= COINCIDENT) & ((length < least) | (length > most))
    if struts := np.flatnonzero(outside).tolist():
        lengths = _each(struts, "strut {} is {:.4f} mm long", length)
        yield "joints.rest_pose", f"{lengths}, the stroke is {least:.4f} to {most:.4f} mm"


def _outside_cone(side: str, sign: float) -> Check:
    def check(values: Values) -> Iterator[tuple[str, str]]:
        struts = rest_struts(values)
        length = np.linalg.norm(struts, axis=1)
        along = sign * struts / np.maximum(length, COINCIDENT)[:, None]
        swing = np.arccos(np.clip((along * values[f"joints.{side}_rest"]).sum(axis=1), -1.0, 1.0))
        cone = values[f"joints.{side}_cone"]
        if joints := np.flatnonzero((length >= COINCIDENT) & (swing > cone + CONE_TOLERANCE)).tolist():
            swings = _each(joints, "joint {} swings {:.2f} deg", np.degrees(swing))
            yield f"joints.{side}_rest", f"in the rest pose {swings}, the cone is {np.degrees(cone):.2f} deg"

    return check


def _each(rows: list[int], words: str, quantity: Array) -> str:
    return ", ".join(words.format(row + 1, quantity[row]) for row in rows)


_CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    (_POSE, _coincident),
    ((*_POSE, "struts.stroke"), _outside_stroke),
    ((*_POSE, "joints.base_rest", "joints.base_cone"), _outside_cone("base", 1.0)),
    ((*_POSE, "joints.platform_rest", "joints.platform_cone"), _outside_cone("platform", -1.0)),
)
"""Each check with the entries it needs; it runs when all of them are there and well formed."""


def contradictions(values: Values) -> list[Fault]:
    """What the entries that could be read say against each other."""
    return [
        Fault("M106", tuple(entry.split(".")), found)
        for needs, check in _CHECKS
        if all(values.get(need) is not None for need in needs)
        for entry, found in check(values)
    ]
