# SPDX-License-Identifier: LGPL-2.1-or-later
"""Formulas: strut lengths of axis positions and their derivatives, as statements for a controller.

Axes: X Y Z of the tool tip in the work frame {C}, and A B C in degrees, the rotation of the platform in the axes of
{C}. With the work frame turned by w about Z of {M}, and the tip p, the reach L and the joints a_i, b_i:

    R = Rz(w) Rz(C) Ry(B) Rx(A) Rz(-w),  arm_i = R (a_i + L z),  d_i = |p + arm_i - b_i|

so A = B = C = 0 is the upright platform with zero spin in {M}, whatever the work frame. A tilted work frame has no such
form. The length that the controller counts is d_i + lead twist / 360 - offset, as in ``machine.kinematics.screw``:
tests compare both statements of the formula. Derivatives are by the axes, in mm per mm and mm per degree: the rows of
the Jacobian by twist, times the twist of each axis.
"""

from __future__ import annotations

from pkm_post.writing.kinematics.dialects import Assign, Statement, assignments
from pkm_post.writing.kinematics.variables import AXES, STRUTS

_RADIAN = "0.0174532925199433"
"""rad per degree."""

_POSE = """
sin_a = sin(a)
cos_a = cos(a)
sin_b = sin(b)
cos_b = cos(b)
sin_c = sin(c+work_c)
cos_c = cos(c+work_c)
sin_w = sin(work_c)
cos_w = cos(work_c)
tip_x = work_x+cos_w*x-sin_w*y
tip_y = work_y+sin_w*x+cos_w*y
tip_z = work_z+z
reach = nose+tool_length
w11 = cos_c*cos_b
w21 = sin_c*cos_b
w31 = 0-sin_b
w12 = cos_c*sin_b*sin_a-sin_c*cos_a
w22 = sin_c*sin_b*sin_a+cos_c*cos_a
w32 = cos_b*sin_a
w13 = cos_c*sin_b*cos_a+sin_c*sin_a
w23 = sin_c*sin_b*cos_a-cos_c*sin_a
w33 = cos_b*cos_a
r11 = w11*cos_w-w12*sin_w
r21 = w21*cos_w-w22*sin_w
r31 = w31*cos_w-w32*sin_w
r12 = w11*sin_w+w12*cos_w
r22 = w21*sin_w+w22*cos_w
r32 = w31*sin_w+w32*cos_w
"""
"""w: Rz(w + C) Ry(B) Rx(A), r: the first two columns of R; the third ones are the same."""

_DISTANCE = """
low = platform_z{i}+reach
arm_x = r11*platform_x{i}+r12*platform_y{i}+w13*low
arm_y = r21*platform_x{i}+r22*platform_y{i}+w23*low
arm_z = r31*platform_x{i}+r32*platform_y{i}+w33*low
strut_x = tip_x+arm_x-base_x{i}
strut_y = tip_y+arm_y-base_y{i}
strut_z = tip_z+arm_z-base_z{i}
distance = sqrt(strut_x*strut_x+strut_y*strut_y+strut_z*strut_z)
"""

_DIRECTION = """
u_x = strut_x/distance
u_y = strut_y/distance
u_z = strut_z/distance
"""

_TWIST = """
n_x = r11*platform_axis_x{i}+r12*platform_axis_y{i}+w13*platform_axis_z{i}
n_y = r21*platform_axis_x{i}+r22*platform_axis_y{i}+w23*platform_axis_z{i}
n_z = r31*platform_axis_x{i}+r32*platform_axis_y{i}+w33*platform_axis_z{i}
k_x = base_axis_y{i}*n_z-base_axis_z{i}*n_y
k_y = base_axis_z{i}*n_x-base_axis_x{i}*n_z
k_z = base_axis_x{i}*n_y-base_axis_y{i}*n_x
v_u = base_axis_x{i}*u_x+base_axis_y{i}*u_y+base_axis_z{i}*u_z
n_u = n_x*u_x+n_y*u_y+n_z*u_z
sine = u_x*k_x+u_y*k_y+u_z*k_z
cosine = base_axis_x{i}*n_x+base_axis_y{i}*n_y+base_axis_z{i}*n_z-v_u*n_u
twist = atan2(sine, cosine)
length = distance+lead_per_degree*twist-offset{i}
"""

_PULL_OF_SCREW = """
scale = lead_per_radian/(1-n_u*n_u)
by_n = scale*n_u/distance
by_v = lead_per_radian*v_u/(1-v_u*v_u)/distance
g_x = u_x+by_n*(n_y*u_z-n_z*u_y)-by_v*(base_axis_y{i}*u_z-base_axis_z{i}*u_y)
g_y = u_y+by_n*(n_z*u_x-n_x*u_z)-by_v*(base_axis_z{i}*u_x-base_axis_x{i}*u_z)
g_z = u_z+by_n*(n_x*u_y-n_y*u_x)-by_v*(base_axis_x{i}*u_y-base_axis_y{i}*u_x)
m_x = arm_y*g_z-arm_z*g_y+scale*(u_x-n_u*n_x)
m_y = arm_z*g_x-arm_x*g_z+scale*(u_y-n_u*n_y)
m_z = arm_x*g_y-arm_y*g_x+scale*(u_z-n_u*n_z)
"""

_PULL = """
g_x = u_x
g_y = u_y
g_z = u_z
m_x = arm_y*g_z-arm_z*g_y
m_y = arm_z*g_x-arm_x*g_z
m_z = arm_x*g_y-arm_y*g_x
"""
"""The derivative of the length by the velocity of the tip, g, and by the angular velocity of the platform, m."""

_ROW = """
row_x{row} = cos_w*g_x+sin_w*g_y
row_y{row} = cos_w*g_y-sin_w*g_x
row_z{row} = g_z
row_a{row} = {radian}*(w11*m_x+w21*m_y+w31*m_z)
row_b{row} = {radian}*(cos_c*m_y-sin_c*m_x)
row_c{row} = {radian}*m_z
"""
"""A turns about the first column of w, B about (-sin, cos, 0) of w + C, and C about z."""

_SPEED = "speed{i} = counts_per_mm*(row_x*rate_x+row_y*rate_y+row_z*rate_z+row_a*rate_a+row_b*rate_b+row_c*rate_c)"


def pose_terms() -> list[Statement]:
    """Rotation and tip in {M} from the axes and the work frame."""
    return assignments(_POSE)


def length_of(strut: int, screw: bool) -> list[Statement]:
    """The counted length of a strut, mm, and the terms of its derivatives."""
    if screw:
        return assignments((_DISTANCE + _DIRECTION.lstrip() + _TWIST.lstrip()).format(i=strut))
    return [*assignments(_DISTANCE.format(i=strut)), Assign("length", f"distance-offset{strut}")]


def row_of(strut: int, screw: bool, row: int | str = "") -> list[Statement]:
    """The derivatives of the length just computed, by the six axes; ``row`` ends their names."""
    text = _PULL_OF_SCREW if screw else _DIRECTION + _PULL.lstrip()
    return assignments(text.format(i=strut) + _ROW.lstrip().format(row=row, radian=_RADIAN))


def counts_of(strut: int) -> Statement:
    """Counts of the motor at the length just computed."""
    return Assign(f"motor{strut}", f"counts_per_mm*(length-zero{strut})")


def residual_of(strut: int) -> Statement:
    """The length from the motor's counts minus the length just computed, mm."""
    return Assign(f"residual{strut}", f"motor{strut}/counts_per_mm+zero{strut}-length")


def speed_of(strut: int) -> Statement:
    """Speed of the motor from the rates of the axes, counts in the time unit of speeds."""
    return assignments(_SPEED.format(i=strut))[0]


def normal_equations() -> list[Statement]:
    """J^T J in s, lower half, and J^T times the residuals in ``step``, both by the six axes."""
    found: list[Statement] = []
    for row, axis in enumerate(AXES, start=1):
        for column, other in enumerate(AXES[:row], start=1):
            found.append(Assign(f"s{row}{column}", "+".join(f"row_{axis}{i}*row_{other}{i}" for i in STRUTS)))
        found.append(Assign(f"step{row}", "+".join(f"row_{axis}{i}*residual{i}" for i in STRUTS)))
    return found


def solution() -> list[Statement]:
    """Solve s step = step in place: s = L D L^T without pivots, as s is positive definite; then L, D and L^T in turn.

    Below the diagonal s becomes L, on it D.
    """
    found: list[Statement] = []
    for column in STRUTS:
        before = range(1, column)
        found += _less(f"s{column}{column}", [f"s{column}{k}*s{column}{k}*s{k}{k}" for k in before])
        for row in range(column + 1, 7):
            found += _less(f"s{row}{column}", [f"s{row}{k}*s{column}{k}*s{k}{k}" for k in before])
            found.append(Assign(f"s{row}{column}", f"s{row}{column}/s{column}{column}"))
    for row in STRUTS:
        found += _less(f"step{row}", [f"s{row}{k}*step{k}" for k in range(1, row)])
    found += [Assign(f"step{row}", f"step{row}/s{row}{row}") for row in STRUTS]
    for row in reversed(STRUTS):
        found += _less(f"step{row}", [f"s{k}{row}*step{k}" for k in range(row + 1, 7)])
    return found


def _less(target: str, products: list[str]) -> list[Statement]:
    return [Assign(target, "-".join([target, *products]))] if products else []


def regular() -> tuple[str, ...]:
    """Conditions for a solvable last step."""
    return tuple(f"s{row}{row}>least_pivot" for row in STRUTS)
