# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses: tool poses along a contact path, refined until straight moves keep both tolerances. Units: mm, rad.

Between two rows the machine moves the tip on a line and turns the axis on a great circle. At places between, the cutter
in that pose is compared with the tangent plane of the surface, and its axis with the required one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from pkm_post.geometry import Array, along, angle_between, dot, norm, towards
from pkm_post.model import Diagnostic, Diagnostics, Phrase, Place
from pkm_post.toolpath.compensation.contact import tip_from_contact
from pkm_post.toolpath.compensation.cutter import Cutter
from pkm_post.toolpath.surface.contact_path import ContactPath, PassPattern
from pkm_post.toolpath.surface.stepover import cutter_gap
from pkm_post.toolpath.surface.surface import Surface, SurfaceSamples
from pkm_post.toolpath.surface.tool_axis import AxisRule, FeedFrame, LinkEnds, feed_frame, tool_axes


@dataclass(frozen=True)
class SurfaceTolerances:
    """Allowed deviation of a straight move between its ends.

    Attributes:
        chord: distance of the cutter from the surface, above it or into it, and of the line between contact points from
            the path of the contact on the surface, mm.
        axis: angle of the tool axis from the one required by the rule, rad.
    """

    chord: float = 0.01
    axis: float = math.radians(0.1)

    def __post_init__(self) -> None:
        if not (self.chord > 0.0 and self.axis > 0.0):
            raise ValueError(f"SurfaceTolerances: expected both above 0, got {self}")


@dataclass(frozen=True)
class SurfacePoses:
    """Tool poses at N rows of a path.

    Attributes:
        path: the rows.
        point: (N, 3) contact points.
        normal: (N, 3) unit normals there.
        frame: directions of feed and tilt.
        axis: (N, 3) unit tool axes.
        tip: (N, 3) tool tips.
        clamped: (N,) whether the axis was clamped to its cone.
    """

    path: ContactPath
    point: Array
    normal: Array
    frame: FeedFrame
    axis: Array
    tip: Array
    clamped: Array


_SHARES = (0.25, 0.5, 0.75)
"""Places between two rows where the tolerances are checked; a new row goes in the middle."""
_SHORTEST = 1e-3
"""mm: moves between closer contacts are not divided further; there the surface has an edge."""
_EDGE = math.radians(1.0)
_ROUNDS = 40

Progress = Callable[[float], None]


@dataclass(frozen=True)
class PoseRefinement:
    """The inputs that determine the pose at a point of the surface.

    Attributes:
        surface: the surface.
        pattern: the lines of the passes.
        cutter: the corner of the cutter.
        rule: rule of the tool axis.
        tolerances: tolerances of straight moves.
        place: place for diagnostics.
    """

    surface: Surface
    pattern: PassPattern
    cutter: Cutter
    rule: AxisRule
    tolerances: SurfaceTolerances
    place: Place

    def poses(
        self, path: ContactPath, progress: Progress = lambda share: None
    ) -> tuple[SurfacePoses | None, Diagnostics]:
        """Refine the path to the tolerances and compute the pose at each row.

        Args:
            path: passes in order of travel, settled on the pattern.
            progress: called from time to time with the completed share, from 0 to 1; may raise to abort.

        Returns:
            The poses, or None when the cutter cannot touch the surface somewhere; and the diagnostics.
        """
        samples = self.surface.at(path.u, path.v)
        open_ = path.run[:-1] == path.run[1:]
        done = 0.0
        for _ in range(_ROUNDS):
            poses, faults = self._at(path, samples)
            if poses is None:
                return None, faults
            behind = np.flatnonzero(open_ & self._divisible(poses))
            if not len(behind):
                break
            middle, middle_samples, fails = self._midpoints(poses, behind)
            behind, middle = behind[fails], middle.take(fails)
            rows = SurfaceSamples(
                *(np.insert(old, behind + 1, new[fails], axis=0) for old, new in _pairs(samples, middle_samples))
            )
            path, samples, open_ = path.with_rows(behind, middle), rows, _open_again(open_, behind)
            done = max(done, 1.0 - len(behind) / max(len(path) - 1, 1))
            progress(done)
        else:
            return None, (
                Diagnostic(
                    "N305", self.place, Phrase("after {} halvings, {} moves are too long", _ROUNDS, len(behind))
                ),
            )
        return poses, (*faults, *self._edges(poses))

    def _at(self, path: ContactPath, samples: SurfaceSamples) -> tuple[SurfacePoses | None, Diagnostics]:
        """Poses at rows with known samples of the surface."""
        travel = np.gradient(samples.point, axis=0) if len(path) > 1 else samples.along_u
        frame = feed_frame(self.pattern, path, samples, travel)
        before, after = _adjacent_passes(path)
        links = LinkEnds(frame.take(before), frame.take(after), samples.point[after] - samples.point[before])
        frame = frame.with_links(links, samples.normal, path.link)
        axis, clamped = tool_axes(samples.normal, frame.feed, self.rule, frame.side)
        tip, faults = tip_from_contact(samples.point, samples.normal, axis, self.cutter, self.place)
        if tip is None:
            return None, _first_of_each(faults, samples.point)
        return SurfacePoses(path, samples.point, samples.normal, frame, axis, tip, clamped), faults

    def _divisible(self, poses: SurfacePoses) -> Array:
        """Moves that may be divided: long ones, and those of links that turn the tool in place."""
        turns = angle_between(poses.axis[:-1], poses.axis[1:]) > self.tolerances.axis
        return (norm(np.diff(poses.point, axis=0)) > _SHORTEST) | (_links(poses.path) & turns)

    def _midpoints(self, poses: SurfacePoses, behind: Array) -> tuple[ContactPath, SurfaceSamples, Array]:
        """The rows in the middle of moves, the surface there, and the moves that exceed the tolerances."""
        path = poses.path
        left, right = path.take(behind), path.take(behind + 1)
        is_link = _links(path)[behind]
        before, after = (rows[at] for rows, at in zip(_adjacent_passes(path), (behind, behind + 1), strict=True))
        links = LinkEnds(poses.frame.take(before), poses.frame.take(after), poses.point[after] - poses.point[before])
        fails = np.zeros(len(behind), dtype=bool)
        for share in _SHARES:
            u, v = (before + share * (after - before) for before, after in ((left.u, right.u), (left.v, right.v)))
            settled = self.pattern.snap(self.surface, u, v, right.number)
            u, v = (np.where(is_link, raw, on_line) for raw, on_line in zip((u, v), settled, strict=True))
            link = np.where(is_link, _link_share(left.link, right.link, share), np.nan)
            between = replace(right, u=u, v=v, link=link)
            samples = self.surface.at(u, v)
            fails |= self._fails(poses, behind, between, samples, links, share)
            if share == 0.5:
                middle, middle_samples = between, samples
        return middle, middle_samples, fails

    def _fails(
        self,
        poses: SurfacePoses,
        behind: Array,
        between: ContactPath,
        samples: SurfaceSamples,
        links: LinkEnds,
        share: float,
    ) -> Array:
        """Moves that exceed the tolerances at a place between their ends, (n,)."""
        chord = poses.point[behind + 1] - poses.point[behind]
        way = samples.point - poses.point[behind]
        square = dot(chord, chord)
        on_the_spot = square <= _SHORTEST**2
        passed = np.where(on_the_spot, share, dot(way, chord) / np.where(on_the_spot, 1.0, square))
        passed = np.clip(passed, 0.0, 1.0)[:, None]
        tip = poses.tip[behind] + passed * (poses.tip[behind + 1] - poses.tip[behind])
        axis = along(poses.axis[behind], passed * towards(poses.axis[behind], poses.axis[behind + 1]))
        frame = feed_frame(self.pattern, between, samples, chord).with_links(links, samples.normal, between.link)
        wanted, _ = tool_axes(samples.normal, frame.feed, self.rule, frame.side)
        off = cutter_gap(tip, axis, samples.point, samples.normal, self.cutter)
        twisted = angle_between(axis, wanted) > self.tolerances.axis
        sideways = norm(way - passed * chord)
        return (np.maximum(np.abs(off), sideways) > self.tolerances.chord) | twisted

    def _edges(self, poses: SurfacePoses) -> Diagnostics:
        """A warning where the surface has edges: adjacent contacts with different normals."""
        near = (poses.path.run[:-1] == poses.path.run[1:]) & (norm(np.diff(poses.point, axis=0)) <= _SHORTEST)
        angle = angle_between(poses.normal[:-1], poses.normal[1:])
        edges = np.flatnonzero(near & (angle > _EDGE))
        if not len(edges):
            return ()
        x, y, z = poses.point[edges[0]]
        text = f"{len(edges)} times, first at ({x:.3f}, {y:.3f}, {z:.3f}) by {np.degrees(angle[edges[0]]):.1f} degrees"
        return (Diagnostic("N306", self.place, text),)


def _first_of_each(faults: Diagnostics, point: Array) -> Diagnostics:
    """The first fault of each kind, with its contact point instead of an internal row number."""
    firsts = {fault.code: fault for fault in reversed(faults)}
    return tuple(
        replace(first, place=replace(first.place, line=0), found=_at_point(point[first.place.line - 1], first.found))
        for _, first in sorted(firsts.items())
    )


def _at_point(point: Array, found: str) -> str:
    return "at ({:.3f}, {:.3f}, {:.3f}): ".format(*point) + found


def _links(path: ContactPath) -> Array:
    """Moves of links, from the end of a pass to the start of the next, (N - 1,)."""
    in_link = ~np.isnan(path.link)
    return (path.number[1:] != path.number[:-1]) | in_link[1:] | in_link[:-1]


def _link_share(before: Array, after: Array, share: float) -> Array:
    """Interpolated shares of links between rows; a link ends where a pass begins."""
    first, last = np.where(np.isnan(before), 0.0, before), np.where(np.isnan(after), 1.0, after)
    return first + share * (last - first)


def _adjacent_passes(path: ContactPath) -> tuple[Array, Array]:
    """For each row the last pass row not after it, and the first pass row not before it, (N,) each."""
    rows = np.arange(len(path))
    in_pass = np.isnan(path.link)
    before = np.maximum.accumulate(np.where(in_pass, rows, 0))
    after = np.minimum.accumulate(np.where(in_pass, rows, len(rows) - 1)[::-1])[::-1]
    return before, after


def _open_again(open_: Array, behind: Array) -> Array:
    """Moves to check next: only both halves of the divided ones."""
    divided = np.zeros(len(open_), dtype=bool)
    divided[behind] = True
    return np.repeat(divided, np.where(divided, 2, 1))


def _pairs(left: SurfaceSamples, right: SurfaceSamples) -> list[tuple[Array, Array]]:
    """The columns of two patches, side by side."""
    return [(getattr(left, item.name), getattr(right, item.name)) for item in fields(SurfaceSamples)]
