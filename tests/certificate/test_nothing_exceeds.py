# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dense instants, by Newton's method: none exceeds the figures, nor leaves the tool's course by more than is said."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from machines import example
from programs import ON_PALLET, cone, random_job, square_with_arc

from pkm_post.certificate import certify, joints, playback, tool_spline
from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.tool_spline import ToolSpline
from pkm_post.geometry import hermite_lengths, hermite_speeds, length_of, norm
from pkm_post.machine import forward, linearise
from pkm_post.model import StrutMotion
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan
from pkm_post.toolpath.place import place

TOLERANCES = Tolerances(1e-3, np.radians(1e-3))
DENSE = 1001
"""Instants of an interval: a hundred and more for each one of the certificate."""
WORST, RANDOM = 6, 6
"""Intervals looked at of each job: those with the largest figures of tip and axis and speed each, and by chance."""
FORWARD = 1e-9
"""mm: forward kinematics ends when the struts are right to 1e-10 mm."""
NOT_LOOSE = 1.03
"""How much more than what dense instants find the figure of the tip may say, where corners are shallow."""
WEIGHTS = np.geomspace(0.01, 100, 161)
SHARES = np.linspace(0, 1, 65)
MOST_ROWS = 400
"""Intervals whose course is looked at, of each job, by chance, beside those the tool can miss its course by most."""
SAME = 1e-9
"""mm and rad: forward kinematics ends when the struts are right to 1e-10 mm."""
SHAPES = {"cone": cone, "arcs and a helix": square_with_arc}
JOBS = [*SHAPES, *range(16)]


def made(job):
    """A job by name, or a random one by number; every third allows more at its corners (G64 P)."""
    if job in SHAPES:
        return SHAPES[job]()
    found = random_job(np.random.default_rng(job))
    return dataclasses.replace(found, tip_tolerance=np.full(len(found), 0.02)) if job % 3 == 0 else found


@cache
def planned(job):
    """Machine, trajectory, plan and printed struts of a job; none where the machine cannot do it."""
    machine = example()
    trajectory, faults = place(made(job), machine, ON_PALLET)
    if faults:
        return None
    found, faults = plan(trajectory, machine, TOLERANCES)
    if faults:
        return None
    exact = found.struts
    struts = StrutMotion(exact.time_ms, np.round(exact.length, 6), np.round(exact.speed, 4), exact.events)
    return machine, trajectory, found.motion, struts


@cache
def certified(job):
    """The same with the certificate."""
    if planned(job) is None:
        return None
    machine, trajectory, motion, struts = planned(job)
    return *planned(job), certify(struts, "x.pmc", trajectory, machine, motion, TOLERANCES)[0]


def dense(job, rows):
    """What tip and axis are off by their figures, tip speed by its ceiling, and lengths and speeds of the struts.

    At many instants of some intervals, (N, DENSE) each.
    """
    machine, trajectory, motion, struts, certificate = certified(job)
    after, knot = rows + 1, np.repeat(rows, DENSE)
    duration = np.diff(struts.time_ms)[rows] / 1000
    ends = struts.length[rows], struts.speed[rows], struts.length[after], struts.speed[after]
    length, speed = (of(*ends, duration, np.linspace(0, 1, DENSE)) for of in (hermite_lengths, hermite_speeds))
    tool = motion.tool_length[knot + 1]
    pose = forward(machine, length.reshape(-1, 6), tool, motion.tip[knot], motion.axis[knot], motion.spin[knot])
    assert pose.converged.all()
    reported = np.column_stack([certificate.tip_deviation[knot] + FORWARD, certificate.axis_deviation[knot] + FORWARD])
    off = off_by(trajectory, pose, motion.segment[knot], motion.segment[knot + 1], reported)
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool)
    twist = np.linalg.solve(jacobian, speed.reshape(-1, 6, 1))[..., 0]
    fastest = np.array([trajectory.feed[motion.segment[row] : motion.segment[row + 1] + 1].max() for row in rows])
    of_ceiling = norm(twist[:, :3]).reshape(-1, DENSE) / (1.01 * fastest + 0.05)[:, None]
    return *off.T.reshape(2, -1, DENSE), of_ceiling, length, speed


def off_by(trajectory, pose, first, last, reported):
    """Parts of what is reported, (N, 2), by which poses are off in tip and axis, from the pose that fits best by it.

    Reported is that there is a programmed pose from which neither is off by more. On a segment the candidates lie
    between the one nearest for the tip and the one nearest for the axis: weights from one to the other find them.
    """
    off, free = (
        np.full(reported.shape, np.inf),
        dataclasses.replace(trajectory, tip_tolerance=np.zeros(len(trajectory))),
    )
    others = (TrajectoryRuler(free, Tolerances(TOLERANCES.tip * weight, TOLERANCES.axis)) for weight in WEIGHTS)
    for ruler in (TrajectoryRuler(trajectory, TOLERANCES), *others):
        open_yet = np.flatnonzero(off.max(axis=1) > 1)
        if not len(open_yet):
            break
        for further in range((last - first)[open_yet].max() + 1):
            segment = np.minimum(first + further, last)[open_yet]
            parts = ruler.deviation_from(pose.tip[open_yet], pose.axis[open_yet], segment)[:2].T / reported[open_yet]
            better = parts.max(axis=1) < off[open_yet].max(axis=1)
            off[open_yet[better]] = parts[better]
    return off


def chosen(job):
    """Intervals of a job: the worst by what the certificate says of them, and some by chance."""
    certificate = certified(job)[-1]
    count = len(certificate.time)
    by_tip = np.argsort(certificate.tip_deviation / certificate.tip_tolerance)[-WORST:]
    by_axis = np.argsort(certificate.axis_deviation)[-WORST:]
    chance = np.random.default_rng(count).integers(0, count, RANDOM)
    return np.unique(np.concatenate([by_tip, by_axis, chance]))


def reported(certificate, name):
    return found(certificate, name).value


def found(certificate, name):
    return next(finding for finding in certificate.findings if finding.name == name)


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS)
def test_dense_instants_find_nothing_above_the_figures(job):
    if certified(job) is None:
        assert job not in SHAPES
        pytest.skip("beyond the reach of the machine")
    certificate, rows = certified(job)[-1], chosen(job)
    tip, axis, of_ceiling, length, speed = dense(job, rows)
    assert tip.max() <= 1
    assert axis.max() <= 1
    fastest = found(certificate, "tip speed")
    assert of_ceiling.max() <= fastest.value / fastest.limit
    assert np.abs(speed).max() <= reported(certificate, "strut speed") * (1 + 1e-12)
    assert length.min() >= reported(certificate, "shortest strut") - FORWARD
    assert length.max() <= reported(certificate, "longest strut") + FORWARD


def test_figures_say_little_more_than_there_is():
    certificate, rows = certified("cone")[-1], chosen("cone")
    worst = rows == np.argmax(certificate.tip_deviation)
    assert dense("cone", rows)[0][worst].max() > 1 / NOT_LOOSE


def test_even_instants_alone_would_say_too_little(monkeypatch):
    # What the dense instants are there for: without what hides and without the joints, they find more than the figure.
    monkeypatch.setattr(playback, "chordal_deviation", lambda columns: np.zeros(columns.shape[2]))
    blind = lambda task, tip, axis, rows, last: (np.zeros((2, 2, len(rows))), np.ones((2, len(rows))))  # noqa: E731
    monkeypatch.setattr(joints, "_off_both", blind)
    monkeypatch.setitem(globals(), "certified", cache(certified.__wrapped__))
    assert dense("cone", chosen("cone"))[0].max() > 1.001


def test_tolerance_at_the_worst_place_is_reported_with_it():
    certificate = certified(3)[-1]
    assert set(np.unique(certificate.tip_tolerance)) <= {TOLERANCES.tip, 0.02}
    finding = next(finding for finding in certificate.findings if finding.code == "V101")
    by_tolerance = certificate.tip_deviation / certificate.tip_tolerance
    assert finding.value / finding.limit == pytest.approx(by_tolerance.max(), rel=1e-12)
    row = np.searchsorted(certificate.time, finding.time, side="right") - 1
    assert finding.limit == certificate.tip_tolerance[row]
    assert by_tolerance[row] == pytest.approx(by_tolerance.max(), rel=0.01)  # a hundredth may hide at most


def course_of(job, struts=None):
    """A job's machine, plan, struts and course; none where the machine cannot do it."""
    if planned(job) is None:
        pytest.skip("beyond the reach of the machine")
    machine, _, motion, printed = planned(job)
    struts = struts or printed
    return machine, motion, struts, ToolSpline.of(machine, struts, motion)[0]


def by_newton(machine, motion, struts, rows, tip, axis, spin):
    """Tip, axis and velocity of the tip at the shares of some intervals, (3, M, N) each, from guesses like theirs."""
    played = (of(*struts.cubics(rows), SHARES) for of in (hermite_lengths, hermite_speeds))
    lengths, speeds = (columns.swapaxes(0, 1).reshape(-1, 6) for columns in played)
    tool = np.tile(motion.tool_length[rows + 1], len(SHARES))
    pose = forward(machine, lengths, tool, tip.reshape(3, -1).T, axis.reshape(3, -1).T, spin.ravel())
    assert pose.converged.all()
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool)
    twist = np.linalg.solve(jacobian, speeds[..., None])[..., 0]
    return (columns.T.reshape(3, len(SHARES), -1) for columns in (pose.tip, pose.axis, twist[:, :3]))


@pytest.mark.slow
def test_most_intervals_have_a_course():
    courses = [course_of(job)[-1] for job in JOBS if planned(job) is not None]
    assert np.isfinite(np.concatenate([course.missed[0] for course in courses])).mean() > 0.9


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS)
def test_no_instant_is_farther_from_the_course_than_is_said(job):
    machine, motion, struts, course = course_of(job)
    reported = np.flatnonzero(np.isfinite(course.missed[0]))
    assert len(reported) > 0.7 * (len(struts) - 1)
    by_most = reported[np.argsort(course.missed[0, reported])[-50:]]
    chance = np.random.default_rng(1).choice(reported, min(MOST_ROWS, len(reported)), replace=False)
    rows = np.unique(np.concatenate([by_most, chance]))
    tip, axis, spin = course.at(rows, SHARES[:, None])
    velocity = course.velocity(rows, SHARES[:, None])
    exact = by_newton(machine, motion, struts, rows, tip, axis, spin)
    for said, missed, found in zip((tip, axis, velocity), course.missed[:, rows], exact, strict=True):
        assert np.all(length_of(*(found - said)).max(axis=0) <= missed + SAME)


def test_what_is_said_is_not_far_from_what_there_is():
    machine, motion, struts, course = course_of("cone")
    rows = np.argsort(np.where(np.isfinite(course.missed[0]), course.missed[0], 0))[-50:]
    tip, axis, spin = course.at(rows, SHARES[:, None])
    found, _, _ = by_newton(machine, motion, struts, rows, tip, axis, spin)
    off = length_of(*(found - tip)).max(axis=0)
    assert np.all(course.missed[0, rows] < 2 * off)


def test_a_program_that_is_off_its_plan_has_no_course_there():
    *_, struts = planned("cone")
    known = np.isfinite(course_of("cone", struts)[-1].missed).all(axis=0)
    knot = 2 + int(np.flatnonzero(np.convolve(known, np.ones(5), "valid") == 5)[0])  # in the middle of five intervals
    for column, off in (("length", 0.001), ("speed", 1e6)):
        wrong = getattr(struts, column).copy()
        wrong[knot, 2] += off
        _, _, _, course = course_of("cone", dataclasses.replace(struts, **{column: wrong}))
        assert np.isinf(course.missed[:, knot - 1 : knot + 1]).all()
        assert np.isfinite(course.missed[0, knot + 2])


@pytest.mark.parametrize("at_once", [1, 7])
def test_intervals_in_other_passes_have_the_same_course(monkeypatch, at_once):
    whole = course_of(5)[-1]
    monkeypatch.setattr(tool_spline, "_AT_ONCE", at_once)
    rounding = 3e-9  # of a sum of inverse Jacobians, in mm, rad and mm/s
    np.testing.assert_allclose(course_of(5)[-1].missed, whole.missed, rtol=1e-6, atol=rounding)
