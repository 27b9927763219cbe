# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers: dress-ups, arrays and copies on top of a CAM operation, linked by their ``Base``.

Takes a document object; returns the objects below it, and the layers that would corrupt the tool axis. Stock dress-ups
rebuild moves from X Y Z and arrays rotate only these: I J K words below them are dropped or left unchanged.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pkm_post.freecad_app.commands.words import Words

_OURS = "pkm_post."


def is_ours(operation: Any) -> bool:
    """Whether the object belongs to this add-on, whose objects transform tool axes together with points."""
    return type(getattr(operation, "Proxy", None)).__module__.startswith(_OURS)


def bases(operation: Any) -> list[Any]:
    """The operations directly below; faces and edges from which an operation is made are excluded."""
    base = getattr(operation, "Base", None)
    linked = base if isinstance(base, list | tuple) else [base]
    return [below for below in linked if hasattr(below, "isDerivedFrom") and below.isDerivedFrom("Path::Feature")]


def spoilers(operation: Any) -> Iterator[Any]:
    """Yield third-party layers, the object itself or below it, on top of moves with tool-axis words."""
    for below in bases(operation):
        if not is_ours(operation) and Words.of(below.Path.Commands).axis_words().any():
            yield operation
        yield from spoilers(below)
