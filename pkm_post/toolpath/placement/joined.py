# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joined: programs concatenated into one."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from pkm_post.model import MOTION_COLUMNS, OPTIONAL_COLUMNS, Program


def joined(programs: Sequence[Program]) -> Program:
    """Concatenate programs that share operations, tools and source, as copies do.

    Args:
        programs: at least one; each is reached from the one before by its first rapid move.

    Raises:
        ValueError: there is none, or they do not have the same operations.
    """
    if not programs or any(program.operations != programs[0].operations for program in programs):
        raise ValueError("joined: expected programs of the same operations, at least one")
    names = {*MOTION_COLUMNS, *OPTIONAL_COLUMNS, "position", "tool_axis"}
    first_rows = np.cumsum([0, *map(len, programs)])
    columns: dict[str, Any] = {name: np.concatenate([getattr(program, name) for program in programs]) for name in names}
    return dataclasses.replace(
        programs[0],
        **columns,
        events=tuple(
            dataclasses.replace(event, row=int(first) + event.row)
            for first, program in zip(first_rows, programs, strict=False)
            for event in program.events
        ),
    )
