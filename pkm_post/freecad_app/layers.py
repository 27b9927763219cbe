# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers: dress-ups, arrays and copies that stand above a CAM operation, by their ``Base``.

A document object enters; what lies below it, and which layers would spoil the tool axis, leaves. Stock dress-ups
rebuild moves from X Y Z and arrays turn these alone: I J K words below them are dropped or left as they were.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pkm_post.freecad_app.commands.words import Words

_OURS = "pkm_post."


def is_ours(operation: Any) -> bool:
    """Whether the object is one of this add-on, which turns tool axes along with points."""
    return type(getattr(operation, "Proxy", None)).__module__.startswith(_OURS)


def bases(operation: Any) -> list[Any]:
    """The operations right below; the faces and edges that an operation is made from are none."""
    base = getattr(operation, "Base", None)
    linked = base if isinstance(base, list | tuple) else [base]
    return [below for below in linked if hasattr(below, "isDerivedFrom") and below.isDerivedFrom("Path::Feature")]


def spoilers(operation: Any) -> Iterator[Any]:
    """Layers of others, in the object or below it, that stand above moves with tool-axis words."""
    for below in bases(operation):
        if not is_ours(operation) and Words.of(below.Path.Commands).axis_words().any():
            yield operation
        yield from spoilers(below)
