# SPDX-License-Identifier: LGPL-2.1-or-later
"""Phrase: a text that remembers its pattern and values, so that the GUI can translate it and convert its units.

Files, the command line and comparisons see only its English text. Its pattern is a literal in the sources:
``tools/core_texts.py`` gathers the patterns for translation, and ``freecad_app.core_texts`` displays phrases.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Amount:
    """A number with its unit.

    Attributes:
        value: in that unit.
        unit: as printed; empty for none.
        digits: format of the number.
    """

    value: float
    unit: str
    digits: str = ".4g"

    def __str__(self) -> str:
        return f"{self.value:{self.digits}} {self.unit}".rstrip()


class Pattern(str):
    """The pattern of a phrase, before its values are known."""

    __slots__ = ()

    def phrase(self, *values: object, **named: object) -> Phrase:
        """The phrase with these values."""
        return Phrase(str(self), *values, **named)


class Phrase(str):
    """A text made of a pattern and its values, as by ``str.format``.

    Attributes:
        pattern: English, with a field in braces for each value.
        values: by position; phrases and amounts among them are translated and converted, too.
        named: by name.
    """

    pattern: str
    values: tuple[object, ...]
    named: Mapping[str, object]

    def __new__(cls, pattern: str, *values: object, **named: object) -> Phrase:  # noqa: D102 - as the class
        made = super().__new__(cls, pattern.format(*values, **named))
        made.pattern, made.values, made.named = pattern, values, named
        return made

    def __getnewargs_ex__(self) -> tuple[tuple[object, ...], Mapping[str, object]]:
        return (self.pattern, *self.values), self.named
