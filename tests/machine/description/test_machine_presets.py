# SPDX-License-Identifier: LGPL-2.1-or-later
"""Presets are found by name, other machine files by path; presets have the numbers that were published of them."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from machines import axis_and_spin, direction, rotation_about

from pkm_post.machine.description.fields import FIELDS, REQUIRED
from pkm_post.machine.description.presets import find_machine, presets, templates
from pkm_post.machine.description.reader import read_machine
from pkm_post.machine.kinematics.forward import forward
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.kinematics.jacobian import scaled_jacobian

INCH = 25.4
PRINTED = 5.1e-5
"""mm: lengths that were printed with four decimals."""
PRINTED_JOINTS = 1.5e-4
"""mm: the same for joints that were printed with four decimals as well."""
PRINTED_SHIFT = 5.1e-4


def preset(name):
    machine, diagnostics = read_machine(find_machine(name))
    assert diagnostics == ()
    return machine


def lengths(machine, tip, axis, spin, tool_length=0.0):
    return strut_lengths(machine, np.array([tip], float), axis[None], np.array([spin]), np.array([tool_length]))[0]


def test_the_machines_that_come_with_the_add_on():
    assert presets() == [
        "example_6tps",
        "linuxcnc_genhexkins",
        "nategh_agheli_calibrated",
        "nategh_agheli_nominal",
    ]
    assert templates() == ["vamt1y", "xnz63"]


@pytest.mark.parametrize("name", presets())
def test_every_preset_reads_without_fault(name):
    assert preset(name) is not None


@pytest.mark.parametrize("name", templates())
def test_every_template_is_refused_entry_by_entry(name):
    machine, diagnostics = read_machine(find_machine(name))
    assert machine is None
    assert {item.code for item in diagnostics} == {"M107"}
    known = {"name", "units.length", "units.angle", "units.time", "controller.kind"}
    required = {field.entry for field in FIELDS if field.default is REQUIRED} - known
    assert {item.found.split(": ")[0] for item in diagnostics} == required | {"work_offsets.G54.origin"}
    text = find_machine(name).read_text(encoding="utf-8").split("\n")
    assert all('= "unknown"' in text[item.place.line - 1] or "G54" in text[item.place.line - 1] for item in diagnostics)


@pytest.mark.parametrize("name", templates())
def test_filled_in_template_is_a_machine(name, tmp_path):
    """Every "unknown" replaced by what the example has, also those that are commented out."""
    example = tomllib.loads(find_machine("example_6tps").read_text(encoding="utf-8"))
    example["struts"] |= {"jerk": 1e5, "screw_lead": 0.0}
    section, filled = [], []
    for line in find_machine(name).read_text(encoding="utf-8").split("\n"):
        line = line.removeprefix("# ") if line.endswith('= "unknown"') else line
        section = line.strip("[]").split(".") if line.startswith("[") else section
        key = line.split(" = ")[0]
        if line.startswith("G54"):
            line = "G54 = { origin = [0.0, 0.0, 150.0] }"
        elif line.endswith('= "unknown"'):
            table = example
            for part in section:
                table = table[part]
            value = table[key]
            line = f"{key} = {value!r}" if not isinstance(value, str) else f'{key} = "{value}"'
        filled.append(line)
    path = tmp_path / "filled.toml"
    path.write_text("\n".join(filled), encoding="utf-8")
    machine, diagnostics = read_machine(path)
    assert diagnostics == ()
    assert machine.base_joints.tolist() == example["base"]["joints"]
    assert (machine.base_joint_kind, machine.platform_joint_kind) == ("universal", "spherical")


@pytest.mark.parametrize("path", ["here.toml", "HERE.TOML", "machines/here", "C:\\machines\\here", "./example_6tps"])
def test_path_is_used_as_it_is(path):
    assert find_machine(path) == Path(path)


@pytest.mark.parametrize("name", ["unknown", "", "*", "EXAMPLE_6TPS", "..", "templates"])
def test_unknown_name_finds_nothing(name):
    assert find_machine(name) is None


# Pose (x, y, z in inches; A, B, C in degrees), lengths in inches: LinuxCNC's genhexkins with its default geometry.
@pytest.mark.parametrize(
    ("tip", "angles", "expected", "printed"),
    [
        ((0, 0, 20), (0, 0, 0), (29.74668, 29.74668, 29.74671, 29.74636, 29.74636, 29.74671), 5.1e-6),
        ((1.5, -2, 21), (5, -8, 12), (30.583140, 32.152049, 30.148660, 31.941150, 25.764859, 33.062423), 5.1e-7),
    ],
)
def test_genhexkins_preset_has_the_lengths_of_linuxcnc(tip, angles, expected, printed):
    roll, pitch, yaw = angles
    pose = axis_and_spin(rotation_about(2, yaw) @ rotation_about(1, pitch) @ rotation_about(0, roll))
    found = lengths(preset("linuxcnc_genhexkins"), np.array(tip) * INCH, *pose)
    np.testing.assert_allclose(found / INCH, expected, atol=printed, rtol=0)


def test_genhexkins_preset_is_at_home_where_linuxcnc_says():
    # HOME_OFFSET of every joint in LinuxCNC's hexapod.ini, four decimals
    machine = preset("linuxcnc_genhexkins")
    found = lengths(machine, machine.home_tip, machine.home_axis, machine.home_spin)
    np.testing.assert_allclose(found, np.array(machine.controller["zero_length"]), atol=3e-4 * INCH, rtol=0)


# Tip in mm, (a, b, c) in degrees with R = Rx(a) Ry(b) Rz(c), condition of the Jacobian with a characteristic length of
# 125 mm: an independent script with the joint tables of Nategh and Agheli (2009).
@pytest.mark.parametrize(
    ("tip", "angles", "expected", "condition"),
    [
        ((0, 0, 800), (0, 0, 0), (828.3627,) * 6, 9.317),
        ((100, 50, 800), (10, -5, 0), (830.6364, 856.9671, 837.5555, 846.4620, 840.2568, 804.9900), 10.163),
        ((-80, 120, 900), (0, 20, 5), (928.8214, 897.6917, 945.3281, 982.5024, 943.4544, 927.1083), 12.156),
    ],
)
def test_nominal_preset_has_the_known_lengths_and_condition(tip, angles, expected, condition):
    a, b, c = angles
    axis, spin = axis_and_spin(rotation_about(0, a) @ rotation_about(1, b) @ rotation_about(2, c))
    machine = preset("nategh_agheli_nominal")
    np.testing.assert_allclose(lengths(machine, tip, axis, spin), expected, atol=PRINTED_JOINTS, rtol=0)
    pose = np.array([tip], float), axis[None], np.array([spin]), np.zeros(1)
    assert np.linalg.cond(scaled_jacobian(machine, *pose)[0]) == pytest.approx(condition, abs=5.1e-4)


def test_calibrated_preset_is_where_a_machine_that_was_not_calibrated_goes():
    """The same script: sent to (0, 0, 800) with nominal lengths, the real machine lands 43 mm and 5.27 deg away."""
    nominal, real = preset("nategh_agheli_nominal"), preset("nategh_agheli_calibrated")
    home = np.array([[0.0, 0.0, 800.0]]), np.array([[0.0, 0.0, 1.0]]), np.zeros(1)
    sent = strut_lengths(nominal, *home, np.zeros(1))
    landed = forward(real, sent, np.zeros(1), *home)
    assert landed.converged.all()
    np.testing.assert_allclose(landed.tip[0] - home[0][0], (41.208, 13.592, 1.550), atol=PRINTED_SHIFT, rtol=0)
    turned = np.degrees(np.arccos((np.trace(landed.rotation[0]) - 1) / 2))
    assert turned == pytest.approx(5.27, abs=5.1e-3)


# Tip, (tilt, azimuth, spin) in degrees, lengths in mm, then determinant, condition and smallest singular value of the
# Jacobian with a length of 200 mm: an independent script for the assumed machine.
@pytest.mark.parametrize(
    ("tip", "angles", "expected", "of_jacobian"),
    [
        (
            (30, -40, 250),
            (20, 35, 10),
            (1102.4037, 1116.2497, 1048.4513, 1020.2956, 1095.1151, 1041.2776),
            (-1.17981, 4.8344, 0.46087),
        ),
        (
            (0, 150, 200),
            (25, 0, 0),
            (1153.9999, 1118.5095, 1017.9289, 1130.8235, 1216.2718, 1147.7747),
            (-0.93006, 5.3963, 0.41685),
        ),
        (
            (0, 150, 200),
            (25, 0, -21),
            (1151.7802, 1169.1149, 1022.2133, 1167.1682, 1169.6207, 1139.9719),
            (-0.83188, 5.6377, 0.40256),
        ),
        (
            (-80, 60, 320),
            (28, 200, -15),
            (1014.8398, 918.4429, 1021.9476, 1106.5066, 1014.1873, 1114.0934),
            (-0.99318, 5.3141, 0.41748),
        ),
    ],
)
def test_example_preset_has_the_known_lengths(tip, angles, expected, of_jacobian):
    tilt, azimuth, spin = angles
    machine, axis = preset("example_6tps"), direction(tilt, azimuth)
    found = lengths(machine, tip, axis, np.radians(spin), 120.0)
    np.testing.assert_allclose(found, expected, atol=PRINTED + PRINTED_JOINTS, rtol=0)
    pose = np.array([tip], float), axis[None], np.radians([spin]), np.array([120.0])
    jacobian = scaled_jacobian(machine, *pose)[0]
    values = np.linalg.svd(jacobian, compute_uv=False)
    found = np.linalg.det(jacobian), values[0] / values[-1], values[-1]
    assert np.abs(np.subtract(found, of_jacobian)) == pytest.approx([0, 0, 0], abs=1e-4)
