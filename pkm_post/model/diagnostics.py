# SPDX-License-Identifier: LGPL-2.1-or-later
"""Diagnostics: faults of the input, collected while reading and checking, reported as text.

Every fault has a code; the table ``RULES`` has the severity, cause and cure of each. A diagnostic adds the place and
what was found there. Faults of the caller are ``ValueError`` and not part of this module.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from pkm_post.model.rules import RULES, Rule, Severity

__all__ = ["RULES", "Diagnostic", "Place", "Refused", "Rule", "Severity", "errors"]


@dataclass(frozen=True)
class Place:
    """Position in the input.

    Attributes:
        file: file name as the user gave it.
        operation: name of the CAM operation, empty when the file has none.
        line: line, or number of the command in its operation, from 1; 0 for the whole.
        column: column from 1; 0 for the whole line.
    """

    file: str
    operation: str = ""
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        position = ":".join(str(number) for number in (self.line, self.column) if number)
        return ": ".join(part for part in (self.file, self.operation, position and f"line {position}") if part)


@dataclass(frozen=True)
class Diagnostic:
    """One fault at one place.

    Attributes:
        code: key into ``RULES``.
        place: position in the input.
        found: what was found there, in the words of the input.
    """

    code: str
    place: Place
    found: str

    @property
    def severity(self) -> Severity:
        """Severity of the rule."""
        return RULES[self.code].severity

    @property
    def text(self) -> str:
        """Severity, code, cause, what was found, and the cure."""
        rule = RULES[self.code]
        return f"{rule.severity.value} {self.code}: {rule.cause}: {self.found}; {rule.cure}"

    def __str__(self) -> str:
        return f"{self.place}: {self.text}"


def errors(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Diagnostics that stop a job."""
    return tuple(item for item in diagnostics if item.severity is Severity.ERROR)


class Refused(Exception):  # noqa: N818 - it is no error of the program
    """The job is refused because of its input. Raised by pipeline and entry points, once all faults are known."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(str(item) for item in self.diagnostics))
