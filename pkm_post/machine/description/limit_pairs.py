# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limit pairs: mutually exclusive limits of a machine file.

Input: the entries in mm, rad and s, by name. Output: faulty entries and what was found there. An unreachable limit,
like a rapid speed beyond the strut speed, is no contradiction: the lower one holds.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.machine.description.rest_pose import Check, Values

_STRUTS = 6
_BEYOND_REACH = 10
"""In lengths of the longest strut."""


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
    """Check that a position is not beyond all reach: the path to it would be planned, step by step."""

    def check(values: Values) -> Iterator[tuple[str, str]]:
        away = float(np.linalg.norm(values[entry] - values["base.joints"].mean(axis=0)))
        most = _BEYOND_REACH * values["struts.stroke"][1]
        if away > most:
            yield entry, f"{away:.4f} mm from the middle of the base joints, no strut reaches beyond {most:.4f} mm"

    return check


CHECKS: tuple[tuple[tuple[str, ...], Check], ...] = (
    (("controller.approach_speed", "struts.speed"), _fast_approach),
    (
        ("controller.line_limit", "controller.length_decimals", "controller.speed_decimals", "struts.stroke"),
        _short_lines,
    ),
    *(((entry, "base.joints", "struts.stroke"), _far(entry)) for entry in ("tool_path.home_tip", "tool_change.nose")),
)
"""Each check with its required entries."""
