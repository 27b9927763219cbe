# SPDX-License-Identifier: LGPL-2.1-or-later
"""Window: what FreeCAD's window does for document objects and long computations.

``freecad_gui.workbench.install`` registers it when FreeCAD starts with a window. Without one nothing is registered, and
objects have no views.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

VIEWS: dict[str, Callable[[Any], object]] = {}
"""By the kind of object, what attaches its view provider to a view object."""
ESCAPE_WATCHES: list[Callable[[], Any]] = []
"""At most one: makes a watch with ``begin``, ``end`` and ``pressed``."""


REFUSALS: list[Callable[[Any, Any], object]] = []
"""At most one: shows a job and the diagnostics for which it was not posted."""


def shows_refusal(job: Any, diagnostics: Any) -> bool:
    """Show why a job was not posted, if there is a window; whether it was shown."""
    for show in REFUSALS:
        show(job, diagnostics)
    return bool(REFUSALS)


VERDICTS: list[Callable[[Any, Any], object]] = []
"""At most one: keeps the findings of a post for the icons of a job and its operations."""


def show_verdict(job: Any, findings: Any) -> None:
    """Let the tree show what posting found of a job as it is, None when it begins, if there is a window."""
    for show in VERDICTS:
        show(job, findings)


def add_view(kind: str, obj: Any) -> None:
    """Attach the view provider of a kind to an object, if there is a window."""
    if kind in VIEWS:
        VIEWS[kind](obj.ViewObject)


def escape_watch() -> Any:
    """A watch of the Escape key, or None without a window."""
    return ESCAPE_WATCHES[0]() if ESCAPE_WATCHES else None
