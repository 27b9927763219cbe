# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections: the motions of a program in {C}, in pieces of one modal state, and the events between them.

Input: motions with known end points, and events. Output: the columns and events of a ``Program``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pkm_post.model import Array, Event, EventKind, joined, read_only

_COLUMNS = ("position", "tool_axis", "feed", "arc_centre", "arc_axis", "kind")


@dataclass(frozen=True)
class Section:
    """Motions of one modal state: n of them, in mm, mm/s and {C}.

    Attributes:
        row: (n,) row in the file, from 0.
        kind: (n,) of ``model.Kind``.
        position: (n, 3).
        tool_axis: (n, 3).
        feed: (n,) NaN on rapid moves.
        arc_centre: (n, 3) NaN but on arcs.
        arc_axis: (n, 3) NaN but on arcs.
        stops: whether each ends at rest.
        exact_path: whether their corners are followed rather than rounded.
        tolerance: of the tip, mm; 0 for none.
        side: radius of cutter compensation, positive to the left.
        plane: coordinate of {C} that its plane is normal to.
    """

    row: Array
    kind: Array
    position: Array
    tool_axis: Array
    feed: Array
    arc_centre: Array
    arc_axis: Array
    stops: bool
    exact_path: bool
    tolerance: float
    side: float
    plane: int


@dataclass
class Sections:
    """All motions and events of a program.

    Attributes:
        events: in order.
    """

    events: list[Event] = field(default_factory=list)
    _sections: list[Section] = field(default_factory=list)
    _count: int = 0

    def __len__(self) -> int:
        return self._count

    def add(self, section: Section) -> None:
        """Add motions."""
        self._sections.append(section)
        self._count += len(section.row)

    def add_event(self, kind: EventKind, value: float) -> None:
        """Add an event after the last motion."""
        self.events.append(Event(self._count, kind, value))

    def columns(self) -> dict[str, Array]:
        """The columns of a program of at least one motion."""
        sections = self._sections
        counts = [len(section.row) for section in sections]
        columns = {name: joined([getattr(section, name) for section in sections]) for name in _COLUMNS}
        columns |= {
            "line": joined([section.row for section in sections]).astype(np.int32) + 1,
            "operation": np.zeros(len(self), np.int32),
            "exact_stop": np.repeat([section.stops for section in sections], counts),
            "exact_path": np.repeat([section.exact_path for section in sections], counts),
            "tip_tolerance": np.repeat([section.tolerance for section in sections], counts),
            "side_offset": np.repeat([section.side for section in sections], counts),
            "plane": np.repeat(np.array([section.plane for section in sections], np.uint8), counts),
        }
        return {name: read_only(column) for name, column in columns.items()}
