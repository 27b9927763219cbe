# SPDX-License-Identifier: LGPL-2.1-or-later
"""State of a controlled machine, for display."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pkm_post.control.link.status import Status
from pkm_post.control.link.stopping import emergency_text
from pkm_post.control.numerical_control.homing import Homing
from pkm_post.control.numerical_control.single_block import BlockDisplay
from pkm_post.toolpath import ToolPose


@dataclass(frozen=True)
class ControlState:
    """A snapshot for display.

    Attributes:
        status: of struts and program; the last one if the link is lost, None before the first reading.
        pose: of the tool at the actual strut lengths; None if no pose fits, or before the first reading.
        lost: the reason of a lost link; empty while it is up.
        emergency: instructions for the operator if the link is lost while the machine may move.
        homing: of a homing started here; None otherwise.
        block: the next block; None outside single block mode.
        note: why the machine was held from here, or given up to another client, while a program runs.
    """

    status: Status | None
    pose: ToolPose | None
    lost: str = ""
    emergency: tuple[str, ...] = ()
    homing: Homing | None = None
    block: BlockDisplay | None = None
    note: str = ""

    def without_link(self, reason: str, may_move: bool) -> ControlState:
        """The state after the link is lost, with instructions if the machine may move; none before the first link."""
        if self.status is None and not may_move:
            return replace(self, lost=reason, emergency=())
        return replace(self, lost=reason, emergency=emergency_text(None if may_move else self.status))
