# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time and line of a finding belong together, and there it is worst; also where an interval has many short chords."""

import numpy as np
import pytest
import test_nothing_exceeds
from programs import program
from test_nothing_exceeds import TOLERANCES, certified

from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.geometry import angle_between, hermite_lengths, hermite_speeds, norm
from pkm_post.machine import forward, linearise

MOMENT = 1e-9
"""s: times are computed in seconds, those of the program are whole milliseconds."""
LOOKED_FOR = "V101", "V102", "V108"
DENSE = 1001
"""Instants of an interval: four for each one of the certificate."""
NEARLY = 0.99
"""Part of the worst of these that there is at the moment reported: looks are as far apart as four of these instants."""
FIGURE = 0.1
"""Part by which the figure may differ from that: it has what can hide, and counts programmed points at joints."""


def short_chords(count=600, chord=0.05, radius=20.0):
    """An arc in chords of a twentieth of a millimetre; the tool axis swings."""
    angle = np.arange(count) * chord / radius
    tilt = np.radians(5) * np.sin(3 * angle)
    position = np.column_stack([radius * np.sin(angle), radius * (1 - np.cos(angle)), np.full(count, 50.0)])
    return program(position, np.column_stack([np.sin(tilt), 0 * tilt, np.cos(tilt)]))


@pytest.fixture(autouse=True)
def jobs(monkeypatch):
    monkeypatch.setitem(test_nothing_exceeds.SHAPES, "short chords", short_chords)


JOBS = ["short chords", "cone", "arcs and a helix", *range(16)]


def certified_or_skipped(job):
    if certified(job) is None:
        pytest.skip("beyond the reach of the machine")
    return certified(job)


def executed(trajectory, motion, time):
    """Lines of the segments under way at a time."""
    return set(trajectory.line[under_way(motion, time)].tolist())


def apart_from_joints(motion, begin, end, *times):
    """Instants of an interval without those between a joint and the look beside it.

    There the programmed point of the joint counts, which may be nearer than the segment under way.
    """
    times = np.array(times or np.linspace(begin, end, DENSE))
    look = 4 * (end - begin) / (DENSE - 1)
    joints = motion.joint_time[(motion.joint_time > begin - look) & (motion.joint_time < end + look)]
    return times[(np.abs(times[:, None] - joints) > look).all(axis=1)]


def under_way(motion, time):
    """Segments under way at a time, as the joints of the plan tell it: two at a joint."""
    ends = motion.joint_time
    begins = np.concatenate([[0.0], ends[:-1]])
    return np.flatnonzero((begins <= time + MOMENT) & (time <= ends + MOMENT))


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS)
def test_the_line_reported_is_that_of_the_program_at_the_time_reported(job):
    _, trajectory, motion, _, certificate = certified_or_skipped(job)
    for finding in certificate.findings:
        assert finding.place.line in executed(trajectory, motion, finding.time), finding


def test_intervals_of_short_chords_have_many_lines():
    _, _, motion, _, _ = certified("short chords")
    assert np.diff(motion.segment).max() > 10


def test_what_is_known_of_an_interval_as_a_whole_is_reported_at_its_start_with_what_comes_next():
    _, trajectory, motion, struts, certificate = certified("short chords")
    whole = [finding for finding in certificate.findings if finding.code in ("V103", "V104", "V106", "V107")]
    assert len(whole) == 5
    for finding in whole:
        assert np.abs(struts.time_ms[:-1] / 1000 - finding.time).min() < MOMENT
        assert executed(trajectory, motion, finding.time + 2 * MOMENT) == {finding.place.line}


def at_times(job, knot, time, segment):
    """What the tool does at times in an interval, by Newton's method, by code of the finding, (N,) each.

    Deviations, mm and degrees, are those from segments of these times; speeds are of the tip, mm/s.
    """
    trajectory = certified(job)[1]
    pose, velocity = played(job, knot, time)
    tip, axis, _ = TrajectoryRuler(trajectory, TOLERANCES).deviation_from(pose.tip, pose.axis, segment)
    return {"V101": tip, "V102": np.degrees(axis), "V108": norm(velocity)}


def from_joint(job, knot, time, segment):
    """Deviations, mm and degrees, from the programmed end of a segment: at a corner more than from its sides."""
    trajectory = certified(job)[1]
    pose, _ = played(job, knot, np.array([time]))
    angle = angle_between(pose.axis[0], trajectory.axis[segment])
    return {"V101": norm(pose.tip[0] - trajectory.tip[segment]), "V102": np.degrees(angle)}


def played(job, knot, time):
    """Poses of the tool at times in an interval, and velocities of the tip, (N, 3)."""
    machine, _, motion, struts, _ = certified(job)
    begin, end = struts.time_ms[knot] / 1000, struts.time_ms[knot + 1] / 1000
    row, share = np.full(len(time), knot), (time - begin) / (end - begin)
    cubic = (column[at : at + 1] for at in (knot, knot + 1) for column in (struts.length, struts.speed))
    cubic = *cubic, np.array([end - begin])
    length, speed = (of(*cubic, share)[0] for of in (hermite_lengths, hermite_speeds))
    tool = motion.tool_length[row + 1]
    pose = forward(machine, length, tool, motion.tip[row], motion.axis[row], motion.spin[row])
    assert pose.converged.all()
    jacobian, _ = linearise(machine, pose.tip, pose.rotation, tool)
    return pose, np.linalg.solve(jacobian, speed[..., None])[:, :3, 0]


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS)
def test_no_moment_of_the_interval_is_worse_than_the_one_reported(job):
    _, _, motion, struts, certificate = certified_or_skipped(job)
    for finding in certificate.findings:
        if finding.code in LOOKED_FOR:
            knot = np.searchsorted(certificate.time, finding.time, side="right") - 1
            times = apart_from_joints(motion, *struts.time_ms[[knot, knot + 1]] / 1000)
            segments = np.array([under_way(motion, time)[0] for time in times])
            elsewhere = at_times(job, knot, times, segments)[finding.code].max()
            reported = under_way(motion, finding.time)
            there = at_times(job, knot, np.full(len(reported), finding.time), reported)[finding.code].max()
            assert there >= NEARLY * elsewhere, finding
            most = there
            if len(reported) > 1:
                most = max(there, from_joint(job, knot, finding.time, reported[0]).get(finding.code, 0.0))
            assert finding.value <= (1 + FIGURE) * most, finding
            if finding.time in apart_from_joints(motion, *struts.time_ms[[knot, knot + 1]] / 1000, finding.time):
                assert finding.value >= (1 - FIGURE) * there, finding
