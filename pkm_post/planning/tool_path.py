# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool path: tip, axis and spin with rounded corners, as functions of path length s.

Input: a trajectory and the tolerances of tip and axis at its corners. Output: poses with exact first and second
derivatives at any s, in mm and rad. Tip and axis are rounded in step, so that cutting direction and tool attitude stay
synchronous; the axis always turns along great circles, never through Euler angles [paper section 5.2].

A joint whose direction changes by D (unit tangents by path length) is rounded over the half width d on both sides
with the cubic step W(v) = 3 v^2 - 2 v^3, v = (x + d) / 2d: the rounded path starts and ends with the curvature of its
segments, and its deviation at the joint is |D| times the integral of W up to the joint, 3/16 d |D|. Where extended arcs
diverge beyond that change of direction, the path follows them with the quintic step S(v) = 10 v^3 - 15 v^4 + 6 v^5,
whose second derivative is also zero at both ends.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from pkm_post.geometry import Array, along_rates, norm
from pkm_post.model import Poses, Trajectory, pieces, read_only, select_rows, uniform
from pkm_post.toolpath import Segments, direction

FOR_CORNERS = np.array([0.55, 0.4])
"""Shares of the tolerances of tip and axis for rounding corners."""
OFFSET = 3 / 16
"""Deviation at the joint per half width and change of direction."""
_BLEND_DEVIATION = 0.0134
"""Deviation per half width squared and change of curvature: the maximum of (2v - 1)^2 S(v) / 2 before the joint."""
_NEGLIGIBLE = 1e-12
"""Changes below this impose no limit; keeps quotients finite."""
_BEND = 0.5
"""rad: largest extension of an arc; beyond it, the two segments of a joint no longer approximate each other."""
_SHARE = 0.45
"""Share of the shorter neighbour that a blend may use; two blends on one segment never meet."""
_JOINTS_AT_ONCE = 16384
"""Joints whose blends are computed in one pass."""
_INSIDE = 1 - 1e-9
"""Share of the half width that counts as the blend: at its very end the segment is exact despite rounding."""


Triple = tuple[Array, Array, Array]
"""A quantity with first and second derivative."""


@dataclass(frozen=True)
class ToolPath:
    """A path of N segments with the N - 1 blends between them.

    Attributes:
        segments: the segments before rounding.
        starts: (N + 1,) path length s at the start of each segment, and at the end of the path.
        blend: (N + 1,) half width of the blend at the start of each segment; 0 at rests and at both ends.
        rounding: (2, N + 1) how much of the corner tolerances of tip and axis that blend uses, up to 1.
        rests: (N + 1,) whether the motion stops at the start of each segment; true at both ends.
        feed: (N,) highest speed by path length, mm/s.
        tool_length: (N,) gauge length in use.
        tip_tolerance: (N,) programmed tolerance of the tip on each segment, mm; 0 if none.
        share: (N,) of the acceleration limits to plan with if jerk is limited; of those of jerk its power 3/2.
    """

    segments: Segments
    starts: Array
    blend: Array
    rounding: Array
    rests: np.ndarray[tuple[int], np.dtype[np.bool_]]
    feed: Array
    tool_length: Array
    tip_tolerance: Array
    share: Array

    @classmethod
    def of(
        cls,
        trajectory: Trajectory,
        tip_tolerance: Array | float,
        axis_tolerance: float,
        segments: Segments | None = None,
    ) -> ToolPath:
        """The path of a trajectory.

        Args:
            trajectory: at least one segment.
            tip_tolerance: largest deviation of the tip from the segments at corners, mm; a number, or (N,) by segment.
                At a joint the lower tolerance of its two segments applies.
            axis_tolerance: largest deviation of the tool axis, rad.
            segments: its segments, if some are smoothed; by default as programmed.
        """
        segments = segments or Segments.of(trajectory)
        rests = np.concatenate([[True], trajectory.exact_stop])
        blend, rounding = _blends(segments, rests, tip_tolerance, axis_tolerance)
        return cls(
            segments=segments,
            starts=np.concatenate([[0.0], np.cumsum(segments.extent)]),
            blend=blend,
            rounding=rounding,
            rests=rests,
            feed=trajectory.feed,
            tool_length=trajectory.tool_length(),
            tip_tolerance=trajectory.tip_tolerance,
            share=uniform(1.0, len(segments)),
        )

    @functools.cached_property
    def attitude(self) -> tuple[Array, Array, Array] | None:
        """Tool axis (1, 3), spin (1,) and gauge length (1,) if constant along the whole path, as with three axes."""
        seg = self.segments
        if seg.axis_rate.any() or seg.spin_rate.any():
            return None
        columns = seg.axis, seg.spin, self.tool_length
        return (seg.axis[:1], seg.spin[:1], self.tool_length[:1]) if all((c == c[:1]).all() for c in columns) else None

    def at(self, s: Array) -> Poses:
        """Poses at path lengths s, (M,); at a joint those of the earlier segment."""
        segment = np.clip(np.searchsorted(self.starts, s) - 1, 0, len(self.segments) - 1)
        return self.within(segment, s - self.starts[segment])

    def within(self, segment: Array, u: Array) -> Poses:
        """Poses at path lengths u, (M,), of the given segments, with derivatives by path length."""
        tip, axis = self.segments.tip_at(segment, u), self.segments.axis_at(segment, u)
        spin = self.segments.spin_at(segment, u)
        to_end = self.segments.extent[segment] - u
        joint, x = segment + (u > to_end), np.where(u > to_end, -to_end, u)
        rows = np.flatnonzero(np.abs(x) < _INSIDE * self.blend[joint])
        if len(rows):
            self._round(joint[rows], x[rows], rows, tip, axis, spin)
        tip_0, tip_1, tip_2 = map(read_only, tip)  # avoids copies
        return Poses(tip_0, tip_1, tip_2, *axis, *spin, select_rows(self.tool_length, segment), segment)

    def _round(self, joint: Array, x: Array, rows: Array, tip: Triple, axis: Triple, spin: Triple) -> None:
        """Overwrite the rows in blends, at distances x from the joints at the starts of segments ``joint``.

        With p1, p2 the two extended segments, D the change of tangent and H the integral of W:
        p = p1 + D H + S (p2 - p1 - D x); if both are lines this is p1 + D H.
        """
        before, seg = joint - 1, self.segments
        at_end, blend = seg.extent[before], _Blend.of(x, self.blend[joint])
        _overwrite(tip, rows, blend.rounded(*_ExtendedSegments(joint, x, at_end).of(seg.tip_at)))
        curved = (seg.is_curve(before) | seg.is_curve(joint)) & seg.splines.turns
        for some, turned in ((~curved, self._round_circles), (curved, self._round_curves)):
            if some.any():
                turned(joint[some], x[some], rows[some], axis, spin)

    def _round_circles(self, joint: Array, x: Array, rows: Array, axis: Triple, spin: Triple) -> None:
        """Overwrite axis and spin in blends of segments whose axis turns along great circles."""
        before, seg = joint - 1, self.segments
        h, w, w1 = step(x, self.blend[joint])
        rate, rate_after = seg.axis_at(before, seg.extent[before])[1], seg.axis_rate[joint]
        if rate.any() or rate_after.any():
            change, (column, first, second) = rate_after - rate, (one[:, None] for one in (h, w, w1))
            tangent = x[:, None] * rate + column * change, rate + first * change, second * change
            _overwrite(axis, rows, along_rates(seg.axis[joint], *tangent))
        if seg.never_spins:
            return
        turn = seg.spin_rate[before]
        change = seg.spin_rate[joint] - turn
        _overwrite(spin, rows, (seg.spin[joint] + turn * x + change * h, turn + change * w, change * w1))

    def _round_curves(self, joint: Array, x: Array, rows: Array, axis: Triple, spin: Triple) -> None:
        """The same next to smooth curves, whose axes do not turn along great circles."""
        seg = self.segments
        blend, ways = _Blend.of(x, self.blend[joint]), _ExtendedSegments(joint, x, seg.extent[joint - 1])
        k, k1, k2 = (one.T for one in blend.rounded(*ways.of(seg.axis_at)))
        k, k1, k2 = direction((k, k1, k2))
        _overwrite(axis, rows, (k.T, k1.T, k2.T))
        turn, turn_1, turn_2 = blend.rounded(*ways.of(_as_vectors(seg.spin_at)))
        _overwrite(spin, rows, (turn[:, 0], turn_1[:, 0], turn_2[:, 0]))


def _overwrite(values: Triple, rows: Array, others: Triple) -> None:
    for value, other in zip(values, others, strict=True):
        value[rows] = other


def _as_vectors(at: Callable[[Array, Array], Triple]) -> Callable[[Array, Array], Triple]:
    """Scalars as vectors of one coordinate."""

    def vectors(segment: Array, u: Array) -> Triple:
        value, first, second = at(segment, u)
        return value[:, None], first[:, None], second[:, None]

    return vectors


def _blends(
    segments: Segments, rests: Array, tip_tolerance: Array | float, axis_tolerance: float
) -> tuple[Array, Array]:
    """Half widths of the blends, (N + 1,), and their shares of the tolerances of tip and axis, (2, N + 1)."""
    blend, rounding = np.zeros(len(segments) + 1), np.zeros((2, len(segments) + 1))
    joints = 1 + np.flatnonzero(~(rests[1:-1] | segments.in_one_curve()))
    tip = np.broadcast_to(tip_tolerance, len(segments))
    for rows in pieces(len(joints), _JOINTS_AT_ONCE):
        joint = joints[rows]
        before, at_start = joint - 1, np.zeros(len(joint))
        at_end = segments.extent[before]
        _, tangent_end, bend_end = segments.tip_at(before, at_end)
        _, tangent_start, bend_start = segments.tip_at(joint, at_start)
        changes = norm(tangent_start - tangent_end), norm(bend_start - bend_end)
        turn = norm(segments.axis_at(joint, at_start)[1] - segments.axis_at(before, at_end)[1])
        curvature, neighbour = np.maximum(norm(bend_start), norm(bend_end)), np.minimum(at_end, segments.extent[joint])
        at_joint = _at_joints(tip, joint)
        half = blend[joint] = half_widths(*changes, curvature, turn, neighbour, at_joint, axis_tolerance)
        rounding[0, joint] = _share(_tip_deviation(*changes, half), at_joint)
        rounding[1, joint] = _share(OFFSET * turn * half, axis_tolerance)
    return blend, rounding


def _tip_deviation(tip_change: Array, curvature_change: Array, half_width: Array) -> Array:
    """Largest deviation of the tip in blends, (N,) mm."""
    return (OFFSET * tip_change + _BLEND_DEVIATION * curvature_change * half_width) * half_width


def _share(deviation: Array, tolerance: Array | float) -> Array:
    """Deviations by tolerance, (N,); where there is no tolerance, there is no blend."""
    return np.divide(deviation, tolerance, out=np.zeros(len(deviation)), where=np.asarray(tolerance) > 0)


def _at_joints(tolerance: Array, joint: Array) -> Array:
    """Lower tolerance of the two segments at each joint."""
    return np.minimum(tolerance[joint - 1], tolerance[joint])


def half_widths(
    tip_change: Array,
    curvature_change: Array,
    curvature: Array,
    axis_change: Array,
    neighbour: Array,
    tip: Array | float,
    axis: float,
) -> Array:
    """Half widths of the blends that stay within the tolerances, (N,) in path length.

    Args:
        tip_change: (N,) magnitude of the change of the tip's tangent at each joint.
        curvature_change: (N,) magnitude of the change of the tip's curvature vector, 1/mm.
        curvature: (N,) the higher curvature of the two segments, 1/mm.
        axis_change: (N,) magnitude of the change of the tool axis' rate, rad by path length.
        neighbour: (N,) length of the shorter of the two segments; 0 where the motion stops.
        tip: tolerance of the tip, mm; a number, or (N,).
        axis: tolerance of the tool axis, rad.
    """
    # Solves corner * d + bend * d^2 = tolerance; this form of the root is also exact for bend = 0.
    corner, bend = OFFSET * np.maximum(tip_change, _NEGLIGIBLE), _BLEND_DEVIATION * curvature_change
    by_tip = 2 * tip / (corner + np.sqrt(corner**2 + 4 * bend * tip))
    by_axis = axis / (OFFSET * np.maximum(axis_change, _NEGLIGIBLE))
    by_bend = _BEND / np.maximum(curvature, _NEGLIGIBLE)
    return np.minimum.reduce([by_tip, by_axis, by_bend, _SHARE * neighbour])


def step(x: Array, half_width: Array) -> tuple[Array, Array, Array]:
    """The integral of W, W itself and W' at distances x from the joint, -d <= x <= d, (N,) each."""
    width = 2 * half_width
    v = (x + half_width) / width
    return (
        width * v**3 * (1 - v / 2),
        v**2 * (3 - 2 * v),
        6 * v * (1 - v) / width,
    )


def smooth_step(x: Array, half_width: Array) -> tuple[Array, Array, Array]:
    """S, S' and S'' at distances x from the joint, -d <= x <= d, (N,) each."""
    width = 2 * half_width
    v = (x + half_width) / width
    return (
        v**3 * (10 - v * (15 - 6 * v)),
        30 * (v * (1 - v)) ** 2 / width,
        60 * v * (1 - v) * (1 - 2 * v) / width**2,
    )


class _Blend(NamedTuple):
    """Both steps at M places of blends, with derivatives, (M, 1) each: H, W, W'; S, S', S''; and the distances x."""

    x: Array
    step: Array
    step_1: Array
    step_2: Array
    smooth: Array
    smooth_1: Array
    smooth_2: Array

    @classmethod
    def of(cls, x: Array, half_width: Array) -> _Blend:
        columns = x, *step(x, half_width), *smooth_step(x, half_width)
        return cls(*(column[:, None] for column in columns))

    def rounded(self, one: Triple, two: Triple, change: Array) -> Triple:
        """Blend of two quantities, (M, C) each, given the change of the first derivative at the joint."""
        s, s1, s2 = self.smooth, self.smooth_1, self.smooth_2
        apart, parting = two[0] - one[0] - change * self.x, two[1] - one[1] - change
        return (
            one[0] + change * self.step + s * apart,
            one[1] + change * self.step_1 + s * parting + s1 * apart,
            one[2] + change * self.step_2 + s * (two[2] - one[2]) + 2 * s1 * parting + s2 * apart,
        )


class _ExtendedSegments(NamedTuple):
    """The two segments at joints, each extended past it: the joints, distances x, and the ends of the first ones."""

    joint: Array
    x: Array
    at_end: Array

    def of(self, at: Callable[[Array, Array], Triple]) -> tuple[Triple, Triple, Array]:
        """A quantity on both extended segments, and the change of its first derivative at the joint."""
        before, after, places = self.joint - 1, self.joint, len(self.x)
        first = np.flatnonzero(np.diff(after, prepend=-1))  # places at one joint are contiguous
        segment = np.concatenate([before, after, before[first], after[first]])
        u = np.concatenate([self.at_end + self.x, self.x, self.at_end[first], np.zeros(len(first))])
        value, rate, bend = at(segment, u)  # one call, as most blends have few places
        one, two = ((value[side], rate[side], bend[side]) for side in (slice(places), slice(places, 2 * places)))
        ends, starts = np.split(rate[2 * places :], 2)
        return one, two, np.repeat(starts - ends, np.diff(first, append=len(after)), axis=0)
