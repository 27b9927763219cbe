# SPDX-License-Identifier: LGPL-2.1-or-later
"""Part checks: spindle, holder and struts against the part.

Only surfaces count: a body that is inside the part from the first pose on is not detected, one that enters it is. The
tool is not a body, as it has to touch the part. Units: mm.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.kinematics.between import Check
from pkm_post.machine.kinematics.bodies import (
    cylinders_of,
    has_strut_bodies,
    lever_of_rod,
    reach_of_body,
    strut_cylinders,
)
from pkm_post.machine.kinematics.checks import HUNDREDTH, STRUTS, arms_from_tip
from pkm_post.machine.kinematics.interference import COMFORT
from pkm_post.machine.kinematics.part import Part, distance_from_part
from pkm_post.machine.kinematics.placed import Placed
from pkm_post.machine.kinematics.way import Way
from pkm_post.model import Body, Machine

_FAR = 5 * COMFORT
"""mm: margins are capped here, which leaves the survey room for large steps."""


def part_checks(machine: Machine, way: Way, shortest: float, part: Part) -> tuple[Check, ...]:
    """Check that platform bodies and struts keep clear of the part; none for those the machine file does not state.

    Args:
        machine: bodies and struts.
        way: for the longest tool.
        shortest: lower bound of a strut's joint distance on the path, mm.
        part: the part to keep clear of.
    """
    far = _FAR + machine.clearance
    checks = [
        Check(
            f"{body.name} and part", "K117", "mm", (body.name,), "{part} by {by:.3f} mm",
            partial(_of_body, body, part, far), 1.0, reach_of_body(machine, way, body), HUNDREDTH, COMFORT,
        )
        for body in machine.bodies
    ]  # fmt: skip
    if has_strut_bodies(machine):
        lever, arm = lever_of_rod(machine, shortest), float(arms_from_tip(machine, way.tool_length).max())
        checks.append(
            Check(
                "strut and part", "K121", "mm", STRUTS, "strut {part} by {by:.3f} mm", partial(_of_struts, part, far),
                lever, lever * arm, HUNDREDTH, COMFORT,
            )
        )  # fmt: skip
    return tuple(checks)


def _of_body(body: Body, part: Part, far: float, placed: Placed) -> Array:
    """Margins of one body, (M, 1)."""
    return distance_from_part(cylinders_of(placed, body), part, far)[:, None] - placed.machine.clearance


def _of_struts(part: Part, far: float, placed: Placed) -> Array:
    """Margins of the struts, (M, 6)."""
    pieces = [distance_from_part(piece, part, far) for piece in strut_cylinders(placed)]
    return np.min(pieces, axis=0).reshape(-1, 6) - placed.machine.clearance
