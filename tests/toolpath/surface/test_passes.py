# SPDX-License-Identifier: LGPL-2.1-or-later
"""Passes over known surfaces: distances, scallops, tolerances of straight moves, trimming, order, sides."""

import math

import numpy as np
import pytest
from shapes import (
    BALL,
    BULL,
    FLAT,
    MICRON,
    PLACE,
    covered,
    cylinder,
    distance_to_cutter,
    distance_to_torus,
    passes,
    plate,
    played,
    settings,
    sphere,
    torus,
)  # fmt: skip

from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.surface.options import CutMode, PassLines, PassOrder
from pkm_post.toolpath.surface.passes import surface_poses
from pkm_post.toolpath.surface.poses import SurfaceTolerances
from pkm_post.toolpath.surface.stepover import Stepover
from pkm_post.toolpath.surface.tool_axis import AxisRule

ROUNDING = 1e-9
LEAN = AxisRule(lead=math.radians(10.0), tilt=math.radians(5.0))
DISC = plate(inside=lambda u, v: np.hypot(u - 20.0, v - 10.0) < 9.0)
RING = plate(inside=lambda u, v: (np.hypot(u - 20.0, v - 10.0) < 9.0) & (np.hypot(u - 20.0, v - 10.0) > 4.0))


def heights(poses, column):
    return np.array([np.median(poses.point[rows, column]) for rows in passes(poses)])


def test_passes_on_a_plate_are_evenly_apart_and_reach_its_borders():
    poses = covered(plate(), stepover=Stepover(distance=3.0))
    assert heights(poses, 1) == pytest.approx(np.linspace(0.0, 20.0, 8))
    for rows in passes(poses):
        assert sorted(poses.point[rows[[0, -1]], 0]) == pytest.approx([0.0, 40.0])


@pytest.mark.slow
@pytest.mark.parametrize("lines", [PassLines.ALONG_U, PassLines.ALONG_V])
def test_neighbours_on_a_torus_are_nowhere_farther_apart_than_the_stepover(lines):
    step = 2.0
    poses = covered(torus(), lines=lines, stepover=Stepover(distance=step))
    lines_of = [poses.point[rows] for rows in passes(poses)]
    widest = 0.0
    for line, following in zip(lines_of, lines_of[1:], strict=False):
        share = np.linspace(0.0, 1.0, 21)[:, None, None]
        dense = (following[:-1] + share * np.diff(following, axis=0)).reshape(-1, 3)
        apart = np.linalg.norm(line[:, None] - dense[None], axis=2).min(axis=1)
        widest = max(widest, apart.max())
    assert 0.85 * step < widest < step + 0.01  # twice the chord tolerance is less


@pytest.mark.parametrize("hollow", [False, True], ids=["ball", "bowl"])
def test_scallops_between_passes_on_a_sphere_have_the_height(hollow):
    wanted, radius = 0.02, 25.0
    surface = sphere(radius, -np.pi / 2, -0.3, hollow=True) if hollow else sphere(radius, 0.3, np.pi / 2)
    poses = covered(surface, stepover=Stepover(scallop=wanted), rule=AxisRule(cone=0.6))
    latitude = np.sort(np.arcsin(np.abs(heights(poses, 2)) / radius))
    centre = radius + (-3.0 if hollow else 3.0)
    half = np.diff(latitude) / 2
    along, aside = centre * np.cos(half), centre * np.sin(half)
    cusp = along + (1.0 if hollow else -1.0) * np.sqrt(3.0**2 - aside**2)
    height = np.abs(cusp - radius)
    assert height.max() <= wanted * 1.001
    assert height.min() > 0.8 * wanted  # a whole number of passes
    # the pole is a point: the first pass is half a pass away from it
    assert np.pi / 2 - latitude[-1] == pytest.approx(half[-1], rel=0.01)


@pytest.mark.parametrize("order", [PassOrder.ZIGZAG, PassOrder.SPIRAL])
@pytest.mark.parametrize("chord", [0.05, 0.005])
def test_ball_stays_within_the_chord_tolerance_of_a_torus_all_the_way(order, chord):
    tolerances = SurfaceTolerances(chord, axis=1.0)
    poses = covered(torus(), order=order, tolerances=tolerances, rule=LEAN, stepover=Stepover(distance=2.5))
    tip, axis, moving = played(poses)
    off = distance_to_torus((tip + 3.0 * axis).reshape(-1, 3)) - 3.0
    assert np.abs(off).max() < 1.05 * chord
    assert np.abs(off).max() > 0.3 * chord
    assert np.isin(poses.path.number[moving], poses.path.number).all()


def test_bull_nose_stays_within_the_chord_tolerance_of_a_sphere():
    chord, radius = 0.01, 25.0
    poses = covered(sphere(radius), BULL, rule=LEAN, tolerances=SurfaceTolerances(chord, 1.0))
    tip, axis, _ = played(poses)
    tip, axis = tip.reshape(-1, 3), axis.reshape(-1, 3)
    off = distance_to_cutter(np.zeros_like(tip), tip, axis, BULL) - radius
    assert np.abs(off).max() < 1.05 * chord


@pytest.mark.parametrize("cutter", [BALL, BULL], ids=["ball", "bull"])
def test_passes_that_meet_at_a_pole_turn_the_tool_about_it_without_gouging(cutter):
    chord, radius = 0.005, 25.0
    poses = covered(sphere(radius, lowest=1.0), cutter, lines=PassLines.ALONG_V, stepover=Stepover(distance=6.0),
                    rule=AxisRule(lead=0.3), tolerances=SurfaceTolerances(chord, 0.01))  # fmt: skip
    tip, axis, _ = played(poses)
    tip, axis = tip.reshape(-1, 3), axis.reshape(-1, 3)
    off = distance_to_cutter(np.zeros_like(tip), tip, axis, cutter) - radius
    assert np.abs(off).max() < 1.05 * chord


def test_axis_stays_within_its_tolerance_on_a_cylinder():
    tolerance, lead = math.radians(0.02), math.radians(20.0)
    poses = covered(
        cylinder(),
        rule=AxisRule(lead=lead, tilt=0.4),
        tolerances=SurfaceTolerances(1.0, tolerance),
        order=PassOrder.ONE_WAY,
    )
    tip, axis, moving = played(poses)
    point = poses.point[moving] + np.linspace(0, 1, 11)[:, None, None] * (poses.point[moving + 1] - poses.point[moving])
    in_pass = np.isnan(poses.path.link[moving]) & np.isnan(poses.path.link[moving + 1])
    in_pass &= poses.path.number[moving] == poses.path.number[moving + 1]
    angle = np.arctan2(point[..., 1], point[..., 0])
    n = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=-1)
    t = np.stack([-np.sin(angle), np.cos(angle), np.zeros_like(angle)], axis=-1)
    wanted = np.sin(lead) * t + np.cos(lead) * (np.cos(0.4) * n + np.sin(0.4) * np.cross(n, t))
    off = np.arccos(np.clip(np.einsum("...j,...j->...", wanted, axis), -1.0, 1.0))[:, in_pass]
    assert 0.3 * tolerance < off.max() < 1.1 * tolerance


def test_straight_lines_need_no_points_between():
    few = covered(plate(), stepover=Stepover(distance=5.0), tolerances=SurfaceTolerances(1e-6, 1e-6))
    assert len(few.path) < 60


@pytest.mark.parametrize("cutter", [BALL, BULL, FLAT], ids=["ball", "bull", "flat"])
def test_cutter_touches_the_surface_at_every_contact(cutter):
    poses = covered(torus(), cutter, rule=AxisRule(lead=0.2, cone=0.7))
    on_surface = distance_to_torus(poses.point)
    touching = distance_to_cutter(poses.point, poses.tip, poses.axis, cutter)
    assert np.abs(on_surface).max() < ROUNDING
    assert np.abs(touching).max() < 1e-7


def test_axes_stay_in_their_cone_and_move_the_least():
    cone = 0.5
    rule = AxisRule(lead=0.2, cone_axis=(0.0, 0.0, 2.0), cone=cone)
    poses, free = (covered(torus(), rule=each, stepover=Stepover(distance=4.0)) for each in (rule, AxisRule(lead=0.2)))
    angle = np.arccos(poses.axis[:, 2])
    assert angle.max() < cone + ROUNDING
    assert angle[poses.clamped] == pytest.approx(cone)
    assert np.count_nonzero(poses.clamped) > 100
    assert not free.clamped.any()
    in_pass = np.isnan(poses.path.link) & ~poses.clamped
    k = np.sin(0.2) * poses.frame.feed + np.cos(0.2) * poses.normal
    assert poses.axis[in_pass] == pytest.approx(k[in_pass])
    # the smallest change is in the plane of the axis that was wanted and the middle of the cone
    flat = np.cross(k[poses.clamped], [0.0, 0.0, 1.0])
    assert np.abs(np.einsum("nj,nj->n", flat, poses.axis[poses.clamped])).max() < ROUNDING


def test_lead_leans_forward_and_tilt_to_one_side_both_ways_of_a_zigzag():
    poses = covered(plate(), rule=LEAN)
    in_pass = np.isnan(poses.path.link)
    assert np.einsum("nj,nj->n", poses.axis, poses.frame.feed)[in_pass] == pytest.approx(np.sin(LEAN.lead))
    assert poses.axis[in_pass, 1] == pytest.approx(np.cos(LEAN.lead) * np.sin(LEAN.tilt))
    assert poses.axis[~in_pass, 1].min() > np.sin(LEAN.tilt) / 2


def test_tool_goes_round_its_contact_where_the_feed_turns():
    poses = covered(plate(), BULL, rule=AxisRule(lead=0.2))
    assert poses.axis[:, 2] == pytest.approx(np.cos(0.2))
    in_link = ~np.isnan(poses.path.link)
    assert in_link.sum() > 100
    # at the end of a zigzag by way of the next pass, never over the border back
    assert poses.axis[in_link, 1].min() > 0.0


@pytest.mark.parametrize("lines", [PassLines.ALONG_U, PassLines.PLANES])
def test_passes_on_a_trimmed_disc_end_on_its_border(lines):
    poses = covered(DISC, lines=lines, plane=(1.0, 0.5, 0.0), order=PassOrder.ONE_WAY)
    away = np.hypot(poses.point[:, 0] - 20.0, poses.point[:, 1] - 10.0)
    assert away.max() <= 9.0
    for rows in passes(poses):
        assert away[rows[[0, -1]]] == pytest.approx(9.0, abs=MICRON)


def test_half_a_stepover_is_left_at_the_tips_of_a_disc():
    rows = heights(covered(DISC, stepover=Stepover(distance=1.0)), 1)
    assert [rows[0] - 1.0, 19.0 - rows[-1]] == pytest.approx([0.5, 0.5], abs=0.05)


def test_passes_across_a_hole_are_cut_and_joined_nowhere_over_it():
    poses = covered(RING)
    away = np.hypot(poses.point[:, 0] - 20.0, poses.point[:, 1] - 10.0)
    assert away.min() >= 4.0
    per_pass = [np.unique(poses.path.run[poses.path.number == n]) for n in np.unique(poses.path.number)]
    assert max(len(runs) for runs in per_pass) == 2
    tip, _, _ = played(poses)
    assert np.hypot(tip[..., 0] - 20.0, tip[..., 1] - 10.0).min() > 3.9


def test_zigzag_goes_to_and_fro_without_lifting():
    poses = covered(plate())
    assert np.unique(poses.path.run).tolist() == [0]
    senses = [poses.path.sense[rows[0]] for rows in passes(poses)]
    assert senses == [1.0 if number % 2 == 0 else -1.0 for number in range(21)]


def test_one_way_lifts_between_passes_but_not_round_a_column():
    lifted, round_ = (covered(each, order=PassOrder.ONE_WAY, rule=AxisRule(tilt=0.5)) for each in (plate(), cylinder()))
    assert len(np.unique(lifted.path.run)) == len(passes(lifted)) == 21
    assert np.unique(round_.path.run).tolist() == [0]
    assert set(round_.path.sense) == {1.0}


def test_spiral_is_one_pass_round_both_borders():
    poses = covered(cylinder(), order=PassOrder.SPIRAL, rule=AxisRule(tilt=0.5), stepover=Stepover(distance=4.0))
    assert len(passes(poses)) == 1
    z = poses.point[:, 2]
    assert np.diff(z).min() > -ROUNDING
    angle = np.unwrap(np.arctan2(poses.point[:, 1], poses.point[:, 0]))
    assert angle[-1] - angle[0] == pytest.approx(2 * np.pi * 10)
    assert z[angle < angle[0] + 2 * np.pi - 0.01].max() == pytest.approx(0.0, abs=ROUNDING)
    assert z[angle > angle[-1] - 2 * np.pi + 0.01].min() == pytest.approx(30.0, abs=ROUNDING)


def test_parallel_planes_are_planes_and_all_lines_run_one_way():
    normal = np.array([2.0, 1.0, 0.0]) / math.sqrt(5.0)
    poses = covered(torus(), lines=PassLines.PLANES, plane=(2.0, 1.0, 0.0), order=PassOrder.ONE_WAY,
                    stepover=Stepover(distance=3.0), rule=AxisRule(cone=0.8))  # fmt: skip
    place = poses.point @ normal
    for rows in passes(poses):
        assert np.ptp(place[rows]) < 1e-7
        steps = np.diff(poses.point[rows], axis=0)
        assert (np.einsum("nj,nj->n", steps, np.cross(poses.normal[rows[:-1]], normal)) > 0).mean() > 0.99
    assert np.abs(distance_to_torus(poses.point)).max() < ROUNDING


def test_level_planes_go_round_a_column_from_its_seam():
    poses = covered(cylinder(), lines=PassLines.PLANES, plane=(0.0, 0.0, 1.0), rule=AxisRule(tilt=0.5))
    assert np.unique(poses.path.run).tolist() == [0]
    for rows in passes(poses):
        angle = np.unwrap(np.arctan2(poses.point[rows, 1], poses.point[rows, 0]))
        assert abs(angle[-1] - angle[0]) == pytest.approx(2 * np.pi)


def sideways(poses):
    """Where the next passes are: +1 right of the feed, -1 left of it; of passes that follow each other."""
    lines = passes(poses)
    towards = poses.point[lines[1][0]] - poses.point[lines[0][0]]
    right = np.cross(poses.frame.feed[lines[0][0]], poses.axis[lines[0][0]])
    return float(np.sign(np.dot(towards, right)))


@pytest.mark.parametrize("reversed_", [False, True])
@pytest.mark.parametrize("lines", [PassLines.ALONG_U, PassLines.ALONG_V, PassLines.PLANES])
@pytest.mark.parametrize(("mode", "side"), [(CutMode.CLIMB, 1.0), (CutMode.CONVENTIONAL, -1.0)])
def test_on_a_floor_climbing_has_the_next_passes_on_the_right(reversed_, lines, mode, side):
    chosen = {"order": PassOrder.ONE_WAY, "lines": lines, "plane": (0.0, 1.0, 0.0), "reversed": reversed_}
    assert sideways(covered(plate(), cut_mode=mode, **chosen)) == side
    assert sideways(covered(plate(), cut_mode=mode, clockwise=False, **chosen)) == -side


@pytest.mark.parametrize(("mode", "sense"), [(CutMode.CLIMB, -1.0), (CutMode.CONVENTIONAL, 1.0)])
@pytest.mark.parametrize("order", [PassOrder.ONE_WAY, PassOrder.SPIRAL])
def test_round_a_column_climbing_is_clockwise_from_above(mode, sense, order):
    # outside of a part, with a cutter that turns clockwise, climb milling keeps the part on the right
    poses = covered(cylinder(), order=order, cut_mode=mode, rule=AxisRule(cone=math.radians(30.0)))
    turn = np.cross(poses.point[:-1], poses.point[1:])[:, 2]
    assert np.sign(turn[np.abs(turn) > MICRON]).mean() == sense


def test_reversed_passes_begin_on_the_other_side():
    assert heights(covered(plate(), reversed=True), 1) == pytest.approx(np.linspace(20.0, 0.0, 21))


def fault(surface, cutter=BALL, **chosen):
    poses, faults = surface_poses(surface, cutter, settings(**chosen), PLACE)
    assert poses is None
    return {each.code for each in faults}


def test_what_cannot_be_covered_is_reported():
    assert fault(plate(), order=PassOrder.SPIRAL) == {"N301"}
    assert fault(cylinder(), order=PassOrder.SPIRAL, lines=PassLines.PLANES) == {"N301"}
    assert fault(plate(inside=lambda u, v: np.zeros(len(u), dtype=bool))) == {"N302"}
    assert fault(sphere(2.5, hollow=True), stepover=Stepover(scallop=0.01)) == {"N303"}
    bowl = sphere(25.0, lowest=-1.2, highest=0.0, hollow=False)
    assert "N102" in fault(bowl, rule=AxisRule(cone=0.1))


def test_undercut_is_reported_once_with_its_place():
    poses, (only,) = surface_poses(
        sphere(25.0, lowest=-1.2, highest=0.0), BALL, settings(rule=AxisRule(cone=0.1)), PLACE
    )
    assert poses is None
    assert (only.code, only.place) == ("N102", PLACE)
    place = [float(number) for number in only.found.removeprefix("at (").split(")")[0].split(",")]
    assert np.linalg.norm(place) == pytest.approx(25.0, abs=MICRON)
    assert place[2] < 0.0


def test_cutters_of_other_shapes_are_the_callers_fault():
    with pytest.raises(ValueError, match="expected a ball"):
        surface_poses(plate(), Cutter.apt(10.0, 1.0, b=0.1), settings(), PLACE)


def test_progress_is_reported_and_may_stop_the_work():
    reported = []
    surface_poses(torus(), BALL, settings(), PLACE, reported.append)
    assert reported == sorted(reported)
    assert 0.0 <= reported[0] <= reported[-1] <= 1.0

    def stop(share):
        raise InterruptedError

    with pytest.raises(InterruptedError):
        surface_poses(torus(), BALL, settings(), PLACE, stop)
