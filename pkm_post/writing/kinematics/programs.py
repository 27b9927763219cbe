# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs: the inverse and the forward kinematic program, as statements.

The inverse program converts axis positions to motor counts, and in PVT mode axis rates to motor speeds. The forward
program finds the axis positions of six counts by Newton's method. It always starts upright at the start position in the
variables, so the same counts give the same position. If it does not converge within its steps, or converges to a pose
with too much tilt or turn, it reports that there is no solution.
"""

from __future__ import annotations

from pkm_post.writing.kinematics import formulas
from pkm_post.writing.kinematics.dialects import Assign, Comment, Fail, If, Statement, While, assignments
from pkm_post.writing.kinematics.variables import AXES, STRUTS

_START = """
sin_w = sin(work_c)
cos_w = cos(work_c)
d_x = start_x-work_x
d_y = start_y-work_y
x = cos_w*d_x+sin_w*d_y
y = cos_w*d_y-sin_w*d_x
z = start_z-work_z
a = 0
b = 0
c = 0
steps = 0
outcome = 1
worst = tolerance+1
"""
"""The start position in the work frame."""

_PLAUSIBLE = ("abs(a)<90", "abs(b)<90", "abs(c)<180")
"""Other poses have the same lengths; these limits exclude an upside-down platform."""


def inverse_program(screw: bool) -> tuple[Statement, ...]:
    """The body of the inverse kinematic program; ``screw`` is whether the struts turn with their joints."""
    body: list[Statement] = [*formulas.pose_terms()]
    for strut in STRUTS:
        rates = (*formulas.row_of(strut, screw), formulas.speed_of(strut))
        body += [
            Comment(f"strut {strut}"),
            *formulas.length_of(strut, screw),
            formulas.counts_of(strut),
            If(("wants_speed>0",), rates),
        ]
    return tuple(body)


def forward_program(screw: bool, homed: tuple[str, ...]) -> tuple[Statement, ...]:
    """The body of the forward kinematic program.

    ``screw`` is whether the struts turn with their joints; ``homed`` are conditions that hold when all six motors know
    their positions.
    """
    loop = While(("worst>tolerance", "steps<most_steps"), _newton_step(screw))
    accept = If(("worst<tolerance", *_PLAUSIBLE), (Assign("outcome", "0"),))
    refuse = If(("outcome>0",), (Fail(),))
    return (*assignments(_START), If(homed, (loop, accept)), refuse)


def _newton_step(screw: bool) -> tuple[Statement, ...]:
    body: list[Statement] = [Assign("steps", "steps+1"), *formulas.pose_terms(), Assign("worst", "0")]
    for strut in STRUTS:
        error = f"abs(residual{strut})"
        body += [
            Comment(f"strut {strut}"),
            *formulas.length_of(strut, screw),
            formulas.residual_of(strut),
            *formulas.row_of(strut, screw, strut),
            If((f"{error}>worst",), (Assign("worst", error),)),
        ]
    body += [Comment("least squares: J^T J step = J^T residual"), *formulas.normal_equations(), *formulas.solution()]
    step = [Assign(axis, f"{axis}+step{row}") for row, axis in enumerate(AXES, start=1)]
    stop = (Assign("steps", "most_steps"), Assign("worst", "tolerance+1"))
    body.append(If(formulas.regular(), tuple(step), stop))
    return tuple(body)
