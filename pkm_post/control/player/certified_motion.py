# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certified motions: motions between two points, rounded as sent, each with its own certificate.

The certificate compares with the programmed trajectory between the two points, and with the limits of the machine.

Input: a schedule along a section, and the end of the previous motion. Output: points with a certificate.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from pkm_post.certificate import AdjacentMotion, certify
from pkm_post.control.link.status import AnySettings
from pkm_post.control.player.sections import PathPoint, TrajectorySection, subpath
from pkm_post.geometry import Array
from pkm_post.model import Certificate, Kind, Machine, Motion, Refused, StrutMotion, Tolerances, errors
from pkm_post.planning import PathState, Schedule, WindowPlanner, strut_motion

LONGEST_MS = 128
"""Longest interval: the controller computes two moves ahead, and a continuation must arrive before that."""
_SAME_MM = 1e-6
"""A place this close to the end of a row belongs to the next row."""


@dataclass(frozen=True)
class MotionState:
    """The state of a motion at one of its points.

    Attributes:
        section: number of the section of the part.
        state: place, speed and override on its path.
        length: (6,) strut lengths, as sent, mm.
        speed: (6,) strut speeds, as sent, mm/s.
        adjacent: the last interval of the motion that ends there, for a motion that continues.
    """

    section: int
    state: PathState
    length: Array
    speed: Array
    adjacent: AdjacentMotion = field(default_factory=AdjacentMotion)


@dataclass(frozen=True)
class CertifiedMotion:
    """A motion between two points, as sent to the controller.

    Attributes:
        struts: its points, starting with the last one of the previous motion.
        row: (M,) row of the trajectory at each point.
        share: (M,) completed share of that row.
        certificate: of its motion.
        end: its end state.
    """

    struts: StrutMotion
    row: Array
    share: Array
    certificate: Certificate
    end: MotionState


@dataclass(frozen=True)
class MotionCertifier:
    """Makes and certifies the motions of a machine."""

    machine: Machine
    settings: AnySettings
    tolerances: Tolerances

    def motion(
        self,
        section: TrajectorySection,
        windows: WindowPlanner,
        at: MotionState,
        schedule: Schedule,
        until_ms: int,
        override: float,
    ) -> CertifiedMotion:
        """The motion of a schedule up to a time, certified.

        Args:
            section: of the trajectory.
            windows: plans along its path.
            at: end of the previous motion.
            schedule: from there to a rest.
            until_ms: whole ms of it to send.
            override: factor of the feed.

        Raises:
            Refused: the certificate does not hold.
        """
        motion = windows.motion(schedule, until_ms, override, LONGEST_MS)
        struts = self._as_sent(strut_motion(motion, self.machine), at)
        s, _, _ = schedule.at(motion.time_ms / 1000)
        adjacent = replace(at.adjacent, goes_on=until_ms != int(schedule.rests_ms[-1]))
        certificate = self._certified(section, windows, struts, motion, s[[0, -1]], override, adjacent)
        starts = windows.path.starts
        row = np.clip(np.searchsorted(starts, s + _SAME_MM, side="right") - 1, 0, len(windows.programmed) - 1)
        share = np.clip((s - starts[row]) / np.diff(starts)[row], 0.0, 1.0)
        state = windows.reached(schedule, until_ms, override)
        end = MotionState(
            at.section,
            state,
            struts.length[-1],
            struts.speed[-1],
            _last(struts, motion) if adjacent.goes_on else AdjacentMotion(),
        )
        return CertifiedMotion(struts, section.first + row, share, certificate, end)

    def _as_sent(self, struts: StrutMotion, at: MotionState) -> StrutMotion:
        """The motion rounded as sent, starting from the point sent before."""
        length = np.round(struts.length, self.settings.length_decimals)
        speed = np.round(struts.speed, self.settings.speed_decimals) + 0.0
        length[0], speed[0] = at.length, at.speed
        return replace(struts, length=length, speed=speed)

    def _certified(
        self,
        section: TrajectorySection,
        windows: WindowPlanner,
        struts: StrutMotion,
        motion: Motion,
        s: Array,
        override: float,
        adjacent: AdjacentMotion,
    ) -> Certificate:
        starts, rows = windows.path.starts, section.trajectory
        first = int(np.searchsorted(starts, s[0], side="right")) - 1
        last = int(np.searchsorted(starts, s[1])) - 1
        share = [(at - starts[row]) / (starts[row + 1] - starts[row]) for at, row in zip(s, (first, last), strict=True)]
        programmed = subpath(rows, PathPoint(first, float(share[0])), PathPoint(last, float(share[1])))
        factor = np.where(programmed.kind == Kind.RAPID, min(override, 1.0), override)
        programmed = replace(programmed, feed=programmed.feed * factor)
        joints = np.append(motion.joint_time[first:last], motion.time_ms[-1] / 1000)
        segment = np.clip(motion.segment - first, 0, last - first)
        local = replace(motion, segment=segment, joint_time=joints)
        found, diagnostics = certify(
            struts, rows.source, programmed, self.machine, local, self.tolerances, adjacent=adjacent
        )
        if found is None or errors(diagnostics):
            raise Refused(diagnostics)
        return found


def _last(struts: StrutMotion, motion: Motion) -> AdjacentMotion:
    """The last interval of a motion; with strut speeds as sent and tip speeds as planned."""
    seconds = float(struts.time_ms[-1] - struts.time_ms[-2]) / 1000
    speed, tip = struts.speed[-1] - struts.speed[-2], motion.tip_rate[-1] - motion.tip_rate[-2]
    return AdjacentMotion(seconds, speed / seconds, tip / seconds)
