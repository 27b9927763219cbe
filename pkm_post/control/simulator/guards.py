# SPDX-License-Identifier: LGPL-2.1-or-later
"""Guards: motors out of bounds: limits, switches, following errors, amplifiers.

Enters: the motors. Leaves: columns (6,) of booleans.
"""

from __future__ import annotations

import numpy as np

from pkm_post.control.simulator.motors import Motors
from pkm_post.control.simulator.variables import Array

LIMITS_DISABLED, WORD = 0x20000, 1 << 24
"""LIMITS_DISABLED is a bit of Ixx24, which is a word of 24 bits."""


def beyond_limits(motors: Motors) -> Array:
    """Which motors move further beyond a limit or into a switch, (6,)."""
    high, low = at_limits(motors)
    searching = np.array([jog is not None and jog.homing for jog in motors.jogs])
    outside = (motors.high_switch | high & ~searching) & (motors.speed > 0)
    return outside | (motors.low_switch | low & ~searching) & (motors.speed < 0)


def at_limits(motors: Motors) -> tuple[Array, Array]:
    """Which motors are beyond Ixx13, and which beyond Ixx14; 0 means no limit, and a bit of Ixx24 disables all."""
    high, low = motors.variables.column(13), motors.variables.column(14)
    heeded = (np.abs(motors.variables.column(24)) % WORD).astype(np.int64) & LIMITS_DISABLED == 0
    return heeded & (high != 0) & (motors.actual > high), heeded & (low != 0) & (motors.actual < low)


def exceeded(motors: Motors) -> Array:
    """Which closed-loop motors have a following error above Ixx11, (6,)."""
    limit = motors.variables.column(11) / 16
    return motors.closed & (limit > 0) & (np.abs(motors.following_error) > limit)


def warned(motors: Motors) -> Array:
    """Which motors have a following error above Ixx12, (6,)."""
    limit = motors.variables.column(12) / 16
    return (limit > 0) & (np.abs(motors.following_error) > limit)


def in_position(motors: Motors) -> Array:
    """Which motors rest at their commanded position within Ixx28, (6,)."""
    near = np.abs(motors.following_error) <= motors.variables.column(28) / 16
    return near & ~motors.moving() & motors.closed
