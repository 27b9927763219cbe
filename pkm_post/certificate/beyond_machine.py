# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beyond the machine: values of a trajectory that no posting for its machine can produce.

Enters: a trajectory read from a file, and the machine it names. Leaves: places, and the value found there. Such a file
was modified; it is not planned, since its path or duration may be unbounded.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import norm
from pkm_post.model import EventKind, Kind, Machine, Place, Trajectory

_FARTHEST = 10
"""Distance from the middle of the base in longest struts, as in placement."""
_ROUNDING = 1e-9
"""Relative rounding error of limits converted from other units."""
_SAME = 1e-9
"""mm, rad, and of unit axes."""


def beyond_machine(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    """Each quantity beyond the machine, with its first place.

    Args:
        trajectory: at least one segment with any values that a trajectory file may have.
        machine: the machine it was made for.
    """
    yield from _of_segments(trajectory, machine)
    yield from _of_start(trajectory, machine)
    yield from _of_spindle(trajectory, machine)


def _of_segments(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    most = np.where(trajectory.kind == Kind.RAPID, machine.rapid_speed, machine.feed_speed)
    away = norm(trajectory.tip - machine.base_joints.mean(axis=0))
    for wrong, values, words in (
        (away > _FARTHEST * machine.strut_stroke[1], away, "the tip is {:.6g} mm from the middle of the base"),
        (trajectory.feed > most * (1 + _ROUNDING), trajectory.feed, "the feed is {:.6g} mm/s, the machine allows less"),
    ):
        rows = np.flatnonzero(wrong)
        if len(rows):
            yield trajectory.place(int(rows[0])), words.format(values[rows[0]])


def _of_start(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    pairs = (
        (trajectory.start_tip, machine.home_tip),
        (trajectory.start_axis, machine.home_axis),
        (np.array([trajectory.start_spin]), np.array([machine.home_spin])),
    )
    if any(np.abs(start - home).max() > _SAME for start, home in pairs):
        yield Place(trajectory.source), "the start pose is not the home of the machine"


def _of_spindle(trajectory: Trajectory, machine: Machine) -> Iterator[tuple[Place, str]]:
    for event in trajectory.events:
        speed = abs(event.value)
        allowed = machine.spindle_least_speed <= speed <= machine.spindle_speed
        if event.kind is EventKind.SPINDLE and speed and not allowed:
            yield trajectory.place(min(event.row, len(trajectory) - 1)), f"the spindle turns at {speed:g} rpm"
            return
