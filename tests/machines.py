# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines for the tests: the assumed example, LinuxCNC's genhexkins default, and the Nategh-Agheli hexapod."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from pkm_post.machine import find_machine
from pkm_post.model import Machine, ToolChange

INCH = 25.4
LEAD = 10.0
"""mm: lead of the screws of ``screwed``."""
JERKS = re.compile(r"^(?:tip_)?jerk = .*\n", re.MULTILINE)


def machine(base, platform, reach=0.0, stroke=(0.0, np.inf), characteristic_length=200.0) -> Machine:
    """A machine of joints alone: limits wide open, rest axes along the struts of an upright platform."""
    base, platform = np.asarray(base, dtype=float), np.asarray(platform, dtype=float)
    upright = np.tile([0.0, 0.0, 1.0], (6, 1))
    return Machine(
        name="test", fingerprint="0" * 64, base_joints=base, platform_joints=platform, spindle_nose=reach,
        strut_stroke=stroke, strut_speed=500.0, strut_acceleration=5000.0, base_rest=-upright, base_cone=np.pi,
        platform_rest=upright, platform_cone=np.pi, characteristic_length=characteristic_length,
        least_singular_value=0.0, home_tip=np.array([0.0, 0.0, 300.0]), rapid_speed=250.0, feed_speed=200.0,
        tip_acceleration=2000.0, axis_speed=1.0, spindle_speed=24000.0, work_offsets={"G54": np.eye(4)},
        controller={},
    )  # fmt: skip


def ring(radius, angles_deg, z):
    angles = np.radians(angles_deg)
    return np.column_stack([radius * np.cos(angles), radius * np.sin(angles), np.full(6, z)])


def example() -> Machine:
    """The assumed example machine, from its ring formulas, without limits of jerk.

    Its platform plane is 80 mm above the spindle nose.
    """
    base = ring(600, [12, 108, 132, 228, 252, 348], 1400)
    platform = ring(200, [48, 72, 168, 192, 288, 312], 0)
    return machine(base, platform, reach=80.0, stroke=(750.0, 1250.0))


def without_jerk(stated: Machine) -> Machine:
    """A machine whose plans are the fastest without limits of jerk; for what is tested of these plans."""
    return replace(stated, strut_jerk=np.inf, tip_jerk=np.inf)


def text_without_jerk(text=None) -> str:
    """The text of a machine file, by default the example's, without limits of jerk."""
    text, count = JERKS.subn("", text or find_machine("example_6tps").read_text(encoding="utf-8"))
    assert count == 2
    return text


def genhexkins() -> Machine:
    """LinuxCNC's default hexapod, converted from inches."""
    base = np.array([[-22.95, 13.25], [22.95, 13.25], [22.95, 13.25], [0, -26.5], [0, -26.5], [-22.95, 13.25]])
    platform = np.array([[-1, 11.5], [1, 11.5], [10.459, -4.884], [9.459, -6.616], [-9.459, -6.616], [-10.459, -4.884]])
    flat = np.zeros((6, 1))
    return machine(np.hstack([base, flat]) * INCH, np.hstack([platform, flat]) * INCH)


def nategh() -> Machine:
    """The hexapod machine tool of Nategh and Agheli (2009), nominal geometry."""
    return machine(
        ring(325, [20, 100, 140, 220, 260, 340], 0),
        ring(125, [42.5, 77.5, 162.5, 197.5, 282.5, 317.5], 0),
        characteristic_length=125.0,
    )


def screwed(machine):
    """The machine with universal joints at both ends and no keys: its screws turn with the joints."""
    base = np.tile([1.0, 0.0, 0.0], (6, 1))
    platform = np.tile([np.cos(0.2), np.sin(0.2), 0.0], (6, 1))
    return replace(
        machine, base_axes=base, platform_axes=platform, screw_lead=LEAD, platform_joint_kind="universal",
    )  # fmt: skip


def direction(tilt_deg, azimuth_deg):
    tilt, azimuth = np.radians(tilt_deg), np.radians(azimuth_deg)
    return np.array([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])


def axis_and_spin(rotation):
    """The tool axis and spin that give a rotation matrix; for poses published as Euler angles."""
    from pkm_post.machine import platform_rotation

    axis = rotation[:, 2]
    rest = platform_rotation(axis[None], np.zeros(1))[0].T @ rotation
    return axis, np.arctan2(rest[1, 0], rest[0, 0])


def rotation_about(coordinate, degrees):
    angle = np.radians(degrees)
    i, j = [(1, 2), (2, 0), (0, 1)][coordinate]
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[i, j], matrix[j, i] = -np.sin(angle), np.sin(angle)
    return matrix


def random_poses(rng, count, tilt_deg=30.0):
    """Poses inside the example machine: tip, axis, spin, gauge length."""
    tip = rng.uniform([-100, -100, 150], [100, 100, 350], (count, 3))
    tilt, azimuth = rng.uniform(0, tilt_deg, count), rng.uniform(0, 360, count)
    axis = direction(tilt, azimuth).T
    return tip, axis, np.radians(rng.uniform(-20, 20, count)), np.full(count, 120.0)


def with_tool_change(stated: Machine, **changes) -> Machine:
    """A machine with a tool-change pose beside the middle of the example's workspace, tilted and spun."""
    pose = {
        "nose": np.array([90.0, -60.0, 460.0]), "axis": direction(8.0, 30.0), "spin": np.radians(7.0),
        "safe_height": 270.0,
    }  # fmt: skip
    return replace(stated, tool_change=ToolChange(**(pose | changes)))


SPINDLE_AXIS = """
[spindle.axis]
motor = 7
letter = "Z"
counts_per_turn = 36000.0
speed = 1500.0
acceleration = 200.0
lead_tolerance = 0.005
"""
SPINDLE_CODES = 'spindle_axis = "M29"\nspindle_speed = "M28"\n'


def spindle_axis_text(table=SPINDLE_AXIS, codes=SPINDLE_CODES) -> str:
    """The example's machine file with a spindle that is an axis."""
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    assert text.count('optional_stop = "M1"\n') == 1
    return text.replace('optional_stop = "M1"\n', f'optional_stop = "M1"\n{codes}') + table


TOOL_CHANGE_TABLES = """
spin_up_time = 2.0
spin_down_time = 3.0
largest_tool_diameter = 40.0
longest_tool = 180.0

[tool_change]
nose = [90.0, -60.0, 460.0]
axis = [0.1, 0.06, 1.0]
spin = 7.0
safe_height = 270.0
"""


def tool_change_file(folder) -> Path:
    """The example's machine file with a tool-change pose, spindle times and the largest tool."""
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    assert text.count("speed = 24000.0\n") == 1
    made = folder / "changes_tools.toml"
    made.write_text(text.replace("speed = 24000.0\n", "speed = 24000.0\n" + TOOL_CHANGE_TABLES), encoding="utf-8")
    return made
