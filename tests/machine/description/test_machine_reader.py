# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading a machine file: the preset against its own construction, and what every part of a file becomes."""

import hashlib
import math
import re
from pathlib import Path

import numpy as np
import pytest
from machines import spindle_axis_text, text_without_jerk

from pkm_post.machine.description.presets import find_machine
from pkm_post.machine.description.reader import machine_of, read_machine
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.model import SpindleAxis

MICRON = 1e-3
PRINTED_COORDINATE = 1e-4  # mm, joints are printed with 4 decimals
PRINTED_LENGTH = 0.06  # mm, lengths are printed with 1 decimal
PRINTED_SWING = 0.051  # deg, swings are printed with 1 decimal
BASE_AZIMUTHS = (12, 108, 132, 228, 252, 348)
PLATFORM_AZIMUTHS = (48, 72, 168, 192, 288, 312)
PRESET = find_machine("example_6tps")
TOOL = 120.0


@pytest.fixture(scope="module")
def machine():
    machine, diagnostics = read_machine(PRESET)
    assert diagnostics == ()
    return machine


def read_text(tmp_path: Path, text: str):
    path = tmp_path / "machine.toml"
    path.write_text(text, encoding="utf-8")
    machine, diagnostics = read_machine(path)
    assert diagnostics == ()
    return machine


def preset_with(old: str, new: str) -> str:
    text = PRESET.read_text(encoding="utf-8")
    assert text.count(old) == 1
    return text.replace(old, new)


def ring(radius, z, azimuths):
    angle = np.radians(azimuths)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(6, float(z))])


def tilted(tilt, azimuth):
    """Rotation that tilts the vertical by ``tilt`` towards ``azimuth`` without spin (rad)."""
    x, y = -math.sin(azimuth), math.cos(azimuth)
    cross = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(tilt) * cross + (1 - math.cos(tilt)) * cross @ cross


def struts(machine, tip_z, rotation):
    """Struts in {M} from base joint to platform joint, (6, 3) in mm."""
    above_tip = machine.platform_joints + [0, 0, machine.spindle_nose + TOOL]
    return [0, 0, tip_z] + above_tip @ rotation.T - machine.base_joints


def worst_swing_deg(direction, rest):
    direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return math.degrees(np.arccos(np.clip((direction * rest).sum(axis=1), -1, 1)).max())


def test_joints_of_the_example_stand_on_their_rings(machine):
    assert machine.base_joints == pytest.approx(ring(600, 1400, BASE_AZIMUTHS), abs=PRINTED_COORDINATE)
    assert machine.platform_joints == pytest.approx(ring(200, 0, PLATFORM_AZIMUTHS), abs=PRINTED_COORDINATE)


# Lengths computed for the ideal rings by a program of its own, printed with one decimal.
@pytest.mark.parametrize(("tip_z", "length"), [(0, 1282.9), (100, 1189.9), (200, 1098.1), (300, 1007.9), (400, 919.7)])
def test_struts_of_the_example_have_the_known_lengths(machine, tip_z, length):
    assert np.linalg.norm(struts(machine, tip_z, np.eye(3)), axis=1) == pytest.approx(length, abs=PRINTED_LENGTH)


# Swings from the same program: the worst over the six joints and over azimuths in steps of 15 deg, tip at z = 200.
# Between those azimuths the platform joints swing up to 0.04 deg more.
@pytest.mark.parametrize(
    ("tilt", "base", "platform"), [(15, 3.7, 18.4), (25, 6.3, 30.7), (30, 7.6, 36.8), (35, 8.9, 42.8)]
)
def test_joints_of_the_example_swing_by_the_known_angles(machine, tilt, base, platform):
    turns = [tilted(math.radians(tilt), math.radians(azimuth)) for azimuth in range(0, 360, 15)]
    along = [struts(machine, 200.0, turn) for turn in turns]
    base_swings = [worst_swing_deg(strut, machine.base_rest) for strut in along]
    platform_swings = [
        worst_swing_deg(-strut @ turn, machine.platform_rest) for strut, turn in zip(along, turns, strict=True)
    ]
    assert max(base_swings) == pytest.approx(base, abs=PRINTED_SWING)
    assert max(platform_swings) == pytest.approx(platform, abs=PRINTED_SWING)


def test_rest_axes_lie_along_the_struts_in_the_rest_pose(machine):
    along = struts(machine, 200.0, np.eye(3))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    assert machine.base_rest == pytest.approx(along, abs=1e-15)
    assert machine.platform_rest == pytest.approx(-along, abs=1e-15)


def test_motors_of_the_example_count_from_the_length_at_home(machine):
    at_home = np.linalg.norm(struts(machine, machine.home_tip[2], np.eye(3)), axis=1)
    assert machine.controller["zero_length"] == pytest.approx(at_home, abs=PRINTED_COORDINATE)


def test_numbers_arrive_in_mm_rad_and_s(machine):
    assert machine.name == "Example 6-TPS"
    assert machine.spindle_nose == 80.0
    assert machine.strut_stroke == (750.0, 1250.0)
    assert (machine.strut_speed, machine.strut_acceleration) == (500.0, 5000.0)
    assert machine.base_cone == pytest.approx(np.full(6, math.radians(25)))
    assert machine.platform_cone == pytest.approx(np.full(6, math.radians(45)))
    assert (machine.characteristic_length, machine.least_singular_value) == (200.0, 0.1)
    assert machine.home_tip.tolist() == [0.0, 0.0, 300.0]
    assert (machine.rapid_speed, machine.feed_speed, machine.tip_acceleration) == (250.0, 200.0, 2000.0)
    assert machine.axis_speed == pytest.approx(math.pi / 3)
    assert machine.spindle_speed == 24000.0


def test_fingerprint_is_the_digest_of_the_bytes(machine):
    assert machine.fingerprint == hashlib.sha256(PRESET.read_bytes()).hexdigest()


def test_controller_is_passed_through_with_its_codes(machine):
    assert machine.controller["kind"] == "turbo_pmac"
    assert machine.controller["letters"] == ("A", "B", "C", "U", "V", "W")
    assert machine.controller["counts_per_mm"] == 10000.0
    assert machine.controller["codes"]["tool_change"].format(value=7) == "T7 M6"
    assert machine.controller["codes"]["optional_stop"] == "M1"


@pytest.mark.parametrize(
    ("entry", "default"),
    [
        ("coordinate_system", 1),
        ("program", 10),
        ("length_decimals", 6),
        ("speed_decimals", 4),
        ("memory_words", 237568),
        ("line_limit", 159),
    ],
)
def test_controller_entries_may_be_left_to_their_defaults(tmp_path, entry, default):
    machine = read_text(tmp_path, preset_with(f"{entry} = {default}\n", ""))
    assert machine.controller[entry] == default


def test_work_offset_is_an_origin_turned_about_the_vertical(tmp_path):
    offset = "{ origin = [10.0, -20.0, 150.0], rotation_z = 30.0 }"
    machine = read_text(tmp_path, preset_with("{ origin = [0.0, 0.0, 150.0], rotation_z = 0.0 }", offset))
    half, long = 0.5, math.sqrt(3) / 2
    expected = [[long, -half, 0, 10], [half, long, 0, -20], [0, 0, 1, 150], [0, 0, 0, 1]]
    assert machine.work_offsets["G54"] == pytest.approx(np.array(expected), abs=1e-14)


def test_work_offset_without_a_turn_is_parallel_to_the_machine(tmp_path):
    machine = read_text(tmp_path, preset_with(", rotation_z = 0.0 }", " }"))
    assert machine.work_offsets["G54"][:3, :3].tolist() == np.eye(3).tolist()


def test_typed_matrix_becomes_the_nearest_rotation(tmp_path):
    rows = "[[0.866025, 0, 0.5, 7], [0, 1, 0, 8], [-0.5, 0, 0.866025, 9], [0, 0, 0, 1]]"
    machine = read_text(tmp_path, preset_with("[work_offsets]\n", f"[work_offsets]\nG55 = {{ matrix = {rows} }}\n"))
    pose = machine.work_offsets["G55"]
    assert list(machine.work_offsets) == ["G55", "G54"]
    assert pose[:3, :3] @ pose[:3, :3].T == pytest.approx(np.eye(3), abs=1e-15)
    assert pose[:3, :3] == pytest.approx(tilted(math.radians(30), 0.0), abs=1e-6)
    assert pose[:, 3].tolist() == [7.0, 8.0, 9.0, 1.0]
    with pytest.raises(ValueError, match="read-only"):
        pose[0, 0] = 2.0


def test_machine_without_work_offsets_has_none(tmp_path):
    text = preset_with("G54 = { origin = [0.0, 0.0, 150.0], rotation_z = 0.0 }\n", "")
    assert read_text(tmp_path, text).work_offsets == {}


def test_stated_rest_axes_take_the_place_of_computed_ones(tmp_path, machine):
    rows = ", ".join(["[0, 0, -2]"] * 6)
    text = preset_with("rest_tool_length = 120.0\n", f"rest_tool_length = 120.0\nbase_rest = [{rows}]\n")
    stated = read_text(tmp_path, text)
    assert stated.base_rest.tolist() == [[0.0, 0.0, -1.0]] * 6
    assert np.array_equal(stated.platform_rest, machine.platform_rest)


def test_entries_that_came_later_may_be_left_out(tmp_path):
    """A file as it could be written first: everything that was added since has a default that changes nothing."""
    text = text_without_jerk()
    text = text[: text.index("# Bodies for")] + text[text.index("[joints]") :]
    text = text[: text.index("# Cylinders")] + text[text.index("[singularity]") :]
    machine = read_text(tmp_path, text)
    assert (machine.strut_jerk, machine.tip_jerk) == (math.inf, math.inf)
    assert machine.length_offset.tolist() == [0.0] * 6
    assert (machine.base_joint_kind, machine.platform_joint_kind) == ("universal", "spherical")
    assert (machine.screw_lead, machine.clearance, machine.home_spin, machine.spindle_least_speed) == (0, 0, 0, 0)
    assert (machine.tube_radius, machine.tube_length, machine.rod_radius, machine.rod_length) == (0, 0, 0, 0)
    assert (machine.base_joint_radius, machine.platform_joint_radius) == (0, 0)
    assert (machine.bodies, machine.fixtures) == ((), ())
    assert machine.home_axis.tolist() == [0, 0, 1]
    assert (machine.strut_stiffness, machine.strut_rigidity) == (None, math.inf)


@pytest.mark.parametrize(
    ("section", "line", "attribute", "value"),
    [
        ("struts", "jerk = 1e5", "strut_jerk", 1e5),
        ("struts", "length_offset = [1, 2, 3, 4, 5, -6.5]", "length_offset", [1, 2, 3, 4, 5, -6.5]),
        ("struts", "rigidity = 2e8", "strut_rigidity", 2e8),
        ("joints", 'base_kind = "spherical"', "base_joint_kind", "spherical"),
        ("joints", 'platform_kind = "universal"', "platform_joint_kind", "universal"),
        ("tool_path", "home_axis = [0, 3, 4]", "home_axis", [0, 0.6, 0.8]),
        ("tool_path", "home_spin = -90", "home_spin", -math.pi / 2),
        ("spindle", "least_speed = 500", "spindle_least_speed", 500),
    ],
)
def test_later_entries_arrive(tmp_path, section, line, attribute, value):
    text = text_without_jerk().replace(f"[{section}]\n", f"[{section}]\n{line}\n")
    machine = read_text(tmp_path, text)
    found = getattr(machine, attribute)
    assert (found if isinstance(value, str) else np.asarray(found)) == pytest.approx(value)


def test_solids_of_the_example(machine):
    assert [(body.name, body.radius, body.start, body.end) for body in machine.bodies] == [
        ("platform", 150, -25, 25),
        ("spindle", 60, -80, 200),
        ("tool holder", 25, -130, -80),
    ]
    (table,) = machine.fixtures
    assert (table.name, table.lowest.tolist(), table.highest.tolist()) == ("table", [-500, -500, -100], [500, 500, 0])
    assert (machine.tube_radius, machine.tube_length, machine.rod_radius, machine.rod_length) == (32, 700, 20, 650)
    assert (machine.clearance, machine.base_joint_radius, machine.platform_joint_radius) == (2, 60, 45)
    assert machine.strut_stiffness == 1e5


def test_limits_of_jerk_of_the_example(machine):
    assert (machine.strut_jerk, machine.tip_jerk) == (1e6, 4e5)


def test_bodies_may_be_tables_of_their_own(tmp_path):
    start = PRESET.read_text(encoding="utf-8").index("bodies = [")
    end = PRESET.read_text(encoding="utf-8").index("fixtures = ")
    inline = PRESET.read_text(encoding="utf-8")[start:end]
    table = '[[interference.bodies]]\nname = "nose"\nradius = 60\nfrom = -80\nto = 0\n\n[singularity]\n'
    text = preset_with(inline, "").replace("[singularity]\n", table)
    (body,) = read_text(tmp_path, text).bodies
    assert (body.name, body.radius, body.start, body.end) == ("nose", 60, -80, 0)


def test_rest_pose_is_held_against_the_stroke_as_it_is_counted(tmp_path):
    """The struts are 1098.1 mm between their joints there; with an offset of 400 mm they count as 698.1."""
    offsets = preset_with("[struts]\n", "[struts]\nlength_offset = [0, 0, 400, 0, 0, 0]\n")
    path = tmp_path / "offset.toml"
    path.write_text(offsets.replace("rod_length = 650.0", "rod_length = 950.0"), encoding="utf-8")
    machine, (fault,) = read_machine(path)
    assert machine is None
    assert fault.code == "M106"
    assert "strut 3 is 698.1" in fault.found


def test_twist_at_rest_is_that_of_the_kinematics(tmp_path):
    """Two rooms that may not know each other have the same angle, and the stroke is that of the corrected length."""
    axes = "base_axes = [[1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0]]\n"
    axes += "platform_axes = [[1, 0.3, 0], [0, 1, 0], [1, 0, -0.2], [0.1, 1, 0], [1, 0, 0], [0, 1, 0]]\n"
    text = preset_with("[struts]\n", "[struts]\nscrew_lead = 10\n").replace(
        "[joints]\n", f'[joints]\nplatform_kind = "universal"\n{axes}'
    )
    machine = read_text(tmp_path, text)
    rest = np.array([[0.0, 0.0, 200.0]]), np.array([[0.0, 0.0, 1.0]]), np.zeros(1), np.array([TOOL])
    counted = strut_lengths(machine, *rest)[0]
    assert np.ptp(counted) > 0.1
    path = tmp_path / "machine.toml"
    path.write_text(text.replace("stroke = [750.0, 1250.0]", "stroke = [750.0, 900.0]"), encoding="utf-8")
    reported = read_machine(path)[1]
    found = [float(number) for number in re.findall(r"is (\d+\.\d{4}) mm long", reported[0].found)]
    assert found == pytest.approx(counted, abs=PRINTED_COORDINATE)


def test_right_angle_is_a_possible_cone(tmp_path):
    machine = read_text(tmp_path, preset_with("platform_cone = 45.0", "platform_cone = 90"))
    assert machine.platform_cone.tolist() == [math.pi / 2] * 6


def test_every_joint_may_have_a_cone_of_its_own(tmp_path):
    machine = read_text(tmp_path, preset_with("base_cone = 25.0", "base_cone = [20, 21, 22, 23, 24, 25.0]"))
    assert np.degrees(machine.base_cone) == pytest.approx([20, 21, 22, 23, 24, 25])


def test_a_spindle_that_is_an_axis_arrives_in_turns():
    machine, faults = machine_of(spindle_axis_text().encode(), "machine.toml")
    assert faults == ()
    assert machine.spindle_axis == SpindleAxis(7, "Z", 36000.0, 25.0, 200.0, 0.005)
    assert machine.controller["codes"]["spindle_axis"] == "M29"


@pytest.mark.parametrize(
    ("before", "after", "found"),
    [
        ('spindle_axis = "M29"\n', "", [("M103", "controller.codes.spindle_axis")]),
        ("acceleration = 200.0", "", [("M103", "spindle.axis.acceleration")]),
        ('letter = "Z"', 'letter = "U"', [("M106", "spindle.axis.letter")]),
        ("speed = 1500.0", "speed = 30000.0", [("M106", "spindle.axis.speed")]),
        ('kind = "turbo_pmac"', 'kind = "power_pmac"', [("M106", "spindle.axis.motor")]),
        ("motor = 7", "motor = 6", [("M104", "spindle.axis.motor")]),
    ],
)
def test_a_spindle_that_is_an_axis_is_stated_as_a_whole(before, after, found):
    text = spindle_axis_text()
    assert text.count(before) == 1
    _, faults = machine_of(text.replace(before, after).encode(), "machine.toml")
    assert [(fault.code, fault.found.split(": ")[0]) for fault in faults] == found


def test_a_byte_order_mark_says_nothing():
    content = PRESET.read_bytes()
    marked, faults = machine_of(b"\xef\xbb\xbf" + content, "machine.toml")
    assert faults == ()
    assert marked.fingerprint == hashlib.sha256(b"\xef\xbb\xbf" + content).hexdigest()
    (fault,) = machine_of(b"\xef\xbb\xbfname = ?", "machine.toml")[1]
    assert (fault.code, fault.place.line, fault.place.column) == ("M102", 1, 8)
