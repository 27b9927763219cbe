# SPDX-License-Identifier: LGPL-2.1-or-later
"""Operation state: conditions under which the path of a CAM operation is invalid.

Takes an active operation of a recomputed document; returns diagnostics. FreeCAD marks what it could not read or
compute, and continues.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pkm_post.freecad_app.commands.faults import not_text
from pkm_post.freecad_app.layers import bases, is_ours, spoilers
from pkm_post.model import Diagnostic, Place

_NOT_READ, _NOT_COMPUTED = "Restore", "Touched"
"""Entries of ``State``. The first remains until the document is closed, whatever is computed."""


def state_faults(operation: Any, source: str) -> list[Diagnostic]:
    """The faults of an operation before its commands are read: the first fault, or all layers in the way.

    Args:
        operation: of a job, active.
        source: name of the document.
    """
    place = Place(source, operation.Label)
    for code, found in _FAULTS:
        told = found(operation)
        if told:
            return [Diagnostic(code, place, told)]
    try:
        return [Diagnostic("J108", place, layer.Label) for layer in spoilers(operation)]
    except UnicodeDecodeError as fault:
        return [not_text(fault, source, operation.Label)]


def _has_no_path(operation: Any) -> str:
    return "" if operation.isDerivedFrom("Path::Feature") else f"a {operation.TypeId}"


def _not_read(operation: Any) -> str:
    return "its state is Restore" if _NOT_READ in operation.State else ""


def _not_valid(operation: Any) -> str:
    if not operation.isValid():
        return str(operation.getStatusString())
    return "the operation it copies is gone" if is_ours(operation) and operation.Base is None else ""


def _not_computed(operation: Any) -> str:
    return "its state is Touched" if _NOT_COMPUTED in operation.State else ""


def _empty(operation: Any) -> str:
    """A path that CAM computes has at least a comment; only one made from an inactive operation is entirely empty."""
    return "" if operation.Path.Size or _stands_on_inactive(operation) else "no command, not even a comment"


def _stands_on_inactive(operation: Any) -> bool:
    return any(getattr(below, "Active", True) is False or _stands_on_inactive(below) for below in bases(operation))


_FAULTS: tuple[tuple[str, Callable[[Any], str]], ...] = (
    ("J136", _has_no_path),
    ("J134", _not_read),
    ("J116", _not_valid),
    ("J133", _not_computed),
    ("J132", _empty),
)
"""Finding by code, empty if there is none, in this order: each test relies on those before it."""
