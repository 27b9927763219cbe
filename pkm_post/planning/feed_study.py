# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feed study: the feed as programmed, as possible on the machine, and as planned, at even instants of a motion.

Input: the feed plan. Output: columns by time. The possible feed is the highest speed at which every strut, the tip and
the tool axis keep their speed limits, and their acceleration limits by path curvature alone: the feed that a plan could
reach there given unlimited room to accelerate. Where the plan is below the programmed feed, the limit is the quantity
that uses the largest share of its limit at that instant. Units: mm, s.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import AT_FEED, FeedStudy, Machine, Trajectory
from pkm_post.planning.schedule import Schedule
from pkm_post.planning.speed_limits import LimitedQuantity, limited_quantities
from pkm_post.planning.tool_path import ToolPath

_INSTANTS = 2000
_NEGLIGIBLE = 1e-9
"""Derivatives below this impose no limit; keeps quotients finite."""
_CONTROLLER = "blocks of the controller"
_QUANTITIES = ("strut", "tip", "tool axis")
"""Names of the limited quantities, in order."""


def feed_study(path: ToolPath, schedule: Schedule, trajectory: Trajectory, machine: Machine) -> FeedStudy:
    """The feed of a planned motion.

    Args:
        path: the planned path; its feed is reduced where the controller needs it.
        schedule: position along the path by time.
        trajectory: as programmed.
        machine: its limits.
    """
    time = (np.arange(_INSTANTS) + 0.5) / _INSTANTS * schedule.rests_ms[-1] / 1000
    s, speed, acceleration = schedule.at(time)
    poses = path.at(s)
    row = poses.segment
    names, possible, used = zip(*_columns(limited_quantities(machine, poses), speed, acceleration), strict=True)
    programmed = trajectory.feed[row]
    names, used = (*names, _CONTROLLER), (*used, np.where(path.feed[row] < programmed, speed / path.feed[row], 0.0))
    moved = np.where(norm(poses.tip_1) > _NEGLIGIBLE, norm(poses.tip_1), 1.0)  # 1 where the tool turns in place
    planned = speed * moved
    return FeedStudy(
        time=time,
        programmed=programmed,
        possible=np.minimum.reduce(possible) * moved,
        planned=planned,
        limit=np.where(planned >= AT_FEED * programmed, -1, np.argmax(used, axis=0)),
        limits=names,
        row=row,
        cutting=trajectory.cutting()[row],
    )


def _columns(
    quantities: tuple[LimitedQuantity, ...], speed: Array, acceleration: Array
) -> Iterator[tuple[str, Array, Array]]:
    """For each limit its name, the highest path speed it allows, and its used share, (M,) each."""
    for noun, item in zip(_QUANTITIES, quantities, strict=True):
        now = item.first * acceleration[:, None] + item.second * np.square(speed)[:, None]
        first_second_now = (item.magnitudes(vectors).T for vectors in (item.first, item.second, now))
        for number, (first, second, accelerated) in enumerate(zip(*first_second_now, strict=True), 1):
            name = f"{noun} {number}" if item.each else noun
            if np.isfinite(item.speed):
                yield f"speed of {name}", item.speed / np.maximum(first, _NEGLIGIBLE), first * speed / item.speed
            if np.isfinite(item.acceleration):
                allowed = np.sqrt(item.acceleration / np.maximum(second, _NEGLIGIBLE))
                yield f"acceleration of {name}", allowed, accelerated / item.acceleration
