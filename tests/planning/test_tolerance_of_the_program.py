# SPDX-License-Identifier: LGPL-2.1-or-later
"""G64 P from the column of a program to the certificate: corners, cubics and what is judged."""

from dataclasses import replace

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, program

from pkm_post.certificate import certify
from pkm_post.model import Kind
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import interpolate, plan_feed, strut_motion
from pkm_post.planning.feed_plan import tool_path
from pkm_post.report import Results, summary
from pkm_post.toolpath.place import place

ASKED = Tolerances(tip=1e-3, axis=np.radians(1e-3))
OFFSET = 3 / 16
RIGHT_ANGLE = np.sqrt(2)
ZIGZAG = [[0, 0, 60], [20, 0, 60], [20, 20, 60], [40, 20, 60], [40, 40, 60], [60, 40, 60]]


def placed(tolerance, **more):
    given = replace(program(ZIGZAG), tip_tolerance=tolerance, **more)
    trajectory, faults = place(given, example(), ON_PALLET)
    assert not faults
    return trajectory


def planned(trajectory):
    feed_plan, faults = plan_feed(trajectory, example(), ASKED)
    assert not faults
    return feed_plan.path, interpolate(feed_plan).motion


def certified(trajectory, motion, tolerances=ASKED):
    struts = strut_motion(motion, example())
    certificate, faults = certify(struts, "part.pmc", trajectory, example(), motion, tolerances)
    return certificate, faults


def worst(certificate, code):
    return next(finding for finding in certificate.findings if finding.code == code)


def test_the_lower_tolerance_of_two_rows_rounds_their_corner():
    path = tool_path(placed([0, 0.05, 0.05, 0, 0.0002, 0.05]), ASKED)
    most = np.array([0.05 - 0.45 * ASKED.tip, 0.55 * ASKED.tip, 0.55 * 0.0002, 0.55 * 0.0002])
    np.testing.assert_allclose(path.blend[2:-1], most / (OFFSET * RIGHT_ANGLE), rtol=1e-12)


def test_a_program_that_says_what_was_asked_for_changes_nothing():
    said, silent = planned(placed(np.full(6, ASKED.tip))), planned(placed(np.zeros(6)))
    np.testing.assert_array_equal(said[0].blend, silent[0].blend)
    np.testing.assert_array_equal(said[1].time_ms, silent[1].time_ms)


def test_wide_corners_are_faster_and_certified_by_the_tolerance_of_their_rows():
    narrow, wide = placed(np.zeros(6)), placed(np.full(6, 0.05))
    (_, slow), (_, fast) = planned(narrow), planned(wide)
    assert fast.time_ms[-1] < slow.time_ms[-1]
    certificate, faults = certified(wide, fast)
    assert not faults
    tip = worst(certificate, "V101")
    assert tip.limit == 0.05
    # The bisector of a right angle meets both sides at 45 degrees: the nearest point is nearer than the corner.
    corner = worst(certificate, "V110")
    assert 0.9 * 0.05 < corner.value <= corner.limit == 0.05
    assert tip.value == pytest.approx(corner.value / RIGHT_ANGLE, abs=ASKED.tip)
    # Judged by what was asked for, as if the program had not said anything, it does not hold.
    _, faults = certified(narrow, fast)
    assert {fault.code for fault in faults} >= {"V101", "V110"}


def test_the_worst_is_the_largest_by_its_own_tolerance():
    trajectory = placed([0, 0.05, 0.05, 0.0004, 0.0004, 0.0004])
    _, motion = planned(trajectory)
    certificate, faults = certified(trajectory, motion)
    assert not faults
    off = certificate.tip_deviation / certificate.tip_tolerance
    tip = worst(certificate, "V101")
    assert tip.value / tip.limit == pytest.approx(off.max(), rel=1e-12)
    assert set(np.unique(certificate.tip_tolerance)) == {ASKED.tip, 0.05, 0.0004}


def half_circle(tolerance):
    """Where the path bends all along, tolerances decide how far apart points are; about corners accelerations do."""
    kind, nowhere = [Kind.RAPID, Kind.ARC], [np.nan] * 3
    made = program(
        ZIGZAG[:2], kind=kind, centre=np.array([nowhere, [10, 0, 60]]), turn=np.array([nowhere, [0, 0, 1]]), feed=20.0
    )
    trajectory, faults = place(replace(made, tip_tolerance=np.full(2, tolerance)), example(), ON_PALLET)
    assert not faults
    return trajectory


@pytest.mark.parametrize("of", [half_circle, lambda tolerance: placed(np.full(6, tolerance))])
def test_cubics_keep_to_a_tolerance_that_is_tighter_than_was_asked_for(of):
    tight = of(0.0001)
    _, motion = planned(tight)
    certificate, faults = certified(tight, motion)
    assert not faults
    assert worst(certificate, "V101").limit == 0.0001


def test_a_tighter_tolerance_takes_more_points():
    _, coarse = planned(half_circle(0.0))
    _, motion = planned(half_circle(0.0001))
    assert len(motion.time_ms) > 1.3 * len(coarse.time_ms)


def test_an_exact_path_is_at_rest_in_its_corners_and_on_the_path():
    trajectory = placed(np.zeros(6), exact_path=np.ones(6, bool))
    path, motion = planned(trajectory)
    assert not path.blend.any()
    at_corner = np.searchsorted(motion.time_ms, np.rint(1000 * motion.joint_time))
    np.testing.assert_allclose(motion.tip_rate[at_corner], 0, atol=1e-12)
    np.testing.assert_allclose(motion.tip[at_corner], trajectory.tip, atol=1e-9)
    certificate, faults = certified(trajectory, motion)
    assert not faults
    assert worst(certificate, "V101").value <= 0.5 * ASKED.tip


def test_the_report_has_the_points_of_rest_and_the_tolerances_of_the_program():
    trajectory = placed([0, 0.05, 0.05, 0, 0.02, 0.02], exact_stop=[False, True, False, True, False, False])
    _, motion = planned(trajectory)
    certificate, _ = certified(trajectory, motion)
    struts = strut_motion(motion, example())
    report = summary.report(Results(trajectory, example(), motion, struts, certificate, ASKED))
    assert report["tolerances"]["tip_of_program_mm"] == [0.02, 0.05]
    held = report["hold_points"]
    assert held["line"] == [2, 4, 6]
    assert held["operation"] == ["Finish"] * 3
    still = motion.time_ms[(np.abs(motion.tip_rate) < 1e-12).all(axis=1)]
    assert [0, *np.rint(1000 * np.array(held["time_s"]))] == still.tolist()
