# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces without a controller: together they are one motion, and their certificates are that of the whole."""

import numpy as np
import pytest
from playing import BOTH, HOOK, JUMPING, MACHINE, SETTINGS, TOLERANCES, joined, trajectory_of
from programs import cone

from pkm_post.certificate import certify, reconstruct
from pkm_post.control.player import sections
from pkm_post.control.player.certificate_log import CertificateLog
from pkm_post.control.player.knot_list import (
    POINT_VARIABLES,
    Layout,
    assignment_lines,
    point_assignments,
    read_assignments,
)
from pkm_post.control.player.pieces import PiecePlanner
from pkm_post.control.player.sections import parts_of
from pkm_post.geometry import angle_between, norm
from pkm_post.machine import forward_along_path
from pkm_post.model import Refused
from pkm_post.planning.feed_plan import tool_path
from pkm_post.toolpath import ToolPose
from pkm_post.toolpath.place import place


def read_points(values, place):
    """Interval, six lengths and six speeds of each point, from its first variable on, to the end of the list."""
    while place:
        numbers = np.array([float(values[place + n]) for n in range(POINT_VARIABLES)])
        yield int(numbers[1]), numbers[2:8], numbers[8:14]
        place = int(numbers[0])


def pieces_of(trajectory, override=lambda: 1.0, piece_ms=250, machine=JUMPING):
    """The pieces of a trajectory in one part."""
    (part,) = (each for each in parts_of(trajectory) if each.end > each.first)
    planner = PiecePlanner(trajectory, part, machine, SETTINGS, TOLERANCES)
    at, found = planner.start(), []
    while not found or not found[-1].is_end:
        found.append(planner.next_piece(at, override(), piece_ms=piece_ms))
        at = found[-1].motion.end
    return found


def wave(rows=200):
    x = np.linspace(0, 60, rows)
    return trajectory_of(np.column_stack([x, np.sin(x / 6), 80 + np.cos(x / 5)]), feed=100.0)


@pytest.fixture
def short_blocks(monkeypatch):
    monkeypatch.setattr(sections, "BLOCK_ROWS", 48)
    monkeypatch.setattr(sections, "_CHOICE", 8)


@pytest.mark.slow
@BOTH
@pytest.mark.parametrize("trajectory", [trajectory_of(HOOK), wave()], ids=["corners", "wave"])
def test_the_certificates_of_the_pieces_are_that_of_the_whole(trajectory, machine, short_blocks):
    motions, log = [piece.motion for piece in pieces_of(trajectory, machine=machine)], CertificateLog()
    for motion in motions:
        log.add(motion)
    whole = joined(motions)
    recovered, faults = reconstruct(whole, "whole", trajectory, machine, TOLERANCES)
    assert not faults
    certificate, faults = certify(
        whole, "whole", trajectory, machine, recovered.motion, TOLERANCES, spin_deviation=recovered.spin_deviation
    )
    assert not faults and certificate.holds and log.holds and log.seconds == certificate.duration
    worst = {finding.name: finding.value / (finding.limit or 1) for finding in log.findings}
    assert worst["shortest interval"] == np.diff(whole.time_ms).min() / MACHINE.shortest_interval
    for finding in certificate.findings:
        if finding.name == "strut off its plan" or not finding.limit:
            continue  # the plan is recovered; limits of 0 are differences
        # deviations are bounds of what samples miss, and depend on where these lie
        slack = 0.1 if finding.unit in ("mm", "degrees") else 0.02
        assert finding.value / finding.limit == pytest.approx(worst[finding.name], abs=slack), finding


def test_sections_have_the_same_path_and_bounded_size(short_blocks):
    trajectory = wave()
    (part,) = parts_of(trajectory)
    found = list(sections.sections_of(trajectory, part, TOLERANCES))
    assert len(found) > 2 and max(len(each.trajectory) for each in found) < 3 * 48 + 8
    for one, other in zip(found[:-1], found[1:], strict=True):
        paths = [tool_path(each.trajectory, TOLERANCES) for each in (one, other)]
        assert len(paths[0].segments.splines) and len(paths[1].segments.splines)
        begin, end = one.over, one.first + len(one.trajectory) - 2 * sections._BESIDE
        (s0, s1), (t0, t1) = (
            [path.starts[row - each.first] for row in (begin, end)]
            for path, each in zip(paths, (one, other), strict=True)
        )
        assert s1 - s0 == pytest.approx(t1 - t0, abs=1e-9)
        way = np.linspace(0.5 * (paths[0].starts[begin - one.first + 1] - s0), s1 - s0, 500)
        poses = [path.at(at + way) for path, at in zip(paths, (s0, t0), strict=True)]
        np.testing.assert_allclose(poses[0].tip, poses[1].tip, atol=1e-9)
        np.testing.assert_allclose(poses[0].tip_2, poses[1].tip_2, atol=1e-6)


@pytest.mark.slow
def test_five_axes_at_changing_overrides():
    trajectory, _ = place(cone(24, 0.2), MACHINE, np.eye(4) + np.outer([0, 0, 150, 0], [0, 0, 0, 1]))
    random = np.random.default_rng(3)
    found = pieces_of(trajectory, lambda: float(random.uniform(0.2, 1.5)), 400)
    for before, after in zip(found[:-1], found[1:], strict=True):
        for motion in filter(None, (after.motion, before.stop)):
            np.testing.assert_array_equal(motion.struts.length[0], before.motion.struts.length[-1])
            np.testing.assert_array_equal(motion.struts.speed[0], before.motion.struts.speed[-1])
        assert (before.stop or before.motion).certificate.holds
        assert not (before.stop or before.motion).struts.speed[-1].any()
    end = found[-1].motion
    struts = joined([piece.motion for piece in found]).length
    reached = forward_along_path(MACHINE, struts, np.full(len(struts), 120.0), ToolPose.at_home(MACHINE))
    assert norm(reached.tip[-1] - trajectory.tip[-1]) < 1e-5 and end.share[-1] == 1
    assert angle_between(reached.axis[-1:], trajectory.axis[-1:])[0] < 1e-6


def test_a_path_out_of_reach_is_refused():
    with pytest.raises(Refused) as refused:
        pieces_of(trajectory_of([[0, 0, 60], [600, 0, 60]]))
    assert {fault.code for fault in refused.value.diagnostics} & {"K101", "K102", "K103"}


@pytest.mark.slow
def test_points_as_lines_read_back():
    (piece, *_) = pieces_of(trajectory_of(HOOK))
    places = list(Layout().points())[: len(piece.motion.struts) - 1]
    lines = list(assignment_lines(point_assignments(piece.motion.struts, places, SETTINGS)))
    assert max(map(len, lines)) <= 200
    points = list(read_points(read_assignments(lines), places[0]))
    motion = piece.motion.struts
    assert [ms for ms, _, _ in points] == np.diff(motion.time_ms).tolist()
    np.testing.assert_array_equal([length for _, length, _ in points], motion.length[1:])
    np.testing.assert_array_equal([speed for _, _, speed in points], motion.speed[1:])
    with pytest.raises(ValueError, match="expected assignments"):
        read_assignments(["P1=2 M60=1"])
