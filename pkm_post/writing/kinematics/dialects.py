# SPDX-License-Identifier: LGPL-2.1-or-later
"""Dialects: kinematic statements, independent of the controller, and their text for Turbo PMAC and Power PMAC.

Expressions are texts of names, decimals, ``+ - * /``, brackets and the functions sin, cos, sqrt, abs and atan2, with
angles in degrees. No name has a sign, since not every controller of the family is documented to accept one.

Sources: Turbo PMAC User Manual (Delta Tau), "Setting Up a Coordinate System", p. 259 to 267, and "Computational
Features", p. 248, for functions and I15; Power PMAC User's Manual (Omron), "Kinematic Subroutines", p. 511 to 519, and
Software Reference Manual, "Command Syntax Summary", for operators and functions.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from pkm_post.writing.kinematics.variables import AXES, STRUTS, work_numbers


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


_ARC_TANGENT = re.compile(r"atan2\((\w+), (\w+)\)")
_NAME = re.compile(r"[a-z]\w*")


@dataclass(frozen=True)
class KinematicDialect:
    """The words of one controller.

    Attributes:
        comment: start of a comment.
        functions: its names of functions with angles in degrees.
        equal: its comparison of equal numbers.
        both: between two conditions.
        arc_tangent: maps target, sine and cosine to lines that assign the angle in degrees.
        branch: opens the first branch of a condition, with ``{}`` for the condition.
        otherwise: between two branches.
        end_branch: ends a condition.
        loop: opens a loop, with ``{}`` for the condition.
        end_loop: ends a loop.
        names: names of axes, rates, motors and the flag of speeds.
        fail: maps the coordinate system to the lines that report a missing solution.
    """

    comment: str
    functions: Mapping[str, str]
    equal: str
    both: str
    arc_tangent: Callable[[str, str, str], list[str]]
    branch: str
    otherwise: str
    end_branch: str
    loop: str
    end_loop: str
    names: Mapping[str, str]
    fail: Callable[[int], list[str]]


def _names(wants_speed: str, axes: str, numbers: Sequence[int], rate: int, motor: str, speed: str) -> dict[str, str]:
    """Names of axes X Y Z A B C with these numbers, of their rates ``rate`` higher, of motors and of their speeds."""
    of_axes = dict(zip(AXES, numbers, strict=True))
    return {
        "wants_speed": wants_speed,
        **{axis: f"{axes}{number}" for axis, number in of_axes.items()},
        **{f"rate_{axis}": f"{axes}{number + rate}" for axis, number in of_axes.items()},
        **{f"motor{strut}": f"{motor}{strut}" for strut in STRUTS},
        **{f"speed{strut}": speed.format(strut) for strut in STRUTS},
    }


def _power_failure(system: int) -> list[str]:
    """An error that stops a motion program, or positions that are not numbers for a query."""
    unknown = [f"C{number}=sqrt(0-1)" for number in (0, 1, 2, 6, 7, 8)]
    return ["if (Ldata.Status&$40) {", f"Coord[{system}].ErrorStatus=255", "} else {", *unknown, "}"]


TURBO = KinematicDialect(
    comment=";",
    functions={name: name.upper() for name in ("sin", "cos", "sqrt", "abs")},
    equal="=",
    both=" AND ",
    arc_tangent=lambda target, sine, cosine: [f"Q0={cosine}", f"{target}=ATAN2({sine})"],
    branch="IF ({})",
    otherwise="ELSE",
    end_branch="ENDIF",
    loop="WHILE ({})",
    end_loop="ENDWHILE",
    names=_names("Q10", "Q", (7, 8, 9, 1, 2, 3), 10, "P", "P10{}"),
    fail=lambda system: [f"M{run_time_error(system)}=1"],
)
POWER = KinematicDialect(
    comment="//",
    functions={"sin": "sind", "cos": "cosd", "sqrt": "sqrt", "abs": "abs"},
    equal="==",
    both=" && ",
    arc_tangent=lambda target, sine, cosine: [f"{target}=atan2d({sine},{cosine})"],
    branch="if ({}) {{",
    otherwise="} else {",
    end_branch="}",
    loop="while ({}) {{",
    end_loop="}",
    names=_names("D0", "C", (6, 7, 8, 0, 1, 2), 32, "L", "R{}"),
    fail=_power_failure,
)


def run_time_error(system: int) -> int:
    """Suggested M-variable of the run-time error bit of a coordinate system of the Turbo PMAC."""
    return 5082 + 100 * system


def rendered(
    statements: Sequence[Statement],
    dialect: KinematicDialect,
    numbers: Mapping[str, int],
    system: int,
    forward: bool,
    literal: Mapping[str, str] | None = None,
) -> list[str]:
    """Lines of the forward or inverse program with the words of a controller.

    ``numbers`` are the Q-variables of the parameters, by name; ``literal`` are further names in its spelling.
    """
    computed = (name for name in assigned(statements) if name not in dialect.names)
    variables = {name: f"Q{number}" for name, number in {**numbers, **work_numbers(computed, forward)}.items()}
    names = {**variables, **dialect.names, **dialect.functions, **(literal or {})}
    return list(_lines(statements, dialect, names, system))


def _lines(
    statements: Sequence[Statement], dialect: KinematicDialect, names: Mapping[str, str], system: int
) -> Iterator[str]:
    for statement in statements:
        match statement:
            case Comment(text):
                yield f"{dialect.comment} {text}"
            case Assign(target, expression):
                yield from _assignment(target, expression, dialect, names)
            case If(conditions, then, otherwise):
                yield dialect.branch.format(_condition(conditions, dialect, names))
                yield from _lines(then, dialect, names, system)
                if otherwise:
                    yield dialect.otherwise
                    yield from _lines(otherwise, dialect, names, system)
                yield dialect.end_branch
            case While(conditions, body):
                yield dialect.loop.format(_condition(conditions, dialect, names))
                yield from _lines(body, dialect, names, system)
                yield dialect.end_loop
            case Fail():
                yield from dialect.fail(system)


def _assignment(target: str, expression: str, dialect: KinematicDialect, names: Mapping[str, str]) -> list[str]:
    """The lines of an assignment; the trailing name is for checks against the formulas."""
    if (arc := _ARC_TANGENT.fullmatch(expression)) is not None:
        *before, last = dialect.arc_tangent(names[target], names[arc[1]], names[arc[2]])
    else:
        before, last = [], f"{names[target]}={_named(expression, names)}"
    return [*before, f"{last} {dialect.comment} {target}"]


def _condition(conditions: Sequence[str], dialect: KinematicDialect, names: Mapping[str, str]) -> str:
    parts = (_named(condition, names).replace("=", dialect.equal) for condition in conditions)
    return dialect.both.join(parts)


def _named(expression: str, names: Mapping[str, str]) -> str:
    return _NAME.sub(lambda name: names[name[0]], expression)
