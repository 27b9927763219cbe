# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results: the results of a posting or a verification, for the report, its page and its picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pkm_post.geometry import Array
from pkm_post.model import Certificate, FeedStudy, Machine, Motion, Setup, StrutMotion, Tolerances, Trajectory


@dataclass(frozen=True)
class Results:
    """The input of a report.

    Attributes:
        machine: its limits are shown.
        struts: the program as read back.
        feed: feed of the plan; None if only the program is known.
        reading: interpretation of the input, as in ``model.Program``.
        files: hashes of the files (``summary.hashes``).
        setup: the set-up; None if unknown.
        work_offset: name of the work offset and the (4, 4) pose of {C} in {M}; None if unknown.
        unit: of lengths on the page, mm or inch.
        date: text on the page; empty for none.
    """

    trajectory: Trajectory
    machine: Machine
    motion: Motion
    struts: StrutMotion
    certificate: Certificate
    tolerances: Tolerances
    feed: FeedStudy | None = None
    reading: Sequence[str] = ()
    files: Mapping[str, Any] = field(default_factory=dict)
    setup: Setup | None = None
    work_offset: tuple[str, Array] | None = None
    unit: str = "mm"
    date: str = ""
