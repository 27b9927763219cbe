# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random jobs on the machines of the presets, planned, printed with some decimals, and certified."""

from dataclasses import replace
from functools import cache

import numpy as np
from programs import random_job

from pkm_post.certificate import certify
from pkm_post.geometry import hermite_lengths
from pkm_post.machine import forward_from_rotation, machine_named, platform_rotation
from pkm_post.model.certificate import Tolerances
from pkm_post.planning import plan
from pkm_post.toolpath.place import place

NARROW, WIDE, UNEQUAL = (1e-3, 1e-3), (0.2, 2.0), (1e-3, 2.0)
"""Tolerances of tip, mm, and tool axis, degrees."""
STEP = 1e-4
"""s: of the finite differences. Forward kinematics ends within 1e-10 mm, so accelerations are right to 0.04 mm/s^2."""


@cache
def preset(name):
    """The machine of a preset."""
    machine, faults = machine_named(name)
    assert not faults
    return machine


def offset(machine):
    """A work offset that puts random jobs about the machine's home."""
    frame = np.eye(4)
    frame[:3, 3] = machine.home_tip - [0, 0, 60]
    if machine.name.startswith("Example"):
        frame[2, 3] = 150
    return frame


@cache
def posted(name, seed, tolerances, decimals=(6, 4)):
    """Machine, trajectory, plan, printed struts, certificate and faults of a random job; none where out of reach."""
    return printed(preset(name), planned(name, seed, tolerances), tolerances, decimals)


@cache
def planned(name, seed, tolerances):
    """Trajectory and plan of a random job; none where out of reach."""
    return _planned(preset(name), random_job(np.random.default_rng(seed)), tolerances)


def of(machine, program, tolerances, decimals=(6, 4)):
    """What ``posted`` returns, of a program."""
    return printed(machine, _planned(machine, program, tolerances), tolerances, decimals)


def _planned(machine, program, tolerances):
    trajectory, faults = place(program, machine, offset(machine))
    if faults:
        return None
    made, faults = plan(trajectory, machine, _asked(tolerances))
    return None if faults else (trajectory, made)


def _asked(tolerances):
    tip, axis = tolerances
    return Tolerances(tip, np.radians(axis))


def printed(machine, job, tolerances, decimals):
    """What ``posted`` returns, of a job that is planned."""
    if job is None:
        return None
    trajectory, made = job
    motion, exact = made.motion, made.struts
    length, speed = (np.round(one, digits) for one, digits in zip((exact.length, exact.speed), decimals, strict=True))
    struts = replace(exact, length=length, speed=speed)
    certificate, found = certify(struts, "x.pmc", trajectory, machine, motion, _asked(tolerances))
    return machine, trajectory, motion, struts, certificate, found


def finding(certificate, name):
    """The row of a certificate with a name."""
    return next(row for row in certificate.findings if row.name == name)


def played(machine, motion, struts, rows, instants):
    """Rate of the tool axis, rad/s, and acceleration of the tip, mm/s^2, of some intervals at even instants.

    By finite differences of poses that Newton's method finds, (N, M, 3) each: no formula of the certificate is in it.
    """
    duration = np.diff(struts.time_ms)[rows] / 1000
    ends = struts.length[rows], struts.speed[rows], struts.length[rows + 1], struts.speed[rows + 1]
    share = np.broadcast_to(np.linspace(0, 1, instants), (len(rows), instants))
    knot = np.repeat(rows, instants)
    tool = motion.tool_length[knot + 1]
    at, turned = motion.tip[knot], platform_rotation(motion.axis[knot], motion.spin[knot])
    tips, axes = [], []
    for shift in (-STEP, 0.0, STEP):  # the cubics go on beyond their ends
        length = hermite_lengths(*ends, duration, share + shift / duration[:, None]).reshape(-1, 6)
        pose = forward_from_rotation(machine, length, tool, at, turned)
        assert pose.converged.all()
        at, turned = pose.tip, pose.rotation  # little is left to the next instant
        tips.append(pose.tip.reshape(len(rows), instants, 3))
        axes.append(pose.axis.reshape(len(rows), instants, 3))
    return (axes[2] - axes[0]) / (2 * STEP), (tips[2] - 2 * tips[1] + tips[0]) / STEP**2
