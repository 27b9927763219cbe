# SPDX-License-Identifier: LGPL-2.1-or-later
"""LinuxCNC: the configuration of a machine for LinuxCNC's hexapod kinematics, genhexkins, and for its streamer.

Input: a machine in mm and rad. Output: texts of the ini file, of HAL files with the geometry, with simulated drives and
with the streamer, and of the tool table, in mm and degrees. Joint i - 1 is strut i; its position is the distance of the
joint centres, corrected for the screw: counted length plus length offset. Tool lengths count from the plane of the
platform joints: ``spindle_nose`` plus gauge length, with ``genhexkins.spindle-offset`` at zero.

halstreamer puts the first row of a table on the pins at once. Here each strut's command passes two switches: it follows
the feedback until ``drives-on``, then holds its position, and takes the streamer's pins, counted lengths, once the
first row is within ``START_TOLERANCE`` of the command of all six struts. With any other first row ``stream-refused``
turns on, no further row is taken, and no strut moves.

Sources: LinuxCNC 2.9, ``src/emc/kinematics/genhexkins.c`` for the pins, manual pages streamer(9), near(9), logic(9),
flipflop(9), mux2(9), and2(9), not(9), "INI Configuration", "HAL Component List" and "Tool Table" for the rest.
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


START_TOLERANCE = 0.05
"""mm; posted programs start at a pose to the same length."""
DEPTH = 4000
"""Rows in the streamer's buffer: four seconds at a servo period of 1 ms."""
_STRUTS = range(6)


def stream_hal() -> str:
    """The HAL file, for a thread named servo-thread and signals strut-N-fb written by the drives."""
    return "\n".join([*_components(), *_start_interlock(), *_commands(), *_functions()]) + "\n"


def _components() -> list[str]:
    names = {
        "near": _each("near"),
        "mux2": [*_each("still"), *_each("command")],
        "and2": ["go", "row-there", "enable"],
        "not": ["filled", "far", "stop", "not-accepted", "not-refused"],
        "flipflop": ["accepted", "refused"],
    }
    return [
        "# A table for halstreamer moves the struts from where they are, or not at all.",
        "# The drives write strut-N-fb and drives-on, and take strut-N-cmd: counted lengths in mm, strut 1 is N = 0.",
        "# stream-start begins; stream-refused says that the first row is not where the struts are.",
        f"loadrt streamer depth={DEPTH} cfg=ffffff",
        *(f"loadrt {module} names={','.join(those)}" for module, those in names.items()),
        "# of six inputs, of three and of three: all of them",
        "loadrt logic names=all-near,accept,refuse personality=0x106,0x103,0x103",
        *(f"setp near-{strut}.difference {START_TOLERANCE}" for strut in _STRUTS),
    ]


def _each(name: str) -> list[str]:
    return [f"{name}-{strut}" for strut in _STRUTS]


def _start_interlock() -> list[str]:
    """Accept or refuse the first row; the result is latched until stream-start or drives-on goes off."""
    return [
        "# a row is on the pins when the streamer was enabled and had one; its enable is set at the period's end",
        "net stream-empty streamer.0.empty => filled.in",
        "net stream-filled filled.out => row-there.in0",
        "net stream-enable => row-there.in1",
        "net row-there row-there.out => accept.in-00 refuse.in-00",
        "net first-near all-near.and => far.in accept.in-01",
        "net first-far far.out => refuse.in-01",
        "net not-refused not-refused.out => accept.in-02 enable.in1",
        "net not-accepted not-accepted.out => refuse.in-02",
        "net stream-accept accept.and => accepted.set",
        "net stream-refuse refuse.and => refused.set",
        "net stream-accepted accepted.out => not-accepted.in",
        "net stream-refused refused.out => not-refused.in",
        "# begins with stream-start while drives-on, and begins again after either was off",
        "net stream-start => go.in0",
        "net drives-on => go.in1",
        "net stream-go go.out => stop.in enable.in0",
        "net stream-stop stop.out => accepted.reset refused.reset",
        "net stream-enable enable.out => streamer.0.enable",
    ]


def _commands() -> list[str]:
    """Feedback until the drives are on, then the last command, then the streamer's pins."""
    lines = ["# feedback while the drives are off, else the last command; the streamer's pins once the row is accepted"]
    lines.append("net drives-on => " + " ".join(f"still-{strut}.sel" for strut in _STRUTS))
    lines.append("net stream-accepted => " + " ".join(f"command-{strut}.sel" for strut in _STRUTS))
    for strut in _STRUTS:
        lines += [
            f"net strut-{strut}-fb => still-{strut}.in0",
            f"net strut-{strut}-cmd command-{strut}.out => still-{strut}.in1",
            f"net strut-{strut}-still still-{strut}.out => command-{strut}.in0 near-{strut}.in2",
            f"net strut-{strut}-row streamer.0.pin.{strut} => command-{strut}.in1 near-{strut}.in1",
            f"net strut-{strut}-near near-{strut}.out => all-near.in-{strut:02}",
        ]
    return lines


def _functions() -> list[str]:
    """In signal order, so that the result for the first row takes effect in the period in which it arrives."""
    order = [
        "go", "stop", *_each("still"), "streamer.0", *_each("near"), "all-near", "far", "filled", "row-there", "accept",
        "accepted", "not-accepted", "refuse", "refused", "not-refused", "enable", *_each("command"),
    ]  # fmt: skip
    return [f"addf {name} servo-thread" for name in order]
