# SPDX-License-Identifier: LGPL-2.1-or-later
"""Selection: what of a CAM job is meant, where not all of it is: operations and fixtures.

FreeCAD newer than 1.1 lets people choose both in the dialog of CAM's Post Process.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Selection:
    """What is meant; None means all.

    Attributes:
        operations: some of the job's own.
        fixtures: some of the job's own.
    """

    operations: Sequence[Any] | None = None
    fixtures: Sequence[str] | None = None

    def operations_of(self, job: Any) -> list[Any]:
        """The operations that are meant, in the order of the job."""
        own = list(job.Operations.Group)
        return own if self.operations is None else [each for each in own if each in self.operations]

    def strangers(self, job: Any) -> list[Any]:
        """Operations that are meant and are none of the job's."""
        return [each for each in self.operations or () if each not in job.Operations.Group]

    def fixtures_of(self, job: Any) -> list[str]:
        """The fixtures that are meant, in the order of the job."""
        own = list(job.Fixtures)
        return own if self.fixtures is None else [each for each in own if each in self.fixtures]


EVERYTHING = Selection()
"""The whole job."""
