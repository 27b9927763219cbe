# SPDX-License-Identifier: LGPL-2.1-or-later
"""LinuxCNC: the configuration of a machine for LinuxCNC's hexapod kinematics, genhexkins.

Input: a machine in mm and rad. Output: texts of the ini file, of HAL files with the geometry and with simulated
drives, and of the tool table, in mm and degrees. Joint i - 1 is strut i; its position is the distance of the joint
centres, corrected for the screw: counted length plus length offset. Tool lengths count from the plane of the platform
joints: ``spindle_nose`` plus gauge length, with ``genhexkins.spindle-offset`` at zero.

Sources: LinuxCNC 2.9, ``src/emc/kinematics/genhexkins.c`` for the pins, "INI Configuration", "HAL Component List" and
"Tool Table" of its documentation for the rest.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import Machine
from pkm_post.writing.controllers.pvt.decimals import plain
from pkm_post.writing.gcode.tool_axes import NOTATIONS, GcodeDialect

_COORDINATES = "xyz"
_LINEAR, _ROTARY = "XYZ", "ABC"


def ini_text(machine: Machine, stem: str, lengths: Sequence[float], tool_length: float) -> str:
    """The ini file.

    Args:
        machine: speeds and limits.
        stem: start of the names of the other files.
        lengths: counted strut lengths at home with the tool of the rest pose, mm.
        tool_length: gauge length of that tool, mm.
    """
    home = _home(machine, tool_length)
    sections = [
        ("EMC", (("VERSION", "1.1"), ("MACHINE", _printable(machine.name)), ("DEBUG", "0"))),
        ("DISPLAY", (("DISPLAY", "axis"), ("GEOMETRY", "XYZABC"), ("MAX_FEED_OVERRIDE", "1.0"))),
        ("TASK", (("TASK", "milltask"), ("CYCLE_TIME", "0.010"))),
        ("RS274NGC", (("PARAMETER_FILE", f"{stem}.var"), ("RS274NGC_STARTUP_CODE", "G21 G17 G90 G94 G40 G49 G80"))),
        ("EMCMOT", (("EMCMOT", "motmod"), ("SERVO_PERIOD", "1000000"))),
        ("EMCIO", (("EMCIO", "io"), ("CYCLE_TIME", "0.100"), ("TOOL_TABLE", f"{stem}.tbl"))),
        ("HAL", (("HALFILE", f"{stem}-simulated-drives.hal"), ("HALFILE", f"{stem}-kinematics.hal"))),
        ("KINS", (("KINEMATICS", "genhexkins"), ("JOINTS", "6"))),
        ("TRAJ", _trajectory(machine, home)),
        *(_axis(machine, letter) for letter in (*_LINEAR, *_ROTARY)),
        *(_joint(machine, joint, float(length)) for joint, length in enumerate(lengths)),
    ]
    return "\n".join(line for name, entries in sections for line in _section(name, entries))


def _section(name: str, entries: Iterable[tuple[str, str]]) -> list[str]:
    return [f"[{name}]", *(f"{key} = {value}" for key, value in entries), ""]


def _home(machine: Machine, tool_length: float) -> list[float]:
    """X Y Z of the platform origin and A B C at home: the position without an active tool length."""
    origin = machine.home_tip + (machine.spindle_nose + tool_length) * machine.home_axis
    roll_pitch_yaw = NOTATIONS[GcodeDialect.LINUXCNC].values
    angles = roll_pitch_yaw(machine.home_axis[None], np.array([machine.home_spin]))[0]
    return [*origin.tolist(), *angles.tolist()]


def _trajectory(machine: Machine, home: Sequence[float]) -> list[tuple[str, str]]:
    turning, turning_up = np.degrees(machine.axis_speed), np.degrees(_turning_acceleration(machine))
    linear, acceleration = max(machine.rapid_speed, machine.feed_speed), machine.tip_acceleration
    return [
        ("COORDINATES", "X Y Z A B C"),
        ("LINEAR_UNITS", "mm"),
        ("ANGULAR_UNITS", "degree"),
        ("HOME", " ".join(_number(value) for value in home)),
        ("DEFAULT_LINEAR_VELOCITY", _number(machine.feed_speed)),
        ("MAX_LINEAR_VELOCITY", _number(linear)),
        ("DEFAULT_LINEAR_ACCELERATION", _number(acceleration)),
        ("MAX_LINEAR_ACCELERATION", _number(acceleration)),
        ("DEFAULT_ANGULAR_VELOCITY", _number(turning)),
        ("MAX_ANGULAR_VELOCITY", _number(turning)),
        ("DEFAULT_ANGULAR_ACCELERATION", _number(turning_up)),
        ("MAX_ANGULAR_ACCELERATION", _number(turning_up)),
    ]


def _axis(machine: Machine, letter: str) -> tuple[str, list[tuple[str, str]]]:
    if letter in _LINEAR:
        rates = machine.rapid_speed, machine.tip_acceleration
    else:
        rates = np.degrees(machine.axis_speed), np.degrees(_turning_acceleration(machine))
    speed, acceleration = (_number(rate) for rate in rates)
    return f"AXIS_{letter}", [("MAX_VELOCITY", speed), ("MAX_ACCELERATION", acceleration)]


def _turning_acceleration(machine: Machine) -> float:
    """rad/s^2 at which the outermost platform joint has the acceleration of a strut."""
    return float(machine.strut_acceleration / norm(machine.platform_joints).max())


def _joint(machine: Machine, joint: int, length: float) -> tuple[str, list[tuple[str, str]]]:
    offset = float(machine.length_offset[joint])
    shortest, longest = machine.strut_stroke
    return f"JOINT_{joint}", [
        ("TYPE", "LINEAR"),
        ("MIN_LIMIT", _number(shortest + offset)),
        ("MAX_LIMIT", _number(longest + offset)),
        ("MAX_VELOCITY", _number(machine.strut_speed)),
        ("MAX_ACCELERATION", _number(machine.strut_acceleration)),
        ("HOME", _number(length + offset)),
        ("HOME_OFFSET", _number(length + offset)),
        ("HOME_SEQUENCE", "0"),
    ]


def kinematics_hal(machine: Machine) -> str:
    """Geometry of the machine on the pins of genhexkins, and the active tool length."""
    lines = ["# Geometry for genhexkins: base joints in {M}, platform joints in {T}, mm"]
    lines += _points("base", machine.base_joints) + _points("platform", machine.platform_joints)
    lines.append(f"setp genhexkins.screw-lead {_number(machine.screw_lead)}")
    if machine.screw_lead != 0.0:
        lines.append("# Axes of the universal joints, fixed to the base and to the platform")
        lines += _points("base-n", machine.base_axes) + _points("platform-n", machine.platform_axes)
    lines += [
        "# Tool lengths count from the plane of the platform joints",
        "setp genhexkins.spindle-offset 0",
        "net tool-length motion.tooloffset.z => genhexkins.tool-offset",
        "setp genhexkins.convergence-criterion 0.000000001",
    ]
    return "\n".join(lines) + "\n"


def _points(pin: str, points: Array) -> list[str]:
    return [
        f"setp genhexkins.{pin}.{row}.{coordinate} {_number(value)}"
        for row, point in enumerate(points.tolist())
        for coordinate, value in zip(_COORDINATES, point, strict=True)
    ]


def simulated_drives_hal() -> str:
    """Drives that follow exactly, tools that change at once, and no emergency stop."""
    lines = [
        "# Simulated drives: to be replaced by those of the machine",
        "loadrt [KINS]KINEMATICS",
        "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS",
        "addf motion-command-handler servo-thread",
        "addf motion-controller servo-thread",
        *(f"net strut-{joint} joint.{joint}.motor-pos-cmd => joint.{joint}.motor-pos-fb" for joint in range(6)),
        "net emergency-stop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in",
        "net tool-prepared iocontrol.0.tool-prepare => iocontrol.0.tool-prepared",
        "net tool-changed iocontrol.0.tool-change => iocontrol.0.tool-changed",
    ]
    return "\n".join(lines) + "\n"


def tool_table(machine: Machine, tool_length: float) -> str:
    """A tool table with only the tool of the rest pose."""
    length, nose = _number(machine.spindle_nose + tool_length), _number(machine.spindle_nose)
    return f"T1 P1 Z{length} D0 ; gauge length {_number(tool_length)} and {nose} to the platform joints\n"


def _number(value: float) -> str:
    return plain(round(float(value), 9))


def _printable(text: str) -> str:
    return "".join(character if " " <= character <= "~" else "?" for character in text)
