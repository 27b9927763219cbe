# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report on a whole trajectory: places, units, cells, and what arcs do between their ends."""

import dataclasses
import json

import numpy as np
import pytest
from programs import ON_PALLET, cone, program, random_job, square_with_arc

from pkm_post.machine.description.presets import find_machine
from pkm_post.machine.description.reader import read_machine
from pkm_post.machine.kinematics.inverse import strut_lengths
from pkm_post.machine.reach.collision_mesh import CollisionMesh
from pkm_post.machine.reach.report import check_reach, pose_path_of
from pkm_post.model import Kind
from pkm_post.model.machine import Box
from pkm_post.planning.tool_path import ToolPath
from pkm_post.toolpath.place import place

MICRON = 1e-3
NANOMETRE = 1e-6
SHARES = np.linspace(0.0, 1.0, 21)


@pytest.fixture(scope="module")
def machine():
    return read_machine(find_machine("example_6tps"))[0]


def placed(job, machine):
    trajectory, faults = place(job, machine, ON_PALLET)
    assert trajectory is not None, faults
    return trajectory


def finding(report, name):
    return next(finding for finding in report.findings if finding.subject.name == name)


@pytest.mark.parametrize("job", [cone(), square_with_arc(), random_job(np.random.default_rng(4))], ids=range(3))
def test_the_way_is_the_trajectory_and_its_bounds_hold(job, machine):
    trajectory = placed(job, machine)
    path, segment, duration = pose_path_of(trajectory)
    ends = np.append(segment[1:] != segment[:-1], True)
    ends[0] = False
    np.testing.assert_allclose(path.tip[ends], trajectory.tip, atol=NANOMETRE)
    np.testing.assert_allclose(path.axis[ends], trajectory.axis, atol=1e-9)
    np.testing.assert_allclose(path.tip[0], trajectory.start_tip, atol=NANOMETRE)
    cells = np.arange(1, len(path))
    tip, axis, _, _ = path.inside(np.repeat(cells, 21), np.tile(SHARES, len(cells)))
    tip, axis = tip.reshape(-1, 21, 3), axis.reshape(-1, 21, 3)
    np.testing.assert_allclose(tip[:, -1], path.tip[1:], atol=NANOMETRE)
    steps = np.linalg.norm(np.diff(tip, axis=1), axis=2)
    assert np.all(steps <= path.travel[1:, None] / 20 + NANOMETRE)
    assert np.all(path.travel[1:] <= steps.sum(axis=1) * 1.01 + NANOMETRE)
    bend = np.linalg.norm(np.diff(tip, 2, axis=1), axis=2) * 20**2
    assert np.all(bend <= path.bend[1:, None] * 1.01 + MICRON)
    np.testing.assert_allclose(np.linalg.norm(np.diff(axis, axis=1), axis=2).sum(axis=1), path.angle[1:], atol=1e-4)
    extent = ToolPath.of(trajectory, 0.0, 0.0).segments.extent
    assert duration.sum() == pytest.approx(np.sum(extent / trajectory.feed))


def test_a_good_job_holds_all_checks_and_the_report_says_so(machine):
    trajectory = placed(cone(), machine)
    report = check_reach(trajectory, machine)
    assert not report.faults()
    names = [finding.subject.name for finding in report.findings]
    assert names == [
        "shortest struts", "longest struts", "base joints", "platform joints", "singular poses", "strut and strut",
        "strut and platform", "strut and fixture", "platform and fixture", "spindle and fixture",
        "tool holder and fixture", "strut speed",
    ]  # fmt: skip
    reported = report.as_dict()
    assert json.loads(json.dumps(reported)) == reported
    for check in reported["checks"]:
        assert check["first_violation"] is None and check["cure"] is None
        assert 0 < check["proven_margin"] <= check["margin"]
        assert check["name"] in report.text()
    joints = finding(report, "platform joints")
    assert reported["checks"][3]["margin"] == pytest.approx(np.degrees(joints.margin.min()))
    assert len(report.column("strut and strut")) == len(report.tip) == len(report.segment)
    with pytest.raises(ValueError, match="expected one of"):
        report.column("hoses")


def test_places_of_violations_are_those_of_the_program(machine):
    lengths = strut_lengths(machine, *pose_path_of(placed(cone(), machine))[0].rows(slice(None)))
    tight = dataclasses.replace(machine, strut_stroke=(750.0, lengths.max() - 5.0))
    report = check_reach(placed(cone(), machine), tight)
    longest = finding(report, "longest struts")
    over = lengths.max(axis=1) > lengths.max() - 5.0
    trajectory = report.trajectory
    reported = report.as_dict()["checks"][1]
    assert longest.first_bad_row == np.flatnonzero(over)[0]
    assert reported["first_violation"]["line"] == trajectory.line[report.segment[np.flatnonzero(over)[0]]]
    assert reported["worst"]["line"] == trajectory.line[report.segment[np.argmax(lengths.max(axis=1))]]
    assert reported["part"] == str(np.argmax(lengths.max(axis=0)) + 1)
    assert reported["margin"] == pytest.approx(-5.0)
    (fault,) = report.faults()
    assert (fault.code, fault.place.line) == ("K102", reported["worst"]["line"])
    assert fault.place.operation == "Finish" and "by 5.000 mm" in fault.found
    assert "longest struts: move or turn the part" in report.text()


def test_an_arc_is_followed_and_not_its_chord(machine):
    # Half a circle of 80 mm about (0, 0): its ends are far from a pin that stands at the far side of the arc.
    centre, turn = np.full((3, 3), np.nan), np.full((3, 3), np.nan)
    centre[2], turn[2] = [0, 0, 60], [0, 0, 1]
    kind = [Kind.RAPID, Kind.LINE, Kind.ARC]
    job = program([[80, 0, 100], [80, 0, 60], [-80, 0, 60]], kind=kind, centre=centre, turn=turn)
    holder_end = 150 + 60 + 120 + 80 - 130
    for beside, bad in ((105.0 + 1.9, True), (105.0 + 2.1, False)):  # 80 mm, 25 mm of the holder, 2 mm of clearance
        pin = Box("pin", [-0.1, beside, 0.0], [0.1, beside + 1, holder_end + 20])
        report = check_reach(placed(job, machine), dataclasses.replace(machine, fixtures=(pin,)))
        found = finding(report, "tool holder and fixture")
        assert (found.first_bad_row is not None) == bad
        assert found.margin.min() == pytest.approx(beside - 107, abs=0.02)
        assert report.segment[found.worst_row] == len(report.trajectory) - 1


def test_the_part_and_the_normals_add_checks(machine):
    trajectory = placed(cone(), machine)
    part = CollisionMesh.of(boxes=[Box("stock", [-20.0, -20, 150], [20.0, 20, 200])])
    normal = np.tile([0.0, 0.0, 1.0], (len(trajectory), 1))
    stiff = dataclasses.replace(machine, strut_stiffness=1e5)
    report = check_reach(trajectory, stiff, part, normal, least_stiffness=1e6)
    assert finding(report, "tool holder and part").at_least > 0
    assert finding(report, "stiffness along the normal").margin.max() < 0
    assert [fault.code for fault in report.faults()] == ["K119"]
    assert report.as_dict()["checks"][-1]["proven_margin"] is None
    assert "rows only" in report.text()


def test_strut_speed_is_that_of_the_feed(machine):
    job = cone()
    slow, fast = (
        finding(check_reach(placed(dataclasses.replace(job, feed=np.where(np.isnan(job.feed), np.nan, feed)), machine),
                      machine), "strut speed")
        for feed in (10.0, 100.0)
    )  # fmt: skip
    cutting = np.arange(len(slow.margin)) > len(slow.margin) // 2
    ratio = (machine.strut_speed - fast.margin[cutting]) / (machine.strut_speed - slow.margin[cutting])
    np.testing.assert_allclose(ratio, 10.0, rtol=1e-6)
