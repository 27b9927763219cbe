# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trajectories played on a machine with limits of jerk: whatever is ordered, struts and tip keep them."""

from dataclasses import replace

import numpy as np
import pytest
from playing import HOOK, JERK, RECTANGLE, SETTINGS, SMOOTH, TOLERANCES, Playing, joined, trajectory_of

from pkm_post.certificate import certify, reconstruct
from pkm_post.control.player.certificate_log import CertificateLog
from pkm_post.control.player.orders import Order
from pkm_post.control.player.pieces import PiecePlanner
from pkm_post.control.player.sections import parts_of

JERKS = ("V112", "V115")


def wave(length=40.0):
    x = np.linspace(0, length, round(3 * length))
    return trajectory_of(np.column_stack([x, np.sin(x / 6), 80 + np.cos(x / 5)]), feed=60.0)


def pieces_of(trajectory, overrides, single_block=False):
    """Pieces at one override after the other, the last one to the end."""
    (part,) = parts_of(trajectory)
    planner, found = PiecePlanner(trajectory, part, SMOOTH, SETTINGS, TOLERANCES), []
    at, overrides = planner.start(), list(overrides)
    while not found or not found[-1].is_end:
        override = overrides.pop(0) if len(overrides) > 1 else overrides[0]
        found.append(planner.next_piece(at, override, single_block))
        at = found[-1].motion.end
    return found


def speed_of(piece):
    """Tip speed where a piece ends, mm/s."""
    return piece.motion.end.state.speed


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_jerk_across_pieces_is_that_of_the_whole_at_changing_overrides(seed):
    trajectory, chance = wave(), np.random.default_rng(seed)
    found = pieces_of(trajectory, [1.0, *chance.choice([0.05, 0.4, 1.0, 1.5], 12)])
    motions, log = [piece.motion for piece in found], CertificateLog()
    for piece in found:
        log.add(piece.motion)
        assert piece.stop is None or (piece.stop.certificate.holds and not piece.stop.struts.speed[-1].any())
    whole = joined(motions)
    recovered, faults = reconstruct(whole, "whole", trajectory, SMOOTH, TOLERANCES)
    assert not faults
    fastest = replace(trajectory, feed=1.5 * trajectory.feed)
    certificate, _ = certify(
        whole, "whole", fastest, SMOOTH, recovered.motion, TOLERANCES, spin_deviation=recovered.spin_deviation
    )
    of_whole = {finding.code: finding.value for finding in certificate.findings}
    of_pieces = {finding.code: finding.value for finding in log.findings}
    assert log.holds
    for code in JERKS:
        assert of_pieces[code] == pytest.approx(of_whole[code], rel=0.02) and of_whole[code] <= JERK


@pytest.mark.slow
def test_an_override_shows_and_rests_are_not_needed_for_it():
    found = pieces_of(wave(150.0), [1.0] * 3 + [0.3] * 6 + [1.5] * 4 + [1.0])
    speeds = [speed_of(piece) for piece in found]
    assert speeds[2] == pytest.approx(60.0, rel=0.05)
    assert min(speeds[4:9]) == pytest.approx(18.0, rel=0.1)
    assert max(speeds[10:13]) == pytest.approx(90.0, rel=0.1)
    assert all(speeds[:-1])


@pytest.mark.slow
def test_single_block_rests_at_ends_of_lines():
    found = pieces_of(trajectory_of(HOOK), [1.0], single_block=True)
    shares = [piece.motion.share[-1] for piece in found if not speed_of(piece)]
    assert len(shares) == 3 and all(share in (0.0, 1.0) for share in shares)


@pytest.mark.slow
def test_holds_overrides_and_a_late_planner_keep_the_limits_on_the_simulated_machine():
    orders = {
        5: [Order("override", 1.5)],
        15: [Order("hold")],
        70: [Order("resume")],
        76: [Order("override", 0.4)],
        84: [Order("override", 0.0)],
        140: [Order("override", 1.0)],
    }
    playing = Playing.of(trajectory_of(RECTANGLE, feed=40.0), at=orders, machine=SMOOTH)
    playing.answer = lambda player: None  # a hold waits for resume, an override of 0 for another one
    late = iter([0.0] * 12 + [1.5])
    done = playing.play(delay=lambda: next(late, 0.0))
    playing.check()
    assert done.finished and done.log.holds and not orders and playing.arrived() < 1e-3
    assert {"waits: hold", "waits: override 0"} <= {state.phase for state in playing.states}
    assert {finding.code for finding in done.log.findings} >= set(JERKS)
    assert playing.mean_jerk() <= JERK
