# SPDX-License-Identifier: LGPL-2.1-or-later
"""Counts and following errors at the tip, against finite differences and six loops that are integrated in time."""

import dataclasses
import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from posted_jobs import of, preset
from programs import program, random_job

from pkm_post.certificate.drives import contour_error
from pkm_post.certificate.tool_course import ToolCourse
from pkm_post.geometry import hermite_lengths, norm
from pkm_post.machine import forward

STEP_S = 1e-4
WIDE = (0.01, 0.05)
STEADY = 0.6, 0.9
"""Parts of a motion between which it is long on its circle."""


def figure(certificate, name):
    return next(each.value for each in certificate.figures if each.name.startswith(name))


def with_gains(gains):
    return dataclasses.replace(preset("example_6tps"), velocity_gain=np.broadcast_to(np.asarray(gains, float), 6))


def circle(radius, turns=3, feed=50.0):
    turn = np.linspace(0, 2 * np.pi * turns, 180 * turns)
    way = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(len(turn), 60.0)])
    return program(way, feed=feed)


def followed(machine, motion, struts):
    """Where the tip ought to be and where loops of these gains bring it, (T, 3) each, in even steps of time."""
    time = np.arange(0, struts.time_ms[-1] / 1000, STEP_S)
    row = np.clip(np.searchsorted(struts.time_ms / 1000, time, side="right") - 1, 0, len(struts) - 2)
    begin, duration = struts.time_ms[row] / 1000, np.diff(struts.time_ms)[row] / 1000
    ends = struts.length[row], struts.speed[row], struts.length[row + 1], struts.speed[row + 1]
    asked = hermite_lengths(*ends, duration, ((time - begin) / duration)[:, None])[:, 0]
    there, at = np.empty_like(asked), asked[0]
    keep = np.exp(-machine.velocity_gain * STEP_S)  # exact for a loop whose command stands during a step
    for step, command in enumerate(asked):
        at = command + (at - command) * keep
        there[step] = at
    some = slice(None, None, 20)
    guess = motion.tip[row][some], motion.axis[row][some], motion.spin[row][some]
    tool = motion.tool_length[row + 1][some]
    return [forward(machine, lengths[some], tool, *guess).tip for lengths in (asked, there)]


def off_path(path, points):
    """Distance of points from a path given by close places, in micrometres."""
    begin, way = path[:-1], np.diff(path, axis=0)
    keep = norm(way) > 1e-9
    begin, way = begin[keep], way[keep]
    nearest = []
    for point in points:
        share = np.clip(((point - begin) * way).sum(axis=1) / np.square(way).sum(axis=1), 0, 1)
        nearest.append(norm(point - begin - share[:, None] * way).min())
    return 1000 * np.array(nearest)


def steady(machine, motion, struts):
    """Contour errors of a motion where it runs steadily, in micrometres."""
    task = SimpleNamespace(struts=struts, knots=ToolCourse.of(machine, struts, motion)[1])
    begin, end = np.searchsorted(struts.time_ms, [part * struts.time_ms[-1] for part in STEADY])
    return contour_error(task, machine.velocity_gain)[begin:end]


def test_equal_gains_draw_a_smaller_circle():
    radius, feed, gain = 20.0, 50.0, 30.0
    machine, _, motion, struts, certificate, _ = of(with_gains(gain), circle(radius, feed=feed), WIDE)
    expected = 1000 * (radius - radius / np.sqrt(1 + (feed / (radius * gain)) ** 2))  # 69 um, docs/references.md
    found = steady(machine, motion, struts)
    assert np.median(found) == pytest.approx(expected, rel=0.02)
    assert found.max() <= figure(certificate, "contour error")


@pytest.mark.parametrize("gains", [30.0, [30, 33, 30, 30, 30, 30], [40, 30, 35, 45, 38, 50]])
def test_six_loops_leave_the_circle_by_what_is_told(gains):
    machine, _, motion, struts, certificate, faults = of(with_gains(gains), circle(15.0, turns=1), WIDE)
    assert faults == ()
    asked, there = followed(machine, motion, struts)
    begin, end = (int(part * len(there)) for part in STEADY)
    found, told = off_path(asked, there[begin:end]).max(), steady(machine, motion, struts).max()
    assert 0.8 * told <= found <= 1.05 * told
    assert told <= figure(certificate, "contour error")


def test_unequal_gains_leave_a_straight_line_and_equal_ones_do_not():
    line = program([[-40, 0, 60], [40, 0, 60]], feed=40.0)
    errors = []
    for gains in (30.0, [30, 33, 30, 30, 30, 30]):
        machine, _, motion, struts, certificate, _ = of(with_gains(gains), line, WIDE)
        asked, there = followed(machine, motion, struts)
        errors.append(off_path(asked, there[len(there) // 2 : -len(there) // 4]).max())
        assert errors[-1] <= 1.05 * figure(certificate, "contour error")
    assert errors[1] > 5 * errors[0]


def test_one_count_moves_the_tip_by_no_more_than_is_told():
    machine, _, motion, struts, certificate, _ = of(preset("example_6tps"), random_job(np.random.default_rng(3)), WIDE)
    count = 1 / machine.controller["counts_per_mm"]
    rows = np.arange(0, len(motion), max(1, len(motion) // 40))
    most = 0.0
    for signs in itertools.product((1, -1), repeat=6):
        lengths = struts.length[rows] + count * np.array(signs)
        moved = forward(
            machine, lengths, motion.tool_length[rows], motion.tip[rows], motion.axis[rows], motion.spin[rows]
        )
        most = max(most, 1000 * norm(moved.tip - motion.tip[rows]).max())
    told = figure(certificate, "tip moved by one count")
    assert 0.9 * told <= most <= told * 1.01


def test_without_gains_there_is_no_figure_of_them():
    unstated = dataclasses.replace(preset("example_6tps"), velocity_gain=None)
    *_, certificate, _ = of(unstated, circle(15.0, turns=1), WIDE)
    assert not [each for each in certificate.figures if each.name.startswith("contour error")]
    assert ("following error", "not covered") in [(row.subject, row.extent.value) for row in certificate.coverage]
