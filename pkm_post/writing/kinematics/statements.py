# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statements: a kinematic program, independent of the controller.

Expressions are texts of names, decimals, ``+ - * /``, brackets and the functions sin, cos, sqrt, abs and atan2, with
angles in degrees. No name has a sign, since not every controller of the family is documented to accept one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Comment:
    """A comment of one line."""

    text: str


@dataclass(frozen=True)
class Assign:
    """An assignment; an arc tangent stands alone, as ``atan2(sine, cosine)`` of two names."""

    target: str
    expression: str


@dataclass(frozen=True)
class If:
    """Two branches; the first runs if all conditions, comparisons by ``=``, ``<`` or ``>``, hold."""

    conditions: tuple[str, ...]
    then: tuple[Statement, ...]
    otherwise: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class While:
    """A loop that runs while all conditions hold."""

    conditions: tuple[str, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class Fail:
    """Report that there is no solution, as the controller expects."""


Statement = Comment | Assign | If | While | Fail


def assignments(text: str) -> list[Statement]:
    """The assignments of a text, one ``name = expression`` in each line."""
    parts = (line.split("=", 1) for line in text.strip().splitlines())
    return [Assign(target.strip(), expression.strip()) for target, expression in parts]


def assigned(statements: Sequence[Statement]) -> Iterator[str]:
    """Yield the targets of all assignments, in the order of the text."""
    for statement in statements:
        match statement:
            case Assign(target, _):
                yield target
            case If(_, then, otherwise):
                yield from assigned([*then, *otherwise])
            case While(_, body):
                yield from assigned(body)
