# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tool path: tip, axis and spin with rounded corners, as functions of path length s.

Enters: a trajectory and the tolerances of tip and axis at its corners. Leaves: poses with exact first and second
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
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array, along_rates, norm
from pkm_post.model import Poses, Trajectory
from pkm_post.toolpath import Segments

OFFSET = 3 / 16
"""Deviation at the joint per half width and change of direction."""
_BOW = 0.0134
"""Deviation per half width squared and change of curvature: the maximum of (2v - 1)^2 S(v) / 2 before the joint."""
_NEGLIGIBLE = 1e-12
"""Changes below this impose no limit; keeps the quotients finite."""
_BEND = 0.5
"""rad: the most that an arc is extended; beyond it, the two segments of a joint no longer approximate each other."""
_SHARE = 0.45
"""Share of the shorter neighbour that a blend may use; two blends on one segment never meet."""
_INSIDE = 1 - 1e-9
"""Share of the half width that counts as the blend: at its very end the segment is exact despite rounding."""


@dataclass(frozen=True)
class ToolPath:
    """A path of N segments with the N - 1 blends between them.

    Attributes:
        segments: the segments before rounding.
        starts: (N + 1,) path length s at the start of each segment, and at the end of the path.
        blend: (N + 1,) half width of the blend at the start of each segment; 0 at rests and at both ends.
        rests: (N + 1,) whether the motion stops at the start of each segment; true at both ends.
        feed: (N,) highest speed by path length, mm/s.
        tool_length: (N,) gauge length in use.
        tip_tolerance: (N,) tolerance of the tip on each segment where the program states one, mm; 0 elsewhere.
    """

    segments: Segments
    starts: Array
    blend: Array
    rests: np.ndarray[tuple[int], np.dtype[np.bool_]]
    feed: Array
    tool_length: Array
    tip_tolerance: Array

    @classmethod
    def of(cls, trajectory: Trajectory, tip_tolerance: Array | float, axis_tolerance: float) -> ToolPath:
        """The path of a trajectory.

        Args:
            trajectory: at least one segment.
            tip_tolerance: largest deviation of the tip from the segments at corners, mm; a number, or (N,) by segment.
                At a joint the lower tolerance of its two segments applies.
            axis_tolerance: largest deviation of the tool axis, rad.
        """
        segments = Segments.of(trajectory)
        rests = np.concatenate([[True], trajectory.exact_stop])
        return cls(
            segments=segments,
            starts=np.concatenate([[0.0], np.cumsum(segments.extent)]),
            blend=_blends(segments, rests, tip_tolerance, axis_tolerance),
            rests=rests,
            feed=trajectory.feed,
            tool_length=trajectory.tool_length(),
            tip_tolerance=trajectory.tip_tolerance,
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
        rate = self.segments.spin_rate[segment]
        spin = [self.segments.spin[segment] + u * rate, rate.copy(), np.zeros_like(rate)]
        distance_to_end = self.segments.extent[segment] - u
        for joint, x in ((segment, u), (segment + 1, -distance_to_end)):
            rows = np.flatnonzero(np.abs(x) < _INSIDE * self.blend[joint])
            if len(rows):
                self._round(joint[rows], x[rows], rows, tip, axis, spin)
        return Poses(*tip, *axis, spin[0], spin[1], spin[2], self.tool_length[segment], segment)

    def _round(
        self, joint: Array, x: Array, rows: Array, tip: tuple[Array, ...], axis: tuple[Array, ...], spin: list[Array]
    ) -> None:
        """Overwrite the rows in blends, at distances x from the joints at the starts of segments ``joint``.

        With p1, p2 the two extended segments, D the change of tangent and H the integral of W:
        p = p1 + D H + S (p2 - p1 - D x); where both are lines this is p1 + D H.
        """
        before, seg = joint - 1, self.segments
        at_end = seg.extent[before]
        h, w, w1 = (value[:, None] for value in step(x, self.blend[joint]))
        s, s1, s2 = (value[:, None] for value in smooth_step(x, self.blend[joint]))
        change = seg.tip_at(joint, 0 * x)[1] - seg.tip_at(before, at_end)[1]
        one, two = seg.tip_at(before, at_end + x), seg.tip_at(joint, x)
        apart, parting = two[0] - one[0] - change * x[:, None], two[1] - one[1] - change
        tip[0][rows] = one[0] + change * h + s * apart
        tip[1][rows] = one[1] + change * w + s * parting + s1 * apart
        tip[2][rows] = one[2] + change * w1 + s * (two[2] - one[2]) + 2 * s1 * parting + s2 * apart

        rate, rate_after = seg.axis_at(before, at_end)[1], seg.axis_rate[joint]
        if rate.any() or rate_after.any():
            change = rate_after - rate
            tangent = along_rates(seg.axis[joint], x[:, None] * rate + h * change, rate + w * change, w1 * change)
            for value, rounded in zip(axis, tangent, strict=True):
                value[rows] = rounded

        turn = seg.spin_rate[before]
        change = seg.spin_rate[joint] - turn
        spin[0][rows] = seg.spin[joint] + turn * x + change * h[:, 0]
        spin[1][rows] = turn + change * w[:, 0]
        spin[2][rows] = change * w1[:, 0]


def _blends(segments: Segments, rests: Array, tip_tolerance: Array | float, axis_tolerance: float) -> Array:
    blend = np.zeros(len(segments) + 1)
    joint = np.arange(1, len(segments))
    before, at_end, at_start = joint - 1, segments.extent[:-1], np.zeros(len(joint))
    _, tangent_end, bend_end = segments.tip_at(before, at_end)
    _, tangent_start, bend_start = segments.tip_at(joint, at_start)
    axis_change = segments.axis_rate[1:] - segments.axis_at(before, at_end)[1]
    neighbour = np.where(rests[1:-1], 0.0, np.minimum(segments.extent[1:], segments.extent[:-1]))
    blend[1:-1] = half_widths(
        norm(tangent_start - tangent_end),
        norm(bend_start - bend_end),
        np.maximum(norm(bend_start), norm(bend_end)),
        norm(axis_change),
        neighbour,
        _of_joints(np.broadcast_to(tip_tolerance, len(segments))),
        axis_tolerance,
    )
    return blend


def _of_joints(tolerance: Array) -> Array:
    """The lower tolerance of the two segments at each joint, (N - 1,)."""
    return np.minimum(tolerance[:-1], tolerance[1:])


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
    # Solves corner * d + bow * d^2 = tolerance; this form of the root is also exact for bow = 0.
    corner, bow = OFFSET * np.maximum(tip_change, _NEGLIGIBLE), _BOW * curvature_change
    by_tip = 2 * tip / (corner + np.sqrt(corner**2 + 4 * bow * tip))
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
