# SPDX-License-Identifier: LGPL-2.1-or-later
"""Best position: the work offset that maximises the score of the worst pose of a whole job.

Takes a trajectory with the work offset it was placed with; returns another work offset, with the margins before and
after. The job includes its mirrored and rotated copies, since they are in the trajectory; it excludes the path from the
home pose to its first point. Only a few poses are decisive: the search uses this active set, and whenever its result
makes another pose the worst one, that pose is added. The search climbs from one start or several; these are
independent, so any executor of ``concurrent.futures`` can distribute them.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine.spin.normalised_margins import SampledPoses, normalised_margins, score
from pkm_post.machine.spin.policy import STROKE
from pkm_post.model import Machine, Trajectory, checkpoint
from pkm_post.toolpath import rotation

_AT_RANDOM = 24
_SEED = 1
_MOST_STEPS = 2000


def pattern_search(height: Callable[[Array], Array], start: Array, first_step: Array, last_step: Array) -> Array:
    """Climb from a start to a point that no small step improves, (D,).

    Args:
        height: maps points (P, D) to their heights (P,).
        start: (D,) start point.
        first_step: (D,) initial steps by coordinate; zero for fixed ones.
        last_step: (D,) steps at which the search ends.
    """
    random = np.random.default_rng(_SEED)
    free = np.flatnonzero(first_step)
    at, best, scale = start, float(height(start[None])[0]), 1.0
    for _ in range(_MOST_STEPS):
        checkpoint()
        if (scale * first_step <= last_step).all():
            break
        directions = random.normal(size=(_AT_RANDOM, len(free)))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        steps = np.zeros((2 * len(free) + _AT_RANDOM, len(start)))
        steps[:, free] = np.vstack([np.eye(len(free)), -np.eye(len(free)), directions])
        tried = at + scale * first_step * steps
        heights = height(tried)
        highest = int(np.argmax(heights))
        if heights[highest] > best:
            at, best, scale = tried[highest], float(heights[highest]), min(2 * scale, 1.0)
        else:
            scale /= 2
    return at


FREEDOMS = "xyzabc"
"""Translations along and rotations about the axes of {M} through the middle of the job, by letter."""

_FIRST_STEP = np.array([80.0, 80.0, 80.0, *np.radians([10.0, 10.0, 30.0])])
_LAST_STEP = np.array([0.1, 0.1, 0.1, *np.radians([0.02, 0.02, 0.02])])
_FIRST_POSES = 40
_POSES_THAT_JOIN = 8
_ROUNDS = 50
_EQUAL = 1e-6
"""Score difference that counts as zero."""
_SEARCH_RANGE = np.array([150.0, 150.0, 150.0, *np.radians([20.0, 20.0, 120.0])])
"""mm and rad: range about the best position in which others are tried."""
_WORTH = 1e-3
"""Least product of margin share and distance, in these steps, for a position worth trying."""
_START_RANGE = np.array([200.0, 200.0, 200.0, *np.radians([10.0, 10.0, 180.0])])
"""mm, rad: range of the starts about the original position, in each freedom."""


@dataclass(frozen=True)
class WorkpiecePosition:
    """Result of the search.

    Attributes:
        machine_from_work: (4, 4) the work offset.
        move: (6,) displacement: mm along, and rad about, the axes of {M} through the middle of the job.
        before: (3,) least shares of stroke, joints and distance to singular poses with the original work offset.
        after: (3,) the same with the new work offset.
    """

    machine_from_work: Array
    move: Array
    before: Array
    after: Array


@dataclass(frozen=True)
class _Job:
    """Poses of a job in {M}, moved as a whole about its middle."""

    machine: Machine
    middle: Array
    tip: Array
    axis: Array
    spin: Array
    tool_length: Array

    def normalised_margins(self, moves: Array, rows: Array) -> Array:
        """Shares of the given poses after each move, (P, R, 3), for moves (P, 6)."""
        matrices = np.array([_matrix(move, self.middle) for move in moves])
        turned = matrices[:, :3, :3].transpose(0, 2, 1)
        tip = self.tip[rows] @ turned + matrices[:, None, :3, 3]
        axis = self.axis[rows] @ turned
        count = len(moves)
        repeated = np.tile(self.spin[rows], count), np.tile(self.tool_length[rows], count)
        left = normalised_margins(self.machine, tip.reshape(-1, 3), axis.reshape(-1, 3), *repeated)
        return left.reshape(count, len(rows), 3)


def best_position(
    trajectory: Trajectory,
    machine: Machine,
    free: str = "xyzc",
    weights: dict[int, float] | None = None,
    fixed: Array | None = None,
    starts: int = 1,
    executor: Executor | None = None,
) -> WorkpiecePosition:
    """Search for the work offset.

    Args:
        trajectory: a job on the machine; its spin is kept at every pose.
        free: letters of ``FREEDOMS`` that may change.
        weights: weights of the shares, by column; the stroke by default.
        fixed: (N,) segments that do not move with the workpiece, such as tool changes; none by default.
        starts: number of starts: the position of the trajectory, and reproducible random ones; the best result counts,
            the first of equal ones.
        executor: distributes the climbs; by default they run in this process.

    Raises:
        ValueError: a letter is unknown, or there are no letters or no starts.
    """
    job, climbs = _climbs(trajectory, machine, free, weights, fixed, starts, executor)
    return _position(job, trajectory, climbs[int(np.argmax([least for _, least in climbs]))][0])


def good_positions(
    trajectory: Trajectory,
    machine: Machine,
    free: str = "xyzc",
    fixed: Array | None = None,
    starts: int = 1,
    executor: Executor | None = None,
) -> tuple[WorkpiecePosition, ...]:
    """Candidate positions for further checks; arguments and errors as in ``best_position``.

    Returns:
        The best position; then the ends of the other climbs, and the best position displaced in its freedoms, where
        margins of stroke and joints remain. Each has good margins and is far from those before it, so that it may pass
        a check that they fail.
    """
    job, climbs = _climbs(trajectory, machine, free, None, fixed, starts, executor)
    best = climbs[int(np.argmax([least for _, least in climbs]))][0]
    steps = [share * _SEARCH_RANGE[row] * np.eye(6)[row] for row, name in enumerate(FREEDOMS) if name in free
             for share in (-1.0, -0.5, 0.5, 1.0)]  # fmt: skip
    found = [_position(job, trajectory, best)]
    left = [
        _position(job, trajectory, move) for move in (*(end for end, _ in climbs), *(best + step for step in steps))
    ]
    while left:
        worth = [each.after.min() * min(_distance(each.move, other.move) for other in found) for each in left]
        if max(worth) < _WORTH:
            break
        found.append(left.pop(int(np.argmax(worth))))
    return tuple(found)


def _climbs(
    trajectory: Trajectory,
    machine: Machine,
    free: str,
    weights: dict[int, float] | None,
    fixed: Array | None,
    starts: int,
    executor: Executor | None,
) -> tuple[_Job, list[tuple[Array, float]]]:
    """The job, and the final move, (6,), and score of the climb from each start."""
    if not free or set(free) - set(FREEDOMS):
        raise ValueError(f"free: expected letters of {FREEDOMS!r}, got {free!r}")
    if starts < 1:
        raise ValueError(f"starts: expected 1 or more, got {starts}")
    job = _job(trajectory, machine, np.zeros(len(trajectory), dtype=bool) if fixed is None else fixed)
    chosen = np.array([letter in free for letter in FREEDOMS])
    task = functools.partial(_climb, job, weights or {STROKE: 1.0}, chosen)
    moves = _starts(starts) * chosen
    return job, list(executor.map(task, moves) if executor else map(task, moves))


def _position(job: _Job, trajectory: Trajectory, move: Array) -> WorkpiecePosition:
    checkpoint()
    every = np.arange(len(job.tip))
    return WorkpiecePosition(
        machine_from_work=_matrix(move, job.middle) @ trajectory.machine_from_work,
        move=np.array(move.tolist()),  # copied, for the same bytes from every executor
        before=job.normalised_margins(np.zeros((1, 6)), every)[0].min(axis=0),
        after=job.normalised_margins(move[None], every)[0].min(axis=0),
    )


def _distance(move: Array, other: Array) -> float:
    """Distance of two moves, in steps of ``_SEARCH_RANGE``."""
    apart = np.append((move - other)[:3], np.angle(np.exp(1j * (move - other)[3:])))
    return float(np.abs(apart / _SEARCH_RANGE).max())


def _starts(count: int) -> Array:
    """Moves to climb from, (count, 6), the first of them zero; a larger count only appends moves."""
    random = np.random.default_rng(_SEED)
    return np.vstack([np.zeros(len(FREEDOMS)), random.uniform(-_START_RANGE, _START_RANGE, (count - 1, len(FREEDOMS)))])


def _climb(job: _Job, weights: dict[int, float], chosen: Array, start: Array) -> tuple[Array, float]:
    """The final move of a climb, (6,), and the score of its worst pose."""
    every = np.arange(len(job.tip))
    move, active, least = start, _first_poses(job), -math.inf
    # Even if the rounds do not suffice, the reported result is evaluated at every pose.
    for _ in range(_ROUNDS):

        def worst(moves: Array, rows: Array = active) -> Array:
            left = job.normalised_margins(moves, rows)
            scores = score(left.reshape(-1, 3), weights).reshape(len(moves), -1)
            return np.asarray(scores.min(axis=1))

        move = pattern_search(worst, move, _FIRST_STEP * chosen, _LAST_STEP)
        scores = score(job.normalised_margins(move[None], every)[0], weights)
        least = float(scores.min())
        if least >= worst(move[None])[0] - _EQUAL:
            break
        active = np.union1d(active, np.argsort(scores)[:_POSES_THAT_JOIN])
    return move, least


def _job(trajectory: Trajectory, machine: Machine, fixed: Array) -> _Job:
    """The poses that move with the workpiece; of a segment from home or a tool change only the end."""
    samples = SampledPoses.of(trajectory)
    from_elsewhere, at_end = np.append(True, fixed[:-1]), np.append(np.diff(samples.segment) > 0, True)
    rows = ~fixed[samples.segment] & (~from_elsewhere[samples.segment] | at_end)
    tip = samples.tip[rows]
    middle = (tip.min(axis=0) + tip.max(axis=0)) / 2
    return _Job(machine, middle, tip, samples.axis[rows], samples.spin[rows], samples.tool_length[rows])


def _first_poses(job: _Job) -> Array:
    """Poses at the extremes of the job in every coordinate, and some between."""
    coordinates = np.hstack([job.tip, job.axis])
    ends = np.concatenate([coordinates.argmin(axis=0), coordinates.argmax(axis=0)])
    between = np.linspace(0, len(job.tip) - 1, min(_FIRST_POSES, len(job.tip))).astype(np.int64)
    return np.union1d(ends, between)


def _matrix(move: Array, middle: Array) -> Array:
    """The (4, 4) matrix of a translation and rotations about the middle."""
    matrix = np.eye(4)
    matrix[:3, 3] = move[:3]
    for coordinate, angle in enumerate(move[3:]):
        direction = np.eye(3)[coordinate]
        if not math.isclose(angle, 0.0):
            matrix = matrix @ rotation(middle, direction, angle)
    return matrix
