# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of a machine at home against numbers from elsewhere, and the commands that print them."""

import dataclasses

import numpy as np
import programs
import pytest

from pkm_post.cli import main
from pkm_post.geometry.vectors import unit
from pkm_post.machine import find_machine, jacobian_of_tip, presets, templates
from pkm_post.machine.description.reader import read_machine
from pkm_post.model import Refused
from pkm_post.posting.machine_check import at_home, home_faults, machine_summary
from pkm_post.posting.steps import post

PRINTED = 5.1e-2  # one decimal


def machine(name="example_6tps", **changes):
    return dataclasses.replace(read_machine(find_machine(name))[0], **changes)


def test_stiffness_is_the_known_one():
    # An independent script: struts of 100 N/um, tip at (0, 0, 200), tool vertical: 48.7 in x and y, 497.6 N/um in z.
    low = machine(home_tip=np.array([0.0, 0.0, 200.0]))
    assert at_home(low).stiffness / 1000 == pytest.approx([48.7, 48.7, 497.6], abs=PRINTED)
    assert at_home(machine(strut_stiffness=None)).stiffness is None


def test_condition_of_the_published_hexapod_is_the_known_one():
    # An independent script: 9.317 at (0, 0, 800) with a characteristic length of 125 mm.
    values = at_home(machine("nategh_agheli_nominal")).singular_values
    assert values[0] / values[-1] == pytest.approx(9.317, abs=5.1e-4)


def test_turning_rate_is_what_the_struts_allow():
    """About the axis that needs most of a strut, that strut runs at its speed; about no axis does one run faster."""
    one = machine()
    rate = at_home(one).turning_rate
    pose = one.home_tip[None], one.home_axis[None], np.zeros(1), np.array([one.rest_tool_length])
    axes = unit(np.random.default_rng(1).normal(size=(20000, 3)))
    fastest = np.abs(rate * axes @ jacobian_of_tip(one, *pose)[0, :, 3:].T).max()
    assert 0.99 * one.strut_speed < fastest <= one.strut_speed * (1 + 1e-12)


@pytest.mark.parametrize("name", presets())
def test_presets_can_stand_at_home(name):
    assert home_faults(machine(name), name) == ()
    assert all(label and figure for label, figure in machine_summary(machine(name)))


@pytest.mark.parametrize(
    ("changes", "found"),
    [
        ({"strut_stroke": (1010.0, 1250.0)}, "by 2.113 mm"),
        ({"strut_stroke": (750.0, 1000.0)}, "by 7.887 mm"),
        ({"base_cone": np.radians(1.0)}, "base joints: "),
        ({"platform_cone": np.radians(1.0)}, "platform joints: "),
        ({"least_singular_value": 0.6}, "singular poses: "),
        ({"clearance": 100.0}, "strut and strut: "),
    ],
)
def test_a_home_out_of_reach_is_reported(changes, found):
    reported = home_faults(machine(**changes), "m.toml")
    assert {item.code for item in reported} == {"M108"}
    assert any(found in item.found for item in reported)


def test_a_singular_home_has_no_condition():
    # With a spin of 90 degrees a hexapod of this kind is singular (Fichter 1986).
    rows = dict(machine_summary(machine(home_spin=np.pi / 2)))
    assert rows["  condition"].startswith("none")
    assert "  stiffness" not in rows


def test_the_command_prints_figures_and_ends_well(capsys):
    assert main(["machine", "check", "example_6tps"]) == 0
    reported = capsys.readouterr()
    assert reported.err == ""
    assert "Example 6-TPS: complete" in reported.out
    assert "1007.8869 mm" in reported.out
    assert "platform, spindle, tool holder" in reported.out


def test_the_command_says_what_a_template_needs(capsys):
    assert main(["machine", "check", "vamt1y"]) == 1
    reported = capsys.readouterr()
    assert reported.out == ""
    assert all("error M107" in line for line in reported.err.splitlines())
    assert "struts.stroke: expected 2 numbers" in reported.err


def test_the_list_tells_machines_from_templates(capsys):
    assert main(["machine", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[: len(presets())] == presets()
    assert [line.split(" (template")[0] for line in lines[len(presets()) :]] == templates()


def test_a_home_that_is_out_of_reach_is_a_warning(capsys, tmp_path):
    path = tmp_path / "far.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    path.write_text(text.replace("home_tip = [0.0, 0.0, 300.0]", "home_tip = [0.0, 0.0, 900.0]"), encoding="utf-8")
    assert main(["machine", "check", str(path)]) == 0
    assert "warning M108" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ('stop = "M0"', 'stop = "M1"', "got 'M1' for stop and optional_stop"),
        ('coolant_off = "M9"', 'coolant_off = "PVT3"', "controller.codes.coolant_off: "),
        ('stop = "M0"', 'stop = "A12"', "got A in 'A12'"),
    ],
)
def test_a_file_is_complete_only_where_a_program_can_be_written_for_it(capsys, tmp_path, old, new, found):
    path = tmp_path / "codes.toml"
    text = find_machine("example_6tps").read_text(encoding="utf-8")
    assert text.count(f"\n{old}") == 1
    path.write_text(text.replace(f"\n{old}", f"\n{new}"), encoding="utf-8")
    one, _ = read_machine(path)
    with pytest.raises(Refused) as refused:
        post(programs.square_with_arc(), one, tmp_path / "x.pmc")
    assert main(["machine", "check", str(path)]) == 1
    reported = capsys.readouterr()
    assert reported.out == ""
    assert f"{path}: error M104" in reported.err and found in reported.err
    assert [item.found for item in refused.value.diagnostics] == [
        reported.err.split("form: ")[1].rsplit("; correct", 1)[0]
    ]


def test_figures_of_the_drives_are_those_of_the_home_pose():
    rows = dict(machine_summary(machine()))
    assert rows["velocity gains"] == "50.0000 1/s"
    assert rows["points"] == "1 ms apart or more, at most 500 in a second"
    # No count moves the tip by more than the sum of the columns of J^-1.
    one = machine()
    pose = one.home_tip[None], one.home_axis[None], np.zeros(1), np.array([one.rest_tool_length])
    columns = np.linalg.norm(np.linalg.inv(jacobian_of_tip(one, *pose)[0])[:3], axis=0)
    most = at_home(one).count_at_tip * one.controller["counts_per_mm"]
    assert columns.max() < most <= columns.sum()
    silent = dict(machine_summary(machine(velocity_gain=None, block_rate=np.inf)))
    assert silent["velocity gains"].startswith("none stated") and silent["points"].endswith("no rate stated")


def test_a_job_that_is_out_of_reach_is_reported_of_a_home_that_is(tmp_path):
    far = machine(home_tip=np.array([0.0, 0.0, 900.0]))
    for one, codes in ((far, {"M108"}), (machine(), set())):
        with pytest.raises(Refused) as refused:
            post(programs.program([[0, 0, 60], [10, 0, 60], [600, 0, 60]]), one, tmp_path / "x.pmc")
        assert {item.code for item in refused.value.diagnostics} & {"M108"} == codes
        assert any(item.code.startswith("K1") for item in refused.value.diagnostics)
