# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moves: a program from the poses along the passes: rapid moves, approach, lead-in, passes, lead-out, retract.

Between two runs the tool retracts along its axis, through the space it came from, up to a plane; there it turns
upright, crosses, tilts again and descends along its next axis. It retracts beyond the plane where rapid motion ended
farther from the run than the plane is: so the run can also be cut the other way. Units: mm, mm/s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from pkm_post.geometry import Array
from pkm_post.model import Amount, Diagnostic, Diagnostics, Kind, Phrase, Place, Program
from pkm_post.toolpath.surface.options import LeadMove, SurfaceOptions
from pkm_post.toolpath.surface.poses import SurfacePoses
from pkm_post.toolpath.surface.tool_axis import clamp_to_cone

_UP = np.array([0.0, 0.0, 1.0])
_FLATTEST = math.sin(math.radians(5.0))
"""Rise of the tool axis below which the path along it up to the plane would be too long."""
_ONE_AXIS = math.cos(1e-3)
"""Cosine from which two tool axes count as one; heights are then measured along it."""
_ONE_HEIGHT = 1e-6
"""mm within which two heights are equal, with six decimals."""
_NO_NORMAL = np.full(3, np.nan)


@dataclass(frozen=True)
class _Rows:
    """Columns of the program under construction."""

    kind: Array
    tip: Array
    axis: Array
    feed: Array
    normal: Array

    @classmethod
    def of(cls, kind: Kind, tip: Array, axis: Array, feed: float, normal: Array = _NO_NORMAL) -> _Rows:
        """Rows of one kind and feed; a single axis or normal applies to all."""
        rows = len(tip)
        return cls(
            np.full(rows, kind),
            tip,
            np.broadcast_to(axis, (rows, 3)),
            np.full(rows, np.nan if kind is Kind.RAPID else feed),
            np.broadcast_to(normal, (rows, 3)),
        )


def program_from_poses(
    covered: list[SurfacePoses], settings: SurfaceOptions, place: Place
) -> tuple[Program | None, Diagnostics]:
    """The program through all poses.

    Args:
        covered: the poses of each surface, in order of travel.
        settings: planes, leads, feeds.
        place: file and operation named as the source of the program.

    Returns:
        The program, without events and tools, or None when the tool cannot be lifted somewhere; and the diagnostics.
    """
    runs = [(poses, rows) for poses in covered for rows in _runs(poses)]
    parts: list[_Rows] = []
    for number, (poses, rows) in enumerate(runs):
        come = settings.clearance_height if number == 0 else settings.safe_height
        leave = settings.clearance_height if number == len(runs) - 1 else settings.safe_height
        visit, faults = _visit(poses, rows, come, leave, settings, place)
        if faults:
            return None, tuple(faults)
        parts += visit
    return _program(parts, place), ()


def _visit(
    poses: SurfacePoses, rows: Array, come: float, leave: float, settings: SurfaceOptions, place: Place
) -> tuple[list[_Rows], list[Diagnostic]]:
    """Rows down from a plane, along a run, and up to a plane; and their diagnostics."""
    first, last = int(rows[0]), int(rows[-1])
    lead_in, lead_out = _lead(poses, first, -1.0, settings)[::-1], _lead(poses, last, 1.0, settings)
    begin = lead_in[0] if len(lead_in) else poses.tip[first]
    end = lead_out[-1] if len(lead_out) else poses.tip[last]
    faults = _lift_faults(poses.axis[first], begin, come, place)
    faults += _lift_faults(poses.axis[last], end, leave, place)
    if faults:
        return [], faults
    approach = _approach(begin, poses.axis[first], come, settings)
    lift = _least_lift(begin, poses.axis[first], end, poses.axis[last], approach)
    leave = lift if lift > leave + _ONE_HEIGHT else leave
    return [
        *_descent(begin, poses.axis[first], come, settings, _NO_NORMAL if len(lead_in) else poses.normal[first]),
        _Rows.of(Kind.LINE, lead_in, poses.axis[first], settings.feed),
        _Rows.of(Kind.LINE, poses.tip[rows], poses.axis[rows], settings.feed, poses.normal[rows]),
        _Rows.of(Kind.LINE, lead_out, poses.axis[last], settings.feed),
        *_ascent(end, poses.axis[last], leave, settings),
    ], []


def _approach(begin: Array, axis: Array, height: float, settings: SurfaceOptions) -> float:
    """Distance from a run, along the axis, at which the rapid motion from a plane ends."""
    return min(settings.approach, (height - begin[2]) / axis[2])


def _least_lift(begin: Array, axis: Array, end: Array, axis_at_end: Array, approach: float) -> float:
    """The z at which the lift is as far from the run as the approach, and as high above its start."""
    below = max(float((begin - end) @ axis), 0.0) if axis @ axis_at_end > _ONE_AXIS else 0.0
    return end[2] + (approach + below) * axis_at_end[2]


def _runs(poses: SurfacePoses) -> list[Array]:
    """The rows of each run."""
    run = poses.path.run
    return np.split(np.arange(len(run)), np.flatnonzero(run[1:] != run[:-1]) + 1)


def _lead(poses: SurfacePoses, row: int, sense: float, settings: SurfaceOptions) -> Array:
    """Lead tips from a pose outwards, nearest first: along the feed, or on a quarter circle off the surface."""
    length, along, off = settings.lead_length, sense * poses.frame.feed[row], poses.normal[row]
    if settings.lead_move is LeadMove.NONE or length == 0.0:
        return np.zeros((0, 3))
    if settings.lead_move is LeadMove.TANGENT:
        return poses.tip[row] + length * along[None]
    step = 2.0 * math.acos(max(1.0 - settings.tolerances.chord / length, 0.0))
    angle = np.linspace(0.0, math.pi / 2.0, max(math.ceil(math.pi / 2.0 / step), 1) + 1)[1:, None]
    return poses.tip[row] + length * (np.sin(angle) * along + (1.0 - np.cos(angle)) * off)


def _on_plane(tip: Array, axis: Array, height: float) -> Array:
    """The intersection of the tool axis through the tip with a plane of constant z."""
    return tip + (height - tip[2]) / axis[2] * axis


def _descent(begin: Array, axis: Array, height: float, settings: SurfaceOptions, normal: Array) -> list[_Rows]:
    """Upright on the plane, then tilted, then down along the axis, the last piece at plunge feed.

    The normal belongs to the contact where the descent ends, NaN if it ends in a lead.
    """
    above = _on_plane(begin, axis, height)
    resting = _resting(settings)
    rapid_end = begin + _approach(begin, axis, height, settings) * axis
    return [
        _Rows.of(Kind.RAPID, above[None], resting, np.nan),
        _Rows.of(Kind.RAPID, np.array([above, rapid_end]), axis, np.nan),
        _Rows.of(Kind.LINE, begin[None], axis, settings.plunge_feed, normal),
    ]


def _ascent(end: Array, axis: Array, height: float, settings: SurfaceOptions) -> list[_Rows]:
    """Up along the axis, then upright."""
    above = _on_plane(end, axis, height)[None]
    resting = _resting(settings)
    return [_Rows.of(Kind.RAPID, above, axis, np.nan), _Rows.of(Kind.RAPID, above, resting, np.nan)]


def _resting(settings: SurfaceOptions) -> Array:
    """The tool axis between runs: upright, or as close to it as the cone allows."""
    rule = settings.rule
    return clamp_to_cone(_UP[None], np.asarray(rule.cone_axis, dtype=np.float64), rule.cone)[0]


def _lift_faults(axis: Array, tip: Array, height: float, place: Place) -> list[Diagnostic]:
    """Faults that prevent a retract along the tool axis to the plane."""
    if axis[2] < _FLATTEST:
        above, least = (math.degrees(math.asin(each)) for each in (axis[2], _FLATTEST))
        return [
            Diagnostic(
                "N304",
                place,
                Phrase("{} degrees above the horizontal, at least {} are needed", f"{above:.1f}", f"{least:g}"),
            )
        ]
    if tip[2] > height:
        return [
            Diagnostic(
                "N307",
                place,
                Phrase(
                    "the tip is at z = {}, the plane at {}", Amount(tip[2], "mm", "z.3f"), Amount(height, "mm", "z.3f")
                ),
            )
        ]
    return []


def _program(parts: list[_Rows], place: Place) -> Program:
    columns = {item.name: np.concatenate([getattr(part, item.name) for part in parts]) for item in fields(_Rows)}
    kept = _moving(columns["tip"], columns["axis"])
    kind, tip, axis, feed, normal = (column[kept] for column in columns.values())
    rows = len(kind)
    none = np.full((rows, 3), np.nan)
    return Program(
        kind=kind, position=tip, tool_axis=axis, feed=feed, arc_centre=none, arc_axis=none,
        operation=np.zeros(rows), line=np.arange(1, rows + 1), events=(), operations=(place.operation,), tools={},
        source=place.file, normal=normal,
    )  # fmt: skip


def _moving(tip: Array, axis: Array) -> Array:
    """Rows that move: tip or axis differs from the row before."""
    still = (np.abs(np.diff(tip, axis=0)).max(axis=1) < 1e-9) & (np.abs(np.diff(axis, axis=0)).max(axis=1) < 1e-9)
    return np.concatenate([[True], ~still])
