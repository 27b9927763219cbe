# SPDX-License-Identifier: LGPL-2.1-or-later
"""Status: 24-bit words with the state of a motor or a coordinate system.

Only bits that clients of the Turbo PMAC rely on are set [TurboPMAC, #?, ??; EPICSpmac]. All others are zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from pkm_post.control.simulator import guards
from pkm_post.control.simulator.moves import Cubic
from pkm_post.control.simulator.numerals import hexadecimal
from pkm_post.control.simulator.variables import SIMULATED_MOTORS

if TYPE_CHECKING:
    from pkm_post.control.simulator.controller import Controller


def motor_status(controller: Controller, motor: int) -> str:
    """The answer to ``#n?``: two words."""
    if motor > SIMULATED_MOTORS:
        return hexadecimal(0, 0)
    motors, index = controller.motors, motor - 1
    high, low = guards.at_limits(motors)
    jog = motors.jogs[index]
    system = controller.system_of(motor)
    first = {
        23: motors.activated[index],
        22: low[index] or motors.low_switch[index],
        21: high[index] or motors.high_switch[index],
        19: motors.enabled[index],
        18: not motors.closed[index],
        13: motors.speed[index] == 0,
        10: jog is not None and jog.homing,
    }
    second = {
        15: system is not None,
        11: motors.stopped_on_limit[index],
        10: motors.homed[index],
        3: motors.amplifier_fault[index],
        2: motors.fatal[index],
        1: guards.warned(motors)[index],
        0: guards.in_position(motors)[index],
    }
    number = (system.number - 1) << 20 if system is not None else 0
    return hexadecimal(_word(first), _word(second) | number)


def system_status(controller: Controller, number: int) -> str:
    """The answer to ``&n??``: three words."""
    system, motors = controller.systems[number - 1], controller.motors
    indices = system.axes.indices()
    first = {0: system.running, 2: system.running and not system.stepping, 4: system.running and not system.stepping}
    second = {
        23: system.holding,
        22: system.runtime_error,
        20: motors.amplifier_fault[indices].any(),
        19: motors.fatal[indices].any(),
        18: guards.warned(motors)[indices].any(),
        17: bool(indices) and guards.in_position(motors)[indices].all() and not system.running,
        16: controller.rotary_full(number),
        4: isinstance(system.path.current(), Cubic),
    }
    third = {1: motors.stopped_on_limit[indices].any()}
    return hexadecimal(_word(first), _word(second), _word(third))


def global_status(controller: Controller) -> str:
    """The answer to ``???``: two words. None of the faults they report can occur in a simulation."""
    return hexadecimal(0, 0)


def _word(bits: Mapping[int, object]) -> int:
    return sum(1 << bit for bit, is_set in bits.items() if is_set)
