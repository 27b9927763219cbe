# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reconstruction: the motion of a program in the form of a plan, from program and trajectory only.

Input: the strut motion of a program, the trajectory, the machine. Output: tool poses and rates at its knots, the
segment of each knot and the time of each joint, so that ``certify`` can measure the program of any planner; and the
deviation of the spin from the programmed one. Rests and events, and their order, must match the trajectory.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pkm_post.certificate.consistency import event_fault
from pkm_post.certificate.deviation import TrajectoryRuler
from pkm_post.certificate.joint_times import joint_times
from pkm_post.certificate.played_path import PlayedPath, largest_backward_motion, spin_deviation
from pkm_post.geometry import Array, expand_counts, norm
from pkm_post.machine import PosePath
from pkm_post.model import (
    Diagnostic,
    Diagnostics,
    Machine,
    Motion,
    Place,
    StrutMotion,
    Tolerances,
    Trajectory,
    as_executed,
)

_INSTANTS = 4, 1024
"""Least and most instants of each interval at which its pose path is sampled: as many as its curvature requires."""
_OFF_CHORD = np.array([0.01, 0.01, 0.01, 2e-5, 2e-5, 2e-5, 2e-5])[:, None]
"""mm of the tip, and rad of axis and spin, by which the tool may leave the straight path between two instants."""


@dataclass(frozen=True)
class ReconstructedMotion:
    """The motion of a program in the form of a plan.

    Attributes:
        motion: motion with the knots of the program.
        spin_deviation: (K + 1,) mm of a strut, deviation of the spin about each knot from the programmed one.
        path: path of the tool.
        instants: (K,) of each interval, at which its poses are checked.
    """

    motion: Motion
    spin_deviation: Array
    path: PlayedPath
    instants: Array

    def pose_path(self) -> tuple[PosePath, Array]:
        """The pose path through even instants of all intervals, and their segments."""
        row, number = expand_counts(self.instants)
        first = self.path.at(np.array([0]), np.zeros((1, 1)))[:, 0]
        place = np.hstack([first, self.path.at(row, ((number + 1) / self.instants[row])[None])[:, 0]])
        axis = (place[3:6] / norm(place[3:6].T)).T
        knot = np.append(0, row + 1)
        return PosePath.straight(place[:3].T, axis, place[6], self.motion.tool_length[knot]), self.motion.segment[knot]


def _instants(path: PlayedPath) -> Array:
    """Number of even instants of each interval, (K,): a cubic leaves chords of d seconds by d^2 / 8 max |x''|."""
    intervals = np.arange(len(path.time) - 1)
    ends = (path.rates_at(intervals, np.full(len(intervals), share))[1] / _OFF_CHORD for share in (0.0, 1.0))
    bend = np.maximum(*(np.sqrt(np.square(end).sum(axis=0)) for end in ends))
    return np.clip(np.ceil(np.diff(path.time) * np.sqrt(bend / 8)), *_INSTANTS).astype(np.int64)


def reconstruct(
    struts: StrutMotion, program_name: str, trajectory: Trajectory, machine: Machine, tolerances: Tolerances
) -> tuple[ReconstructedMotion | None, Diagnostics]:
    """The motion of a program, or None with diagnostics if it does not match the trajectory.

    Args:
        struts: the program, read back.
        program_name: names the program in diagnostics.
        trajectory: the programmed trajectory.
        machine: the geometry.
        tolerances: the requested tolerances.
    """
    rests = _Rests.of(struts, trajectory)
    path, fault = None, rests.fault(struts, trajectory, machine)
    if fault is None:
        path, fault = _played_path(struts, rests, trajectory, machine)
    if path is None:
        return None, _diagnostics(fault, program_name)
    ruler = TrajectoryRuler(trajectory, tolerances)
    joint_time = joint_times(path, trajectory, machine, tolerances, rests.rows[1:] - 1, rests.knots[1:])
    fault = _backward_motion_fault(path, ruler, joint_time)
    if fault is not None:
        return None, _diagnostics(fault, program_name)
    off = spin_deviation(path, trajectory, machine, ruler, joint_time)
    return ReconstructedMotion(_motion(path, joint_time), off, path, _instants(path)), ()


_Fault = tuple[str, str]
"""Diagnostic code and finding."""


def _diagnostics(fault: _Fault | None, program_name: str) -> Diagnostics:
    return () if fault is None else (Diagnostic(fault[0], Place(program_name), fault[1]),)


def _played_path(
    struts: StrutMotion, rests: _Rests, trajectory: Trajectory, machine: Machine
) -> tuple[PlayedPath | None, _Fault | None]:
    path, lost = PlayedPath.of(struts, rests.tool_lengths(trajectory), trajectory, machine)
    if path is not None:
        return path, None
    found = f"from {struts.time_ms[lost] / 1000:g} s on no pose near the one before it has the strut lengths"
    return None, ("V107", found)


def _backward_motion_fault(path: PlayedPath, ruler: TrajectoryRuler, joint_time: Array) -> _Fault | None:
    back, when = largest_backward_motion(path, ruler, joint_time)
    if back <= 1:
        return None
    return (
        "V110",
        f"the tool goes back on its path, by {back:.3g} times what it may be off, {when:.3f} s after the start",
    )


def _motion(path: PlayedPath, joint_time: Array) -> Motion:
    return Motion(
        time_ms=path.struts.time_ms,
        tip=path.place[:3].T,
        axis=path.place[3:6].T,
        spin=path.place[6],
        tip_rate=path.rate[:3].T,
        axis_rate=path.rate[3:6].T,
        spin_rate=path.rate[6],
        tool_length=path.tool_length,
        segment=np.minimum(np.searchsorted(joint_time, path.time), len(joint_time) - 1),
        joint_time=joint_time,
        events=path.struts.events,
    )


@dataclass(frozen=True)
class _Rests:
    """The rests of program and trajectory, in order; comparable if their numbers are equal.

    Attributes:
        knots: knots of the program at which every printed speed is zero.
        rows: rows of the trajectory before which the motion rests; row N is its end.
    """

    knots: Array
    rows: Array

    @classmethod
    def of(cls, struts: StrutMotion, trajectory: Trajectory) -> _Rests:
        rests = np.concatenate([[True], trajectory.exact_stop])
        rests[-1] = True
        return cls(np.flatnonzero(~struts.speed.any(axis=1)), np.flatnonzero(rests))

    def fault(self, struts: StrutMotion, trajectory: Trajectory, machine: Machine) -> _Fault | None:
        """The fault that prevents a comparison: another machine, motion at the ends, other rests or events."""
        if trajectory.machine_fingerprint != machine.fingerprint:
            return "T104", f"made for {trajectory.machine}, checked on {machine.name}"
        for which, speed in (("first", struts.speed[0]), ("last", struts.speed[-1])):
            if speed.any():
                return "V105", f"{which} speeds {speed.tolist()} mm/s"
        if len(self.knots) != len(self.rows):
            return "V110", f"the program rests {len(self.knots)} times, the trajectory {len(self.rows)} times"
        at = self.knots[np.searchsorted(self.rows, [event.row for event in trajectory.events])]
        expected = tuple(
            replace(event, row=int(knot)) for knot, event in zip(at, as_executed(trajectory.events), strict=True)
        )
        return None if struts.events == expected else ("V109", event_fault(struts.events, expected))

    def tool_lengths(self, trajectory: Trajectory) -> Array:
        """Gauge length of the tool before each knot, (K + 1,): constant between two rests."""
        by_stretch = trajectory.tool_length()[self.rows[1:] - 1]
        return np.append(by_stretch[:1], np.repeat(by_stretch, np.diff(self.knots)))
