# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits: resource bounds that let every execution end in bounded time and memory.

Enters: the choice of the user. Leaves: the same, checked.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ExecutionLimits:
    """Bounds of an execution.

    Attributes:
        blocks: executed blocks, including those that yield no plain block.
        operations: values and operators evaluated in expressions, and G and M codes output.
        depth: call depth, including the main program.
    """

    blocks: int = 10_000_000
    operations: int = 100_000_000
    depth: int = 10

    def __post_init__(self) -> None:
        for name in ("blocks", "operations", "depth"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name}: expected at least 1, got {getattr(self, name)}")
