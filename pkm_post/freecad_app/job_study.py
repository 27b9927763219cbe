# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job study: the one set of checks of a CAM job that Reach, Simulation and the post-processors share.

Takes a job on its machine; returns the margins of reach along its path and all findings: reach, part, stock, holder,
fixtures, gouges.

A study is a function of trajectory, machine, set-up and tolerances, and is cached by their content: a change of any of
them gives a new study, while others, such as a colour, do not. It lives as long as it is displayed. Posting shares its
collisions: whichever comes first finds them, and the last ones are cached. The further checks of posting concern the
path with rounded corners, and the written program.
"""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from pkm_post.geometry import Array
from pkm_post.machine import Collisions, ReachFinding, ReachReport, ToolPoses, find_collisions, poses_along
from pkm_post.model import (
    RULES,
    Diagnostic,
    Diagnostics,
    Machine,
    Place,
    Setup,
    Severity,
    Tolerances,
    Trajectory,
    errors,
)
from pkm_post.posting import check_path_of

_ROWS = 65536
"""Rows of a column per step of the digest: some columns repeat one row without using more memory."""
_KEPT: WeakValueDictionary[bytes, JobStudy] = WeakValueDictionary()
_COLLISIONS: OrderedDict[bytes, Collisions] = OrderedDict()
"""By content, the last used one at the end."""
_MOST_COLLISIONS = 8
"""Jobs whose collisions are cached: a few lines of text each."""


@dataclass(frozen=True)
class JobStudy:
    """The checks of a job on its machine.

    Attributes:
        reach: margins along the path.
        findings: all errors and warnings, each with operation and line.
    """

    reach: ReachReport
    findings: Diagnostics

    @property
    def holds(self) -> bool:
        """Whether nothing prevents posting."""
        return not errors(self.findings)

    @property
    def margins(self) -> tuple[ReachFinding, ...]:
        """The margins whose violation prevents posting, which slower motion does not."""
        return tuple(each for each in self.reach.findings if RULES[each.subject.code].severity is Severity.ERROR)

    def worst_margin(self) -> Array:
        """The least margin of all checks at each pose, (N,), as a share of its check's largest; violated below 0."""
        columns = [each.margin / max(float(each.margin.max(initial=0.0)), 1e-9) for each in self.margins]
        least: Array = np.min([np.where(column < 0.0, np.minimum(column, -1e-9), column) for column in columns], axis=0)
        return least

    def row_of(self, finding: Diagnostic) -> int:
        """The pose of a finding, as ``row_at``; the first pose if the path has no block there."""
        return self.row_at(finding.place, finding.code) or 0

    def row_at(self, place: Place, code: str = "") -> int | None:
        """The pose of a finding at a place: that of the worst margin in the block, else the end of the block.

        Args:
            place: operation and line.
            code: of the finding, if it has one.

        Returns:
            The row; None if the path has no block at the place.
        """
        report = self.reach
        rows = np.flatnonzero(np.isin(report.segment, _segments_at(report.trajectory, place)))
        if not len(rows):
            return None
        checks = [each for each in report.findings if code and code in (each.subject.code, each.subject.rapid_code)]
        if not checks:
            return int(rows[-1])
        least = np.min([each.margin[rows] for each in checks], axis=0)
        return int(rows[np.argmin(least)])

    def pose_at(self, row: int) -> ToolPoses:
        """The pose of a row in {M}, as one row for kinematics."""
        return ToolPoses(*(np.asarray(column)[row : row + 1] for column in poses_along(self.reach.trajectory)))


def study_of(trajectory: Trajectory, machine: Machine, setup: Setup, tolerances: Tolerances) -> JobStudy:
    """The checks of a trajectory, from the cache if the inputs are unchanged.

    Args:
        trajectory: in {M}, at least one segment.
        setup: part, stock, fixtures and shanks.
        tolerances: allowed deviation of the tool from the trajectory.
    """
    key = digest((trajectory, machine, setup, tolerances))
    kept = _KEPT.get(key)
    if kept is None:
        kept = JobStudy(*check_path_of(trajectory, machine, setup, tolerances, collisions_of))
        _KEPT[key] = kept
    return kept


def collisions_of(trajectory: Trajectory, machine: Machine, setup: Setup, tolerances: Tolerances) -> Collisions:
    """The collisions of a trajectory, as from ``find_collisions``, from the cache if the inputs are unchanged.

    A trajectory read back from its file is unchanged, except for the tolerances in the file.
    """
    if setup.is_empty:
        return find_collisions(trajectory, machine, setup, tolerances)
    key = digest((replace(trajectory, tolerances=tolerances), machine, setup, tolerances))
    found = _COLLISIONS.get(key)
    if found is None:
        found = find_collisions(trajectory, machine, setup, tolerances)
    _COLLISIONS.pop(key, None)  # makes it the newest
    _COLLISIONS[key] = found
    while len(_COLLISIONS) > _MOST_COLLISIONS:
        _COLLISIONS.popitem(last=False)
    return found


def digest(value: object) -> bytes:
    """A fingerprint of the content of dataclasses, columns, mappings and plain values."""
    found = hashlib.blake2b(digest_size=16)
    _add(found, value)
    return found.digest()


def _add(found: Any, value: object) -> None:
    found.update(type(value).__name__.encode())
    if isinstance(value, np.ndarray):
        found.update(f"{value.dtype} {value.shape}".encode())
        for first in range(0, len(value) if value.ndim else 0, _ROWS):
            found.update(np.ascontiguousarray(value[first : first + _ROWS]).tobytes())
        found.update(value.tobytes() if not value.ndim else b"")
    elif is_dataclass(value):
        _add(found, tuple(getattr(value, each.name) for each in fields(value)))
    elif isinstance(value, Mapping):
        _add(found, tuple(sorted(value.items(), key=lambda pair: str(pair[0]))))
    elif isinstance(value, tuple | list | set | frozenset):
        found.update(f"{len(value)}".encode())
        for each in sorted(value, key=str) if isinstance(value, set | frozenset) else value:
            _add(found, each)
    else:
        found.update(repr(value).encode() + b"\0")


def _segments_at(trajectory: Trajectory, place: Place) -> Array:
    """The segments at a place in the source."""
    named = [number for number, name in enumerate(trajectory.operations) if name == place.operation]
    here: Array = np.flatnonzero(np.isin(trajectory.operation, named) & (trajectory.line == place.line))
    return here
