# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rule: severity, cause and cure of one fault of the input."""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Severity(enum.Enum):
    """Severity of a fault: an error stops the job, a warning is shown and the job continues."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True)
class Rule:
    """One row of the table of faults."""

    severity: Severity
    cause: str
    cure: str


def error(cause: str, cure: str) -> Rule:
    """A fault that stops the job."""
    return Rule(Severity.ERROR, cause, cure)


def warning(cause: str, cure: str) -> Rule:
    """A fault that is shown while the job continues."""
    return Rule(Severity.WARNING, cause, cure)


TAPPING = error(
    "tapping needs a feed synchronised with the spindle, which is not supported here",
    "mill the threads as helices; or tap them by G74 or G84 with S and F, on a machine whose spindle is an axis: state"
    " [spindle.axis] in its machine file",
)
"""One rule, with a code for each kind of input."""
