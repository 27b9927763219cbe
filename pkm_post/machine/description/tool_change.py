# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool change: the tool-change pose and spindle times of a machine file, and their contradictions.

Input: the entries in mm, s and rad, by name. Output: the pose, and faulty entries with what was found there.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.machine.description.rest_pose import Check, Values
from pkm_post.machine.description.strut_parts import partner
from pkm_post.model import ToolChange

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
    """Home and tool change with one tool axis on one line: the tip of some tool may be at one point in both."""
    axis, home = np.asarray(values[_AXIS]), np.asarray(values[_HOME[1]])
    away = np.cross(values[_HOME[0]] - values[_NOSE], axis)
    if max(np.abs(away).max(), np.abs(home - axis).max()) < _SAME and values[_SPIN] != values[_HOME[2]]:
        yield _SPIN, "on the line of the home pose the spin has to be tool_path.home_spin"


CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    partner(_NOSE, _HEIGHT),
    partner(_HEIGHT, _NOSE),
    ((_NOSE, _HEIGHT), _low_nose),
    ((_NOSE, _AXIS, _SPIN, *_HOME), _spun_on_the_spot),
    partner("spindle.spin_down_time", "spindle.spin_up_time"),
)
"""Each check with its required entries."""
