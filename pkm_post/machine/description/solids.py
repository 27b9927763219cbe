# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids of a machine file: bodies that move with the platform and fixed boxes.

Input: a list of tables from ``tomllib`` and the scale of its length unit. Output: ``model.Body`` and ``model.Box`` in
mm, or ``FormError`` that names the faulty table of the list.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from pkm_post.machine.description.forms import NAME, Form, FormError, converted, shown
from pkm_post.machine.description.units import Scale
from pkm_post.model import Body, Box

_NAME = "name"
MOST_SOLIDS = 100
"""Most solids of either sort: each body is checked against each fixture along the whole path."""


def _tables(value: Any, shapes: dict[str, tuple[int, ...]], scale: Scale) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the name of each table and its numbers in mm; other keys are refused."""
    if not isinstance(value, list) or len(value) > MOST_SOLIDS:
        raise FormError(shown(value))
    for place, table in enumerate(value, start=1):
        where = f" at place {place}"
        if not isinstance(table, dict):
            raise FormError(shown(table) + where)
        if stray := sorted({_NAME, *shapes} ^ set(table)):
            missing = stray[0] not in table
            raise FormError(("no " if missing else "") + stray[0] + where)
        try:
            name = NAME.read(table[_NAME], scale)
            yield name, {key: converted(table[key], shape, scale) for key, shape in shapes.items()}
        except FormError as wrong:
            raise FormError(f"{wrong}{where}") from wrong


def _read_bodies(value: Any, scale: Scale) -> tuple[Body, ...]:
    bodies = []
    for name, numbers in _tables(value, {"radius": (), "from": (), "to": ()}, scale):
        body = Body(name, *(float(numbers[key]) for key in ("radius", "from", "to")))
        if body.radius < scale.least or body.start >= body.end:
            raise FormError(f"{name} of radius {body.radius:g} mm from {body.start:g} to {body.end:g} mm")
        bodies.append(body)
    return tuple(bodies)


def _read_boxes(value: Any, scale: Scale) -> tuple[Box, ...]:
    boxes = []
    for name, corners in _tables(value, {"lowest": (3,), "highest": (3,)}, scale):
        if np.any(corners["lowest"] >= corners["highest"]):
            raise FormError(f"{name} with a corner 'lowest' that is not below 'highest' in x, y and z")
        boxes.append(Box(name, **corners))
    return tuple(boxes)


BODIES = Form(f"a list of at most {MOST_SOLIDS} tables with name, radius above 0, from, to above from", _read_bodies)
FIXTURES = Form(
    f"a list of at most {MOST_SOLIDS} tables with name, lowest, highest, two corners of 3 numbers", _read_boxes
)
