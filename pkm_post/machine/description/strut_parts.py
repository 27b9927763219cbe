# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strut parts: contradictions among the entries for tube, rod, screw and spindle.

Input: the entries in mm and rad, by name. Output: faulty entries and what was found there.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.machine.description.rest_pose import (
    COINCIDENT,
    POSE,
    SIDES,
    Check,
    Values,
    each,
    rest_distances,
    rest_twists,
)

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
    tube, least = values["struts.tube_length"], values["struts.stroke"][0]
    if tube > least:
        yield "struts.tube_length", f"{tube:.4f} mm is more than the shortest strut, {least:.4f} mm"


def _gap(values: Values) -> Iterator[tuple[str, str]]:
    both, most = values["struts.tube_length"] + values["struts.rod_length"], values["struts.stroke"][1]
    if both < most:
        yield "struts.rod_length", f"tube and rod are {both:.4f} mm together, the longest strut {most:.4f} mm"


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


CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
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
