# SPDX-License-Identifier: LGPL-2.1-or-later
"""Object properties: what our document objects have for people to set and to read, from tables.

Rows enter; the properties are there then. The same is done when a document is opened: one of an older version lacks
those that came later. Names, types and units are a file format: they can be added to, not changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

Row = tuple[str, str, str, str, Any]
"""A property: its type, name, group, what is said of it, and the value it has at first, or its choices."""

EDITABLE, READ_ONLY, HIDDEN = 0, 1, 2
"""Editor modes: whether people may set a property, read it alone, or do not see it."""
NO_RECOMPUTE = 16
"""Attribute of a property that can be set without the object being computed anew."""
_NONE: Mapping[str, int] = MappingProxyType({})


def add_missing(obj: Any, rows: Iterable[Row], mode: int = EDITABLE, attributes: Mapping[str, int] = _NONE) -> None:
    """Give an object the properties that it does not have yet.

    Args:
        obj: the document object.
        rows: the table.
        mode: editor mode of all of them.
        attributes: by name, attributes of properties that have some.
    """
    for kind, name, group, text, value in rows:
        if not hasattr(obj, name):
            obj.addProperty(kind, name, group, text, attributes.get(name, 0))
            setattr(obj, name, value)
        if mode != EDITABLE:
            obj.setEditorMode(name, mode)
