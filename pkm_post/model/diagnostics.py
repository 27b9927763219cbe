# SPDX-License-Identifier: LGPL-2.1-or-later
"""Diagnostics: faults of the input, collected while reading and checking, reported as text.

Every fault has a code; the table ``RULES`` has the severity, cause and cure of each. A diagnostic adds the place
and the text found there. A ``DiagnosticLog`` keeps the first ones of each group and counts the rest, since a program of
a million blocks may have the same fault in each. Errors of the caller are ``ValueError``, not diagnostics.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from pkm_post.model.rules import Severity

Value = TypeVar("Value")

_BREAKING = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]")


def in_one_line(text: str) -> str:
    """A text with its line breaks and other control characters as escapes: names of files and operations have any."""
    return _BREAKING.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


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

    @property
    def position(self) -> str:
        """Line and column, as far as they are known."""
        return ":".join(str(number) for number in (self.line, self.column) if number)

    def __str__(self) -> str:
        parts = (self.file, self.operation, self.position and f"line {self.position}")
        return in_one_line(": ".join(part for part in parts if part))


@dataclass(frozen=True)
class Diagnostic:
    """One fault at one place.

    Attributes:
        code: key into ``RULES``.
        place: position in the input.
        found: the offending text or value, in the words of the input.
    """

    code: str
    place: Place
    found: str

    @property
    def severity(self) -> Severity:
        """Severity of the rule."""
        return severity_of(self.code)

    @property
    def text(self) -> str:
        """Severity, code, cause, finding and cure."""
        from pkm_post.model.rules import RULES

        rule = RULES[self.code]
        return f"{rule.severity.value} {self.code}: {rule.cause}: {in_one_line(self.found)}; {rule.cure}"

    def __str__(self) -> str:
        return f"{self.place}: {self.text}"


Diagnostics = tuple[Diagnostic, ...]


def severity_of(code: str) -> Severity:
    """Severity of the rule with this code."""
    from pkm_post.model.rules import RULES

    return RULES[code].severity


def errors(diagnostics: Iterable[Diagnostic]) -> Diagnostics:
    """Diagnostics that stop a job."""
    return tuple(item for item in diagnostics if item.severity is Severity.ERROR)


class Refused(Exception):  # noqa: N818 - it is no error of the program
    """The job is refused because of its input. Raised by pipeline and entry points, once all faults are known."""

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(str(item) for item in self.diagnostics))

    def __reduce__(self) -> tuple[type[Refused], tuple[Diagnostics]]:
        # Exceptions are pickled with the text that they pass to their base, as on the way out of a process of a pool.
        return type(self), (self.diagnostics,)


def required(value: Value | None, diagnostics: Iterable[Diagnostic]) -> Value:
    """The value of a step that returns it with its diagnostics.

    Raises:
        Refused: there is none; with the diagnostics.
    """
    if value is None:
        raise Refused(diagnostics)
    return value


@dataclass
class DiagnosticLog:
    """Diagnostics of one input.

    Attributes:
        most: maximum kept per group.
    """

    most: int
    _kept: list[tuple[Hashable, Diagnostic]] = field(default_factory=list)
    _count: Counter[Hashable] = field(default_factory=Counter)

    def keeps(self, group: Hashable = "") -> bool:
        """Whether the group still has room."""
        return self._count[group] < self.most

    def add(self, diagnostic: Diagnostic, group: Hashable = "") -> None:
        """Keep a diagnostic, or count it if its group is complete."""
        if self.keeps(group):
            self._kept.append((group, diagnostic))
        self.count(1, group)

    def count(self, number: int, group: Hashable = "") -> None:
        """Count further diagnostics of a group without keeping them."""
        self._count[group] += number

    def more(self, group: Hashable = "") -> int:
        """Number counted but not kept."""
        return max(self._count[group] - self.most, 0)

    @property
    def kept(self) -> Diagnostics:
        """The kept diagnostics, in the order of their addition."""
        return tuple(diagnostic for _, diagnostic in self._kept)

    def has_errors(self) -> bool:
        """Whether any of them is an error."""
        return bool(errors(self.kept))

    def in_order(self, key: Callable[[Diagnostic], Any]) -> Diagnostics:
        """The kept diagnostics, sorted by a key; the last one of a group states the number not kept."""
        ordered = sorted(self._kept, key=lambda entry: key(entry[1]))
        last = {group: index for index, (group, _) in enumerate(ordered)}
        diagnostics = [diagnostic for _, diagnostic in ordered]
        for group, index in last.items():
            if more := self.more(group):
                found = f"{diagnostics[index].found}, and {more} more like it"
                diagnostics[index] = replace(diagnostics[index], found=found)
        return tuple(diagnostics)
