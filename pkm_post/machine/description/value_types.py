# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forms: allowed values of an entry, as a description and a parser.

Input: one value from ``tomllib`` and the scale of its unit. Output: a number, numpy array or text in mm, rad, s, or
``WrongValueError`` with the finding. The descriptions are those of the documentation.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from pkm_post.machine.description.units import Scale
from pkm_post.model import Array, Body, Box

LARGEST = 1e12
"""A larger number, an infinity or a NaN is a typing error: no machine quantity is that large."""
SHORTEST_DIRECTION = 1e-9
UNKNOWN = "unknown"
"""Placeholder in a template for unknown machine data."""
RIGID_TOLERANCE = 1e-6
"""Tolerance of a typed rotation matrix: six decimals are common."""
_ROOM = 1.0 + 1e-9
"""Allowance for unit rounding, so that the limits themselves are valid."""
AXIS_LETTERS = "ABCUVWXYZ"
STRUTS = 6
MOST_SHOWN = 60
"""Characters of a wrong value that a diagnostic quotes."""


class WrongValueError(Exception):
    """A value does not have the required form; the text is the finding."""


class ValueType(NamedTuple):
    """One form: its description, after "expected", and the function that parses and converts a value."""

    words: str
    read: Callable[[Any, Scale], Any]


def _shorten(text: str) -> str:
    return text if len(text) <= MOST_SHOWN else text[: MOST_SHOWN - 3] + "..."


_SHOWN: dict[type, Callable[[Any], str]] = {
    bool: lambda value: str(value).lower(),
    int: lambda value: str(value) if abs(value) <= LARGEST else f"a number beyond {LARGEST:g}",
    float: repr,
    str: lambda value: _shorten(repr(value)),
    list: lambda value: f"a list of {len(value)}",
    dict: lambda value: "a table",
}


def quoted(value: Any) -> str:
    """Format a value of the file, shortened."""
    return _SHOWN.get(type(value), str)(value)


def contains_unknown(value: Any) -> bool:
    """Whether a value, or any part of it, is still to be filled in."""
    if isinstance(value, dict):
        value = list(value.values())
    return any(map(contains_unknown, value)) if isinstance(value, list) else value == UNKNOWN


def _is_number(value: Any) -> bool:
    # The comparison also rejects NaN, infinities and integers that exceed a float.
    return isinstance(value, int | float) and not isinstance(value, bool) and -LARGEST <= value <= LARGEST


def collect(value: Any, shape: tuple[int, ...], at: tuple[int, ...] = ()) -> Any:
    """Nested lists of ``value`` as floats, with exactly this shape.

    Raises:
        WrongValueError: the shape differs; the text is the finding with its place.
    """
    where = f" at place {', '.join(map(str, at))}" if at else ""
    if not shape and _is_number(value):
        return float(value)
    if not shape or not isinstance(value, list) or len(value) != shape[0]:
        raise WrongValueError(quoted(value) + where)
    return [collect(item, shape[1:], (*at, index)) for index, item in enumerate(value, start=1)]


def converted(value: Any, shape: tuple[int, ...], scale: Scale, is_positive: bool = False) -> Array:
    """Numbers of ``value`` in mm, rad and s.

    Raises:
        WrongValueError: wrong shape or implausible magnitude; positive numbers also have a minimum.
    """
    numbers: Array = np.array(collect(value, shape)) * scale.factor
    size = np.abs(numbers)
    if np.any(size > scale.most * _ROOM) or (is_positive and np.any((numbers > 0.0) & (size < scale.least / _ROOM))):
        raise WrongValueError(f"{_shorten(str(value))}; {scale.words}")
    return numbers


def _numbers(
    words: str,
    shape: tuple[int, ...] = (),
    accept: Callable[[Array], Any] = lambda numbers: True,
    finish: Callable[[Array], Any] = lambda numbers: numbers,
    is_positive: bool = False,
) -> ValueType:
    """Form of numbers: shape, condition on the converted values, and result."""

    def read(value: Any, scale: Scale) -> Any:
        numbers = converted(value, shape, scale, is_positive)
        if not accept(numbers):
            raise WrongValueError(_shorten(str(value)))
        return finish(numbers)

    return ValueType(words, read)


def _unit(directions: Array) -> Array:
    return np.asarray(directions / np.linalg.norm(directions, axis=1, keepdims=True))


def _read_pose(value: Any, scale: Scale) -> Array:
    pose = np.array(collect(value, (4, 4)))
    rotation = pose[:3, :3]
    rigid = np.abs(rotation @ rotation.T - np.eye(3)).max() <= RIGID_TOLERANCE and np.linalg.det(rotation) > 0.0
    if not rigid or np.any(pose[3] != (0.0, 0.0, 0.0, 1.0)):
        raise WrongValueError("a matrix that is no rigid motion")
    left, _, right = np.linalg.svd(rotation)
    pose[:3, :3] = left @ right  # nearest rotation: rounded decimals must not stretch a path
    pose[:3, 3] = converted(pose[:3, 3].tolist(), (3,), scale)
    return pose


def _read_half_angles(value: Any, scale: Scale) -> Array:
    angles = converted(value, _one_or_six(value), scale, is_positive=True)
    if np.any((angles <= 0.0) | (angles > math.pi / 2.0)):
        raise WrongValueError(_shorten(str(value)))
    return np.full(STRUTS, angles)


def _one_or_six(value: Any) -> tuple[int, ...]:
    return (STRUTS,) if isinstance(value, list) else ()


def _read_six_positive(value: Any, scale: Scale) -> Array:
    numbers = converted(value, _one_or_six(value), scale, is_positive=True)
    if np.any(numbers <= 0.0):
        raise WrongValueError(_shorten(str(value)))
    return np.full(STRUTS, numbers)


def _text(words: str, accept: Callable[[str], Any]) -> ValueType:
    def read(value: Any, scale: Scale) -> str:
        if not isinstance(value, str) or not accept(value):
            raise WrongValueError(quoted(value))
        return value

    return ValueType(words, read)


def choice(*names: str) -> ValueType:
    """Form of an entry with a fixed choice of words."""
    return _text(f"one of {', '.join(names)}", names.__contains__)


def whole_number(least: int, most: int) -> ValueType:
    """Form of a whole-number entry, from ``least`` to ``most``."""

    def read(value: Any, scale: Scale) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
            raise WrongValueError(quoted(value))
        return value

    return ValueType(f"a whole number from {least} to {most}", read)


def _read_letters(value: Any, scale: Scale) -> tuple[str, ...]:
    letters = value if isinstance(value, list) else []
    known = [letter for letter in letters if isinstance(letter, str) and len(letter) == 1 and letter in AXIS_LETTERS]
    if len(known) != len(letters) or len(set(known)) != STRUTS or len(letters) != STRUTS:
        raise WrongValueError(", ".join(map(quoted, letters)) or quoted(value))
    return tuple(known)


_LEFT_OUT = re.compile(r"([GM]\d{1,4}(?:\.\d)?)\s+\S.*")


def _read_left_out(value: Any, scale: Scale) -> tuple[str, ...]:
    texts = value if isinstance(value, list) else [value]
    found = [_LEFT_OUT.fullmatch(text) if isinstance(text, str) else None for text in texts]
    if not all(found) or not isinstance(value, list):
        raise WrongValueError(", ".join(map(quoted, texts)) or quoted(value))
    return tuple(f"{each[1][0]}{float(each[1][1:]):g}" for each in found if each)


_CODE = re.compile(r"(?:[ -z|~]|\{value\}|\{value:d\}|\{value:\.[1-9]f\})+")
"""Printable ASCII, braces only around the number of the event."""

_FUNCTION = re.compile(r"M[1-9]\d{1,3}")
_OF_THE_LANGUAGE = {17, 29, 30, *range(47, 54), *range(60, 74), *range(96, 100)}
"""M codes of two digits or more with a meaning in some flavour of G-code."""


def _read_functions(value: Any, scale: Scale) -> dict[str, str]:
    given = value if isinstance(value, dict) else {"": value}
    for name, text in given.items():
        fits = isinstance(text, str) and _CODE.fullmatch(text) and "{" not in text
        if not fits or not _FUNCTION.fullmatch(name) or int(name[1:]) in _OF_THE_LANGUAGE:
            raise WrongValueError(f"{name} = {quoted(text)}" if name else quoted(text))
    return dict(given)


NUMBER = _numbers("a number", finish=float)
POSITIVE = _numbers("a number above 0", (), lambda number: number > 0.0, float, is_positive=True)
NOT_NEGATIVE = _numbers("a number, 0 or above", (), lambda number: number >= 0.0, float)
SIX_POSITIVE = ValueType("a number above 0, or 6 of them", _read_six_positive)
HALF_ANGLES = ValueType("an angle above 0 and at most a right angle, or 6 of them", _read_half_angles)
STROKE = _numbers(
    "2 numbers, 0 < first < second",
    (2,),
    lambda stroke: 0.0 < stroke[0] < stroke[1],
    lambda stroke: (float(stroke[0]), float(stroke[1])),
)
POINT = _numbers("3 numbers", (3,))
UPWARDS = _numbers(
    "3 numbers, the third above 0",
    (3,),
    lambda row: row[2] > 0.0 and np.linalg.norm(row) > SHORTEST_DIRECTION,
    lambda row: _unit(row[None])[0],
)
SIX_NUMBERS = _numbers("6 numbers", (STRUTS,), finish=lambda numbers: tuple(map(float, numbers)))
SIX_POINTS = _numbers("6 rows of 3 numbers", (STRUTS, 3))
SIX_DIRECTIONS = _numbers(
    "6 rows of 3 numbers, none of them all zero",
    (STRUTS, 3),
    lambda rows: np.linalg.norm(rows, axis=1).min() > SHORTEST_DIRECTION,
    _unit,
)
POSE = ValueType("4 rows of 4 numbers, a rotation and a shift", _read_pose)
NAME = _text("a text of one line", lambda text: text.strip() and text.isprintable())
PROSE = _text("a text", lambda text: True)
CODE = _text("a line of ASCII, the number as {value}, {value:d} or {value:.3f}", _CODE.fullmatch)
FUNCTIONS = ValueType(
    'a table of texts such as M21 = "M21": M codes from M10 on that do not say how a program runs', _read_functions
)
LEFT_OUT = ValueType('texts such as "M21 chip conveyor": a G or M code and why it is left out', _read_left_out)
LETTERS = ValueType(f"6 different letters out of {' '.join(AXIS_LETTERS)}", _read_letters)


_NAME = "name"
MOST_SOLIDS = 100
"""Most solids of either sort: each body is checked against each fixture along the whole path."""


def _tables(value: Any, shapes: dict[str, tuple[int, ...]], scale: Scale) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the name of each table and its numbers in mm; other keys are refused."""
    if not isinstance(value, list) or len(value) > MOST_SOLIDS:
        raise WrongValueError(quoted(value))
    for place, table in enumerate(value, start=1):
        where = f" at place {place}"
        if not isinstance(table, dict):
            raise WrongValueError(quoted(table) + where)
        if stray := sorted({_NAME, *shapes} ^ set(table)):
            missing = stray[0] not in table
            raise WrongValueError(("no " if missing else "") + stray[0] + where)
        try:
            name = NAME.read(table[_NAME], scale)
            yield name, {key: converted(table[key], shape, scale) for key, shape in shapes.items()}
        except WrongValueError as wrong:
            raise WrongValueError(f"{wrong}{where}") from wrong


def _read_bodies(value: Any, scale: Scale) -> tuple[Body, ...]:
    bodies = []
    for name, numbers in _tables(value, {"radius": (), "from": (), "to": ()}, scale):
        body = Body(name, *(float(numbers[key]) for key in ("radius", "from", "to")))
        if body.radius < scale.least or body.start >= body.end:
            raise WrongValueError(f"{name} of radius {body.radius:g} mm from {body.start:g} to {body.end:g} mm")
        bodies.append(body)
    return tuple(bodies)


def _read_boxes(value: Any, scale: Scale) -> tuple[Box, ...]:
    boxes = []
    for name, corners in _tables(value, {"lowest": (3,), "highest": (3,)}, scale):
        if np.any(corners["lowest"] >= corners["highest"]):
            raise WrongValueError(f"{name} with a corner 'lowest' that is not below 'highest' in x, y and z")
        boxes.append(Box(name, **corners))
    return tuple(boxes)


BODIES = ValueType(
    f"a list of at most {MOST_SOLIDS} tables with name, radius above 0, from, to above from", _read_bodies
)
FIXTURES = ValueType(
    f"a list of at most {MOST_SOLIDS} tables with name, lowest, highest, two corners of 3 numbers", _read_boxes
)
