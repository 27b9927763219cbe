# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool stays as near to its course as is said: many instants of the intervals say so, by Newton's method."""

import dataclasses

import numpy as np
import pytest
from test_nothing_exceeds import certified

from pkm_post.certificate import tool_spline
from pkm_post.certificate.tool_spline import ToolSpline
from pkm_post.geometry import hermite_lengths, hermite_speeds
from pkm_post.geometry.vectors import length_of
from pkm_post.machine import forward, linearise

SHARES = np.linspace(0, 1, 65)
MOST_ROWS = 400
"""Intervals looked at of each job, by chance, beside those the tool can miss its course by most."""
SAME = 1e-9
"""mm and rad: forward kinematics ends when the struts are right to 1e-10 mm."""


def course_of(job, struts=None):
    """A job's machine, plan, struts and course; none where the machine cannot do it."""
    if certified(job) is None:
        pytest.skip("beyond the reach of the machine")
    machine, _, motion, printed, _ = certified(job)
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


JOBS = ["cone", "arcs and a helix", *range(16)]


def test_most_intervals_have_a_course():
    courses = [course_of(job)[-1] for job in JOBS if certified(job) is not None]
    assert np.isfinite(np.concatenate([course.missed[0] for course in courses])).mean() > 0.9


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


def test_what_leaves_a_cubic_does_so_by_no_more_than_the_looks_and_the_factors_say():
    # The factors: quadratics times x^2 (1 - x)^2 are 1 at each look in turn; signs that add up are the worst case.
    share, looks = np.linspace(0, 1, 20001), tool_spline._LOOKS.ravel()
    bases = []
    for look in looks:
        others = looks[looks != look]
        quadratic = np.prod([(share - other) / (look - other) for other in others], axis=0)
        bases.append(quadratic * (share * (1 - share) / (look * (1 - look))) ** 2)
    assert np.abs(bases).sum(axis=0).max() == pytest.approx(1.442, abs=1e-3)
    rates = np.gradient(np.array(bases), share, axis=1)
    assert np.abs(rates).sum(axis=0).max() == pytest.approx(11.153, abs=1e-2)
    with_room = 1.1  # for the change of the Jacobian
    assert with_room * np.abs(bases).sum(axis=0).max() <= tool_spline._MOST
    assert with_room * np.abs(rates).sum(axis=0).max() <= tool_spline._FASTEST


def test_a_program_that_is_off_its_plan_has_no_course_there():
    _, _, _, struts, _ = certified("cone")
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
