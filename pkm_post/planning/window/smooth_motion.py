# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth window: jerk-limited motion along a part of a path, from any place and speed to rest.

A window is the fastest motion from rest to rest that ``jerk.profile`` finds. One that continues a motion starts one
stopping distance behind it. The speed squared of both is a quadratic spline of the path length, so a transition blends
their coefficients: speed and acceleration do not jump. The length of the transition is searched, with limits measured
each half millisecond; if no length keeps them, the motion stays as it is and rests at its end. A stop scales the time
of the motion (``motion_law``), as fast as the limits allow.

Windows use only a share of the acceleration and jerk limits, since stops and transitions need the rest.

Input: a path, a machine, a motion, an override. Output: motion laws. Units: mm, s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, norm
from pkm_post.model import Machine, pieces
from pkm_post.planning.jerk.profile import jerk_limited
from pkm_post.planning.motion_law import MotionLaw, TimeScaledLaw
from pkm_post.planning.profile.refinement import SpanToRest
from pkm_post.planning.rough_limits import DerivativeBounds
from pkm_post.planning.speed_limits import limited_quantities
from pkm_post.planning.speed_profile import stations
from pkm_post.planning.speed_spline import durations, within_cells
from pkm_post.planning.tool_path import ToolPath


class Shares(NamedTuple):
    """Shares of the limits for planning a window."""

    acceleration: float
    jerk: float


FULL, GENTLE = Shares(0.92, 0.85), Shares(0.45, 0.3)
_MOST_USE = 0.985
"""Largest use of a limit in a stop or transition; the rest is for decimals and cubics."""
_SPEED_ROUNDING = 1.001
"""Rounding allowance on speed limits, which a motion may use in full."""
_FIRST_STOP_MS, _LONGEST_STOP_MS = 32, 1 << 15
_STEP_S, _LEAST_STEPS = 0.0005, 64
"""Longest step for measuring a motion, s, and least number of steps: in a short stop they are shorter."""
_STOP_STEPS = 5
"""Halvings between a stop that is too short and one twice as long."""
_FIRST_CHANGE, _LONGER_CHANGE = 0.5, 1.6
"""Length of the first transition, per stopping distance, and factor to the next."""
_LEAST_NODES = 32
"""Least places of a transition."""
_APART = 1e-6
"""Least gap between places, per length of a transition."""
_MORE_S = 0.05
"""s after a transition in which limits are still measured: the stretch to whole ms slows it slightly."""
_BISECTIONS = 50
_AT_ONCE = 4096
_LEAST = 1e-6
"""mm"""


@dataclass(frozen=True)
class SpeedLaw:
    """Speed squared along a path, a quadratic spline with M places, to a rest at its end."""

    s: Array
    square: Array
    acceleration: Array

    @classmethod
    def of(cls, law: MotionLaw) -> SpeedLaw:
        """The speed of a motion with continuous acceleration."""
        if law.acceleration is None:
            raise ValueError("law: expected accelerations at its places")
        return cls(law.s, law.speed**2, law.acceleration)

    @property
    def first(self) -> float:
        """Path length from which it is a quadratic spline: a first cell after a rest is none."""
        return float(self.s[0] if self.square[0] else self.s[1])

    def duration(self) -> float:
        """Time to its end, s."""
        return float(durations(np.diff(self.s), self.square, self.acceleration).sum())

    def law(self, seconds: float) -> MotionLaw:
        """Path length by time; ``seconds`` is its duration, whole ms but for rounding."""
        time = np.concatenate([[0.0], np.cumsum(durations(np.diff(self.s), self.square, self.acceleration))])
        time *= seconds / time[-1]
        time[-1] = seconds
        return MotionLaw(self.s, time, np.sqrt(self.square), self.acceleration)

    def at(self, s: float) -> tuple[float, float]:
        """Speed squared and acceleration at a path length."""
        cell = np.clip(np.searchsorted(self.s, [s], side="right") - 1, 0, len(self.s) - 2)
        x, a = within_cells(self.s, self.square, self.acceleration, cell, np.array([s]))
        return float(x[0]), float(a[0])

    def coefficients(self, s: Array) -> Array:
        """Coefficients of the cells between places that include its own, (K - 1,); no cell may touch a rest."""
        cell = np.clip(np.searchsorted(self.s, s[:-1], side="right") - 1, 0, len(self.s) - 2)
        x, a = within_cells(self.s, self.square, self.acceleration, cell, s[:-1])
        return np.asarray(x + a * np.diff(s))


def fastest_motion(path: ToolPath, machine: Machine, begin: float, end: float, share: Shares = FULL) -> SpeedLaw:
    """The fastest motion from rest to rest under shares of the limits, with no rest of the program in between."""
    limits = replace(
        machine,
        strut_acceleration=share.acceleration * machine.strut_acceleration,
        tip_acceleration=share.acceleration * machine.tip_acceleration,
        strut_jerk=share.jerk * machine.strut_jerk,
        tip_jerk=share.jerk * machine.tip_jerk,
    )
    near = np.ones(len(path.feed), dtype=np.bool_)
    marks = SpanToRest(begin, end, 0.0).of(stations(path, near), path)
    found = jerk_limited(path, marks, limits, DerivativeBounds.of(path))
    return SpeedLaw(found.s, found.square, found.acceleration)


def in_whole_ms(found: SpeedLaw, shortest_ms: int) -> MotionLaw:
    """Slow a motion from rest to rest evenly, to whole ms."""
    elapsed = found.duration()
    seconds = max(np.ceil(1000 * elapsed - 1e-9), shortest_ms) / 1000
    stretch = (elapsed / seconds) ** 2
    return SpeedLaw(found.s, found.square * stretch, found.acceleration * stretch).law(seconds)


def use_of_limits(path: ToolPath, machine: Machine, law: TimeScaledLaw, until: float) -> float:
    """Largest use of acceleration and jerk limits up to a time; infinite if the speed is too high.

    Jerk is that of a ms, measured each half of one: a corner that takes less may begin anywhere in it.
    """
    worst, count = 0.0, max(int(np.ceil(until / _STEP_S)), _LEAST_STEPS)
    step = min(_STEP_S, until / _LEAST_STEPS)
    for rows in pieces(count, _AT_ONCE):
        time = np.minimum(np.arange(rows.start, min(rows.stop + 1, count) + 1) * step, law.duration)
        s, speed, acceleration = law.at(time)
        poses = path.at(s)
        for item in limited_quantities(machine, poses):
            rate = item.first * speed[:, None]
            change = item.first * acceleration[:, None] + item.second * (speed**2)[:, None]
            jerk = (change[2:] - change[:-2]) / (2 * step)
            sizes = [np.abs(values) if item.each else norm(values) for values in (rate, change, jerk)]
            speed_use, *uses = (
                float(size.max(initial=0.0)) / limit
                for size, limit in zip(sizes, (item.speed, item.acceleration, item.jerk), strict=True)
            )
            if not (speed_use <= _SPEED_ROUNDING and np.isfinite(uses).all()):
                return np.inf
            worst = max(worst, *uses)
    return worst


def shortest_stop(path: ToolPath, machine: Machine, moving: TimeScaledLaw) -> TimeScaledLaw:
    """The motion with the shortest stop; the motion itself if it rests sooner."""

    def is_possible(ms: int) -> bool:
        return use_of_limits(path, machine, moving._replace(stop=ms / 1000), ms / 1000) <= _MOST_USE

    ms = first = max(_FIRST_STOP_MS, machine.shortest_interval)
    while ms / 2000 < moving.duration and ms <= _LONGEST_STOP_MS and not is_possible(ms):
        ms *= 2
    if ms / 2000 >= moving.duration or ms > _LONGEST_STOP_MS:
        return moving
    low = ms // 2 if ms > first else machine.shortest_interval
    for _ in range(_STOP_STEPS):
        middle = (low + ms) // 2
        low, ms = (low, middle) if is_possible(middle) else (middle, ms)
    return moving._replace(stop=ms / 1000)


def transition(
    path: ToolPath, machine: Machine, moving: TimeScaledLaw, target: SpeedLaw, override: float, stop_distance: float
) -> TimeScaledLaw | None:
    """The transition from a moving law to a target; None if no length of it keeps the limits.

    Args:
        path: the path.
        machine: the limits.
        moving: the motion, from the place on; its speed is above 0.
        target: the motion from rest to rest to change over to; it starts before the transition does.
        override: feed override of the target.
        stop_distance: length of a stop on the path, mm.
    """
    (here,), _, _ = moving.at(np.zeros(1))
    old = SpeedLaw.of(moving.law)
    length = _FIRST_CHANGE * max(stop_distance, _LEAST)
    first, last = max(old.first, target.first), min(old.s[-2], target.s[-2])
    while here >= first and here + length < last:
        changed = _blended(old, target, float(here), float(here + length))
        if changed is not None:
            found = TimeScaledLaw(changed, 0.0, override, max(override, moving.highest_override))
            until = float(changed.when(np.array([here + length]))[0]) + _MORE_S
            if use_of_limits(path, machine, found, min(until, found.duration)) <= _MOST_USE:
                return found
        length *= _LONGER_CHANGE
    return None


def _blended(old: SpeedLaw, target: SpeedLaw, here: float, there: float) -> MotionLaw | None:
    """Blend from the old motion at ``here`` to the target from ``there`` on, in whole ms; None if impossible."""
    s = _blend_nodes(old, target, here, there)
    under_way, inside = s[:-1], np.searchsorted(s, there)
    middle = (under_way[1:] + under_way[:-1]) / 2  # a coefficient counts most there
    share = _step((middle - middle[0]) / (middle[inside - 1] - middle[0]))
    wanted = target.coefficients(under_way)
    wanted[:inside] *= share[:inside]
    wanted[:inside] += (1 - share[:inside]) * old.coefficients(s[: inside + 1])
    behind = (s[0] + s[-1]) / 2
    slower = _step((middle - middle[0]) / (behind - here))
    x, a = old.at(here)
    start, end = np.array([x, a]), np.array(target.at(float(s[-2])))

    def law(less: float) -> SpeedLaw:
        return _of_coefficients(s, wanted * (1 - less * slower), start, end * (1 - less))

    elapsed = law(0.0).duration()
    wanted_s = np.ceil(1000 * elapsed - 1e-9) / 1000
    low, high = 0.0, 0.5
    if not np.isfinite(elapsed) or law(high).duration() < wanted_s:
        return None
    for _ in range(_BISECTIONS):
        less = (low + high) / 2
        low, high = (less, high) if law(less).duration() < wanted_s else (low, less)
    return law(high).law(float(wanted_s))


def _blend_nodes(old: SpeedLaw, target: SpeedLaw, here: float, there: float) -> Array:
    """The places of both motions and more in between, then those of the target."""
    both = np.concatenate([old.s, target.s, np.linspace(here, there, _LEAST_NODES)])
    both = np.unique(both[(both > here) & (both < there)])
    both = both[(both - here > _APART * (there - here)) & (there - both > _APART * (there - here))]
    apart = np.append(True, np.diff(both) > _APART * (there - here))
    return np.concatenate([[here], both[apart], [there], target.s[target.s > there + _APART * (there - here)]])


def _step(share: Array) -> Array:
    """Smooth step from 0 to 1."""
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(share**2 * (3 - 2 * share))


def _of_coefficients(s: Array, coefficients: Array, start: Array, end: Array) -> SpeedLaw:
    """A motion from the coefficients of its cells, (M - 2,), without the last cell, which touches the rest.

    Args:
        s: (M,) places.
        coefficients: x + a ds of each cell.
        start: speed squared and acceleration at the first place.
        end: those at the last place but one.
    """
    width = np.diff(s)[:-1]
    before, own = width[:-1], width[1:]
    square = (own * coefficients[:-1] + before * coefficients[1:]) / (before + own)
    acceleration = np.diff(coefficients) / (before + own)
    return SpeedLaw(
        s,
        np.concatenate([start[:1], square, end[:1], [0.0]]),
        np.concatenate([start[1:], acceleration, end[1:], [0.0]]),
    )
