# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage: which hazards a certificate covers, and which it does not.

Enters: a machine and a trajectory. Leaves: a row for each hazard. A body whose size the machine file does not state is
not checked, so the rows differ from machine to machine. docs/certificate.md has the same table for users.
"""

from __future__ import annotations

import math

from pkm_post.certificate.beside_the_path import beside_the_path
from pkm_post.machine import NO_SETUP, has_strut_bodies
from pkm_post.model import Coverage, Extent, Machine, Topic, Trajectory

_PATH = (
    ("tool tip and axis", "the program as written, played at every moment against the trajectory"),
    ("feed", "the speed of the tip at every moment against the programmed feed"),
    ("events", "their order and their place on the path"),
)
_LIMITS = (
    ("strut length, speed and acceleration", "the program as written, at every moment"),
    ("tip acceleration and turning rate of the tool axis", "the program as written, at every moment"),
    ("intervals between points", "none is shorter than controller.shortest_interval"),
    ("joints and singular poses", "the planned path with its rounded corners, between its points as well"),
)
_SETUP = (
    ("geometry of the machine", "taken from the machine file"),
    ("work offset and gauge lengths", "taken from the job"),
    ("controller set-up, codes and override", "the set-up file states what the program relies on"),
    ("stiffness, heat and cutting forces", "no model of them is computed"),
)


_JERK = "the mean acceleration from one interval to the next"
_NO_LIMIT = "the machine file states no {}"
_STEPS = "none is stated; the report has the largest"


def coverage(
    machine: Machine, trajectory: Trajectory, collisions: tuple[Coverage, ...] = NO_SETUP
) -> tuple[Coverage, ...]:
    """The hazards, ordered by topic.

    Args:
        machine: the statements of its file determine what was checked.
        trajectory: determines the coverage beside the path.
        collisions: rows of checks against part, stock and fixtures, which are not in the machine file.
    """
    return (
        *_rows(Topic.PATH, Extent.PROVEN, _PATH),
        *_rows(Topic.LIMITS, Extent.PROVEN, _LIMITS),
        *_jerks(machine),
        _block_rate(machine),
        *_collisions(machine),
        *collisions,
        *beside_the_path(machine, trajectory),
        *_rows(Topic.SETUP, Extent.NOT_COVERED, _SETUP),
        _following(machine),
    )


def _rows(topic: Topic, extent: Extent, rows: tuple[tuple[str, str], ...]) -> tuple[Coverage, ...]:
    return tuple(Coverage(topic, subject, extent, detail) for subject, detail in rows)


def _block_rate(machine: Machine) -> Coverage:
    if math.isfinite(machine.block_rate):
        return Coverage(Topic.LIMITS, "blocks in a second", Extent.PROVEN, "every second of the program")
    return Coverage(Topic.LIMITS, "blocks in a second", Extent.NOT_COVERED, _NO_LIMIT.format("controller.block_rate"))


def _following(machine: Machine) -> Coverage:
    """Following errors are reported as a contour error at the knots, without a limit."""
    if machine.velocity_gain is None:
        return Coverage(Topic.SETUP, "following error", Extent.NOT_COVERED, _NO_LIMIT.format("struts.velocity_gain"))
    return Coverage(Topic.SETUP, "following error", Extent.SAMPLED, "struts as first-order lags; a figure, no limit")


def _jerks(machine: Machine) -> tuple[Coverage, ...]:
    """Jerk is checked from one interval to the next if a limit is stated; steps at the knots have no limit."""
    limits = (
        ("strut jerk", "struts.jerk", machine.strut_jerk),
        ("tip jerk", "tool_path.tip_jerk", machine.tip_jerk),
    )
    known = tuple(
        Coverage(Topic.LIMITS, subject, Extent.SAMPLED, _JERK)
        if math.isfinite(limit)
        else Coverage(Topic.LIMITS, subject, Extent.NOT_COVERED, _NO_LIMIT.format(entry))
        for subject, entry, limit in limits
    )
    return (*known, Coverage(Topic.LIMITS, "steps of acceleration at knots", Extent.NOT_COVERED, _STEPS))


def _collisions(machine: Machine) -> tuple[Coverage, ...]:
    """The bodies in the machine file are checked on the planned path."""
    struts, bodies, fixtures = has_strut_bodies(machine), bool(machine.bodies), bool(machine.fixtures)
    pairs = (
        ("strut and strut", struts, "tubes or rods of the struts"),
        ("strut and platform", struts and bodies, "tubes or rods of the struts and bodies of the platform"),
        ("strut and fixture", struts and fixtures, "tubes or rods of the struts and fixtures"),
        ("spindle and fixture", bodies and fixtures, "bodies of the platform and fixtures"),
    )
    return tuple(
        Coverage(Topic.COLLISIONS, subject, Extent.PROVEN, "the planned path, between its points as well")
        if stated
        else Coverage(Topic.COLLISIONS, subject, Extent.NOT_COVERED, f"the machine file does not state {needed}")
        for subject, stated, needed in pairs
    )
