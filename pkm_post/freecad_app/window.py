# SPDX-License-Identifier: LGPL-2.1-or-later
"""Window: hooks of the GUI for document objects and long computations.

``freecad_gui.workbench.install`` registers them when FreeCAD starts with a GUI. Otherwise nothing is registered, and
objects have no views.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

VIEWS: dict[str, Callable[[Any], object]] = {}
"""Functions that attach the view provider to a view object, by kind of object."""
ESCAPE_WATCHES: list[Callable[[], Any]] = []
"""At most one: creates a watch with ``begin``, ``end`` and ``pressed``."""


REFUSALS: list[Callable[[Any, Any], object]] = []
"""At most one: shows a job with the diagnostics that prevented posting."""


def shows_refusal(job: Any, diagnostics: Any) -> bool:
    """Show why a job was not posted, if there is a GUI; return whether it was shown."""
    for show in REFUSALS:
        show(job, diagnostics)
    return bool(REFUSALS)


VERDICTS: list[Callable[[Any, Any], object]] = []
"""At most one: stores the findings of a post for the icons of a job and its operations."""


def show_verdict(job: Any, findings: Any) -> None:
    """Show the findings of posting an unmodified job in the tree, None at its start, if there is a GUI."""
    for show in VERDICTS:
        show(job, findings)


def add_view(kind: str, obj: Any) -> None:
    """Attach the view provider of a kind to an object, if there is a GUI."""
    if kind in VIEWS:
        VIEWS[kind](obj.ViewObject)


def escape_watch() -> Any:
    """A watch of the Escape key, or None without a GUI."""
    return ESCAPE_WATCHES[0]() if ESCAPE_WATCHES else None
