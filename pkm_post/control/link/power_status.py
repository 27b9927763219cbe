# SPDX-License-Identifier: LGPL-2.1-or-later
"""Power status: the state of the six struts of a Power PMAC, as ``status.Status``.

Its bits differ in position from those of a Turbo PMAC, in two words of 32, and elements of its data structure show
whether a program runs. Bits are counted from the least significant one of all hexadecimal digits.
[EPICSpmac, pmacHardwarePower]

Enters: the settings of a controller, and its answers. Leaves: the query for ``status.read_status``, counts, bits, and
their meanings.
"""

from __future__ import annotations

from pkm_post.control.link.status import MOTORS, MotorBits, Status, SystemBits, hexadecimal, lengths_and_errors
from pkm_post.writing import PowerPmacSettings

_ELEMENTS = ("ProgRunning", "FeedHold", "ErrorStatus")
_STATUS_BITS = 64


class PowerMotorBits(MotorBits):
    """Two words of 32 bits: ``#n?``. They have a bit for the closed loop, not for the open loop; see ``_motor``."""

    DIGITS = 16
    PLACES = {
        "homing": 62, "negative_limit": 61, "positive_limit": 60, "warning_following_error": 59,
        "fatal_following_error": 58, "stopped_on_limit": 57, "amplifier_fault": 56, "lower_soft_limit": 55,
        "upper_soft_limit": 54, "homed": 47, "standing": 46, "closed_loop": 45, "amplifier_enabled": 44,
        "in_position": 43, "open_loop": _STATUS_BITS,
    }  # fmt: skip
    TOLD = MotorBits.TOLD | {
        "lower_soft_limit": "on its lower soft limit",
        "upper_soft_limit": "on its upper soft limit",
    }


class PowerSystemBits(SystemBits):
    """Two words of 32 bits: ``&n?``; above them one bit for each of three elements, set if it is not 0."""

    DIGITS = 16
    PLACES = {
        "negative_limit": 61, "positive_limit": 60, "warning_following_error": 59, "fatal_following_error": 58,
        "amplifier_fault": 56, "running": _STATUS_BITS, "held": _STATUS_BITS + 1, "runtime_error": _STATUS_BITS + 2,
    }  # fmt: skip
    TOLD = {name: text for name, text in SystemBits.TOLD.items() if name != "limit"} | {
        "negative_limit": "a lower limit was met",
        "positive_limit": "an upper limit was met",
    }


def query(settings: PowerPmacSettings) -> str:
    """The query line for the complete state."""
    system = settings.coordinate_system
    return " ".join(
        [
            *(f"#{motor}? #{motor}p #{motor}f" for motor in MOTORS),
            f"&{system}? &{system}%",
            *(f"Coord[{system}].{name}" for name in _ELEMENTS),
        ]
    )


def status_of(told: tuple[str, ...], settings: PowerPmacSettings) -> Status:
    """Parse the lines of the answer.

    Raises:
        ValueError: they make no sense.
    """
    expected = 3 * len(MOTORS) + 2 + len(_ELEMENTS)
    if len(told) != expected:
        raise ValueError(f"expected {expected} lines, got {len(told)}")
    motors = tuple(_motor(hexadecimal(line, PowerMotorBits.DIGITS)) for line in told[0:18:3])
    bits = hexadecimal(told[18], PowerSystemBits.DIGITS)
    for place, value in enumerate(told[20:], start=_STATUS_BITS):
        bits |= int(float(value) != 0) << place
    length, error = lengths_and_errors(told, settings)
    return Status(motors, PowerSystemBits(bits), float(told[19]), length, error, slows_in_a_hold=False)


def _motor(value: int) -> PowerMotorBits:
    is_closed = value >> PowerMotorBits.PLACES["closed_loop"] & 1
    return PowerMotorBits(value | (1 - is_closed) << PowerMotorBits.PLACES["open_loop"])
