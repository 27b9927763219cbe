# SPDX-License-Identifier: LGPL-2.1-or-later
"""Selection: the operations and fixtures of a CAM job to use, where not all are wanted.

FreeCAD newer than 1.1 offers both choices in CAM's Post Process dialog.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Selection:
    """The selected items; None means all.

    Attributes:
        operations: some of the job's own.
        fixtures: some of the job's own.
    """

    operations: Sequence[Any] | None = None
    fixtures: Sequence[str] | None = None

    def operations_of(self, job: Any) -> list[Any]:
        """The selected operations, in the order of the job."""
        own = list(job.Operations.Group)
        return own if self.operations is None else [each for each in own if each in self.operations]

    def strangers(self, job: Any) -> list[Any]:
        """Selected operations that do not belong to the job."""
        return [each for each in self.operations or () if each not in job.Operations.Group]

    def fixtures_of(self, job: Any) -> list[str]:
        """The selected fixtures, in the order of the job."""
        own = list(job.Fixtures)
        return own if self.fixtures is None else [each for each in own if each in self.fixtures]


EVERYTHING = Selection()
"""The whole job."""
