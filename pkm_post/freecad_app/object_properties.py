# SPDX-License-Identifier: LGPL-2.1-or-later
"""Object properties: adds user-visible properties to our document objects, from tables.

Takes rows; adds the properties. The same happens when a document is opened: one of an older version lacks
later properties. Names, types and units are a file format: they can be extended, not changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

Row = tuple[str, str, str, str, Any]
"""A property: its type, name, group, description, and its initial value or its choices."""

EDITABLE, READ_ONLY, HIDDEN = 0, 1, 2
"""Editor modes: whether the user can edit a property, only read it, or does not see it."""
NO_RECOMPUTE = 16
"""Attribute of a property whose change does not recompute the object."""
_NONE: Mapping[str, int] = MappingProxyType({})


def add_missing(obj: Any, rows: Iterable[Row], mode: int = EDITABLE, attributes: Mapping[str, int] = _NONE) -> None:
    """Add the properties that an object lacks.

    Args:
        obj: the document object.
        rows: the table.
        mode: editor mode of all of them.
        attributes: property attributes by name, where there are any.
    """
    for kind, name, group, text, value in rows:
        if not hasattr(obj, name):
            obj.addProperty(kind, name, group, text, attributes.get(name, 0))
            setattr(obj, name, value)
        if mode != EDITABLE:
            obj.setEditorMode(name, mode)
