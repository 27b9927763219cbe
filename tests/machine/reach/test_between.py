# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nothing slips through between two rows: slopes hold, and what is found agrees with looking everywhere."""

import dataclasses

import numpy as np
import pytest
from machines import example, screwed
from pose_paths import LENGTH, bodied, counted, samples, upright, wandering, with_limit

from pkm_post.machine.kinematics.placed_machine import PlacedMachine
from pkm_post.machine.reach.collision_mesh import CollisionMesh
from pkm_post.machine.reach.limit_checks import HUNDREDTH, shortest_distance
from pkm_post.machine.reach.path_bounds import check_path
from pkm_post.machine.reach.path_checks import all_checks, reach_findings
from pkm_post.machine.reach.pose_path import PosePath
from pkm_post.model.machine import Box

SHARES = np.linspace(0.0, 1.0, 401)
ROUNDING = 1e-9
PART = CollisionMesh.of(
    boxes=[Box("part", [-60.0, -60, 0], [60.0, 60, 150])], points=np.array([[0.0, 100.0, 200.0], [280.0, 0, 700]])
)

POINTS = CollisionMesh.of(
    points=np.array([[0.0, 100.0, 200.0], [20.0, -60.0, 150.0], [-90.0, 0.0, 180.0], [280.0, 0.0, 700.0]])
)
"""Of points, a distance is exact; of triangles it is a lower bound, which may have steps."""

HIDING = {"K101": 2, "K115": 2, "K117": 1, "K121": 2}
"""Checks that have violations here that neither end of a cell shows. The others are worst at the ends of such cells."""


def checks_of(machine, path, part=PART):
    return all_checks(machine, path, shortest_distance(machine, path), part)


def named(findings, name):
    return next(finding for finding in findings if finding.subject.name == name)


@pytest.mark.slow
@pytest.mark.parametrize("machine", [bodied(), screwed(bodied())], ids=["keyed", "screwed"])
def test_no_margin_changes_faster_than_its_slope(machine):
    path = wandering(np.random.default_rng(1), 40)
    cells = np.arange(1, 40)
    placed = PlacedMachine.of(machine, samples(path, cells, SHARES))
    step = SHARES[1]
    for check in checks_of(machine, path, POINTS):
        change = check.by_travel * path.travel + check.by_turn * path.turn()
        margins = check.margins(placed).reshape(len(cells), len(SHARES), -1)
        fastest = np.abs(np.diff(margins, axis=1)).max(axis=(1, 2)) / step
        exact = check.code != "K116"  # planes are lower bounds of a distance: these may have steps as well
        assert not exact or np.all(fastest <= change[1:] * (1 + 1e-6) + ROUNDING / step), check.name
        assert fastest.max() > 0 or check.name == "spindle and part"  # too far away to be reported


@pytest.mark.parametrize(
    "machine",
    [bodied(), screwed(bodied()), dataclasses.replace(bodied(), length_offset=np.array([-5.0, 3, -4, 0, 6, -5]))],
    ids=["keyed", "screwed", "counted otherwise"],
)
def test_no_joints_are_nearer_than_the_shortest_distance(machine):
    """The law behind all slopes: a screw and an offset change what is counted, not how far the joints are apart."""
    poses = wandering(np.random.default_rng(3), 60)
    for row in range(len(poses)):
        path = PosePath.straight(*poses.rows(slice(row, row + 1)))
        assert shortest_distance(machine, path) <= PlacedMachine.of(machine, path.rows([0])).distance.min() + ROUNDING


@pytest.mark.slow
@pytest.mark.parametrize("code", ["K101", "K102", "K103", "K104", "K105", "K113", "K114", "K115", "K117", "K121"])
def test_findings_agree_with_looking_everywhere(code):
    """Limits of every check are set so that a cell just does not hold them in its middle, or just does."""
    rng, machine = np.random.default_rng(2), bodied()
    hidden = 0
    for _ in range(30):
        path = wandering(rng, 2, tilt_deg=30, spin_deg=60)
        check = next(
            check for check in all_checks(machine, path, shortest_distance(machine, path), POINTS) if check.code == code
        )
        margins = check.margins(PlacedMachine.of(machine, samples(path, np.array([1]), SHARES))).min(axis=1)
        # Between two samples the margin may go down by half of what its slope allows.
        slack = float((check.by_travel * path.travel + check.by_turn * path.turn())[1]) * SHARES[1] / 2
        least = margins.min()
        for limit, bad in ((least + 2 * check.resolution, True), (least - slack - 2 * check.resolution, False)):
            (finding,) = check_path(machine, path, (with_limit(check, limit),))
            assert (finding.first_bad_row is not None) == bad
            assert finding.at_least <= least - limit + ROUNDING
            assert bad or finding.at_least >= 0
            hidden += int(bad and min(margins[0], margins[-1]) > limit)
    assert hidden >= HIDING.get(code, 0)


def test_a_needle_between_two_rows_is_found():
    # A sheet of 0.02 mm stands halfway between two rows that are 300 mm apart; it ends 0.5 mm inside the clearance
    # of the holder, whose flat end is 50 mm above the tip minus 120 + 80 - 130 mm of the platform's frame.
    holder_end = 200.0 + 80 + LENGTH - 130
    path = PosePath.straight(*upright([[-150.0, 0, 200], [150.0, 0, 200]]))
    for rises, bad in ((holder_end - 2.0 + 0.5, True), (holder_end - 2.0 - 0.05, False)):
        sheet = Box("sheet", [0.0, -0.01, 0.0], [0.02, 0.01, rises])
        machine = dataclasses.replace(bodied(), fixtures=(sheet,))
        finding = named(reach_findings(machine, path), "tool holder and fixture")
        assert (finding.first_bad_row == 1) == bad
        check = next(check for check in checks_of(machine, path) if check.name == "tool holder and fixture")
        assert check.margins(PlacedMachine.of(machine, path.rows(slice(None)))).min() > 80
        if bad:
            assert finding.margin[1] == pytest.approx(-0.5, abs=0.5)
            assert finding.subject.parts[finding.part[1]] == "tool holder and sheet"
        else:
            assert 0 <= finding.at_least <= 0.05


def test_a_needle_of_stroke_is_found():
    # From -80 to 10 degrees of spin, struts 1, 3 and 5 are shortest at -36, where joints at 48 and 12 degrees face.
    tip, axis, _, length = upright([[0.0, 0, 200]] * 2)
    path = PosePath.straight(tip, axis, np.radians([-80.0, 10.0]), length)
    facing = np.hypot(600 - 200, 1400 - 200 - 80 - LENGTH)
    assert PlacedMachine.of(example(), path.rows(slice(None))).lengths().min() > facing + 10
    for limit, bad in ((facing + 0.02, True), (facing - 0.02, False)):
        machine = dataclasses.replace(example(), strut_stroke=(limit, 2000.0))
        finding = named(reach_findings(machine, path), "shortest struts")
        assert (finding.first_bad_row == 1) == bad
        if bad:
            assert -0.02 - HUNDREDTH < finding.margin[1] < 0
            assert finding.subject.parts[finding.part[1]] in "135"
        else:
            assert 0 <= finding.at_least <= 0.02


def test_a_singular_pose_is_not_jumped_over():
    # A quarter turn of the platform is singular. From -80 to 80 degrees there is none; from 80 to 100 there is, and
    # from 80 to 280 degrees there are two, so that the determinant has the same sign at both rows.
    for first, last, bad in ((-80, 80, False), (80, 100, True), (80, 280, True)):
        tip, axis, _, length = upright([[0.0, 0, 200]] * 2)
        path = PosePath.straight(tip, axis, np.radians([first, last]), length)
        signs = np.sign(np.linalg.det(PlacedMachine.of(example(), path.rows(slice(None))).scaled_jacobian()))
        assert (signs[0] == signs[1]) == (last != 100)
        finding = named(reach_findings(example(), path), "singular poses")
        assert (finding.first_bad_row is not None) == bad
        assert (finding.at_least > 0) != bad


@pytest.mark.slow
def test_margins_of_many_rows_are_those_of_the_rows_where_little_is_left():
    # In large steps over the rows, or one by one: where less than the comfort is left, the same.
    machine = bodied()
    t = np.linspace(0, 2 * np.pi, 3000)
    tip, axis, spin, length = upright(np.column_stack([100 * np.cos(t), 60 * np.sin(t), 200 + 20 * np.cos(3 * t)]))
    path = PosePath.straight(tip, axis, spin, length)
    placed = PlacedMachine.of(machine, path.rows(slice(None)))
    for check, finding in zip(checks_of(machine, path), reach_findings(machine, path, PART), strict=True):
        if check.comfort < np.inf:
            exact = check.margins(placed).min(axis=1)
            assert np.all(finding.margin <= np.maximum(exact, finding.margin.min()) + ROUNDING), check.name
            near = exact < check.comfort
            np.testing.assert_allclose(finding.margin[near], exact[near], atol=ROUNDING)
            assert np.all(finding.margin[~near] >= check.comfort - ROUNDING), check.name
            # The least one is that of a row, and no other row has less than three quarters of it.
            assert exact[finding.worst_row] == pytest.approx(finding.margin.min(), abs=ROUNDING)
            assert exact.min() >= min(0.75 * finding.margin.min(), finding.margin.min()) - ROUNDING
            assert finding.at_least <= exact.min()


def test_a_way_of_one_row_has_findings():
    findings = reach_findings(bodied(), PosePath.straight(*upright([[0.0, 0, 200]])), PART, np.zeros(1))
    assert all(finding.at_least == finding.margin[0] for finding in findings)


@pytest.mark.slow
@pytest.mark.parametrize("machine", [bodied(), screwed(bodied())], ids=["keyed", "screwed"])
def test_faults_alone_are_those_of_looking_at_every_row(machine):
    # Limits of all checks are set within what they have on random ways, so that some rows break them and others do not.
    rng = np.random.default_rng(12)
    bad_rows = 0
    for _ in range(4):
        corners = wandering(rng, 12, tilt_deg=20)
        path = PosePath.straight(*samples(corners, np.arange(1, 12), np.linspace(0.0, 1.0, 150)[1:]))
        placed = PlacedMachine.of(machine, path.rows(slice(None)))
        for check in checks_of(machine, path, None):
            exact = check.margins(placed).min(axis=1)
            some = with_limit(check, np.quantile(exact, rng.choice([0.0, 0.001, 0.02, 0.5])))
            whole = dataclasses.replace(some, comfort=np.inf)
            (every,), (bad,) = (
                check_path(machine, path, (whole,)),
                check_path(machine, path, (some,), faults_alone=True),
            )
            at = np.flatnonzero(every.margin < 0)
            if check.code == "K116":  # planes may tell too little at a row where its neighbours prove more
                assert set(np.flatnonzero(bad.margin < 0)) <= set(at)
                continue
            np.testing.assert_array_equal(np.flatnonzero(bad.margin < 0), at, err_msg=check.name)
            np.testing.assert_allclose(bad.margin[at], every.margin[at], atol=ROUNDING)
            np.testing.assert_array_equal(bad.part[at], every.part[at])
            assert (bad.at_least < 0) == (every.at_least < 0)
            bad_rows += len(at)
    assert bad_rows > 1000


def test_a_way_within_its_limits_is_proven_by_few_poses():
    path = PosePath.straight(
        *upright(np.column_stack([np.linspace(-50, 50, 20001), np.zeros(20001), np.full(20001, 200.0)]))
    )
    checks, looked_at = counted(checks_of(bodied(), path, None))
    found = check_path(bodied(), path, checks, faults_alone=True)
    assert all(0 <= finding.at_least <= finding.margin.min() for finding in found)
    assert sum(looked_at) < 0.02 * len(path) * len(checks)
